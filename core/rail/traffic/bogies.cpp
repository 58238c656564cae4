#include "core/rail/traffic/bogies.h"

#include <cmath>

namespace railcast {
namespace {

/// Whether the bogies of a standing vehicle are where they are on straight track.
bool StandsStraight(const TrackPath& path, const Alignment& alignment) {
  constexpr double kRounding = 1e-9;
  const auto [body, front, rear] = path.WorldFromVehicleAt(alignment, path.ChainageAt(0));
  const Eigen::Matrix3d& axes = body.linear();
  return front.linear().isApprox(axes, kRounding) && rear.linear().isApprox(axes, kRounding);
}

}  // namespace

bool RestsOnPivots(const ObjectSpec& object) {
  return IsRailVehicle(object.type) && object.follow.value_or(Follow::kTrack) == Follow::kTrack &&
         object.roll_deg == 0.0 && object.pitch_deg == 0.0;
}

void GiveBogies(const ObjectSpec& spec,
                const TrackPath& path,
                const Alignment& alignment,
                ObjectModels& models,
                SceneObject& object) {
  constexpr double kRounding_rad = 1e-9;
  const TrackPose& pose = path.pose();
  const bool is_along = std::abs(std::sin(pose.heading_rad)) <= kRounding_rad;
  if (!(pose.pivot_distance_m > 0.0) || !is_along) return;
  if (!path.moves() && StandsStraight(path, alignment)) return;
  object.pieces = models.VehiclePiecesOf(spec);
}

}  // namespace railcast
