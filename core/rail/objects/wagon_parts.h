#pragma once

#include <Eigen/Core>
#include <array>
#include <initializer_list>
#include <span>
#include <string>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// Running gear and coupling, common to all wagons. Frame: x along the wagon, y left, z up from top
/// of rail; metres. Dimensions are those of the UIC standard wagon parts.

inline constexpr double kWheelRadius_m = 0.46;         ///< At the tape circle.
inline constexpr double kTapeCircleDistance_m = 1.5;   ///< Between the two wheels' tape circles.
inline constexpr double kFlangeBackDistance_m = 1.36;  ///< Between the backs of the flanges.
inline constexpr double kFlangeHeight_m = 0.028;       ///< Extent below top of rail.
inline constexpr double kBogieAxleBase_m = 1.8;
inline constexpr double kBufferHeight_m = 1.06;
inline constexpr double kBufferDistance_m = 1.75;
inline constexpr double kBufferRadius_m = 0.225;
inline constexpr double kBufferLength_m = 0.62;  ///< From the headstock to the buffer face.
inline constexpr double kBogieTop_m = 0.93;      ///< Height at which the wagon's bolster rests.

/// A Y25-type bogie about its pivot.
[[nodiscard]] Model MakeWagonBogie(const RailSurfaces& surfaces);

/// Place of a wheelset along its bogie, and its size.
struct WheelsetPlace {
  double x_m{};
  double radius_m = kWheelRadius_m;  ///< At the tape circle.
};

/// Adds two wheels on their axle.
void AddWheelset(const WheelsetPlace& place, const SurfaceClass& surface, Model& bogie);

/// Adds headstock, buffers, draw hook with screw coupling, and brake hoses at both ends of a
/// vehicle whose buffer faces are `length_m` apart.
void AddDrawAndBufferGear(double length_m, const SurfaceClass& surface, Model& vehicle);

/// A model with an empty part for each of these surfaces, so that references to their meshes stay
/// valid while others are added to (model_parts.h).
[[nodiscard]] Model MakeVehicleOf(std::string name, std::initializer_list<SurfaceClass> surfaces);

/// Elements from which wagons are composed. Frame: x along the wagon, y left, z up from top of
/// rail; metres.

/// Right and left, or back and front.
inline constexpr std::array<double, 2> kBothSides = {-1.0, 1.0};

/// A box between two opposite corners.
[[nodiscard]] Mesh MakeBlock(const Vector3& min_m, const Vector3& max_m);

/// A box specified for the left side, either placed there (`side` 1) or mirrored to the right (-1).
[[nodiscard]] Mesh MakeSideBlock(double side, const Vector3& min_m, const Vector3& max_m);

/// A box specified for the front end, either placed there (`end` 1) or mirrored to the back (-1).
[[nodiscard]] Mesh MakeEndBlock(double end, const Vector3& min_m, const Vector3& max_m);

/// A bar with eight sides, or square if it is thinner than 50 mm.
[[nodiscard]] Mesh MakeBar(const Vector3& begin_m, const Vector3& end_m, double radius_m);

/// A plate extending in y from `begin_y_m` to `end_y_m`, over an outline of (x, z) points.
[[nodiscard]] Mesh MakePlate(std::span<const Eigen::Vector2d> outline,
                             double begin_y_m,
                             double end_y_m);

/// Shunter's steps at the four corners, (+-x, +-y), hanging from `sill_z_m`.
[[nodiscard]] Mesh MakeCornerSteps(double x_m, double y_m, double sill_z_m);

/// Two longitudinal centre members and the bolsters that rest on the bogies.
[[nodiscard]] Mesh MakeCentreSill(double half_length_m, double pivot_distance_m, double top_z_m);

/// Air reservoirs, brake cylinder and brake rod below the middle of the wagon.
[[nodiscard]] Mesh MakeBrakeGear(double pivot_distance_m);

}  // namespace railcast
