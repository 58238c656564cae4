#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/rail/line/plan_course.h"
#include "generator/extras/import/fit/plan_model.h"
#include "generator/extras/import/lines/imported_line.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/rail_map.h"

namespace railcast {

/// A part of a line between two chainages.
struct LineStretch {
  double begin_s_m{};
  double end_s_m{};
  std::size_t way{};  ///< The first way of the map that is on it.
};

/// By so much tags of tracks beside each other may begin and end at different chainages.
inline constexpr double kSameEnd_m = 15.0;

/// The ways of a line from node to node.
/// @param chainages_m Of the line's nodes.
[[nodiscard]] std::vector<LineStretch> WaysAlong(const TrackLine& line,
                                                 std::span<const double> chainages_m);

/// Where ways along a line have something in common: neighbouring ways that have it make one
/// stretch. Stretches are in order of chainage and longer than 0.
[[nodiscard]] std::vector<LineStretch> StretchesWhere(
    const RailMap& map,
    std::span<const LineStretch> ways,
    const std::function<bool(const MapTags&)>& has);

/// The same for the ways of a line.
/// @param chainages_m Of the line's nodes.
[[nodiscard]] std::vector<LineStretch> StretchesWhere(
    const RailMap& map,
    const TrackLine& line,
    std::span<const double> chainages_m,
    const std::function<bool(const MapTags&)>& has);

/// A step from one node of a way to another one of it.
struct WayStep {
  std::size_t way{};
  std::size_t from{};
  std::size_t to{};
};

/// How far along its way each node is.
class WayPlaces {
 public:
  WayPlaces(const RailMap& map, const MapWay& way);

  [[nodiscard]] double length_m() const { return length_m_; }
  /// The place of a node: of several, the one next to another node of the way. A node that is none
  /// of the way counts as the nearer end of it: lines leave out nodes that are kNearestNodes_m from
  /// others.
  [[nodiscard]] double Of_m(std::size_t node, std::size_t other) const;

 private:
  const RailMap& map_;
  const MapWay& way_;
  std::multimap<std::size_t, double> along_m_;  ///< By node.
  double length_m_ = 0.0;
};

/// Whether a step leads to where its way is drawn.
[[nodiscard]] bool IsDrawnForward(const RailMap& map, const WayStep& step);

/// Where something lies against a line.
struct LinePlace {
  double s_m{};
  double d_m{};        ///< Left positive.
  std::size_t node{};  ///< The line's node at or before it.
  double beyond_m{};   ///< How far before (negative) or behind the ends of the line.
};

/// Finds chainage and offset of places on the map against a line.
class LinePlaces {
 public:
  LinePlaces(const RailMap& map, const TrackLine& track, const ImportedLine& line);

  /// Absent if the place is farther away than `farthest_m`.
  [[nodiscard]] std::optional<LinePlace> Of(const Eigen::Vector2d& place_m,
                                            double farthest_m) const;
  [[nodiscard]] double length_m() const { return plan_.length_m(); }
  /// Whether the way at a node of the line is drawn as the line runs.
  [[nodiscard]] bool IsForward(std::size_t node) const;

 private:
  const RailMap& map_;
  const TrackLine& track_;
  const ImportedLine& line_;
  PlanModel plan_;
  PlanCourse course_;
  Eigen::AlignedBox2d bounds_m_;
  std::vector<Eigen::AlignedBox2d> blocks_m_;  ///< Blocks of kBlock steps each.
};

}  // namespace railcast
