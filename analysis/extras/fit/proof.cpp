#include "analysis/extras/fit/proof.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/extras/fit/fit_report.h"
#include "analysis/stats/bins.h"

namespace railcast {
namespace {

/// A figure of one half of the sectors.
struct Judged {
  double ratio{};     ///< Simulated over recorded.
  double distance{};  ///< From the recording's; NaN where there is no figure.
  double error{};     ///< Standard error of the recording's on the distance's scale.
};

struct Figure {
  std::string name;
  std::vector<Judged> halves;

  [[nodiscard]] double MeanRatio() const {
    double sum = 0.0;
    for (const Judged& half : halves) sum += half.ratio;
    const double mean = sum / static_cast<double>(halves.size());
    return std::isfinite(mean) ? mean : std::numeric_limits<double>::quiet_NaN();
  }
};

/// The standard error of a mean over bins of robust standard deviations, relative.
class MeanError {
 public:
  void Add(const Estimate& sigma) {
    constexpr double kNormalQuantile = 1.959964;  // For 95 % intervals.
    const double error = 0.5 * (sigma.high - sigma.low) / (kNormalQuantile * sigma.value);
    if (!std::isfinite(error)) return;
    squares_ += error * error;
    ++num_;
  }
  [[nodiscard]] double value() const { return std::sqrt(squares_) / static_cast<double>(num_); }

 private:
  double squares_{};
  std::size_t num_{};
};

Figure NoiseFigure(const std::vector<PresetComparison>& halves) {
  const bool has_turns = std::ranges::all_of(halves, [](const PresetComparison& half) {
    return std::isfinite(half.TemporalSigmaRatio());
  });
  Figure figure{has_turns ? "noise from turn to turn" : "noise about planes", {}};
  for (const PresetComparison& half : halves) {
    MeanError error;
    if (has_turns) {
      for (const auto& bin : half.recorded.temporal.bins()) error.Add(bin.RobustSigma_m());
    } else {
      for (const auto& bin : half.recorded.noise.planes()) error.Add(bin.RobustRangeSigma_m());
    }
    const double ratio = has_turns ? half.TemporalSigmaRatio() : half.PlaneSigmaRatio();
    figure.halves.push_back({ratio, std::abs(std::log(ratio)), error.value()});
  }
  return figure;
}

Figure HoleFigure(const std::vector<PresetComparison>& halves) {
  Figure figure{"holes", {}};
  for (const PresetComparison& half : halves) {
    HoleCount recorded;
    for (const HoleCount& count : half.recorded.firings) recorded.Add(count);
    const auto num = static_cast<double>(recorded.num_expected);
    const double share = half.recorded.HoleShare();
    // With a hole more, so that none at all is not taken to be exact.
    const double error = std::sqrt(static_cast<double>(recorded.num_missing + 1)) / num;
    figure.halves.push_back(
        {half.HoleRatio(), std::abs(half.simulated.HoleShare() - share), error});
  }
  return figure;
}

bool IsOfLosses(const FittedParameter& parameter) {
  return parameter.place.find("dropout") != std::string::npos;
}

ReplayVerdict VerdictOf(const Figure& before, const Figure& after) {
  double gain_of_all = 0.0;
  bool is_better = true;
  for (std::size_t i = 0; i < before.halves.size(); ++i) {
    const double gain = before.halves[i].distance - after.halves[i].distance;
    gain_of_all += gain;
    is_better = is_better && gain > before.halves[i].error;
  }
  if (is_better) return ReplayVerdict::kBetter;
  return gain_of_all < 0.0 ? ReplayVerdict::kWorse : ReplayVerdict::kNotTold;
}

/// No figure of ranges or holes tells of it.
bool IsOfIntensities(const FittedParameter& parameter) {
  return parameter.place == "lidar/receiver/intensity_noise" ||
         parameter.place == "lidar/receiver/channel_gain" ||
         parameter.place == "lidar/receiver/channel_gain_variation";
}

/// Indices of parameters that have a value to be judged, those in one place that mean nothing
/// without each other: the line of the published noise.
std::vector<std::vector<std::size_t>> StepsOf(const FitResult& result) {
  std::vector<std::vector<std::size_t>> steps;
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    const FittedParameter& parameter = result.parameters[i];
    if (!parameter.is_written() || IsOfIntensities(parameter)) continue;
    if (parameter.place == "lidar/plausibility/noise_sigma1" && !steps.empty()) {
      steps.back().push_back(i);
    } else {
      steps.push_back({i});
    }
  }
  return steps;
}

}  // namespace

FitProof::FitProof(const std::vector<RecordedFrame>& turns, std::string source)
    : source_(std::move(source)) {
  for (const Sectors sectors : {Sectors::kEven, Sectors::kOdd}) {
    SeenTurns half = SeePlanesOf(turns, sectors);
    if (!half.turns.empty()) halves_.push_back(std::move(half));
  }
}

std::map<int, LossBin> FitProof::Losses() const {
  std::map<int, LossBin> losses;
  for (const SeenTurns& half : halves_) {
    for (std::size_t i = 0; i < half.recorded.firings.size(); ++i) {
      const HoleCount& count = half.recorded.firings[i];
      if (count.num_expected == 0) continue;
      const double range_m = RangeBins().middle(i);
      LossBin& bin = losses[static_cast<int>(range_m)];
      bin.num += count.num_expected;
      bin.num_lost += count.num_missing;
      bin.range_sum_m += range_m * static_cast<double>(count.num_expected);
    }
  }
  return losses;
}

void FitProof::Judge(ScenarioSpec scenario, FitResult& result) const {
  const auto replayed = [&](const ScenarioSpec& spec) {
    std::vector<PresetComparison> halves;
    for (const SeenTurns& half : halves_) halves.push_back(CompareTurns(half, spec, source_));
    return halves;
  };
  std::vector<PresetComparison> before = replayed(scenario);
  for (const std::vector<std::size_t>& step : StepsOf(result)) {
    FitResult tried;
    for (const std::size_t i : step) tried.parameters.push_back(result.parameters[i]);
    const ScenarioSpec with = FittedScenario(scenario, tried);
    std::vector<PresetComparison> after = replayed(with);
    const bool is_of_losses = IsOfLosses(tried.parameters.front());
    const Figure old_figure = is_of_losses ? HoleFigure(before) : NoiseFigure(before);
    const Figure new_figure = is_of_losses ? HoleFigure(after) : NoiseFigure(after);
    const ParameterProof proof{new_figure.name, old_figure.MeanRatio(), new_figure.MeanRatio(),
                               VerdictOf(old_figure, new_figure)};
    for (const std::size_t i : step) result.parameters[i].proof = proof;
    if (proof.verdict == ReplayVerdict::kWorse) continue;
    scenario = with;
    before = std::move(after);
  }
}

}  // namespace railcast
