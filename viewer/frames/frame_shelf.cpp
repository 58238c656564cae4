#include "viewer/frames/frame_shelf.h"

#include <algorithm>
#include <string_view>
#include <vector>

namespace railcast {
namespace {

template <typename Value>
std::size_t NumBytesOf(const std::vector<Value>& values) {
  return values.capacity() * sizeof(Value);
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

}  // namespace railcast
