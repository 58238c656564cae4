#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/rail/clearance/clear_space.h"
#include "core/rail/line/line_place.h"
#include "core/rail/network/world_tracks.h"
#include "core/rail/world/gauge_entries.h"
#include "railcast/structures.h"

namespace railcast {

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
  std::vector<HalfWidth> half_widths_;  ///< Of the clear space.
  double widest_m_;                     ///< Of both spaces, on straight track.
  double top_m_;                        ///< Of both spaces.
  double sharpest_per_m_ = 0.0;         ///< Of the track where it is compared with something.
  double reach_m_ = 0.0;                ///< Of the spaces from the axis there.
  std::size_t num_comparisons_ = 0;
  GaugeEntry entry_;
  std::set<int> metres_;  ///< Of chainage, with something of it in a space.
};

}  // namespace railcast
