#include "core/rail/network/route.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/join.h"
#include "core/base/text.h"
#include "core/rail/network/turnout_place.h"

namespace railcast {
namespace {

/// A change from one track to another.
struct Change {
  std::size_t turnout{};
  double s_m{};
};

bool Joins(const TurnoutSite& turnout, std::size_t one, std::size_t other) {
  return (turnout.track == one && turnout.branch == other) ||
         (turnout.track == other && turnout.branch == one);
}

/// Whether one can run from one of its tracks to the other in that direction: through its blades if
/// it opens in the direction of travel, else from the branch.
bool LeadsOver(const TurnoutSite& turnout, std::size_t from, bool runs_back) {
  const bool faces = turnout.opens_ahead() != runs_back;
  return faces == (turnout.track == from);
}

class RouteMaker {
 public:
  RouteMaker(const WorldSpec& world,
             const NetworkDraft& network,
             const RouteSpec& spec,
             WorldFaults& faults)
      : world_(world), network_(network), spec_(spec), faults_(faults) {}

  std::optional<Route> Make() {
    if (!FindTracks()) return std::nullopt;
    double at_m = spec_.runs_back ? std::numeric_limits<double>::infinity()
                                  : -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < tracks_.size(); ++i) {
      const std::optional<Change> change = FindChange(i, at_m);
      if (!change) return std::nullopt;
      at_m = change->s_m;
      changes_.push_back(*change);
    }
    return Assembled();
  }

 private:
  [[nodiscard]] std::string PointerOf(std::size_t index) const {
    return spec_.tracks.size() > 1 ? spec_.pointer + "/" + std::to_string(index) : spec_.pointer;
  }

  bool FindTracks() {
    bool are_known = true;
    for (std::size_t i = 0; i < spec_.tracks.size(); ++i) {
      const std::optional<std::size_t> track = TrackIndex(world_, spec_.tracks[i]);
      if (!track) {
        are_known = false;
        if (!faults_.AreKnown({PointerOf(i)})) continue;
        AddUnknownTrack(world_, PointerOf(i), spec_.tracks[i], faults_);
        continue;
      }
      tracks_.push_back(*track);
      are_known = are_known && network_.courses[*track].has_value();
    }
    return are_known && !tracks_.empty();
  }

  /// The turnout from track i of the route to the next, the first behind `at_m`.
  std::optional<Change> FindChange(std::size_t i, double at_m) {
    const TurnoutSite* wrong_way = nullptr;
    const TurnoutSite* behind = nullptr;
    std::optional<Change> found;
    const double side = spec_.runs_back ? -1.0 : 1.0;
    for (std::size_t k = 0; k < network_.turnouts.size(); ++k) {
      const TurnoutSite& turnout = network_.turnouts[k];
      if (!Joins(turnout, tracks_[i], tracks_[i + 1])) continue;
      if (!LeadsOver(turnout, tracks_[i], spec_.runs_back)) {
        wrong_way = &turnout;
      } else if (!(side * turnout.s_m > side * at_m)) {
        behind = &turnout;
      } else if (!found || side * turnout.s_m < side * found->s_m) {
        found = Change{k, turnout.s_m};
      }
    }
    if (!found) ReportChange(i, wrong_way, behind, at_m);
    return found;
  }

  void ReportChange(std::size_t i,
                    const TurnoutSite* wrong_way,
                    const TurnoutSite* behind,
                    double at_m) {
    const std::string from = Quoted(spec_.tracks[i]);
    const std::string pointer = PointerOf(i + 1);
    const std::string value = Quoted(spec_.tracks[i + 1]);
    if (behind != nullptr) {
      faults_.Add(pointer,
                  "must be joined to track " + from + (spec_.runs_back ? " before " : " behind ") +
                      MetresText(at_m) + " m, where the route comes from, not at " +
                      MetresText(behind->s_m) + " m",
                  value);
    } else if (wrong_way != nullptr) {
      faults_.Add(pointer,
                  "must be reached from track " + from + " the right way: the turnout at " +
                      MetresText(wrong_way->s_m) + " m opens with " +
                      (wrong_way->opens_ahead() ? "rising" : "falling") +
                      " chainage, and the route runs with " +
                      (spec_.runs_back ? "falling" : "rising") + " chainage",
                  value);
    } else {
      faults_.Add(pointer, "must be a track that a turnout joins to track " + from, value);
    }
  }

  [[nodiscard]] Route Assembled() {
    for (const Change& change : changes_) {
      passages_.push_back({change.turnout, TurnoutPosition::kDiverging});
    }
    if (spec_.runs_back) {
      std::reverse(tracks_.begin(), tracks_.end());
      std::reverse(changes_.begin(), changes_.end());
    }
    TrackCourse course = *network_.courses[tracks_.front()];
    std::vector<RouteSection> sections{{tracks_.front(), course.begin_s_m(), course.end_s_m()}};
    for (std::size_t i = 0; i < changes_.size(); ++i) {
      const TrackCourse& next = *network_.courses[tracks_[i + 1]];
      course = Joined(course, next, changes_[i].s_m);
      sections.back().end_s_m = changes_[i].s_m;
      sections.push_back({tracks_[i + 1], changes_[i].s_m, next.end_s_m()});
    }
    for (const RouteSection& section : sections) AddStraightPassages(section);
    return {std::move(course), spec_.tracks, std::move(sections), std::move(passages_)};
  }

  /// Adds the turnouts that lie in the track of a section and that it passes on the straight way.
  void AddStraightPassages(const RouteSection& section) {
    for (std::size_t k = 0; k < network_.turnouts.size(); ++k) {
      const TurnoutSite& turnout = network_.turnouts[k];
      const bool is_changed =
          std::ranges::any_of(changes_, [&](const Change& change) { return change.turnout == k; });
      if (turnout.track != section.track || is_changed) continue;
      if (turnout.s_m < section.begin_s_m || turnout.s_m > section.end_s_m) continue;
      passages_.push_back({k, TurnoutPosition::kStraight});
    }
  }

  const WorldSpec& world_;
  const NetworkDraft& network_;
  const RouteSpec& spec_;
  WorldFaults& faults_;
  std::vector<std::size_t> tracks_;
  std::vector<Change> changes_;
  std::vector<RoutePassage> passages_;
};

}  // namespace

std::string WayText(const Route& route) {
  return (route.names.size() == 1 ? "track " : "route ") + Join(route.names, ", ", Quoted);
}

std::optional<Route> MakeRoute(const WorldSpec& world,
                               const NetworkDraft& network,
                               const RouteSpec& spec,
                               WorldFaults& faults) {
  return RouteMaker(world, network, spec, faults).Make();
}

void CheckPositions(const WorldSpec& world,
                    const NetworkDraft& network,
                    const Route& route,
                    const RouteSpec& spec,
                    WorldFaults& faults) {
  for (const RoutePassage& passage : route.passages) {
    const TurnoutSite& turnout = network.turnouts[passage.turnout];
    const TrackSpec& branch = world.tracks[turnout.branch];
    const std::optional<TurnoutSpec>& given = turnout.opens_ahead() ? branch.begin : branch.end;
    const bool is_ahead =
        spec.runs_back ? turnout.s_m <= spec.from_s_m : turnout.s_m >= spec.from_s_m;
    if (!is_ahead || !given->position || *given->position == passage.position) continue;
    faults.Add(TrackPointer(turnout.branch) +
                   (turnout.opens_ahead() ? "/begin/position" : "/end/position"),
               "must be " + Quoted(std::string(NameOf(passage.position))) + ", as " + spec.pointer +
                   " needs it",
               Quoted(std::string(NameOf(*given->position))));
  }
}

void SetPositions(const Route& route, NetworkDraft& network) {
  for (const RoutePassage& passage : route.passages) {
    TurnoutSite& turnout = network.turnouts[passage.turnout];
    if (!turnout.has_given_position) turnout.position = passage.position;
  }
}

}  // namespace railcast
