#include "core/rail/clearance/clear_space.h"

#include <algorithm>
#include <cmath>

#include "core/rail/clearance/vehicle_outline.h"
#include "core/rail/line/alignment_course.h"

namespace railcast {

double CurveWidening_m(double curvature_per_m, double side) {
  constexpr double kTight_per_m = 1.0 / 250.0;
  const double bend_per_m = std::abs(curvature_per_m);
  if (bend_per_m <= kTight_per_m) return 3.75 * bend_per_m;
  const bool is_inside = curvature_per_m * side > 0.0;
  return is_inside ? 50.0 * bend_per_m - 0.185 : 60.0 * bend_per_m - 0.225;
}

TrackBend BendAt(const TrackCourse& track, const Alignment& alignment, double s_m) {
  constexpr double kMetresPerMm = 1e-3;
  return {.curvature_per_m = track.CurvatureAt(alignment, s_m),
          .cant_m =
              kMetresPerMm * kStandardSpacing_mm * std::abs(std::sin(alignment.At(s_m).cant_rad))};
}

double CantWidening_m(double height_m, double cant_m) {
  constexpr double kFlexibility = 0.4;
  constexpr double kBase_m = 1.5;
  constexpr double kIncludedCant_m = 0.05;
  constexpr double kRollCentre_m = 0.5;
  return kFlexibility / kBase_m * std::max(cant_m - kIncludedCant_m, 0.0) *
         std::max(height_m - kRollCentre_m, 0.0);
}

std::vector<HalfWidth> ClearHalfWidths(const WorldSpec& world) {
  if (!world.clear_space.empty()) return world.clear_space;
  return {kClearHalfWidths.begin(), kClearHalfWidths.end()};
}

std::vector<HalfWidth> ClearSpace(std::vector<HalfWidth> rows,
                                  std::optional<double> contact_height_m,
                                  const TrackBend& bend,
                                  double side) {
  for (HalfWidth& row : rows) {
    row.half_width_m +=
        CurveWidening_m(bend.curvature_per_m, side) + CantWidening_m(row.height_m, bend.cant_m);
  }
  const std::optional<double> pantograph_m =
      contact_height_m ? PantographHalfWidth_m(*contact_height_m) : std::nullopt;
  if (!pantograph_m || rows.back().height_m >= kPantographTop_m) return rows;
  std::size_t num_wider = rows.size();
  while (num_wider > 0 && rows[num_wider - 1].half_width_m < *pantograph_m) --num_wider;
  if (num_wider < rows.size()) {
    HalfWidth& first = rows[num_wider];
    if (num_wider > 0) {
      const HalfWidth& below = rows[num_wider - 1];
      const double share =
          (below.half_width_m - *pantograph_m) / (below.half_width_m - first.half_width_m);
      first.height_m = std::lerp(below.height_m, first.height_m, share);
    }
    first.half_width_m = *pantograph_m;
    rows.resize(num_wider + 1);
  }
  const double from_m = rows.back().height_m;
  rows.push_back({from_m, *pantograph_m});
  rows.push_back({kPantographTop_m, *pantograph_m});
  return rows;
}

}  // namespace railcast
