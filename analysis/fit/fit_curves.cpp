#include "analysis/fit/fit_curves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "analysis/estimate/robust.h"
#include "analysis/stats/headings.h"

namespace railcast {
namespace {

constexpr std::size_t kMaxSurfaces = 6;

Estimate EstimateOf(const FitResult& result, std::string_view place) {
  for (const FittedParameter& parameter : result.parameters) {
    if (parameter.place == place) return parameter.estimate;
  }
  return {};
}

// Values from first to last, as far apart from each other in ratio.
std::vector<double> LogSteps(double first, double last, int num) {
  std::vector<double> steps;
  for (int i = 0; i < num; ++i) steps.push_back(first * std::pow(last / first, i / (num - 1.0)));
  return steps;
}

Chart NoiseByRange(const FitResult& result) {
  Chart chart{"noise",
              "Noise grows with range",
              "Each point: robust scale of as many residuals.",
              {"Range", "m", false, {}},
              {"Standard deviation", "m", false, {}},
              {}};
  ChartSeries measured{"measured", SeriesStyle::kPoints, {}};
  for (const NoiseBin& bin : result.noise_by_range) {
    measured.points.push_back(PointAt(bin.range_m, bin.sigma_m));
  }
  const double sigma0_m = EstimateOf(result, "lidar/plausibility/noise_sigma0_m").value;
  const double sigma1 = EstimateOf(result, "lidar/plausibility/noise_sigma1").value;
  chart.series.push_back(measured);
  if (std::isnan(sigma0_m) || measured.points.empty()) return chart;
  const double last_m = measured.points.back().x;
  chart.series.push_back(
      {"fitted", SeriesStyle::kLine, {{0.0, sigma0_m}, {last_m, sigma0_m + sigma1 * last_m}}});
  return chart;
}

Chart NoiseByPower(const FitResult& result) {
  Chart chart{"noise",
              "Noise falls with power",
              "Each point: robust scale of as many residuals.",
              {"Power over threshold", "", true, {}},
              {"Standard deviation", "m", false, {}},
              {}};
  ChartSeries measured{"measured", SeriesStyle::kPoints, {}};
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (const NoiseBin& bin : result.noise_by_power) {
    const double power = 1.0 / (2.0 * result.snr_at_threshold * bin.inverse_snr);
    measured.points.push_back(PointAt(power, bin.sigma_m));
    least = std::min(least, power);
    most = std::max(most, power);
  }
  chart.series.push_back(measured);
  const double floor_m = EstimateOf(result, "lidar/receiver/range_noise_floor_m").value;
  const double scale_m = EstimateOf(result, "lidar/receiver/range_noise_scale_m").value;
  if (std::isnan(floor_m) || std::isnan(scale_m) || measured.points.empty()) return chart;
  ChartSeries fitted{"fitted", SeriesStyle::kLine, {}};
  for (const double power : LogSteps(least, most, 60)) {
    const double growth_m = scale_m / std::sqrt(2.0 * result.snr_at_threshold * power);
    fitted.points.push_back({power, std::hypot(floor_m, growth_m)});
  }
  chart.series.push_back(fitted);
  return chart;
}

/// How many of a bin returned.
struct Count {
  std::uint64_t returned{};
  std::uint64_t all{};
  double log_power{};
};

// By tenths of the power's logarithm.
using PowerBins = std::map<int, Count>;

// About the threshold: from 1/8 to 8 times it.
constexpr double kReach = 8.0;

std::vector<PowerBins> BinByPower(const std::vector<Trial>& trials,
                                  const std::vector<FitSurface>& surfaces,
                                  const FitSettings& settings,
                                  const FitResult& result) {
  std::vector<std::size_t> place_of(surfaces.size(), 0);
  for (std::size_t i = 0; i < result.surface_ids.size(); ++i) place_of[result.surface_ids[i]] = i;
  std::vector<PowerBins> bins(result.surfaces.size());
  for (const Trial& trial : trials) {
    if (trial.answer == Answer::kElsewhere) continue;
    const std::size_t place = place_of[trial.surface];
    const double log_power = std::log(PowerOf(
        trial, surfaces[trial.surface], result.surfaces[place], settings, result.extinction_per_m));
    if (!(std::abs(log_power) < std::log(kReach))) continue;
    Count& count = bins[place][static_cast<int>(std::floor(10.0 * log_power))];
    ++count.all;
    count.returned += trial.answer == Answer::kReturned ? 1 : 0;
    count.log_power += log_power;
  }
  return bins;
}

// The surfaces with the most trials about the threshold.
std::vector<std::size_t> MostSeen(const std::vector<PowerBins>& bins) {
  std::vector<std::pair<std::uint64_t, std::size_t>> counts;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    std::uint64_t all = 0;
    for (const auto& [bin, count] : bins[i]) all += count.all;
    if (all >= kMinSamples) counts.emplace_back(all, i);
  }
  std::stable_sort(counts.begin(), counts.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::size_t> places;
  for (const auto& [all, place] : counts) {
    if (places.size() < kMaxSurfaces) places.push_back(place);
  }
  return places;
}

Chart Detection(const std::vector<Trial>& trials,
                const std::vector<FitSurface>& surfaces,
                const FitSettings& settings,
                const FitResult& result) {
  Chart chart{"detection",
              "Where beams are lost to the threshold",
              "The surfaces with the most beams about the threshold.",
              {"Power over threshold, as fitted", "", true, {}},
              {"Share that comes back", "", false, {}},
              {}};
  const std::vector<PowerBins> bins = BinByPower(trials, surfaces, settings, result);
  for (const std::size_t place : MostSeen(bins)) {
    ChartSeries series{result.surfaces[place].name, SeriesStyle::kPoints, {}};
    for (const auto& [bin, count] : bins[place]) {
      const Estimate share = Proportion(count.returned, count.all);
      if (!share.is_enough()) continue;
      series.points.push_back(
          PointAt(std::exp(count.log_power / static_cast<double>(count.all)), share));
    }
    if (!series.points.empty()) chart.series.push_back(series);
  }
  const double dropout = EstimateOf(result, "lidar/plausibility/dropout_probability").value;
  const double kept = 1.0 - (std::isnan(dropout) ? 0.0 : dropout);
  ChartSeries fitted{
      settings.is_physical ? "fitted" : "fitted, at range 0", SeriesStyle::kLine, {}};
  if (settings.is_physical && !std::isnan(result.snr_at_threshold)) {
    for (const double power : LogSteps(1.0 / kReach, kReach, 121)) {
      const double excess = result.snr_at_threshold * (power - 1.0);
      fitted.points.push_back({power, kept * 0.5 * std::erfc(-excess / std::numbers::sqrt2)});
    }
  } else if (!settings.is_physical) {
    fitted.points = {{1.0 / kReach, 0.0}, {1.0, 0.0}, {1.0, kept}, {kReach, kept}};
  }
  if (!chart.series.empty() && !fitted.points.empty()) chart.series.push_back(fitted);
  return chart;
}

Chart Intensities(const std::vector<Trial>& trials,
                  const std::vector<FitSurface>& surfaces,
                  const FitSettings& settings,
                  const FitResult& result) {
  constexpr int kNumBins = 20;
  Chart chart{"intensity",
              "How surfaces answer by incidence",
              "Points: medians; lines: the fitted reflectance with the shape given.",
              {"Cosine of the incidence", "", false, {}},
              {"Intensity", "", false, {}},
              {}};
  std::vector<std::size_t> order(result.surfaces.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return result.surfaces[a].num_returned > result.surfaces[b].num_returned;
  });
  if (order.size() > kMaxSurfaces) order.resize(kMaxSurfaces);
  for (const std::size_t place : order) {
    const SurfaceFit& fit = result.surfaces[place];
    if (!fit.reflectance.is_enough()) continue;
    std::map<int, std::vector<double>> bins;
    for (const Trial& trial : trials) {
      if (trial.surface != result.surface_ids[place] || std::isnan(trial.intensity)) continue;
      bins[static_cast<int>(kNumBins * trial.cos_incidence)].push_back(
          static_cast<double>(trial.intensity));
    }
    ChartSeries measured{fit.name, SeriesStyle::kPoints, {}};
    ChartSeries fitted{fit.name + ", fitted", SeriesStyle::kLine, {}};
    for (auto& [bin, intensities] : bins) {
      const double cosine = std::min(1.0, (bin + 0.5) / kNumBins);
      const Estimate median = Median(intensities);
      if (median.is_enough()) measured.points.push_back(PointAt(cosine, median));
      const ShapedAnswer shape = settings.is_physical
                                     ? AnswerOf(surfaces[result.surface_ids[place]], cosine)
                                     : ShapedAnswer{cosine, 0.0};
      fitted.points.push_back({cosine, fit.reflectance.value * shape.diffuse + shape.lobe});
    }
    chart.series.push_back(measured);
    chart.series.push_back(fitted);
  }
  return chart;
}

Chart Biases(const FitResult& result) {
  Chart chart{"channel_bias",
              "Range errors of the channels",
              "Medians of their residuals.",
              {"Channel", "", false, {}},
              {"Bias", "m", false, {}},
              {}};
  ChartSeries series{"bias", SeriesStyle::kPoints, {}};
  for (const ChannelBias& bias : result.residuals.channels) {
    series.points.push_back(PointAt(bias.channel, bias.bias_m));
  }
  chart.series.push_back(series);
  return chart;
}

}  // namespace

std::vector<Chart> MakeFitCharts(const std::vector<Trial>& trials,
                                 const std::vector<FitSurface>& surfaces,
                                 const FitSettings& settings,
                                 const FitResult& result) {
  std::vector<Chart> charts;
  charts.push_back(settings.is_physical && !result.noise_by_power.empty() ? NoiseByPower(result)
                                                                          : NoiseByRange(result));
  charts.push_back(Detection(trials, surfaces, settings, result));
  if (settings.has_reflectances) charts.push_back(Intensities(trials, surfaces, settings, result));
  if (result.residuals.channels.size() > 1) charts.push_back(Biases(result));
  // A chart without a point says nothing.
  std::erase_if(charts, [](const Chart& chart) {
    return std::all_of(chart.series.begin(), chart.series.end(),
                       [](const ChartSeries& series) { return series.points.empty(); });
  });
  return charts;
}

}  // namespace railcast
