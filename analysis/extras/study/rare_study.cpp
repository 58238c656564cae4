#include "analysis/extras/study/rare_study.h"

#include <ctime>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>
#include <utility>

#include "analysis/extras/rare/proposal.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/recipe/recipe_values.h"
#include "core/extras/recipe/scenario_turns.h"
#include "core/io/record/record_text.h"

namespace railcast {
namespace {

double NormalShare(double score) {
  return 0.5 * std::erfc(-score / std::sqrt(2.0));
}

// Seconds of the processor that the calling thread has used.
double ThreadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// The cost of an approach, relative to one on `surface` (docs/study.md). A table, since a
// measurement would make the numbers of approaches differ from run to run.
double CostOfRung(Fidelity rung) {
  if (rung == Fidelity::kFootprint) return 2.5;
  return rung == Fidelity::kReference ? 25.0 : 1.0;
}

/// Lists what a recipe draws.
class FactorList {
 public:
  [[nodiscard]] std::vector<RecipeFactor> Take() { return std::move(factors_); }

  void AddGroup(const DrawGroup& group) {
    // A seed is no factor, and what follows from it stays as drawn, too.
    if (group.options.empty() || group.name.ends_with("seed")) return;
    ChoiceDraw choice;
    for (const GroupOption& option : group.options) {
      choice.values.values.emplace_back(option.name);
      choice.weights.values.push_back(option.weight);
    }
    Add({NameOfGroupDraw(group), group.name, choice, {}});
    const std::size_t index = factors_.size() - 1;
    for (std::size_t i = 0; i < group.options.size(); ++i) {
      for (const PointedDraw& draw : group.options[i].draws.draws) {
        Add({NameOfOptionDraw(group, group.options[i], draw.pointer),
             draw.pointer,
             draw.distribution,
             {.only_with = RareFactor::Condition{index, i}}});
      }
    }
  }

  void AddObjects(const PlacedObjects& objects) {
    double most = 0.0;
    for (const Json& count : ExtremesOf(objects.count)) most = std::max(most, count.get<double>());
    for (int i = 1; i <= static_cast<int>(most); ++i) {
      const std::string object = objects.name + "/" + std::to_string(i);
      for (const PointedDraw& draw : objects.draws.draws) {
        Add({NameOfObjectDraw(object, draw.pointer),
             object + " " + draw.pointer,
             draw.distribution,
             {}});
      }
    }
  }

  void Add(RecipeFactor factor) {
    if (factor.shown.ends_with("seed")) return;
    if (const auto* choice = std::get_if<ChoiceDraw>(&factor.distribution)) {
      factor.law.probabilities = WeightsOf(*choice);
      auto& weights = factor.law.probabilities;
      const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
      for (double& weight : weights) weight /= sum;
    }
    factors_.push_back(std::move(factor));
  }

 private:
  std::vector<RecipeFactor> factors_;
};

/// Makes the trials of a run that its folder does not hold yet.
class RareMaker {
 public:
  RareMaker(const StudySpec& spec,
            const ScenarioDrawer& drawer,
            const StudyChoices& choices,
            const StudyHooks& hooks,
            RareStudy& study)
      : drawer_(drawer),
        choices_(choices),
        hooks_(hooks),
        study_(study),
        most_(spec.rare->most_approaches),
        directory_(choices.directory, study.identity, {}),
        make_approach_(MakerOfApproaches(spec, drawer.recipe(), choices)) {
    study_.approaches = directory_.Read();
  }

  std::optional<std::vector<RareScores>> Try(const std::vector<RareTrial>& trials) {
    const std::uint32_t begin = trials.front().index;
    const auto num_done = std::min(static_cast<std::uint32_t>(study_.approaches.size()) - begin,
                                   static_cast<std::uint32_t>(trials.size()));
    const auto make = [&](const ScenarioTurn& turn) {
      return MakeLine(trials[num_done + turn.index], turn);
    };
    const auto keep = [&](const std::string& line) {
      directory_.Append(line);
      ++study_.num_made;
    };
    const auto show = [&](double num_beyond) {
      const auto num = directory_.num_done() + static_cast<std::uint32_t>(num_beyond);
      hooks_.on_progress(std::min(num, most_), most_);
    };
    TakeTurns(static_cast<std::uint32_t>(trials.size()) - num_done, choices_.num_threads,
              std::numeric_limits<std::uint32_t>::max(),
              {.make = make, .keep = keep, .on_progress = show, .is_stopped = hooks_.is_stopped});
    directory_.Sync();
    if (directory_.num_done() > study_.approaches.size()) study_.approaches = directory_.Read();
    if (study_.approaches.size() < begin + trials.size()) return std::nullopt;
    std::vector<RareScores> scores;
    for (const RareTrial& trial : trials) {
      const ApproachRecord& approach = study_.approaches[trial.index];
      const double spare_m = LeastSpareOf(approach);
      if (trial.is_pair) {
        scores.push_back(
            {approach.cheap_spare_m.value_or(std::numeric_limits<double>::quiet_NaN()), spare_m});
      } else {
        scores.push_back({spare_m});
      }
    }
    return scores;
  }

  // By level.
  [[nodiscard]] double SecondsOfApproach(bool is_pair) const {
    const Effort& effort = efforts_[is_pair ? 1 : 0];
    return 1e-6 * static_cast<double>(effort.time_us) / static_cast<double>(effort.num);
  }

 private:
  struct Effort {
    std::atomic<std::uint64_t> time_us = 0;
    std::atomic<std::uint64_t> num = 0;
  };

  std::optional<std::string> MakeLine(const RareTrial& trial, const ScenarioTurn& turn) {
    const double begin_s = ThreadSeconds();
    DrawnScenario drawn = drawer_.Draw(trial.index, QuantilesAt(study_.factors, trial.point));
    AtPlace(PlaceOfScenario(drawer_.recipe(), trial.index), [&] {
      CheckIsStudied(drawn.scenario);
      if (const std::string_view rung = NameOf(drawn.scenario.fidelity); rung != study_.dear) {
        throw InputError("/fidelity: must be the same in all scenarios with --rare (got " +
                         Quoted(rung) + ", and " + Quoted(study_.dear) + " in the first)");
      }
    });
    std::optional<ApproachRecord> dear;
    if (trial.is_pair) {
      dear = make_approach_(drawn, turn.num_threads, turn.is_stopped);
      if (!dear) return std::nullopt;
    }
    drawn.scenario.fidelity = ValueNamed<Fidelity>(study_.cheap).value();
    const auto cheap = make_approach_(drawn, turn.num_threads, turn.is_stopped);
    if (!cheap) return std::nullopt;
    const double spare_m = LeastSpareOf(*cheap);
    if (dear && !std::isnan(spare_m)) dear->cheap_spare_m = spare_m;
    Effort& effort = efforts_[trial.is_pair ? 1 : 0];
    effort.time_us += static_cast<std::uint64_t>(1e6 * (ThreadSeconds() - begin_s));
    ++effort.num;
    return RecordText(dear ? *dear : *cheap);
  }

  const ScenarioDrawer& drawer_;
  const StudyChoices& choices_;
  const StudyHooks& hooks_;
  RareStudy& study_;
  std::uint32_t most_;
  StudyDirectory directory_;
  ApproachMaker make_approach_;
  std::array<Effort, 2> efforts_;
};

}  // namespace

std::vector<RecipeFactor> FactorsOfRecipe(const Recipe& recipe) {
  FactorList list;
  for (const DrawGroup& group : recipe.groups) list.AddGroup(group);
  for (const PointedDraw& draw : recipe.draws.draws) {
    list.Add({draw.pointer, draw.pointer, draw.distribution, {}});
  }
  for (const PlacedObjects& objects : recipe.objects) list.AddObjects(objects);
  return list.Take();
}

GivenQuantiles QuantilesAt(const std::vector<RecipeFactor>& factors, const RarePoint& point) {
  GivenQuantiles given;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const std::vector<double>& probabilities = factors[i].law.probabilities;
    if (probabilities.empty()) {
      given[factors[i].name] = std::min(NormalShare(point[i]), 1.0 - 0x1p-53);
      continue;
    }
    const auto value = static_cast<std::size_t>(point[i]);
    given[factors[i].name] =
        0.5 * probabilities[value] +
        std::accumulate(probabilities.begin(),
                        probabilities.begin() + static_cast<std::ptrdiff_t>(value), 0.0);
  }
  return given;
}

DrawnScenario DrawRare(const RareStudy& study, const ScenarioDrawer& drawer, std::uint32_t number) {
  return drawer.Draw(number, QuantilesAt(study.factors, study.run.trials.at(number).point));
}

std::optional<RareStudy> RunRareStudy(const StudySpec& study,
                                      const ScenarioDrawer& drawer,
                                      const StudyChoices& choices,
                                      const StudyHooks& hooks) {
  const RareSpec& spec = study.rare.value();
  const Fidelity dear = drawer.Draw(0).scenario.fidelity;
  RareStudy result{.factors = FactorsOfRecipe(drawer.recipe()),
                   .cheap = spec.cheap.empty() ? std::string(NameOf(dear)) : spec.cheap,
                   .dear = std::string(NameOf(dear)),
                   .identity = IdentityOfStudy(study, drawer, choices)};
  result.identity.rare = "cheap " + result.cheap + ", per_stage " + NumberText(spec.per_stage) +
                         ", precision " + NumberText(spec.precision) + ", most_approaches " +
                         NumberText(spec.most_approaches);
  if (spec.unseen) result.identity.rare += ", unseen " + NumberText(*spec.unseen);
  std::vector<RareFactor> laws;
  for (const RecipeFactor& factor : result.factors) laws.push_back(factor.law);
  const double cheap_cost = CostOfRung(ValueNamed<Fidelity>(result.cheap).value());
  RareMaker maker(study, drawer, choices, hooks, result);
  auto run = RunRareEvent(laws,
                          {.seed = drawer.recipe().seed,
                           .num_per_stage = spec.per_stage,
                           .precision = spec.precision,
                           .unseen = spec.unseen,
                           .most_trials = spec.most_approaches,
                           .has_pairs = result.cheap != result.dear,
                           .pair_cost = (CostOfRung(dear) + cheap_cost) / cheap_cost},
                          [&](const std::vector<RareTrial>& trials) { return maker.Try(trials); });
  if (!run) return std::nullopt;
  result.run = std::move(*run);
  result.approach_s = {maker.SecondsOfApproach(false), maker.SecondsOfApproach(true)};
  return result;
}

}  // namespace railcast
