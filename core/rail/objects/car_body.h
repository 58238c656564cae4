#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/scene.h"

namespace railcast {

/// The cross-section of a passenger vehicle's body, left half: the outer face of the side wall as
/// points (y, z) from its lower edge up to the roof, and of the roof from there to the top at y =
/// 0. Frame as in wagon_parts.h.
struct CarSection {
  std::vector<Eigen::Vector2d> side;
  std::vector<Eigen::Vector2d> roof;
};

/// What a part of a side wall holds.
enum class CarOpeningKind { kWindow, kDoor };

/// A window or a door in both side walls.
struct CarOpening {
  CarOpeningKind kind = CarOpeningKind::kWindow;
  double begin_x_m{};
  double end_x_m{};
  double bottom_m{};  ///< Above top of rail.
  double top_m{};
};

/// The surfaces of a passenger vehicle's body.
struct CarSurfaces {
  SurfaceClass wall, door, roof, glass;
};

/// Half the width of the section at a height above top of rail.
[[nodiscard]] double HalfWidthAt_m(const CarSection& section, double z_m);

/// Adds both side walls and the roof between two places along the vehicle. Windows are panes 2 cm
/// behind the outer face of the wall, doors leaves 4 cm behind it, each with a window of its own.
/// @pre No two openings overlap.
void AddCarBody(const CarSection& section,
                const Eigen::Vector2d& begin_end_x_m,
                std::span<const CarOpening> openings,
                const CarSurfaces& surfaces,
                Model& car);

/// Adds a wall across the whole section, from the lower edge of the side walls up.
[[nodiscard]] Mesh MakeCarEnd(const CarSection& section, double begin_x_m, double end_x_m);

}  // namespace railcast
