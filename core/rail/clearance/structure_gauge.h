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

/// How much farther from a track's axis things stand in a curve than on the straight (EN 15273-3):
/// 3.75 m^2 / R; in curves of less than 250 m radius 50 m^2 / R - 0.185 m inside and 60 m^2 / R -
/// 0.225 m outside, which is the same at 250 m. The standard has these down to 150 m; they are
/// continued below.
/// @param curvature_per_m Left positive.
/// @param side > 0 for what stands on the left.
[[nodiscard]] double CurveWidening_m(double curvature_per_m, double side);

/// Least distance of a platform's edge from the axis of a straight track: EBO § 13.
inline constexpr double kLeastPlatformEdge_m = 1.65;

/// A rectangle of the gauge, symmetric about the track's axis.
struct GaugePart {
  double half_width_m{};
  double bottom_m{};  ///< Above top of rail.
  double top_m{};
};

/// The space about a track that must stay clear, in the track's cross-section, from the lowest part
/// upwards:
///
/// - Wagons: width 3150 mm and height 4280 mm of G1, down to top of rail (docs/physics.md 7.6).
/// - Above them, under a contact line: the half width for pantographs from EBO Anlage 1, Tabelle 1,
///   up to the table's lowest height of 5200 mm.
///
/// This is less than the full gauge of EBO Anlage 1, Bild 1. Its outline beside and below the
/// vehicles (room for doors, signals, staff and platforms) is a drawing for which we have no
/// verifiable figures. The same applies to the cut-off corners c and d of Tabelle 1, so corners are
/// square here. The widening in curves below 250 m (Anlage 2) is omitted. Anything inside this
/// gauge obstructs trains; something outside it may still be closer than the regulation permits.
/// examples/brake_client.py uses a different box for obstacles: half width 1.43 m, from 0.35 m to
/// 4.5 m above top of rail.
/// @param contact_height_m Absent = no contact line.
[[nodiscard]] std::vector<GaugePart> StructureGauge(std::optional<double> contact_height_m);

/// Height of the contact wire above a track; absent if it has none.
[[nodiscard]] std::optional<double> ContactHeightOver_m(const TrackSpec& track,
                                                        const CatenarySpec& catenary);

/// The structure gauge as a closed polygon of d (left positive) and h above top of rail.
[[nodiscard]] std::vector<Eigen::Vector2d> GaugeOutline(std::optional<double> contact_height_m);

/// Position of a box relative to a gauge in one cross-section of the track.
struct GaugeClearance {
  /// Whether any part of the box is inside the gauge; touching it does not count.
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
