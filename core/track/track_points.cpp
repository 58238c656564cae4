#include "core/track/track_points.h"

#include <array>
#include <cmath>

#include "core/io/recording/recorded_motion.h"
#include "core/rail/clearance/clear_space.h"

namespace railcast {
namespace {

/// Half the width of an outline at a height: linear between rows, 0 beyond them.
double HalfWidthAt_m(const std::vector<HalfWidth>& rows, double height_m) {
  double half_width_m = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const HalfWidth& below = rows[i - 1];
    const HalfWidth& above = rows[i];
    if (height_m < below.height_m || !(height_m < above.height_m)) continue;
    const double share = (height_m - below.height_m) / (above.height_m - below.height_m);
    half_width_m = std::lerp(below.half_width_m, above.half_width_m, share);
  }
  return half_width_m;
}

}  // namespace

std::vector<PointByTrack> PlacePoints(const RecordedFrame& recorded,
                                      const FoundTrack& track,
                                      double cant_m) {
  const RecordedMotion motion(recorded, Compensation::kSensor);
  const std::vector<GaugePart> outline = VehicleOutline(std::nullopt);
  const std::vector<HalfWidth> rows(kClearHalfWidths.begin(), kClearHalfWidths.end());
  const TrackBend bend{track.curvature_per_m.value, std::abs(cant_m)};
  const std::array<std::vector<HalfWidth>, 2> clear = {ClearSpace(rows, std::nullopt, bend, 1.0),
                                                       ClearSpace(rows, std::nullopt, bend, -1.0)};
  const double known_m = track.KnownFor_m(kMostTrackMargin_m);
  std::vector<PointByTrack> places(recorded.frame.num_slots());
  for (std::size_t slot = 0; slot < places.size(); ++slot) {
    if (!std::isfinite(recorded.frame.x[slot])) continue;
    const Vector3 place_m = track.Place_m(motion.PointOf(slot).cast<double>());
    if (!(std::abs(place_m.x()) <= known_m)) continue;
    const double lateral_m = place_m.y();
    const double height_m = place_m.z();
    const double clear_m = HalfWidthAt_m(clear[lateral_m > 0.0 ? 0 : 1], height_m);
    places[slot] = {static_cast<float>(place_m.x()), static_cast<float>(lateral_m),
                    static_cast<float>(height_m), IsInside(outline, lateral_m, height_m),
                    height_m > 0.0 && std::abs(lateral_m) < clear_m};
  }
  return places;
}

}  // namespace railcast
