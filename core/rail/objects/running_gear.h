#pragma once

#include "core/rail/rail_surfaces.h"
#include "core/scene/mesh.h"

namespace railcast {

/// What all wagons stand on and are pulled by. Frame: x along the wagon, y left, z up from top of
/// rail; metres. Dimensions are those of the UIC standard wagon parts.

inline constexpr double kWheelRadius_m = 0.46;         ///< On the tape circle.
inline constexpr double kTapeCircleDistance_m = 1.5;   ///< Between the two wheels' tape circles.
inline constexpr double kFlangeBackDistance_m = 1.36;  ///< Between the backs of the flanges.
inline constexpr double kFlangeHeight_m = 0.028;       ///< Below top of rail.
inline constexpr double kBogieAxleBase_m = 1.8;
inline constexpr double kBufferHeight_m = 1.06;
inline constexpr double kBufferDistance_m = 1.75;
inline constexpr double kBufferRadius_m = 0.225;
inline constexpr double kBufferLength_m = 0.62;  ///< From the headstock to the face.
inline constexpr double kBogieTop_m = 0.93;      ///< Where the wagon's bolster rests.

/// A bogie of the Y25 kind with its pivot at `pivot_x_m`.
void AddBogie(double pivot_x_m, const RailSurfaces& surfaces, Model& wagon);

/// Headstock, buffers, draw hook with screw coupling and brake hoses at both ends of a wagon whose
/// buffer faces are `length_m` apart.
void AddDrawAndBufferGear(double length_m, const RailSurfaces& surfaces, Model& wagon);

}  // namespace railcast
