#include "generator/dataset/dataset_split.h"

#include <cmath>

#include "core/io/content_hash.h"
#include "generator/dataset/keyed_draws.h"

namespace railcast {
namespace {

Split SplitAt(const SplitSpec& split, double unit) {
  // A share of 0 gets nothing, whatever the rounding of the sum.
  if (unit < split.train) return Split::kTrain;
  if (unit < split.train + split.val || split.test == 0.0) {
    return split.val > 0.0 ? Split::kVal : Split::kTrain;
  }
  return Split::kTest;
}

}  // namespace

std::string LineHash(const Json& scenario) {
  return ContentHash(scenario.at("world").at("alignment").dump());
}

Split SplitOfScenario(const Recipe& recipe, std::uint32_t scenario) {
  return SplitAt(recipe.split, KeyedDraws(recipe.seed, scenario).Unit("split"));
}

Split SplitOfLine(const Recipe& recipe,
                  const std::string& line_hash,
                  const std::optional<Split>& pinned) {
  if (pinned) return *pinned;
  return SplitAt(recipe.split, KeyedDraws(recipe.seed, 0).Unit("split\nline\n" + line_hash));
}

std::optional<Split> SplitOfStretch(const Recipe& recipe,
                                    const std::string& line_hash,
                                    const SeenStretch& stretch) {
  const auto cell_at = [&](double s_m) {
    return static_cast<std::int64_t>(std::floor(s_m / recipe.split.cell_m));
  };
  const auto split_of = [&](std::int64_t cell) {
    const std::string name = "split\nplace\n" + line_hash + "\n" + std::to_string(cell);
    return SplitAt(recipe.split, KeyedDraws(recipe.seed, 0).Unit(name));
  };
  const std::int64_t last = cell_at(stretch.end_s_m);
  const Split split = split_of(last);
  for (std::int64_t cell = cell_at(stretch.begin_s_m); cell < last; ++cell) {
    if (split_of(cell) != split) return std::nullopt;
  }
  return split;
}

}  // namespace railcast
