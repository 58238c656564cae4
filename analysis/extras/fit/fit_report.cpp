#include "analysis/extras/fit/fit_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/report/cell_text.h"
#include "analysis/report/words.h"
#include "analysis/stats/bins.h"
#include "core/base/text.h"

namespace railcast {
namespace {

// The residuals are measured along the beam.
constexpr NoiseShape kNoiseShape = NoiseShape::kBeam;

// Finds a parameter in a scenario; null if the scenario has no such place.
double* Find(ScenarioSpec& scenario, const std::string& place) {
  PlausibilitySpec& published = scenario.lidar.plausibility;
  ReceiverSpec& receiver = scenario.lidar.receiver;
  const std::pair<const char*, double*> places[] = {
      {"lidar/plausibility/noise_sigma0_m", &published.noise_sigma0_m},
      {"lidar/plausibility/noise_sigma1", &published.noise_sigma1},
      {"lidar/plausibility/dropout_probability", &published.dropout_probability},
      {"lidar/receiver/range_noise_floor_m", &receiver.range_noise_floor_m},
      {"lidar/receiver/range_noise_scale_m", &receiver.range_noise_scale_m},
      {"lidar/receiver/pointing_jitter_deg", &receiver.pointing_jitter_deg},
      {"lidar/receiver/intensity_noise", &receiver.intensity_noise},
      {"lidar/receiver/channel_gain", &receiver.channel_gain},
      {"lidar/receiver/channel_gain_variation", &receiver.channel_gain_variation},
      {"weather/rain_dropout_per_m", &scenario.weather.rain_dropout_per_m}};
  for (const auto& [name, value] : places) {
    if (place == name) return value;
  }
  return nullptr;
}

// Rounds to five digits, which is finer than any interval.
double RoundedParameter(double value) {
  if (value == 0.0) return 0.0;
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 4.0);
  // Divide where the unit is small, so that the result is the nearest decimal.
  return unit < 1.0 ? std::round(value / unit) / std::round(1.0 / unit)
                    : std::round(value / unit) * unit;
}

bool HasPublishedNoise(const FitResult& result) {
  return std::any_of(
      result.parameters.begin(), result.parameters.end(), [](const FittedParameter& parameter) {
        return parameter.place == "lidar/plausibility/noise_sigma0_m" && parameter.is_written();
      });
}

std::string ReplayVerdictText(const FittedParameter& parameter) {
  if (parameter.place.empty() || !parameter.estimate.is_enough()) return "";
  switch (parameter.proof.verdict) {
    case ReplayVerdict::kBetter:
      return "better";
    case ReplayVerdict::kWorse:
      return "worse: not written";
    case ReplayVerdict::kNotTold:
      break;
  }
  return "not told";
}

Table ParameterTable(const FitReportInput& input, const FitResult& result) {
  Table table = TableOf(kFitWords, "parameters", {{"has_scenario", input.scenario.has_value()}});
  for (const FittedParameter& parameter : result.parameters) {
    std::vector<Cell> row = {parameter.title, parameter.place, parameter.unit, parameter.estimate};
    if (input.scenario) {
      const ParameterProof& proof = parameter.proof;
      row.insert(row.end(), {ScenarioValue(*input.scenario, parameter.place), proof.figure,
                             proof.before, proof.after, ReplayVerdictText(parameter)});
    }
    row.emplace_back(parameter.remark);
    table.rows.push_back(std::move(row));
  }
  return table;
}

// All reports give noise and bias in mm; the table has the units of the scenario's keys.
constexpr double kMillimetres = 1e3;

Chart NoiseChart(const FitResult& result) {
  Chart chart = ChartOf(kFitWords, "noise");
  ChartSeries measured{"measured", SeriesStyle::kPoints};
  ChartSeries fitted{"fitted", SeriesStyle::kLine};
  for (const NoiseBin& bin : result.noise_by_range) {
    measured.points.push_back(PointAt(bin.range_m, Scaled(bin.sigma_m, kMillimetres)));
    fitted.points.push_back({bin.range_m, kMillimetres * bin.fitted_m});
  }
  chart.series = {measured, fitted};
  return chart;
}

Chart LossChart(const RecordedTrials& trials, const FitResult& result) {
  Chart chart = ChartOf(kFitWords, "losses");
  std::vector<LossBin> sums(RangeBins().size());
  for (const auto& [metre, bin] : trials.losses) {
    const auto place = RangeBins().Find(bin.range_m());
    if (!place) continue;
    sums[*place].num += bin.num;
    sums[*place].num_lost += bin.num_lost;
    sums[*place].range_sum_m += bin.range_sum_m;
  }
  ChartSeries measured{"measured", SeriesStyle::kPoints};
  ChartSeries fitted{"fitted", SeriesStyle::kLine};
  for (const LossBin& bin : sums) {
    if (bin.num < kMinSamples) continue;
    measured.points.push_back(PointAt(bin.range_m(), PercentProportion(bin.num_lost, bin.num)));
    fitted.points.push_back({bin.range_m(), 100.0 * result.loss.At(bin.range_m())});
  }
  chart.series = {measured, fitted};
  return chart;
}

Chart BiasChart(const FitResult& result) {
  Chart chart = ChartOf(kFitWords, "channel_bias");
  ChartSeries series{"bias", SeriesStyle::kPoints};
  for (const ChannelBias& bias : result.channels) {
    series.points.push_back(PointAt(bias.channel, Scaled(bias.bias_m, kMillimetres)));
  }
  chart.series.push_back(series);
  return chart;
}

std::vector<Chart> MakeCharts(const RecordedTrials& trials, const FitResult& result) {
  std::vector<Chart> charts = {NoiseChart(result), LossChart(trials, result), BiasChart(result)};
  // Drop charts without any point.
  std::erase_if(charts, [](const Chart& chart) {
    return std::all_of(chart.series.begin(), chart.series.end(),
                       [](const ChartSeries& series) { return series.points.empty(); });
  });
  return charts;
}

std::vector<Headline> Headlines(const FitResult& result) {
  std::vector<Headline> headlines;
  for (const FittedParameter& parameter : result.parameters) {
    if (!parameter.is_written()) continue;
    headlines.push_back({parameter.title, parameter.unit, parameter.estimate});
  }
  return headlines;
}

}  // namespace

double ScenarioValue(const ScenarioSpec& scenario, const std::string& place) {
  ScenarioSpec copy = scenario;
  const double* const value = Find(copy, place);
  return value == nullptr ? std::numeric_limits<double>::quiet_NaN() : *value;
}

std::string FittedJson(const ScenarioSpec& fitted, const FitResult& result) {
  using Json = nlohmann::ordered_json;
  const Json whole = Json::parse(ResolvedScenarioJson(fitted));
  Json json = {{"version", 1}};
  for (const FittedParameter& parameter : result.parameters) {
    if (!parameter.is_written()) continue;
    const Json::json_pointer place = Json::json_pointer("/" + parameter.place).parent_pointer();
    json[place] = whole.at(place);
  }
  return json.dump(2) + "\n";
}

ScenarioSpec FittedScenario(ScenarioSpec scenario, const FitResult& result) {
  // Parts of one gain: what is not told of one is in the other, or is none.
  const auto is_gain = [](const FittedParameter& parameter) {
    return parameter.is_written() && parameter.place.starts_with("lidar/receiver/channel_gain");
  };
  if (std::ranges::any_of(result.parameters, is_gain)) {
    ReceiverSpec& receiver = scenario.lidar.receiver;
    receiver.channel_gain = receiver.channel_gain_variation = 0.0;
  }
  for (const FittedParameter& parameter : result.parameters) {
    if (!parameter.is_written()) continue;
    *Find(scenario, parameter.place) = RoundedParameter(parameter.estimate.value);
  }
  if (HasPublishedNoise(result)) scenario.lidar.plausibility.noise_shape = kNoiseShape;
  return scenario;
}

Report MakeFitReport(const FitReportInput& input,
                     const RecordedTrials& trials,
                     const FitSettings& settings,
                     const FitResult& result) {
  Report report;
  const std::string rung = settings.is_physical ? "surface" : "plausibility";
  report.title = Joined({"Parameters of rung ", rung, " from ", input.sources.front()});
  report.command = input.command;
  for (const std::string& source : input.sources) report.facts.emplace_back("Input", source);
  report.facts.emplace_back("Kind", input.kind);
  report.facts.emplace_back("Frames", NumberText(trials.num_frames));
  report.facts.emplace_back("Flat pieces of surface", NumberText(trials.num_pieces));
  report.headlines = Headlines(result);
  Section section = SectionOf(kFitWords, "fit",
                              {{"rung", rung},
                               {"from_turns", result.noise_from == NoiseFrom::kTurns},
                               {"from_neighbours", result.noise_from == NoiseFrom::kNeighbours},
                               {"from_pieces", result.noise_from == NoiseFrom::kPieces}});
  section.charts = MakeCharts(trials, result);
  section.tables = {ParameterTable(input, result)};
  report.sections.push_back(std::move(section));
  return report;
}

}  // namespace railcast
