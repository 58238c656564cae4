#include "viewer/overlays/empty_beams.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/io/cloud/scan_motion.h"
#include "viewer/color/palette.h"
#include "viewer/overlays/strokes.h"

namespace railcast {
namespace {

bool IsEmpty(const Frame& frame, std::size_t firing) {
  const auto first =
      frame.range_m.begin() + static_cast<std::ptrdiff_t>(firing * std::size_t{frame.returns});
  return std::none_of(first, first + frame.returns,
                      [](float range_m) { return std::isfinite(range_m); });
}

}  // namespace

Overlay DrawEmptyBeams(const RecordedFrame& recorded, const Beams& beams) {
  Overlay drawing;
  const Frame& frame = recorded.frame;
  if (!recorded.is_grid) return drawing;
  Check(beams.rows == frame.rows && beams.columns == frame.columns, "beams are those of the frame");
  const bool has_outcomes = recorded.Has("outcome");
  const bool has_true_ranges = recorded.Has("true_range_m");
  const ScanMotion motion(frame);
  drawing.segments.reserve(beams.directions.size());
  for (std::size_t firing = 0; firing < beams.directions.size(); ++firing) {
    const Vector3 direction = beams.directions[firing].cast<double>();
    if (!IsEmpty(frame, firing) || !direction.allFinite()) continue;
    const std::size_t slot = firing * frame.returns;
    const bool has_end = has_true_ranges && std::isfinite(frame.true_range_m[slot]);
    const double end_m = has_end ? static_cast<double>(frame.true_range_m[slot]) : kEmptyBeamStub_m;
    const double start_m = end_m > kEmptyBeamStart_m ? kEmptyBeamStart_m : 0.0;
    AddSegment(motion.AtStamp(start_m * direction, beams.times_ns[firing]),
               motion.AtStamp(end_m * direction, beams.times_ns[firing]),
               has_outcomes ? OutcomeRgb(frame.outcome[slot]) : kUnknownOutcomeRgb, drawing);
    drawing.segments.back().opacity = has_end ? kLostBeamOpacity : kOpenBeamOpacity;
  }
  return drawing;
}

}  // namespace railcast
