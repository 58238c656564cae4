#pragma once

#include "core/rail/objects/object_surfaces.h"
#include "railcast/objects.h"
#include "railcast/scene.h"

namespace railcast {

/// Animals that stray onto the line, standing, 3,300 to 4,100 triangles each. Frame: origin on the
/// ground below the middle of the footprint, x in the direction of view, y left, z up; metres.
/// Proportions that no source gives are working values.

[[nodiscard]] constexpr bool IsAnimal(ObjectType type) {
  return type == ObjectType::kDeer || type == ObjectType::kDog || type == ObjectType::kCow;
}

/// @pre IsAnimal(type).
[[nodiscard]] Model MakeAnimal(ObjectType type, const AnimalSurfaces& surfaces);

/// A roebuck with its head up: 0.70 m high at the withers (0.60 to 0.75 m), 1.13 m long from muzzle
/// to rump with its neck upright, antlers of 0.22 m (0.20 to 0.25 m; Mitchell-Jones et al. 1999,
/// "The Atlas of European Mammals").
[[nodiscard]] Model MakeDeer(const AnimalSurfaces& surfaces);

/// A German shepherd dog: 0.63 m high at the withers (0.60 to 0.65 m), trunk 13 % longer than that
/// (10 to 17 %), head of 0.25 m (40 % of the height; FCI standard 166).
[[nodiscard]] Model MakeDog(const AnimalSurfaces& surfaces);

/// A Holstein cow: 1.45 m high at the withers (1.37 to 1.50 m), 2.58 m long from muzzle to tail
/// (2.3 to 2.6 m; dimensions.com).
[[nodiscard]] Model MakeCow(const AnimalSurfaces& surfaces);

inline constexpr double kDeerWithers_m = 0.70;
inline constexpr double kDogWithers_m = 0.63;
inline constexpr double kCowWithers_m = 1.45;

}  // namespace railcast
