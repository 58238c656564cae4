// What real sensors lose on smooth surfaces of one brightness, against the presets' law of it.
// docs/results/validation.md has the figures.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "analysis/stats/holes.h"
#include "core/io/recording/scan_table.h"
#include "railcast/io/recording.h"
#include "tests/analysis/extras/preset/preset_scenario.h"
#include "tests/support/hesai_bag.h"

namespace railcast {
namespace {

struct DarkSensor {
  std::string sensor;
  std::string capture;  ///< Empty for a ROS recording that has the sensor's name.
};

std::ostream& operator<<(std::ostream& out, const DarkSensor& sensor) {
  return out << sensor.sensor;
}

/// The law of effect `sensor_dropout`.
struct LossLaw {
  double anywhere{};
  double dark{};
  double dark_intensity{};

  [[nodiscard]] double At(double intensity) const {
    return anywhere + (1.0 - anywhere) * dark * std::exp(-intensity / dark_intensity);
  }
};

using Counts = std::vector<SmoothHoles::Count>;

double LogLikelihood(const Counts& counts, const LossLaw& law) {
  double sum = 0.0;
  for (const SmoothHoles::Count& count : counts) {
    if (count.firings.num_expected == 0) continue;
    const auto num_missing = static_cast<double>(count.firings.num_missing);
    const double lost = std::max(law.At(count.MeanIntensity()), 1e-9);
    sum += num_missing * std::log(lost) +
           (static_cast<double>(count.firings.num_expected) - num_missing) * std::log1p(-lost);
  }
  return sum;
}

HoleCount SumOf(const Counts& counts) {
  HoleCount sum;
  for (const SmoothHoles::Count& count : counts) sum.Add(count.firings);
  return sum;
}

LossLaw BestUniform(const Counts& counts) {
  const HoleCount sum = SumOf(counts);
  return {static_cast<double>(sum.num_missing) / static_cast<double>(sum.num_expected), 0.0, 1.0};
}

// The best law, to a fifth of an octave.
LossLaw BestLaw(const Counts& counts) {
  LossLaw best = BestUniform(counts);
  double most = LogLikelihood(counts, best);
  for (int a = -1; a < 25; ++a) {
    for (int p = 0; p < 45; ++p) {
      for (int i = 0; i < 35; ++i) {
        const LossLaw law{a < 0 ? 0.0 : 5e-5 * std::exp2(0.2 * a), 5e-4 * std::exp2(0.2 * p),
                          1e-3 * std::exp2(0.2 * i)};
        const double likelihood = LogLikelihood(counts, law);
        if (law.dark > 0.5 || likelihood <= most) continue;
        most = likelihood;
        best = law;
      }
    }
  }
  return best;
}

// Counts in the sectors of 30 deg with even and with odd numbers.
std::array<Counts, 2> CountHalves(Recording& recording) {
  std::array<SmoothHoles, 2> halves;
  while (const auto read = recording.Next()) {
    const RecordedFrame turn = (*read)();
    const auto scan = MakeScanTable(turn.frame);
    if (!turn.is_grid || !scan) continue;
    for (std::size_t column = 0; column < turn.frame.columns; ++column) {
      const double azimuth_rad = scan->column_azimuth_rad[column];
      if (std::isnan(azimuth_rad)) continue;
      const auto sector = static_cast<int>(std::floor(azimuth_rad * 6.0 / std::numbers::pi));
      for (std::size_t row = 0; row < turn.frame.rows; ++row) {
        halves.at(static_cast<std::size_t>(sector & 1)).AddFiring(turn.frame, row, column);
      }
    }
  }
  return {halves[0].by_intensity(), halves[1].by_intensity()};
}

class DarkLosses : public testing::TestWithParam<DarkSensor> {};

TEST_P(DarkLosses, OfThePresetAreTheBestOfOneHalfAndPredictTheOther) {
  const auto& [sensor, capture] = GetParam();
  const std::filesystem::path path =
      RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/" + capture + ".pcap";
  if (capture.empty()) {
    if (const std::string why = WhyNoHesaiBag(sensor); !why.empty()) GTEST_SKIP() << why;
  } else if (!exists(path)) {
    GTEST_SKIP() << path << " is not there";
  }
  const auto recording = OpenRecording(capture.empty() ? HesaiBag(sensor) : path);
  const auto [even, odd] = CountHalves(*recording);
  const PlausibilitySpec preset = PresetScenario(sensor).lidar.plausibility;
  const LossLaw law{preset.dropout_probability, preset.dark_dropout_probability,
                    preset.dark_dropout_intensity};
  const LossLaw best = BestLaw(even);
  const LossLaw uniform = BestUniform(even);
  std::cout << sensor << ": even " << SumOf(even).num_missing << " of " << SumOf(even).num_expected
            << ", best " << best.anywhere << " and dark " << best.dark << " at "
            << best.dark_intensity << '\n';
  for (const Counts& half : {even, odd}) {
    double expected = 0.0;
    double expected_bright = 0.0;
    HoleCount dark;
    HoleCount bright;
    for (const SmoothHoles::Count& count : half) {
      const auto num = static_cast<double>(count.firings.num_expected);
      if (num == 0.0) continue;
      const double mean = count.MeanIntensity();
      (mean < 0.055 ? expected : expected_bright) += num * law.At(mean);
      (mean < 0.055 ? dark : bright).Add(count.firings);
    }
    std::cout << "  dark " << dark.num_missing << " of " << dark.num_expected << " (preset "
              << expected << "), bright " << bright.num_missing << " of " << bright.num_expected
              << " (preset " << expected_bright << "); log-likelihood: preset "
              << LogLikelihood(half, law) << ", best " << LogLikelihood(half, best)
              << ", even's uniform loss " << LogLikelihood(half, uniform) << '\n';
  }
  EXPECT_GT(LogLikelihood(even, law), LogLikelihood(even, best) - 2.0);
  EXPECT_GT(LogLikelihood(odd, law), LogLikelihood(odd, uniform));
}

INSTANTIATE_TEST_SUITE_P(Captures,
                         DarkLosses,
                         testing::Values(DarkSensor{"vlp16", "vlp16_dual"},
                                         DarkSensor{"vlp32c", "vlp32c_single"},
                                         DarkSensor{"pandar64", "pandar64"},
                                         DarkSensor{"vls128", "vls128_single"},
                                         DarkSensor{"xt32", ""},
                                         DarkSensor{"qt128", ""}),
                         [](const auto& test) { return test.param.sensor; });

}  // namespace
}  // namespace railcast
