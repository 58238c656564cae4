#include "viewer/composition/beam_kinds.h"

#include <array>
#include <cmath>

#include "railcast/frame.h"
#include "viewer/color/palette.h"

namespace railcast {

std::vector<Category> BeamKinds(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  std::array<std::size_t, kOutcomeNames.size()> counts{};
  std::size_t num_empty = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += frame.returns) {
    if (!std::isnan(frame.x[slot])) continue;
    ++num_empty;
    ++counts[static_cast<std::size_t>(frame.outcome[slot])];
  }
  if (!recorded.Has("outcome")) {
    return {{.value = 0.0,
             .name = "beams without return",
             .rgb = kUnknownOutcomeRgb,
             .num_points = num_empty}};
  }
  std::vector<Category> kinds;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const auto outcome = static_cast<Outcome>(i);
    kinds.push_back({.value = static_cast<double>(i),
                     .name = "no return: " + OutcomeTitle(outcome),
                     .rgb = OutcomeRgb(outcome),
                     .num_points = counts[i]});
  }
  return kinds;
}

}  // namespace railcast
