#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "railcast/frame.h"

namespace railcast {

/// An echo of a synthetic frame.
struct MadeEcho {
  float range_m{};
  std::uint32_t label = 3;
  float intensity = 0.2F;
  float share = 0.5F;
  Outcome outcome = Outcome::kReturned;
};

/// A frame of one row with these echoes, the strongest first; a firing without echoes met no
/// surface.
[[nodiscard]] inline Frame MakeEchoFrame(const std::vector<std::vector<MadeEcho>>& firings,
                                         std::uint32_t num_returns = 3) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  Frame frame;
  frame.Resize(1, static_cast<std::uint32_t>(firings.size()), num_returns);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const std::vector<MadeEcho>& echoes = firings[slot / num_returns];
    const std::size_t r = slot % num_returns;
    const MadeEcho none{kNaN, 0, kNaN, kNaN,
                        r == 0 ? Outcome::kNoSurface : Outcome::kNoFurtherEcho};
    const MadeEcho& echo = r < echoes.size() ? echoes[r] : none;
    frame.range_m[slot] = frame.true_range_m[slot] = echo.range_m;
    frame.label[slot] = echo.label;
    frame.intensity[slot] = echo.intensity;
    frame.footprint_share[slot] = echo.share;
    frame.outcome[slot] = echo.outcome;
    frame.mixed_share[slot] = 0.0F;
  }
  return frame;
}

}  // namespace railcast
