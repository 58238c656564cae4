#include "viewer/overlays/overlays.h"

#include <optional>
#include <vector>

#include "core/rail/clearance/structure_gauge.h"
#include "viewer/color/palette.h"
#include "viewer/overlays/strokes.h"
#include "viewer/overlays/track_stretch.h"

namespace railcast {
namespace {

constexpr Rgb kGaugeRgb = kReddishPurple;
constexpr double kRingStep_m = 10.0;

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

Overlay DrawStructureGauge(const Surroundings& surroundings, const RecordedFrame& recorded) {
  Overlay drawing;
  const RailWorld& world = *surroundings.world;
  const std::optional<TrackStretch> stretch =
      StretchAbout(world, recorded, kGaugeBehind_m, kGaugeAhead_m);
  if (!stretch) return drawing;
  const std::vector<Eigen::Vector2d> outline = GaugeOutline(
      ContactHeightOver_m(world.vehicle_track(), surroundings.scenario.world.catenary));
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
