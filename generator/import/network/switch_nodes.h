#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "generator/import/lines/line_places.h"
#include "generator/import/map/rail_map.h"

namespace railcast {

/// A node of the map beside a line at which tracks part.
struct SwitchNode {
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  ///< Chainage and offset.
  std::size_t num_ways{};  ///< That lead from it: 3 from a switch, 4 from a crossing or slip.
};

/// The nodes from which three ways lead or more, whether `railway=switch` or not, and those that
/// are tagged so, by chainage.
[[nodiscard]] std::vector<SwitchNode> FindSwitches(const RailMap& map,
                                                   const LinePlaces& places,
                                                   double farthest_m);

}  // namespace railcast
