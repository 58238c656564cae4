#include "core/rail/objects/wagon_parts.h"

#include <numbers>
#include <utility>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using Point2 = Eigen::Vector2d;

}  // namespace

Model MakeVehicleOf(std::string name, std::initializer_list<SurfaceClass> surfaces) {
  Model vehicle{.name = std::move(name), .parts = {}};
  for (const SurfaceClass& surface : surfaces) (void)PartOf(surface, vehicle);
  return vehicle;
}

Mesh MakeBlock(const Vector3& min_m, const Vector3& max_m) {
  return MakeBox(Eigen::AlignedBox3d(min_m, max_m));
}

Mesh MakeBar(const Vector3& begin_m, const Vector3& end_m, double radius_m) {
  const std::array<Vector3, 2> axis = {begin_m, end_m};
  constexpr double kThin_m = 0.025;
  return MakeTube(axis, radius_m, radius_m < kThin_m ? 4 : 8);
}

Mesh MakePlate(std::span<const Point2> outline, double begin_y_m, double end_y_m) {
  std::vector<Point2> turned;
  turned.reserve(outline.size());
  for (const Point2& point : outline) turned.emplace_back(-point.x(), point.y());
  Mesh plate;
  plate.Append(
      MakeExtrusion(turned, begin_y_m, end_y_m),
      MakeTransform(RotationFromYawPitchRoll(0.5 * std::numbers::pi, 0, 0), Vector3::Zero()));
  return plate;
}

Mesh MakeSideBlock(double side, const Vector3& min_m, const Vector3& max_m) {
  if (side > 0.0) return MakeBlock(min_m, max_m);
  return MakeBlock({min_m.x(), -max_m.y(), min_m.z()}, {max_m.x(), -min_m.y(), max_m.z()});
}

Mesh MakeEndBlock(double end, const Vector3& min_m, const Vector3& max_m) {
  if (end > 0.0) return MakeBlock(min_m, max_m);
  return MakeBlock({-max_m.x(), min_m.y(), min_m.z()}, {-min_m.x(), max_m.y(), max_m.z()});
}

Mesh MakeCornerSteps(double x_m, double y_m, double sill_z_m) {
  Mesh frame;
  for (const double end : kBothSides) {
    for (const double side : kBothSides) {
      const double x0 = end * x_m;
      const double y0 = side * y_m;
      for (const double leg : {-0.17, 0.17}) {
        frame.Append(MakeBar({x0 + leg, y0, 0.48}, {x0 + leg, y0, sill_z_m}, 0.018));
      }
      frame.Append(MakeBlock({x0 - 0.19, y0 - 0.12, 0.46}, {x0 + 0.19, y0 + 0.12, 0.49}));
    }
  }
  return frame;
}

Mesh MakeCentreSill(double half_length_m, double pivot_distance_m, double top_z_m) {
  Mesh frame;
  for (const double side : kBothSides) {
    frame.Append(MakeSideBlock(side, {-half_length_m, 0.22, 0.90}, {half_length_m, 0.30, top_z_m}));
    const double pivot_m = side * pivot_distance_m / 2.0;
    frame.Append(MakeBlock({pivot_m - 0.2, -1.2, kBogieTop_m}, {pivot_m + 0.2, 1.2, top_z_m}));
  }
  return frame;
}

Mesh MakeBrakeGear(double pivot_distance_m) {
  Mesh frame;
  const std::vector<Point2> reservoir = {{0.0, 0.0}, {0.08, 0.19}, {1.02, 0.19}, {1.10, 0.0}};
  const Mesh drum = MakeLathe(reservoir, 8);
  frame.Append(drum, MakeTransform(Eigen::Matrix3d::Identity(), {0.5, 0.65, 0.78}));
  frame.Append(drum, MakeTransform(Eigen::Matrix3d::Identity(), {-1.6, -0.65, 0.78}));
  frame.Append(MakeBar({-0.3, 0.45, 0.80}, {0.2, 0.45, 0.80}, 0.16));
  const double end_m = pivot_distance_m / 2.0;
  frame.Append(MakeBar({-end_m, 0.0, 0.72}, {end_m, 0.0, 0.72}, 0.03));
  return frame;
}

}  // namespace railcast
