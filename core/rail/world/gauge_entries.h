#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/rail/clearance/clear_space.h"
#include "core/rail/line/line_place.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/world_tracks.h"
#include "railcast/alignment.h"
#include "railcast/rail_world.h"
#include "railcast/structures.h"

namespace railcast {

/// Something that stands in the clear space of a track, or in the way of its trains.
struct GaugeEntry {
  std::string name;   ///< As reports show it: `platform "west"`.
  std::string track;  ///< Name of the track.
  double begin_s_m{};
  double end_s_m{};
  /// Between these chainages it reaches in; it stays out for more than 5 m between two of them.
  std::vector<ChainageRange> stretches;
  double deepest_s_m{};  ///< Where it reaches farthest in.
  double depth_m{};   ///< From the space's side towards the track's axis; half its width at most.
  double bottom_m{};  ///< Above top of rail, inside the space.
  double top_m{};
  bool is_in_way{};  ///< Whether it reaches into the outline of vehicles.
};

/// What of the world's structures and standing objects is inside the clear space (ClearSpace()) or
/// the outline of vehicles (VehicleOutline()) of which track, by more than a millimetre: first
/// structures, then objects, in their order, each with its tracks in their order. It is found
/// triangle by triangle, so that whatever lies across a curve is found where it does. A wagon that
/// stands in the middle of its own track is left out there. Platforms may stand in the clear space,
/// but must be as far from the axis as EBO § 13 and EN 15273-3 want their edges, up to a tolerance
/// of 5 mm.
[[nodiscard]] std::vector<GaugeEntry> FindGaugeEntries(const WorldSpec& spec,
                                                       const RailWorld& world);

/// The same for one object, whether it moves or not, at one moment, and the outline of vehicles.
/// @param object Index into world.objects(); also of one that was added to it.
/// @param is_on_its_track Whether it is left out on the tracks under it, as a wagon on its rails.
[[nodiscard]] std::vector<GaugeEntry> FindObjectInTheWay(const WorldSpec& spec,
                                                         const RailWorld& world,
                                                         std::size_t object,
                                                         bool is_on_its_track,
                                                         std::int64_t time_ns);

struct StructuresInGauge {
  std::vector<GaugeEntry> entries;
  /// Comparisons of triangles with tracks, which is what it costs: in proportion to the structures,
  /// since each is compared with the tracks that are near it.
  std::size_t num_comparisons = 0;
};

/// The same for the structures alone.
/// @param spec With all tracks, also those of yards.
/// @param courses Of the tracks, in their order.
[[nodiscard]] StructuresInGauge FindStructuresInGauge(const WorldSpec& spec,
                                                      const Alignment& alignment,
                                                      std::span<const TrackCourse> courses);

/// A point of a triangle, as seen from the line and in the world.
struct ProbedCorner : PlaceBesideLine {
  Vector3 place_m;
};
using ProbedCorners = std::array<ProbedCorner, 3>;
using ProbedTriangle = std::array<Vector3, 3>;

[[nodiscard]] ProbedCorner CornerAt(const Alignment& alignment,
                                    const Vector3& place_m,
                                    double near_s_m);

/// What of a triangle is in a part of a space.
struct PartInside {
  double bottom_m = std::numeric_limits<double>::infinity();
  double top_m = -std::numeric_limits<double>::infinity();
  double depth_m{};  ///< From the space's side; 0 of nothing.
};

/// What is measured: what is in the way, or also what is in the clear space.
enum class Asked : std::uint8_t { kWhatIsInTheWay, kWhatIsNotClear };

/// Measures what one thing has in the clear space of one track, and in its trains' way.
class GaugeProbe {
 public:
  /// @param platform If it measures one, which may stand in the clear space up to its edge.
  GaugeProbe(const WorldTracks& tracks,
             std::size_t track,
             const Alignment& alignment,
             Asked asked,
             const PlatformSpec* platform);

  /// Whether something within bounds of chainage and offset may reach in anywhere. Until the next
  /// call, all triangles must be parts of that.
  [[nodiscard]] bool MayReach(const Eigen::AlignedBox2d& bounds_m);

  [[nodiscard]] std::size_t num_comparisons() const { return num_comparisons_; }

  /// @pre MayReach was true for what it is a part of.
  void Add(const ProbedCorners& triangle);

  [[nodiscard]] std::optional<GaugeEntry> Entry(const std::string& name) const;

 private:
  /// Whether the triangle is outside wherever the track lies between its outermost offsets. Does
  /// not need the track's frame, but allows a metre for what differs from it.
  [[nodiscard]] bool IsSurelyOutside(const ProbedCorners& triangle, double length_m) const;
  /// Whether the triangle is on one side of all spaces, allowing for a curve along its length: an
  /// arc that touches the track's axis is k x^2 / (1 + sqrt(1 - k^2 x^2)) beside it after x m, that
  /// is L^2 / 8 R at both ends of a chord of L, and the spaces are turned by as much as its
  /// direction.
  [[nodiscard]] bool IsFar(const ProbedTriangle& here) const;
  /// Halves the edge that is longest along the track.
  void Divide(const ProbedCorners& triangle);
  void MeasureClearSpace(const ProbedTriangle& here, double s_m);
  void MeasurePlatform(const ProbedTriangle& here, double s_m);
  /// These return whether the triangle reaches in.
  bool Measure(const ProbedTriangle& here, const GaugePart& part, double s_m);
  bool Measure(const ProbedTriangle& here,
               double side,
               const std::vector<HalfWidth>& rows,
               double s_m);
  bool Take(const PartInside& part, const std::vector<HalfWidth>& rows, double s_m);

  const TrackSpec& track_;
  const TrackCourse& course_;
  const Alignment& alignment_;
  Asked asked_;
  const PlatformSpec* platform_;
  std::optional<double> contact_height_m_;
  std::vector<GaugePart> outline_;
  std::vector<HalfWidth> half_widths_;  ///< Half-widths of the clear space.
  double widest_m_;                     ///< Half-width of both spaces on straight track.
  double top_m_;                        ///< Top of both spaces.
  double sharpest_per_m_ = 0.0;         ///< Curvature of the track where it is compared.
  double reach_m_ = 0.0;                ///< Reach of the spaces from the axis there.
  std::size_t num_comparisons_ = 0;
  GaugeEntry entry_;
  std::set<int> metres_;  ///< Metres of chainage with something of it in a space.
};

}  // namespace railcast
