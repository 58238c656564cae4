#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/objects.h"
#include "railcast/scene.h"

namespace railcast {

/// The shipped models as scenes have them, with the tables of test_tables.h.

/// The pieces of a model: a rail vehicle's body and bogie, or the whole.
[[nodiscard]] std::vector<Model> PiecesOfModel(const ObjectType& type);
/// The whole, a rail vehicle on its two bogies.
[[nodiscard]] Model WholeModel(const ObjectType& type);

/// All types that railcast ships as models whose label is one of these.
[[nodiscard]] std::vector<ObjectType> TypesLabelled(const std::vector<std::string>& labels);

/// The surface of that material and label.
[[nodiscard]] SurfaceClass SurfaceNamed(const std::string& material, const std::string& label);

/// Of UIC's standard running gear.
inline constexpr double kWheelRadius_m = 0.46;         ///< At the tape circle.
inline constexpr double kTapeCircleDistance_m = 1.5;   ///< Between the two wheels' tape circles.
inline constexpr double kFlangeBackDistance_m = 1.36;  ///< Between the backs of the flanges.
inline constexpr double kFlangeHeight_m = 0.028;       ///< Extent below top of rail.

/// Right and left, or back and front.
inline constexpr std::array<double, 2> kBothSides = {-1.0, 1.0};

}  // namespace railcast
