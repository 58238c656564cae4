#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "generator/import/map/rail_map.h"
#include "generator/import/network/line_world.h"

namespace railcast {

/// What lies between two chainages of a track.
struct TaggedStretch {
  std::size_t track{};
  double begin_s_m{};
  double end_s_m{};

  [[nodiscard]] double length_m() const { return end_s_m - begin_s_m; }
};

/// By so much tags of tracks beside each other may begin and end at different chainages.
inline constexpr double kSameEnd_m = 15.0;

/// Whether the tags of a way say that it lies in a tunnel, or on a bridge; never both.
[[nodiscard]] bool IsTunnel(const MapTags& tags);
[[nodiscard]] bool IsBridge(const MapTags& tags);

/// Where the ways of a world's tracks have something, in centimetres and on the tracks.
[[nodiscard]] std::vector<TaggedStretch> StretchesOfAll(
    const RailMap& map, const LineWorld& world, const std::function<bool(const MapTags&)>& has);

}  // namespace railcast
