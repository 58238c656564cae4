#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/rolling_stock.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using OutlinePoint = Eigen::Vector2d;

/// ISO 668: 8 feet wide and 8 feet 6 inches high.
constexpr double kContainerHalfWidth_m = 2.438 / 2.0;
constexpr double kContainerHeight_m = 2.591;
constexpr double kContainer40Length_m = 12.192;
constexpr double kContainer20Length_m = 6.058;
constexpr double kContainerBottom_m = 1.16;  ///< Top of the wagon's supports.

/// Outer face of a corrugated side wall in plan, from the back to the front: 36 mm deep, every
/// 0.278 m (the usual pressed sheet).
std::vector<OutlinePoint> CorrugatedFace(double half_length_m, double y_m) {
  constexpr double kPitch_m = 0.278;
  constexpr double kDepth_m = 0.036;
  const double begin_m = -half_length_m + 0.16;
  const int num_waves = static_cast<int>((2.0 * half_length_m - 0.32) / kPitch_m);
  const double pitch_m = (2.0 * half_length_m - 0.32) / num_waves;
  std::vector<OutlinePoint> face = {{begin_m, y_m}};
  for (int i = 0; i < num_waves; ++i) {
    const double x_m = begin_m + i * pitch_m;
    face.emplace_back(x_m + 0.25 * pitch_m, y_m);
    face.emplace_back(x_m + 0.50 * pitch_m, y_m - kDepth_m);
    face.emplace_back(x_m + 0.75 * pitch_m, y_m - kDepth_m);
    face.emplace_back(x_m + pitch_m, y_m);
  }
  return face;
}

/// The box between the corner posts and rails: corrugated sides, flat ends.
Mesh MakeContainerWalls(double half_length_m) {
  std::vector<OutlinePoint> outline;
  // MakeExtrusion takes (y, z) and extends along x, which turns upwards: y stays, z becomes -x.
  for (const OutlinePoint& point : CorrugatedFace(half_length_m, kContainerHalfWidth_m - 0.012)) {
    outline.emplace_back(point.y(), -point.x());
  }
  for (std::size_t i = outline.size(); i-- > 0;) {
    const OutlinePoint left = outline[i];
    outline.emplace_back(-left.x(), left.y());
  }
  Mesh walls;
  walls.Append(
      MakeExtrusion(outline, 0.15, kContainerHeight_m - 0.05),
      MakeTransform(RotationFromYawPitchRoll(0, -0.5 * std::numbers::pi, 0), Vector3::Zero()));
  return walls;
}

/// Corner posts with their castings, and the rails between them.
Mesh MakeContainerFrame(double half_length_m) {
  Mesh frame;
  const double y_m = kContainerHalfWidth_m;
  for (const double side : kBothSides) {
    for (const double end : kBothSides) {
      const double x_m = end * half_length_m;
      const double inner_m = x_m - end * 0.178;
      for (const double z_m : {0.0, kContainerHeight_m - 0.118}) {
        frame.Append(MakeSideBlock(side, {std::min(x_m, inner_m), y_m - 0.162, z_m},
                                   {std::max(x_m, inner_m), y_m, z_m + 0.118}));
      }
      const double post_m = x_m - end * 0.16;
      frame.Append(MakeSideBlock(side, {std::min(x_m, post_m), y_m - 0.15, 0.118},
                                 {std::max(x_m, post_m), y_m - 0.004, kContainerHeight_m - 0.118}));
    }
    const double end_m = half_length_m - 0.178;
    frame.Append(MakeSideBlock(side, {-end_m, y_m - 0.06, 0.012}, {end_m, y_m - 0.004, 0.16}));
    frame.Append(MakeSideBlock(side, {-end_m, y_m - 0.06, kContainerHeight_m - 0.07},
                               {end_m, y_m - 0.004, kContainerHeight_m - 0.006}));
  }
  for (const double end : kBothSides) {
    for (const double z_m : {0.012, kContainerHeight_m - 0.13}) {
      frame.Append(MakeEndBlock(end, {half_length_m - 0.10, -y_m + 0.162, z_m},
                                {half_length_m - 0.004, y_m - 0.162, z_m + 0.12}));
    }
  }
  return frame;
}

/// The doors at the back: two leaves with their lock bars.
Mesh MakeContainerDoors(double half_length_m) {
  Mesh doors;
  const double x_m = half_length_m - 0.05;
  for (const double side : kBothSides) {
    doors.Append(MakeSideBlock(side, {-x_m, 0.01, 0.14}, {-x_m + 0.05, 1.05, 2.46}));
    for (const double y_m : {0.25, 0.75}) {
      doors.Append(
          MakeBar({-x_m - 0.02, side * y_m, 0.10}, {-x_m - 0.02, side * y_m, 2.50}, 0.017));
      for (const double z_m : {0.2, 1.0, 2.4}) {
        doors.Append(MakeSideBlock(side, {-x_m - 0.04, y_m - 0.05, z_m},
                                   {-x_m + 0.01, y_m + 0.05, z_m + 0.06}));
      }
      doors.Append(
          MakeSideBlock(side, {-x_m - 0.045, y_m - 0.2, 1.02}, {-x_m - 0.01, y_m + 0.02, 1.06}));
    }
  }
  return doors;
}

Mesh MakeContainer(double length_m) {
  Mesh container = MakeContainerWalls(length_m / 2.0);
  container.Append(MakeContainerFrame(length_m / 2.0));
  container.Append(MakeContainerDoors(length_m / 2.0));
  return container;
}

}  // namespace

RailVehicleModel MakeContainerWagon(const RailSurfaces& surfaces) {
  RailVehicleModel wagon = MakeFlatWagon(surfaces);
  wagon.body.name = "container_wagon";
  // The outer corner castings rest on the outermost spigots, which are 9.02 m from the middle.
  constexpr double kEnd_m = 9.135;
  const auto place = [&](const SurfaceClass& surface, double length_m, double middle_m) {
    MeshOf(surface, wagon.body)
        .Append(MakeContainer(length_m),
                MakeTransform(Eigen::Matrix3d::Identity(), {middle_m, 0.0, kContainerBottom_m}));
  };
  place(surfaces.vehicles.container, kContainer40Length_m, kEnd_m - kContainer40Length_m / 2.0);
  place(surfaces.vehicles.light_container, kContainer20Length_m,
        -kEnd_m + kContainer20Length_m / 2.0);
  return wagon;
}

}  // namespace railcast
