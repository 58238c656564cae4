#include "core/rail/objects/pantograph.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr double kInsulator_m = 0.30;
constexpr double kLowerArm_m = 1.25;
constexpr double kUpperArm_m = 1.60;
constexpr double kHeadHeight_m = 0.13;  ///< From the top of the upper arm to the contact strips.

/// The head: two contact strips with horns that bend down at both ends.
Mesh MakeContactHead(double x_m, double top_m) {
  constexpr double kStripHalf_m = 0.55;
  constexpr double kHeadHalf_m = 0.975;
  Mesh head;
  for (const double end : kBothSides) {
    const double strip_m = x_m + end * 0.19;
    head.Append(MakeBlock({strip_m - 0.03, -kStripHalf_m, top_m - 0.045},
                          {strip_m + 0.03, kStripHalf_m, top_m}));
    for (const double side : kBothSides) {
      const std::vector<Vector3> horn = {{strip_m, side * (kStripHalf_m - 0.03), top_m - 0.025},
                                         {strip_m, side * 0.72, top_m - 0.05},
                                         {strip_m, side * 0.88, top_m - 0.15},
                                         {strip_m, side * (kHeadHalf_m - 0.02), top_m - 0.29}};
      head.Append(MakeTube(horn, 0.02, 6));
    }
  }
  for (const double y_m : {-0.42, 0.42}) {
    head.Append(MakeBar({x_m - 0.19, y_m, top_m - 0.05}, {x_m + 0.19, y_m, top_m - 0.05}, 0.018));
    head.Append(MakeBar({x_m, y_m, top_m - 0.05}, {x_m, y_m, top_m - kHeadHeight_m}, 0.02));
  }
  head.Append(
      MakeBar({x_m, -0.45, top_m - kHeadHeight_m}, {x_m, 0.45, top_m - kHeadHeight_m}, 0.028));
  return head;
}

}  // namespace

void AddRoofInsulator(const Vector3& foot_m, const RailSurfaces& surfaces, Model& vehicle) {
  std::vector<Eigen::Vector2d> sheds = {{0.0, 0.05}};
  for (int i = 0; i < 2; ++i) {
    const double z_m = 0.05 + 0.11 * i;
    sheds.emplace_back(z_m, 0.045);
    sheds.emplace_back(z_m + 0.03, 0.085);
    sheds.emplace_back(z_m + 0.06, 0.045);
  }
  sheds.emplace_back(kInsulator_m, 0.05);
  MeshOf(surfaces.vehicles.insulator, vehicle)
      .Append(MakeLathe(sheds, 6),
              MakeTransform(RotationFromYawPitchRoll(0, -0.5 * std::numbers::pi, 0), foot_m));
}

void AddPantograph(const PantographPlace& place, const RailSurfaces& surfaces, Model& vehicle) {
  const double frame_m = place.base_m + kInsulator_m;
  for (const double y_m : {-0.55, 0.55}) {
    for (const double x_m : {-0.45, 0.45}) {
      AddRoofInsulator({place.x_m + x_m, y_m, place.base_m}, surfaces, vehicle);
    }
  }
  // Foot of the lower arm, and the head straight above the middle of the base.
  const Vector3 foot(place.x_m + place.knee * 0.35, 0.0, frame_m + 0.06);
  const Vector3 head(place.x_m, 0.0, place.contact_height_m - kHeadHeight_m);
  const Vector3 across = head - foot;
  const double reach_m = across.norm();
  const double along_m =
      (reach_m * reach_m + kLowerArm_m * kLowerArm_m - kUpperArm_m * kUpperArm_m) / (2.0 * reach_m);
  const double beside_m = std::sqrt(std::max(0.0, kLowerArm_m * kLowerArm_m - along_m * along_m));
  const Vector3 direction = across / reach_m;
  const Vector3 square(place.knee * std::abs(direction.z()), 0.0,
                       -direction.x() * place.knee * (direction.z() >= 0.0 ? 1.0 : -1.0));
  const Vector3 knee = foot + along_m * direction + beside_m * square;
  Mesh& mesh = MeshOf(surfaces.vehicles.collector, vehicle);
  for (const double y_m : {-0.55, 0.55}) {
    mesh.Append(MakeBar({place.x_m - 0.6, y_m, frame_m + 0.03},
                        {place.x_m + 0.6, y_m, frame_m + 0.03}, 0.035));
  }
  for (const double x_m : {-0.45, 0.45}) {
    mesh.Append(MakeBar({place.x_m + x_m, -0.58, frame_m + 0.04},
                        {place.x_m + x_m, 0.58, frame_m + 0.04}, 0.04));
  }
  mesh.Append(MakeBar(foot, knee, 0.055));
  const Vector3 drawbar(-place.knee * 0.16, 0.0, -0.04);
  mesh.Append(MakeBar(foot - drawbar, knee + 0.6 * drawbar, 0.02));
  for (const double side : kBothSides) {
    mesh.Append(
        MakeBar(knee + Vector3(0, side * 0.10, 0), head + Vector3(0, side * 0.34, 0), 0.026));
  }
  mesh.Append(MakeBar(knee - Vector3(0, 0.16, 0), knee + Vector3(0, 0.16, 0), 0.05));
  mesh.Append(MakeContactHead(place.x_m, place.contact_height_m));
}

}  // namespace railcast
