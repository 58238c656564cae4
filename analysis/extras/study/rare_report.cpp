#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>
#include <utility>

#include "analysis/extras/study/rare_study.h"
#include "analysis/report/words.h"
#include "core/base/text.h"

namespace railcast {

extern const char* const kStudyWords;
namespace {

/// A trial that failed, on the dearest rung that it was made on, after the search.
struct FailedTrial {
  const RarePoint* point;
  double weight{};  ///< In the probability.
};

std::vector<FailedTrial> FailedTrials(const RareStudy& study) {
  const RareRun& run = study.run;
  std::vector<FailedTrial> failed;
  for (std::size_t i = run.num_searching; i < run.trials.size(); ++i) {
    const RareTrial& trial = run.trials[i];
    const RareScores& scores = run.scores[i];
    const auto num =
        static_cast<double>(trial.is_pair ? run.figure.correction.num : run.figure.cheap.num);
    const double score = trial.is_pair ? scores.dear : scores.cheap;
    if (score < 0.0) failed.push_back({&trial.point, trial.weight / num});
  }
  return failed;
}

/// How a factor differs in the failures from what the recipe draws.
struct MovedFactor {
  std::string name{};
  std::string in_failures{};
  std::string usual{};
  double moved_nats{};  ///< Relative entropy.
};

MovedFactor MovedChoice(const RecipeFactor& factor, const std::map<double, double>& weights) {
  const auto& values = std::get<ChoiceDraw>(factor.distribution).values.values;
  const auto text_of = [&](double share, std::size_t value) {
    const Json& json = values[value];
    return (json.is_string() ? json.get<std::string>() : json.dump()) + " in " +
           NumberText(std::round(100.0 * share)) + " %";
  };
  MovedFactor moved{.name = factor.shown};
  double sum = 0.0;
  for (const auto& [value, weight] : weights) sum += weight;
  double most = 0.0;
  for (const auto& [value, weight] : weights) {
    const auto index = static_cast<std::size_t>(value);
    const double share = weight / sum;
    const double usual = factor.law.probabilities[index];
    const double gain = share * std::log(share / usual);
    moved.moved_nats += gain;
    if (gain < most) continue;
    most = gain;
    moved.in_failures = text_of(share, index);
    moved.usual = text_of(usual, index);
  }
  return moved;
}

// The value that a number has at a normal score, with three digits.
std::string ValueTextAt(const RecipeFactor& factor, double score) {
  const KeyedDraws draws(0, 0, QuantilesAt({factor}, {score}));
  const auto value = DrawValue(factor.distribution, draws, factor.name).get<double>();
  const double unit = std::pow(10.0, 2.0 - std::floor(std::log10(std::max(std::abs(value), 1e-9))));
  return NumberText(std::round(value * unit) / unit);
}

// @param weights By normal score.
MovedFactor MovedNumber(const RecipeFactor& factor, const std::map<double, double>& weights) {
  constexpr double kTenth = -1.2816;  // Standard normal quantile of 0.1.
  double sum = 0.0;
  double first = 0.0;
  double second = 0.0;
  for (const auto& [score, weight] : weights) {
    sum += weight;
    first += weight * score;
    second += weight * score * score;
  }
  const auto score_at = [&](double share) {
    double left = share * sum;
    for (const auto& [score, weight] : weights) {
      if (left < weight) return score;
      left -= weight;
    }
    return weights.rbegin()->first;
  };
  const double mean = first / sum;
  const double variance = std::max(second / sum - mean * mean, 1e-6);
  return {factor.shown,
          ValueTextAt(factor, score_at(0.1)) + " to " + ValueTextAt(factor, score_at(0.9)),
          ValueTextAt(factor, kTenth) + " to " + ValueTextAt(factor, -kTenth),
          0.5 * (mean * mean + variance - 1.0 - std::log(variance))};
}

// The factors, the ones that have moved most first.
std::vector<MovedFactor> MovedFactors(const RareStudy& study) {
  const std::vector<FailedTrial> failed = FailedTrials(study);
  std::vector<MovedFactor> moved;
  for (std::size_t i = 0; i < study.factors.size(); ++i) {
    const RecipeFactor& factor = study.factors[i];
    std::map<double, double> weights;
    for (const FailedTrial& trial : failed) {
      const auto& only_with = factor.law.only_with;
      const bool matters =
          !only_with || (*trial.point)[only_with->factor] == static_cast<double>(only_with->value);
      if (matters) weights[(*trial.point)[i]] += trial.weight;
    }
    if (weights.empty()) continue;
    moved.push_back(factor.law.probabilities.empty() ? MovedNumber(factor, weights)
                                                     : MovedChoice(factor, weights));
  }
  std::ranges::stable_sort(moved, std::ranges::greater(), &MovedFactor::moved_nats);
  return moved;
}

Section ConditionsOfFailures(const RareStudy& study) {
  constexpr double kTelling_nats = 0.1;
  Table table = TableOf(kStudyWords, "rare_conditions");
  std::string words;
  for (const MovedFactor& moved : MovedFactors(study)) {
    table.rows.push_back({moved.name, moved.in_failures, moved.usual, moved.moved_nats});
    if (moved.moved_nats < kTelling_nats) continue;
    words += (words.empty() ? "Failures have " : "; ") + moved.name + " " + moved.in_failures +
             " (drawn: " + moved.usual + ")";
  }
  Section section = SectionOf(kStudyWords, "rare_conditions");
  section.paragraphs = {words.empty() ? "No condition stands out." : words + "."};
  section.tables = {std::move(table)};
  return section;
}

Table LevelsTable(const RareStudy& study) {
  const RareRun& run = study.run;
  Table table = TableOf(kStudyWords, "rare_levels");
  const auto add = [&](const char* part, const RareLevel& level, bool is_pair) {
    const double each_s = study.approach_s[is_pair ? 1 : 0];
    table.rows.push_back({part, is_pair ? study.dear + " and " + study.cheap : study.cheap,
                          level.num, level.mean, level.variance, each_s,
                          each_s * static_cast<double>(level.num)});
  };
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  if (run.num_searching > 0) add("search", {run.num_searching, unknown, unknown}, false);
  add("figure", run.figure.cheap, false);
  if (run.figure.correction.num > 0) add("correction", run.figure.correction, true);
  if (const RareBeyond& beyond = run.figure.beyond; beyond.num > 0) {
    const auto met = static_cast<double>(beyond.num_more + beyond.num_fewer);
    add("as drawn", {beyond.num, beyond.share.value, met / static_cast<double>(beyond.num)},
        run.figure.correction.num > 0);
  }
  return table;
}

Table CostTable(const RareStudy& study) {
  const RareFigure& figure = study.run.figure;
  const auto num_pairs =
      static_cast<double>(std::ranges::count_if(study.run.trials, &RareTrial::is_pair));
  const auto num_cheap = static_cast<double>(study.run.trials.size()) - num_pairs;
  const auto [cheap_s, pair_s] = study.approach_s;
  const double spent_s = num_cheap * cheap_s + (num_pairs > 0.0 ? num_pairs * pair_s : 0.0);
  const double plain = PlainTrialsFor(figure.probability);
  const double plain_s = plain * (num_pairs > 0.0 ? pair_s - cheap_s : cheap_s);
  Table table = TableOf(kStudyWords, "rare_cost");
  table.rows = {{std::uint64_t{study.run.trials.size()}, spent_s, std::round(plain), plain_s,
                 plain_s / spent_s}};
  return table;
}

// By the rule of three, with two digits.
std::string RarestText(const RareBeyond& beyond) {
  if (beyond.num == 0) return "";
  std::ostringstream text;
  text << std::setprecision(2) << 3.0 / static_cast<double>(beyond.num);
  return text.str();
}

Section FigureSection(const RareStudy& study) {
  const RareFigure& figure = study.run.figure;
  Section section = SectionOf(kStudyWords, "rare",
                              {{"rung", study.dear},
                               {"refusal", figure.refusal},
                               {"own", figure.beyond.num > 0 ? NumberText(figure.beyond.num) : ""},
                               {"rarest", RarestText(figure.beyond)}});
  Table table = TableOf(kStudyWords, "rare");
  table.rows = {{figure.probability, figure.met, figure.beyond.share, figure.beyond.num,
                 figure.at_most, figure.effective, 100.0 * figure.largest_share,
                 figure.by_proposal[0], figure.by_proposal[1]}};
  section.tables = {std::move(table), LevelsTable(study)};
  if (figure.is_known()) {
    section.tables.push_back(CostTable(study));
  } else {
    // Paragraphs are not in JSON.
    section.tables[0].columns.push_back({.key = "refusal", .title = "No figure, since"});
    section.tables[0].rows[0].emplace_back(figure.refusal);
  }
  return section;
}

}  // namespace

std::vector<Section> RareSections(const RareStudy& study) {
  return {FigureSection(study), ConditionsOfFailures(study)};
}

}  // namespace railcast
