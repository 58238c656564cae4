#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

#include "railcast/frame.h"

namespace railcast {

/// Firings of a frame that are alike by its own result, so that a few of them tell of all.
struct Stratum {
  std::uint32_t label{};      ///< Label of what the beam meets first; 0 = nothing.
  std::uint32_t range_bin{};  ///< By the range of that: up to 25, 50, 100 and 200 m, and beyond.
  bool is_edge{};  ///< Whether the beam is next to another thing, or shares itself with one.
  bool has_return{};

  friend auto operator<=>(const Stratum&, const Stratum&) = default;
};

/// The ends of the range bins; the last one has none.
inline constexpr float kStratumEnds_m[] = {25.0F, 50.0F, 100.0F, 200.0F};

/// The bin of a range; 0 for NaN.
[[nodiscard]] inline std::uint32_t StratumBinOf(float range_m) {
  std::uint32_t bin = 0;
  for (const float end_m : kStratumEnds_m) bin += range_m >= end_m ? 1 : 0;
  return bin;
}

/// Which firings are at an edge, by their cell (row * columns + column): those of which at least
/// 0.1 % of the beam falls beside its main surface, those with a neighbour in their row or column
/// that meets another label or instance, and those with one in their row that meets something more
/// than 0.5 m nearer or farther. Rows differ by more on level ground.
[[nodiscard]] std::vector<std::uint8_t> EdgesOf(const Frame& frame);

/// All of each firing's stratum but the label, as one number: four times the range bin, 2 at an
/// edge and 1 with a return.
/// @param edges As of EdgesOf().
[[nodiscard]] std::vector<std::uint8_t> StratumKindsOf(const Frame& frame,
                                                       const std::vector<std::uint8_t>& edges);
/// The same of some firings alone, by their cells; takes no longer for a larger frame.
[[nodiscard]] std::vector<std::uint8_t> StratumKindsAt(const Frame& frame,
                                                       std::span<const std::uint32_t> cells);
inline constexpr std::uint32_t kNumStratumKinds = 4 * (std::size(kStratumEnds_m) + 1);

[[nodiscard]] inline Stratum StratumOf(std::uint32_t label, std::uint32_t kind) {
  return {.label = label,
          .range_bin = kind / 4,
          .is_edge = (kind & 2U) != 0,
          .has_return = (kind & 1U) != 0};
}

}  // namespace railcast
