#pragma once

#include <optional>
#include <vector>

#include "core/base/transform.h"
#include "core/rail/world_spec.h"

namespace railcast {

/// Half the width that pantographs need under 15 kV, for contact wires up to 6.5 m above top of
/// rail in curves of 250 m radius or more: EBO Anlage 1, Tabelle 1 (to § 9; BGBl. I 1991). Nothing
/// for wires that are higher: the table ends there.
[[nodiscard]] std::optional<double> PantographHalfWidth_m(double contact_height_m);

/// A rectangle of the gauge, as wide to the left as to the right of the track's axis.
struct GaugePart {
  double half_width_m{};
  double bottom_m{};  ///< Above top of rail.
  double top_m{};
};

/// What has to stay clear about a track, in the track's cross-section, from the lowest part up:
///
/// - Wagons: G1's 3150 mm width and 4280 mm height, down to top of rail (physics.md 7.1).
/// - Under a contact line, above them: the pantographs' half width from EBO Anlage 1, Tabelle 1, up
///   to the table's least height of 5200 mm.
///
/// This is less than the whole of EBO Anlage 1, Bild 1: its outline beside and below the vehicles
/// (the room for doors, signals, men, platforms) is a drawing of which we have no figures that we
/// could check, the cut-off corners c and d of Tabelle 1 neither, so corners are square. The
/// widening in curves below 250 m (Anlage 2) is left out. What is inside is in the way of trains;
/// what is outside may still be nearer than the law allows. scripts/brake_client.py looks for
/// obstacles in a box of its own: half width 1.43 m from 0.35 m to 4.5 m above top of rail.
/// @param contact_height_m Absent: no contact line.
[[nodiscard]] std::vector<GaugePart> StructureGauge(std::optional<double> contact_height_m);

/// The height of the contact wire over a track, if it has one.
[[nodiscard]] std::optional<double> ContactHeightOver_m(const TrackSpec& track,
                                                        const CatenarySpec& catenary);

/// The same as a closed polygon of d (left positive) and h above top of rail.
[[nodiscard]] std::vector<Eigen::Vector2d> GaugeOutline(std::optional<double> contact_height_m);

/// How a box stands to a gauge in one cross-section of the track.
struct GaugeClearance {
  bool is_inside{};      ///< Whether any of it is inside the gauge; touching is not.
  double from_axis_m{};  ///< The least distance of the box from the plane d = 0; 0 across it.
};

/// Of a box that is swept along the track. So it must be short against the track's curves.
/// @param track_from_box x along the track, y = d, z = h.
[[nodiscard]] GaugeClearance ClearanceOf(const std::vector<GaugePart>& gauge,
                                         const Transform& track_from_box,
                                         const Vector3& size_m);

}  // namespace railcast
