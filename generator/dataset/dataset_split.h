#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/scenario/json_text.h"
#include "generator/dataset/recipe.h"

namespace railcast {

/// A stretch of a line.
struct SeenStretch {
  double begin_s_m{};
  double end_s_m{};
};

/// Names a line: the hash of the alignment of a resolved scenario.
[[nodiscard]] std::string LineHash(const Json& scenario);

/// The part of a scenario, for SplitBy::kScenario.
[[nodiscard]] Split SplitOfScenario(const Recipe& recipe, std::uint32_t scenario);

/// The part of a line, for SplitBy::kLine.
/// @param pinned That of the base, if it names one.
[[nodiscard]] Split SplitOfLine(const Recipe& recipe,
                                const std::string& line_hash,
                                const std::optional<Split>& pinned);

/// The part of a stretch, for SplitBy::kPlace: that of all its cells, or nothing if they are of
/// several parts.
[[nodiscard]] std::optional<Split> SplitOfStretch(const Recipe& recipe,
                                                  const std::string& line_hash,
                                                  const SeenStretch& stretch);

}  // namespace railcast
