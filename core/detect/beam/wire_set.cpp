#include "core/detect/beam/wire_set.h"

#include <algorithm>
#include <cstddef>

#include "core/base/error.h"

namespace railcast {
namespace {

// A span of contact wire is long compared with the width of a tile's beams, so that a single ball
// around all of it would reject little.
constexpr std::size_t kGroupSegments = 8;

WireBall BallAround(const WireSegment& wire) {
  return {0.5F * (wire.begin_m + wire.end_m),
          0.5F * (wire.end_m - wire.begin_m).norm() + wire.radius_m + wire.travel_m};
}

WireGroup MakeGroup(const std::vector<WireSegment>& segments, std::size_t first) {
  const std::size_t end = segments.size();
  WireGroup group{.ball = {0.5F * (segments[first].begin_m + segments[end - 1].end_m), 0.0F},
                  .first_segment = static_cast<std::uint32_t>(first),
                  .end_segment = static_cast<std::uint32_t>(end)};
  for (std::size_t i = first; i < end; ++i) {
    const float distance_m = std::max((segments[i].begin_m - group.ball.center_m).norm(),
                                      (segments[i].end_m - group.ball.center_m).norm());
    group.ball.radius_m =
        std::max(group.ball.radius_m, distance_m + segments[i].radius_m + segments[i].travel_m);
  }
  return group;
}

}  // namespace

void WireSet::Add(const std::vector<Vector3>& points_m,
                  double radius_m,
                  std::uint32_t surface,
                  const std::vector<Vector3>& moves_m) {
  Check(points_m.size() >= 2, "a wire has two ends");
  Check(moves_m.empty() || moves_m.size() == points_m.size(), "every point moves or none does");
  std::size_t first = segments.size();
  for (std::size_t i = 1; i < points_m.size(); ++i) {
    segments.push_back({.begin_m = points_m[i - 1].cast<float>(),
                        .end_m = points_m[i].cast<float>(),
                        .radius_m = static_cast<float>(radius_m),
                        .surface = surface});
    if (!moves_m.empty()) {
      WireSegment& wire = segments.back();
      wire.begin_move_m = moves_m[i - 1].cast<float>();
      wire.end_move_m = moves_m[i].cast<float>();
      wire.travel_m = std::max(wire.begin_move_m.norm(), wire.end_move_m.norm());
    }
    balls.push_back(BallAround(segments.back()));
    if (segments.size() - first < kGroupSegments && i + 1 < points_m.size()) continue;
    groups.push_back(MakeGroup(segments, first));
    first = segments.size();
  }
}

}  // namespace railcast
