#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/rail/base/world_faults.h"
#include "core/rail/network/network.h"
#include "railcast/world_spec.h"

namespace railcast {

/// A way along tracks, one after the other in the direction of travel, as specified.
struct RouteSpec {
  std::string pointer;  ///< Pointer of the list of names, or of the single name.
  std::vector<std::string> tracks;
  bool runs_back{};   ///< Whether it runs towards falling chainage.
  double from_s_m{};  ///< Where it is entered.
};

/// A turnout that a route passes, and where its blades must lead.
struct RoutePassage {
  std::size_t turnout{};  ///< Index in the network.
  TurnoutPosition position{};
};

/// A part of a route that lies on one track.
struct RouteSection {
  std::size_t track{};
  double begin_s_m{};  ///< Lesser than its end also on a route that runs back.
  double end_s_m{};
};

/// A way along tracks. Its chainage is that of the alignment; at the turnouts it changes tracks.
struct Route {
  TrackCourse course;
  std::vector<std::string> names;      ///< Names of its tracks, in the direction of travel.
  std::vector<RouteSection> sections;  ///< In the order of chainage.
  std::vector<RoutePassage> passages;  ///< In no particular order.
};

/// The tracks by name for messages: `track "main"` or `route "main", "siding"`.
[[nodiscard]] std::string WayText(const Route& route);

/// Makes a route, which begins where its first track does and ends where its last one does. Returns
/// nothing if a track on it is unknown, and adds a fault where a name is unknown, where no turnout
/// joins two tracks that follow each other, and where the one that does opens the other way.
[[nodiscard]] std::optional<Route> MakeRoute(const WorldSpec& world,
                                             const NetworkDraft& network,
                                             const RouteSpec& spec,
                                             WorldFaults& faults);

/// Reports turnouts whose given position is not the one that the route needs, from where it is
/// entered on in the direction of travel.
void CheckPositions(const WorldSpec& world,
                    const NetworkDraft& network,
                    const Route& route,
                    const RouteSpec& spec,
                    WorldFaults& faults);

/// Sets the turnouts without a given position as the route needs them.
void SetPositions(const Route& route, NetworkDraft& network);

}  // namespace railcast
