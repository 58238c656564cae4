#include "viewer/frames/shown_frame.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "core/io/recording/recorded_motion.h"

namespace railcast {
namespace {

template <typename Value>
std::size_t NumBytesOf(const std::vector<Value>& values) {
  return values.capacity() * sizeof(Value);
}

void UndoMotion(const RecordedFrame& recorded, ShownFrame& shown) {
  constexpr std::size_t kGrain = 4096;
  const RecordedMotion motion(recorded, Compensation::kAll);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, shown.num_points(), kGrain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        Eigen::Map<Eigen::Vector3f>(&shown.positions_m[3 * i]) =
                            motion.PointOf(shown.slots[i]);
                      }
                    });
}

}  // namespace

std::size_t NumBytesOf(const ShownFrame& shown) {
  const RecordedFrame& recorded = *shown.recorded;
  std::size_t num_bytes = sizeof(ShownFrame) + sizeof(RecordedFrame) +
                          NumBytesOf(shown.positions_m) + NumBytesOf(shown.slots) +
                          NumBytesOf(recorded.objects);
  ForEachField(recorded.frame, [&](std::string_view, std::string_view, const auto& values) {
    num_bytes += NumBytesOf(values);
  });
  for (const ForeignField& field : recorded.foreign) num_bytes += NumBytesOf(field.values);
  return num_bytes;
}

void FrameShelf::Put(std::size_t place, std::shared_ptr<const ShownFrame> shown) {
  num_bytes_ += NumBytesOf(*shown);
  frames_.emplace_front(place, std::move(shown));
  while (frames_.size() > 1 &&
         (frames_.size() > limits_.num_frames || num_bytes_ > limits_.num_bytes)) {
    num_bytes_ -= NumBytesOf(*frames_.back().second);
    frames_.pop_back();
  }
}

std::shared_ptr<const ShownFrame> FrameShelf::Find(std::size_t place) const {
  const auto found = std::ranges::find(frames_, place, [](const auto& kept) { return kept.first; });
  return found == frames_.end() ? nullptr : found->second;
}

std::shared_ptr<const ShownFrame> FrameShelf::Use(std::size_t place) {
  const auto found = std::ranges::find(frames_, place, [](const auto& kept) { return kept.first; });
  if (found == frames_.end()) return nullptr;
  frames_.splice(frames_.begin(), frames_, found);
  return found->second;
}

ShownFrame MakeShownFrame(RecordedFrame recorded) {
  ShownFrame shown;
  const Frame& frame = recorded.frame;
  // Many frames are kept, so the vectors are made without spare capacity.
  const auto num_points = static_cast<std::size_t>(
      std::ranges::count_if(frame.x, [](float x_m) { return !std::isnan(x_m); }));
  shown.positions_m.reserve(3 * num_points);
  shown.slots.reserve(num_points);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (std::isnan(frame.x[slot])) continue;
    shown.positions_m.insert(shown.positions_m.end(),
                             {frame.x[slot], frame.y[slot], frame.z[slot]});
    shown.slots.push_back(static_cast<std::uint32_t>(slot));
  }
  if (KnowsMotion(recorded)) UndoMotion(recorded, shown);
  shown.recorded = std::make_shared<const RecordedFrame>(std::move(recorded));
  return shown;
}

}  // namespace railcast
