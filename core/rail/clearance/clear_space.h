#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/rail/line/track_course.h"
#include "railcast/alignment.h"
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

/// Whether a place in the track's cross-section is inside an outline; its boundary is not.
[[nodiscard]] bool IsInside(const std::vector<GaugePart>& outline,
                            double lateral_m,
                            double height_m);

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

/// What must be clear of structures about a straight track without cant: linear between two rows,
/// with a step where two have the same height.
///
/// It is the outline (Grenzlinie) about the space that § 9 (3) of the German EBO (BGBl. I 1991)
/// wants clear of everything but the contact line. Its half widths are those of the reference line
/// G2 (Anlage 8), 5 mm for a track gauge up to 1445 mm (Anlage 2, 2.1.1) and 31, 40, 104, 114 and
/// 140 mm at heights of up to 0.4, 1.17, 3.53, 3.835 and 4.68 m for random displacements of track
/// and vehicle (2.3: the greater ones, of the outside of curves and of tracks that are not fixed).
/// Heights are 50 mm more above, by which a track may be lifted, and 10 mm less below, for the wear
/// of rails (Anlage 1). The two lowest rows are the space of the wheels, 0.8735 m (Anlage 1, Bild
/// 2). What Anlage 1 adds for doors, signals, staff and platforms, which may stand there, is left
/// out.
inline constexpr std::array<HalfWidth, 11> kClearHalfWidths = {{{0.0, 0.8735},
                                                                {0.08, 0.8735},
                                                                {0.08, 1.248},
                                                                {0.12, 1.286},
                                                                {0.39, 1.556},
                                                                {0.39, 1.656},
                                                                {1.16, 1.665},
                                                                {1.16, 1.69},
                                                                {3.58, 1.754},
                                                                {3.885, 1.589},
                                                                {4.73, 0.93}}};

/// How much farther from a track's axis things stand in a curve than on the straight (EN 15273-3):
/// 3.75 m^2 / R; in curves of 250 to 150 m radius 50 m^2 / R - 0.185 m inside and 60 m^2 / R -
/// 0.225 m outside, which is the same at 250 m. Below, where that standard ends, EBO Anlage 2, 1
/// adds to what is there at 250 m 0.335 m inside and 0.365 m outside at 120 m, 0.53 and 0.57 m at
/// 100 m, linear between. Below 100 m neither has a figure: that of 100 m grows as 1 / R.
/// @param curvature_per_m Left positive.
/// @param side > 0 for what stands on the left.
[[nodiscard]] double CurveWidening_m(double curvature_per_m, double side);
/// The tightest curve of which norms say how much wider it is.
inline constexpr double kLeastWidenedRadius_m = 100.0;

/// What of a track makes its clear space wider.
struct TrackBend {
  double curvature_per_m{};  ///< Left positive.
  double cant_m{};           ///< Not negative.
};

[[nodiscard]] TrackBend BendAt(const TrackCourse& track, const Alignment& alignment, double s_m);

/// How much a vehicle's part at a height leans out on a canted track, standing or with as much cant
/// deficiency: 0.4 (u - 0.05 m) (h - 0.5 m) / 1.5 m, since the reference line has the first 50 mm
/// (EBO Anlage 2, 1.3, with the flexibility coefficient of Anlage 1).
/// @param cant_m u, not negative.
[[nodiscard]] double CantWidening_m(double height_m, double cant_m);

/// The half widths of a world's clear space.
[[nodiscard]] std::vector<HalfWidth> ClearHalfWidths(const WorldSpec& world);

/// The clear space on one side of a track: half widths wider by CurveWidening_m() and, on both
/// sides, by CantWidening_m(). Under a contact line it reaches up to kPantographTop_m, with half
/// the width of pantographs where it else would be narrower.
/// @param contact_height_m Absent = no contact line.
/// @param side As for CurveWidening_m().
[[nodiscard]] std::vector<HalfWidth> ClearSpace(std::vector<HalfWidth> rows,
                                                std::optional<double> contact_height_m,
                                                const TrackBend& bend,
                                                double side);

/// Least distance of a platform's edge from the axis of a straight track: EBO § 13.
inline constexpr double kLeastPlatformEdge_m = 1.65;

}  // namespace railcast
