#pragma once

#include <optional>
#include <vector>

#include "core/base/transform.h"
#include "core/io/recording/recording.h"
#include "viewer/overlays/drawing.h"
#include "viewer/overlays/surroundings.h"

namespace railcast {

inline constexpr double kGaugeBehind_m = 10.0;
inline constexpr double kGaugeAhead_m = 150.0;

/// Half the width that pantographs need under 15 kV, for contact wires up to 6.5 m above top of
/// rail in curves of 250 m radius or more: EBO Anlage 1, Tabelle 1 (to § 9; BGBl. I 1991). Nothing
/// for wires that are higher: the table ends there.
[[nodiscard]] std::optional<double> PantographHalfWidth_m(double contact_height_m);

/// What has to stay clear about a track, as a closed polygon in the track's cross-section: d (left
/// positive) and h above top of rail.
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
[[nodiscard]] std::vector<Eigen::Vector2d> GaugeOutline(std::optional<double> contact_height_m);

/// GaugeOutline() along the vehicle's track, as far as the track is there, from 10 m behind the
/// vehicle to 150 m ahead: rings at every 10 m of chainage and the corners' edges between,
/// following curves to 5 mm and leaning with the cant. Empty if the frame has no pose.
[[nodiscard]] Drawing DrawStructureGauge(const Surroundings& surroundings,
                                         const RecordedFrame& recorded);

}  // namespace railcast
