#include "core/extras/recipe/split_plan.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/extras/recipe/distribution.h"
#include "core/extras/recipe/drafted_scenario.h"
#include "core/extras/recipe/recipe_values.h"
#include "core/extras/recipe/split_quota.h"
#include "core/io/content_hash.h"
#include "core/scenario/sensors.h"
#include "railcast/lidar.h"

namespace railcast {
namespace {

/// Draws of a start by which its distribution is judged.
constexpr std::uint32_t kNumStarts = 4096;

/// Where a scenario may start, and what it sees from there.
struct StartPlace {
  double s_m{};
  SeenStretch seen;
};

/// A base with what the recipe sets, and with what it draws for scenario 0.
struct BaseGround {
  std::string line_hash;
  std::vector<StartPlace> starts{};  ///< Many draws that are on the line, or all frames.
  double num_drawn{};                ///< All draws, also those off the line.
  double seen_m{};                   ///< How much of the line is seen at most.
};

DraftedScenario DraftOfBase(const Recipe& recipe, const RecipeBases& bases, std::size_t base) {
  DraftedScenario draft(recipe, {}, bases.json(base), base);
  (void)PutRecipeValues(recipe, {recipe.seed, 0}, 0, {}, draft);
  return draft;
}

std::string LineHashOf(const DraftedScenario& draft) {
  return LineHash(Json::parse(ResolvedScenarioJson(draft.OnLine(draft.Read()))));
}

BaseGround GroundOfRecording(const Recipe& recipe,
                             const RecordedBase& run,
                             const DraftedScenario& draft) {
  const double sight_m = SightOf_m(recipe, draft.Read());
  const std::uint32_t num = NumStartsIn(recipe, run);
  BaseGround ground{.line_hash = LineHashOf(draft), .num_drawn = static_cast<double>(num)};
  for (std::uint32_t i = 0; i < num; ++i) {
    const SeenStretch seen = SeenStretchFrom(recipe, run, i, sight_m);
    ground.starts.push_back({run.frames().at(i).s_m, seen});
    ground.seen_m = std::max(ground.seen_m, seen.end_s_m - seen.begin_s_m);
  }
  return ground;
}

BaseGround GroundOf(const Recipe& recipe, const RecipeBases& bases, std::size_t base) {
  const DraftedScenario draft = DraftOfBase(recipe, bases, base);
  if (const auto& run = recipe.bases[base].run) return GroundOfRecording(recipe, *run, draft);
  const ScenarioSpec scenario = WithRecipeSensor(recipe, draft.Read());
  const auto world = draft.Located([&] { return MakeWorld(scenario); });
  const ScanPattern pattern = BuildScanPattern(SensorsOf(scenario).front().lidar.scan);
  const double start_s_m = scenario.vehicle.start_s_m;
  const SeenStretch seen =
      SeenStretchOf(*world, StampsOf(recipe, pattern), SightOf_m(recipe, scenario))
          .ShiftedBy(-start_s_m);
  BaseGround ground{.line_hash = LineHashOf(draft),
                    .num_drawn = kNumStarts,
                    .seen_m = seen.end_s_m - seen.begin_s_m};
  const auto& own = recipe.bases[base].start_s_m;
  const auto& start = own ? own : recipe.start_s_m;
  const KeyedDraws draws(recipe.seed, 0);
  for (std::uint32_t i = 0; i < kNumStarts; ++i) {
    const double s_m =
        start ? DrawValue(*start, draws, "split\nstart_s_m", i).get<double>() : start_s_m;
    if (s_m < 0.0 || s_m > world->alignment().length_m()) continue;
    ground.starts.push_back({s_m, seen.ShiftedBy(s_m)});
  }
  return ground;
}

// "train, val and test".
std::string NamesOfParts(const PerPart<double>& shares) {
  std::vector<std::string> names;
  for (const auto& [split, name] : kEnumNames<Split>) {
    if (shares[static_cast<std::size_t>(split)] > 0.0) names.emplace_back(name);
  }
  return JoinInProse(names, " and ");
}

[[noreturn]] void Refuse(const Recipe& recipe, const std::string& rule, const std::string& got) {
  throw InputError(
      std::vector<Fault>{{ShownPath(recipe.file.lexically_normal()) + ": /split", rule, got}});
}

}  // namespace

std::string LineHash(const Json& scenario) {
  return ContentHash(scenario.at("world").at("alignment").dump());
}

SplitPlan::SplitPlan(const Recipe& recipe, const RecipeBases& bases)
    : recipe_(recipe),
      quota_(QuotaOf(SharesOf(recipe.split), recipe.num_scenarios)),
      key_(KeyedDraws(recipe.seed, 0).Seed("split")) {
  std::vector<double> weights;
  for (const RecipeBase& base : recipe.bases) weights.push_back(base.weight);
  base_weights_.fill(weights);
  if (recipe.split.by == SplitBy::kLine) DivideLines(bases);
  if (recipe.split.by == SplitBy::kPlace) DivideCells(bases);
}

Split SplitPlan::PartOf(std::uint32_t scenario) const {
  const std::uint32_t place = Permuted(scenario, recipe_.num_scenarios, key_);
  if (place < quota_[0]) return Split::kTrain;
  return place < quota_[0] + quota_[1] ? Split::kVal : Split::kTest;
}

void SplitPlan::DivideLines(const RecipeBases& bases) {
  std::vector<SplitPlace> lines;
  std::map<std::string, std::size_t> index_by_line;
  std::vector<std::size_t> line_of_base;
  for (std::size_t i = 0; i < recipe_.bases.size(); ++i) {
    const RecipeBase& base = recipe_.bases[i];
    const std::string hash = LineHashOf(DraftOfBase(recipe_, bases, i));
    const auto [known, is_new] = index_by_line.emplace(hash, lines.size());
    if (is_new) lines.push_back({hash, 0.0, base.split});
    lines[known->second].weight += base.weight;
    line_of_base.push_back(known->second);
  }
  const PerPart<double> shares = SharesOf(recipe_.split);
  const auto parts = DividePlaces(lines, shares, {recipe_.seed, 0});
  if (!parts) {
    const auto num_pinned = std::ranges::count_if(
        lines, [](const SplitPlace& line) { return line.pinned.has_value(); });
    Refuse(recipe_, "must have a line in /bases for each of " + NamesOfParts(shares),
           NumberText(lines.size()) + (lines.size() == 1 ? " line, " : " lines, ") +
               NumberText(num_pinned) + " of them with a part of its own");
  }
  for (std::size_t part = 0; part < kNumSplits; ++part) {
    for (std::size_t i = 0; i < recipe_.bases.size(); ++i) {
      if ((*parts)[line_of_base[i]] != static_cast<Split>(part)) base_weights_[part][i] = 0.0;
    }
  }
}

void SplitPlan::DivideCells(const RecipeBases& bases) {
  std::vector<BaseGround> grounds;
  std::map<std::pair<std::string, std::int64_t>, double> weights;
  double seen_m = 0.0;
  for (std::size_t i = 0; i < recipe_.bases.size(); ++i) {
    const BaseGround& ground = grounds.emplace_back(GroundOf(recipe_, bases, i));
    for (const StartPlace& start : ground.starts) {
      weights[{ground.line_hash, CellAt(start.s_m)}] += recipe_.bases[i].weight / ground.num_drawn;
    }
    seen_m = std::max(seen_m, ground.seen_m);
  }
  std::vector<SplitPlace> places;
  for (const auto& [cell, weight] : weights) {
    places.push_back({cell.first + "\n" + std::to_string(cell.second), weight, {}});
  }
  const std::string got = NumberText(places.size()) + (places.size() == 1 ? " cell" : " cells") +
                          " of " + NumberText(recipe_.split.cell_m) +
                          " m where scenarios start; one sees " + NumberText(std::ceil(seen_m)) +
                          " m, which cells must exceed";
  const PerPart<double> shares = SharesOf(recipe_.split);
  const auto parts = DividePlaces(places, shares, {recipe_.seed, 0});
  if (!parts) Refuse(recipe_, "must have a place for each of " + NamesOfParts(shares), got);
  std::size_t index = 0;
  for (const auto& [cell, weight] : weights) lines_[cell.first][cell.second] = (*parts)[index++];
  for (const BaseGround& ground : grounds) line_of_base_.push_back(&lines_[ground.line_hash]);
  for (std::size_t part = 0; part < kNumSplits; ++part) {
    const auto split = static_cast<Split>(part);
    double sum = 0.0;
    for (std::size_t i = 0; i < grounds.size(); ++i) {
      const auto fits = [&](const StartPlace& start) { return PartOf(i, start.seen) == split; };
      base_weights_[part][i] *=
          static_cast<double>(std::ranges::count_if(grounds[i].starts, fits)) /
          grounds[i].num_drawn;
      sum += base_weights_[part][i];
    }
    if (quota_[part] == 0 || sum > 0.0) continue;
    Refuse(recipe_, "must have room for a scenario in the places of " + std::string(NameOf(split)),
           got);
  }
}

std::int64_t SplitPlan::CellAt(double s_m) const {
  return static_cast<std::int64_t>(std::floor(s_m / recipe_.split.cell_m));
}

std::optional<Split> SplitPlan::PartOf(std::size_t base, const SeenStretch& stretch) const {
  const CellParts& cells = *line_of_base_.at(base);
  if (cells.empty()) return std::nullopt;
  // Where no scenario starts, ground belongs to the nearest cell where one does.
  const auto part_of = [&](std::int64_t cell) {
    const auto after = cells.lower_bound(cell);
    if (after == cells.end()) return std::prev(after)->second;
    if (after == cells.begin() || after->first == cell) return after->second;
    const auto before = std::prev(after);
    return cell - before->first <= after->first - cell ? before->second : after->second;
  };
  const std::int64_t last = CellAt(stretch.end_s_m);
  const Split split = part_of(last);
  for (std::int64_t cell = CellAt(stretch.begin_s_m); cell < last; ++cell) {
    if (part_of(cell) != split) return std::nullopt;
  }
  return split;
}

}  // namespace railcast
