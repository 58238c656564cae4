#pragma once

#include <optional>
#include <vector>

#include "railcast/transform.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Half the width that pantographs need under 15 kV, for contact wires up to 6.5 m above top of
/// rail in curves of 250 m radius or more: EBO Anlage 1, Tabelle 1 (to § 9; BGBl. I 1991). Returns
/// nothing for higher wires, which the table does not cover.
[[nodiscard]] std::optional<double> PantographHalfWidth_m(double contact_height_m);

/// The table's lowest height of the contact wire, up to which pantographs reach at least.
inline constexpr double kPantographTop_m = 5.2;

/// A rectangle of an outline, symmetric about the track's axis.
struct GaugePart {
  double half_width_m{};
  double bottom_m{};  ///< Above top of rail.
  double top_m{};
};

/// The outline of vehicles in the track's cross-section, from the lowest part upwards. Anything
/// inside it is in the way of trains. What structures must keep clear beside it is ClearSpace().
///
/// - Wagons: width 3150 mm and height 4280 mm of G1, down to top of rail (docs/physics.md 7.6).
/// - Above them, under a contact line: the half width for pantographs from EBO Anlage 1, Tabelle 1,
///   up to kPantographTop_m.
///
/// Corners are square, and what vehicles need more in curves is left out.
/// examples/brake_client.py uses a different box for obstacles: half width 1.43 m, from 0.35 m to
/// 4.5 m above top of rail.
/// @param contact_height_m Absent = no contact line.
[[nodiscard]] std::vector<GaugePart> VehicleOutline(std::optional<double> contact_height_m);

/// Height of the contact wire above a track; absent if it has none.
[[nodiscard]] std::optional<double> ContactHeightOver_m(const TrackSpec& track,
                                                        const CatenarySpec& catenary);

/// Position of a box relative to an outline in one cross-section of the track.
struct GaugeClearance {
  /// Whether any part of the box is inside the outline; touching it does not count.
  bool is_inside{};
  /// Minimum distance of the box from the plane d = 0; 0 if the box crosses it.
  double from_axis_m{};
};

/// Clearance of a box that is projected along the track. The box must therefore be short compared
/// with the radius of the track's curves.
/// @param track_from_box x along the track, y = d, z = h.
[[nodiscard]] GaugeClearance ClearanceOf(const std::vector<GaugePart>& gauge,
                                         const Transform& track_from_box,
                                         const Vector3& size_m);

}  // namespace railcast
