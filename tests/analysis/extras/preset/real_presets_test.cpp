// The gate of the presets: each against a recording of its own sensor. docs/results/validation.md
// has the figures.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <ostream>
#include <string>
#include <utility>

#include "analysis/extras/preset/preset_comparison.h"
#include "analysis/stats/bins.h"
#include "core/detect/base/beam_optics.h"
#include "tests/analysis/extras/preset/preset_scenario.h"
#include "tests/support/hesai_bag.h"

namespace railcast {
namespace {

// What Haider and others 2022 report for their sensor model.
constexpr double kGoalOfPoints = 0.085;

struct Gate {
  std::string sensor;
  std::string capture;  ///< Empty for a ROS recording that has the sensor's name.
  Sectors sectors{};
  double intensity{};            ///< Error; NaN: no piece is long enough to be measured.
  double mean_intensity{};       ///< Error of the means at each range; likewise.
  double temporal{};             ///< Simulated over recorded sigma from turn to turn.
  double holes{};                ///< Simulated less recorded share.
  std::uint64_t most_in_dead{};  ///< Pairs of returns nearer than the dead time allows.
};

std::ostream& operator<<(std::ostream& out, const Gate& gate) {
  return out << gate.sensor << (gate.sectors == Sectors::kEven ? " even" : " odd");
}

std::filesystem::path CaptureOf(const Gate& gate) {
  return RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/" + gate.capture + ".pcap";
}

// Why there is nothing to compare with; empty if there is.
std::string WhyNoCapture(const Gate& gate) {
  if (gate.capture.empty()) return WhyNoHesaiBag(gate.sensor);
  return exists(CaptureOf(gate)) ? "" : CaptureOf(gate).string() + " is not there";
}

PresetComparison Compare(const Gate& gate, const ScenarioSpec& scenario) {
  const auto recording =
      OpenRecording(gate.capture.empty() ? HesaiBag(gate.sensor) : CaptureOf(gate));
  return ComparePreset(*recording, scenario, gate.sectors);
}

/// The comparison with the preset itself, made when it is first asked for.
const PresetComparison& OfPreset(const Gate& gate) {
  static std::map<std::pair<std::string, Sectors>, PresetComparison> compared;
  const std::pair key(gate.sensor, gate.sectors);
  auto found = compared.find(key);
  if (found == compared.end()) {
    found = compared.emplace(key, Compare(gate, PresetScenario(gate.sensor))).first;
  }
  return found->second;
}

std::uint64_t NumFirings(const PlaneFigures& figures) {
  Holes::Count all;
  for (const Holes::Count& count : figures.firings) all.Add(count);
  return all.num_expected;
}

class RealPreset : public testing::TestWithParam<Gate> {};

// The limits stand four standard errors from the figures of docs/results/validation.md.
TEST_P(RealPreset, MeasuresItsSensorsPlanesAsTheSensorDid) {
  const Gate& gate = GetParam();
  if (const std::string why = WhyNoCapture(gate); !why.empty()) GTEST_SKIP() << why;
  const PresetComparison& comparison = OfPreset(gate);
  const auto num_cells = static_cast<double>(LikePieces(comparison.intensity).size());
  const double holes = comparison.simulated.HoleShare();
  std::cout << gate << ": points " << comparison.PointsError() << ", intensity "
            << comparison.IntensityError() << " [" << comparison.IntensityError(1.2) << ", "
            << comparison.IntensityError(1.5) << "] of " << num_cells << " cells, means "
            << comparison.MeanIntensityError() << " [" << comparison.MeanIntensityError(1.2) << ", "
            << comparison.MeanIntensityError(1.5) << "], planes " << comparison.PlaneSigmaRatio()
            << ", turns " << comparison.TemporalSigmaRatio() << ", holes "
            << comparison.recorded.HoleShare() << " and " << holes << " of "
            << NumFirings(comparison.recorded) << '\n';
  EXPECT_LT(comparison.PointsError(), kGoalOfPoints);
  if (!std::isnan(gate.intensity)) {
    // The mean of absolute values of normal errors; turns repeat each other.
    const double num = num_cells / static_cast<double>(comparison.num_turns);
    EXPECT_LT(comparison.IntensityError(), gate.intensity * (1.0 + 4.0 * 0.76 / std::sqrt(num)));
    const auto num_means =
        static_cast<double>(MeansOfSteps(LikePieces(comparison.intensity)).size()) /
        static_cast<double>(comparison.num_turns);
    EXPECT_LT(comparison.MeanIntensityError(),
              gate.mean_intensity * (1.0 + 4.0 * 0.76 / std::sqrt(num_means)));
  }
  // The ratio of two robust sigmas of 500 differences each, the fewest that count.
  EXPECT_NEAR(comparison.TemporalSigmaRatio(), gate.temporal, 4.0 * std::sqrt(2.0 / 370.0));
  const double recorded = comparison.recorded.HoleShare();
  const auto num_firings = static_cast<double>(NumFirings(comparison.recorded));
  const double error = std::sqrt((holes + recorded + 1.0 / num_firings) / num_firings);
  EXPECT_NEAR(holes - recorded, gate.holes, 4.0 * error);
  EXPECT_LE(comparison.gaps.num_in_dead, gate.most_in_dead);
}

constexpr double kUnmeasured = std::numeric_limits<double>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    Captures,
    RealPreset,
    testing::Values(
        Gate{"vlp16", "vlp16_dual", Sectors::kEven, kUnmeasured, kUnmeasured, 1.18, -0.0014},
        Gate{"vlp16", "vlp16_dual", Sectors::kOdd, 0.042, 0.028, 1.11, -0.0038},
        Gate{"vlp32c", "vlp32c_single", Sectors::kEven, 0.049, 0.018, 1.24, -0.0109},
        Gate{"vlp32c", "vlp32c_single", Sectors::kOdd, 0.079, 0.048, 1.25, -0.0024},
        Gate{"pandar64", "pandar64", Sectors::kEven, kUnmeasured, kUnmeasured, 0.97, 0.0},
        Gate{"pandar64", "pandar64", Sectors::kOdd, kUnmeasured, kUnmeasured, 0.98, 0.0005},
        Gate{"vls128", "vls128_single", Sectors::kEven, 0.133, 0.116, 1.10, -0.0006},
        Gate{"vls128", "vls128_single", Sectors::kOdd, 0.109, 0.082, 1.10, -0.0021},
        Gate{"xt32", "", Sectors::kEven, 0.049, 0.042, 1.20, 0.0},
        Gate{"xt32", "", Sectors::kOdd, 0.016, 0.015, 1.17, 0.0},
        // 16 of 8343 pairs are one echo, reported twice.
        Gate{"qt128", "", Sectors::kEven, 0.032, 0.028, 1.19, 0.0, 16},
        Gate{"qt128", "", Sectors::kOdd, 0.018, 0.014, 1.16, 0.0, 16}),
    [](const auto& test) {
      return test.param.sensor + (test.param.sectors == Sectors::kEven ? "_even" : "_odd");
    });

/// The nearest two returns of one firing in a recording.
double NearestPair_m(const std::filesystem::path& bag) {
  const auto recording = OpenRecording(bag);
  float nearest_m = std::numeric_limits<float>::infinity();
  while (const auto read = recording->Next()) {
    const RecordedFrame turn = (*read)();
    const std::vector<float>& range_m = turn.frame.range_m;
    for (std::size_t i = 0; i + 1 < range_m.size(); i += 2) {
      // NaN, of a firing with one return, is not nearer.
      nearest_m = std::fmin(nearest_m, std::abs(range_m[i] - range_m[i + 1]));
    }
  }
  return static_cast<double>(nearest_m);
}

// Dead times are rounded down to 0.1 ns, which is 15 mm.
TEST(RealDeadTime, OfThePresetIsThatOfTheNearestReturnsOfOneFiring) {
  for (const char* sensor : {"pandar40p", "qt64"}) {
    if (const std::string why = WhyNoHesaiBag(sensor); !why.empty()) GTEST_SKIP() << why;
    const double dead_m = DeadLength_m(PresetScenario(sensor).lidar.receiver);
    const double nearest_m = NearestPair_m(HesaiBag(sensor));
    EXPECT_LE(dead_m, nearest_m) << sensor;
    EXPECT_GT(dead_m, nearest_m - 0.015) << sensor;
  }
}

const Gate kOddVls128{"vls128", "vls128_single", Sectors::kOdd};

// Points of the bins of range from 80 to 125 m, where all planes are road.
double NumFarPoints(const PlaneFigures& figures) {
  std::uint64_t num = 0;
  for (std::size_t i = 0; i < figures.firings.size(); ++i) {
    const double middle_m = RangeBins().middle(i);
    if (middle_m > 80.0 && middle_m < 125.0) num += figures.num_points(i);
  }
  return static_cast<double>(num);
}

// With the sheet's range and divergence the peak of the stretched pulse falls below the threshold
// on ground that the sensor sees; its energy does not.
TEST(RealVls128, SeesTheRoadByTheEnergyOfThePulseWhosePeakWouldNotSuffice) {
  if (const std::string why = WhyNoCapture(kOddVls128); !why.empty()) GTEST_SKIP() << why;
  ScenarioSpec scenario = PresetScenario("vls128");
  const PresetComparison& by_energy = OfPreset(kOddVls128);
  scenario.lidar.receiver.signal = EchoSignal::kPeak;
  const PresetComparison by_peak = Compare(kOddVls128, scenario);
  const double num_seen = NumFarPoints(by_energy.recorded);
  std::cout << "road from 80 to 125 m: " << num_seen << " points, by energy "
            << NumFarPoints(by_energy.simulated) << ", by peak " << NumFarPoints(by_peak.simulated)
            << '\n';
  EXPECT_NEAR(NumFarPoints(by_energy.simulated), num_seen, 4.0 * std::sqrt(0.05 * num_seen));
  EXPECT_LT(NumFarPoints(by_peak.simulated), 0.6 * num_seen);
}

// The law of incidence: no power of range is left in the intensities of the ground.
TEST(RealVls128, HasIntensitiesOfTheGroundThatLeaveNoPowerOfRange) {
  if (const std::string why = WhyNoCapture(kOddVls128); !why.empty()) GTEST_SKIP() << why;
  const PresetComparison& comparison = OfPreset(kOddVls128);
  const Estimate left = RangeExponentLeft(comparison.intensity);
  std::cout << "power of range left: " << left.value << " [" << left.low << ", " << left.high
            << "] of " << left.num << '\n';
  EXPECT_LT(left.low, 0.0);
  EXPECT_GT(left.high, 0.0);
}

// Floor and scale were set from the even sectors, which have nothing beyond 100 m: a wall at 171 m
// tells whether the noise grows with the signal-to-noise ratio as the formula says.
TEST(RealVls128, HasTheNoiseOfItsSignalOnAFarWallThatWasNotFitted) {
  if (const std::string why = WhyNoCapture(kOddVls128); !why.empty()) GTEST_SKIP() << why;
  const PresetComparison& comparison = OfPreset(kOddVls128);
  const auto bin = RangeBins().Find(171.0);
  const double recorded_m = comparison.recorded.temporal.bins()[*bin].RobustSigma_m().value;
  const double simulated_m = comparison.simulated.temporal.bins()[*bin].RobustSigma_m().value;
  std::cout << "wall at 171 m: " << recorded_m << " m, simulated " << simulated_m << " m\n";
  // Four standard errors of the ratio of robust sigmas of 1,700 and 2,500 differences.
  EXPECT_NEAR(simulated_m / recorded_m, 1.0, 0.15);
}

}  // namespace
}  // namespace railcast
