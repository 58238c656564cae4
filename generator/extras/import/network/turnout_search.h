#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "generator/extras/import/fit/line_fit.h"
#include "generator/extras/import/lines/line_places.h"
#include "generator/extras/import/map/rail_map.h"
#include "generator/extras/import/network/track_network.h"
#include "generator/extras/import/network/track_runs.h"

namespace railcast {

/// A node of the map at which tracks part.
struct SwitchNode {
  std::size_t node{};
  std::size_t num_ways{};  ///< Ways that lead from it: 3 from a switch, 4 from a crossing or slip.
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  ///< Chainage and offset, beside a line.
  bool is_at_end{};  ///< Within a metre of an end of the line, where no turnout can be.
};

/// The nodes from which three ways lead or more, whether `railway=switch` or not, and those that
/// are tagged so.
[[nodiscard]] std::vector<SwitchNode> SwitchesOf(const RailMap& map);

/// The switches beside a line or a metre beyond its ends, by chainage.
[[nodiscard]] std::vector<SwitchNode> FindSwitches(const RailMap& map,
                                                   const LinePlaces& places,
                                                   double farthest_m);

/// Where a run of the map meets a track at one of its ends.
struct Meeting {
  std::size_t track{};
  double s_m{};  ///< Chainage of the run's last point there.
  bool opens_ahead{};
};

/// The turnout for a speed (docs/import.md).
[[nodiscard]] TurnoutType TurnoutFor(double speed_kmph);

/// Straights, arcs and clothoids of a run in the plane of chainage and offset.
struct RunFit {
  PlanModel plan;
  PlanCourse course;

  RunFit(const TrackRun& run, double sigma_m);
  [[nodiscard]] PlanModel Part(double begin_m, double end_m) const {
    return PartOf(plan, begin_m, end_m);
  }
  /// The nearest length that does not lie in a clothoid, forwards or backwards.
  [[nodiscard]] double OutOfClothoid_m(double at_m, bool backwards) const;
  /// The length, not above another one, at which it is cut before a chainage where it comes too
  /// near to others.
  [[nodiscard]] double EndBefore_m(double conflict_s_m, double most_m) const;
  /// The length from which on it lies behind such a chainage.
  [[nodiscard]] double BeginBehind_m(double conflict_s_m) const;
};

/// A turnout for the end of a run, and where from there the run is as it was fitted.
struct TurnoutChoice {
  TurnoutSpec spec;
  PlanPoint behind;      ///< The end of its branch, heading towards rising chainage.
  double track_slope{};  ///< Slope of the track in which it lies.
  double off_cost{};     ///< How far it lies from the map, and from what the speed asks for.
  double join_m{};       ///< Length of the fit at which the track follows it.
  double join_cost{};    ///< Cost of the two arcs between.
  bool has_join = false;
};

/// Turnouts near the point where a run meets a track, those that agree best with the map first.
/// They lie from 14 m before to 6 m behind that point, which mappers put anywhere between blades
/// and frog; if the run leaves more slowly than any turnout, up to 40 m behind it.
[[nodiscard]] std::vector<TurnoutChoice> TurnoutChoices(const TrackNetwork& network,
                                                        const TrackRun& run,
                                                        const RunFit& fit,
                                                        const Meeting& meeting);

/// Specifications of a track with turnouts at one or both ends, the best first; without turnouts at
/// both ends the free end is that of the fit.
[[nodiscard]] std::vector<TrackSpec> TracksBetween(const RunFit& fit,
                                                   const std::vector<TurnoutChoice>* begin,
                                                   const std::vector<TurnoutChoice>* end,
                                                   double free_end_m);

/// The part of a fit as a track without turnouts.
[[nodiscard]] TrackSpec TrackOfPart(const RunFit& fit, double begin_m, double end_m);

}  // namespace railcast
