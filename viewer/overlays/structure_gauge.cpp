#include "viewer/overlays/structure_gauge.h"

#include <array>
#include <utility>

#include "viewer/color/okabe_ito.h"
#include "viewer/overlays/strokes.h"
#include "viewer/overlays/track_stretch.h"

namespace railcast {
namespace {

constexpr Rgb kGaugeRgb = kReddishPurple;
constexpr double kRingStep_m = 10.0;
constexpr double kWagonHalfWidth_m = 1.575;
constexpr double kWagonHeight_m = 4.28;
constexpr double kPantographTop_m = 5.2;
// Contact wires up to ..., half width.
constexpr std::array<std::pair<double, double>, 4> kPantographHalfWidths_m = {
    {{5.3, 1.43}, {5.5, 1.44}, {5.9, 1.47}, {6.5, 1.51}}};

std::vector<Vector3> OutlineAt(const TrackStretch& stretch,
                               const std::vector<Eigen::Vector2d>& outline,
                               double s_m) {
  const Transform sensor_from_track = stretch.SensorFromTrack(s_m);
  std::vector<Vector3> corners;
  for (const Eigen::Vector2d& corner : outline) {
    corners.emplace_back(sensor_from_track * Vector3(0.0, corner.x(), corner.y()));
  }
  return corners;
}

}  // namespace

std::optional<double> PantographHalfWidth_m(double contact_height_m) {
  for (const auto& [highest_m, half_width_m] : kPantographHalfWidths_m) {
    if (contact_height_m <= highest_m) return half_width_m;
  }
  return std::nullopt;
}

std::vector<Eigen::Vector2d> GaugeOutline(std::optional<double> contact_height_m) {
  std::vector<Eigen::Vector2d> left = {{kWagonHalfWidth_m, 0.0},
                                       {kWagonHalfWidth_m, kWagonHeight_m}};
  const std::optional<double> half_width_m =
      contact_height_m ? PantographHalfWidth_m(*contact_height_m) : std::nullopt;
  if (half_width_m) {
    left.emplace_back(*half_width_m, kWagonHeight_m);
    left.emplace_back(*half_width_m, kPantographTop_m);
  }
  std::vector<Eigen::Vector2d> outline = left;
  for (auto corner = left.rbegin(); corner != left.rend(); ++corner) {
    outline.emplace_back(-corner->x(), corner->y());
  }
  return outline;
}

Drawing DrawStructureGauge(const Surroundings& surroundings, const RecordedFrame& recorded) {
  Drawing drawing;
  const RailWorld& world = *surroundings.world;
  const std::optional<TrackStretch> stretch =
      StretchAbout(world, recorded, kGaugeBehind_m, kGaugeAhead_m);
  if (!stretch) return drawing;
  const CatenarySpec& catenary = surroundings.scenario.world.catenary;
  const bool has_wire = catenary.enabled && world.vehicle_track().electrified;
  const std::vector<Eigen::Vector2d> outline =
      GaugeOutline(has_wire ? std::optional(catenary.contact_height_m) : std::nullopt);
  for (const double s_m : stretch->WholeChainages_m(kRingStep_m)) {
    std::vector<Vector3> ring = OutlineAt(*stretch, outline, s_m);
    ring.push_back(ring.front());
    AddPolyline(ring, kGaugeRgb, drawing);
  }
  std::vector<Vector3> last;
  for (const double s_m : stretch->LineChainages_m()) {
    const std::vector<Vector3> corners = OutlineAt(*stretch, outline, s_m);
    for (std::size_t i = 0; i < last.size(); ++i) {
      AddSegment(last[i], corners[i], kGaugeRgb, drawing);
    }
    last = corners;
  }
  return drawing;
}

}  // namespace railcast
