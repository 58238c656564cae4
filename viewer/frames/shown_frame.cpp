#include "viewer/frames/shown_frame.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/io/recording/recorded_motion.h"

namespace railcast {
namespace {

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
