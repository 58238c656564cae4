// The gate of the presets: each against a recording of its own sensor. docs/validation.md has the
// figures.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <ostream>
#include <string>

#include "analysis/preset/preset_comparison.h"
#include "tests/analysis/preset/preset_scenario.h"
#include "tests/support/hesai_bag.h"

namespace railcast {
namespace {

// What Haider and others 2022 report for their sensor model.
constexpr double kGoalOfPoints = 0.085;
constexpr double kGoalOfIntensity = 0.093;

struct Gate {
  std::string sensor;
  std::string capture;  ///< Empty for a ROS recording that has the sensor's name.
  Sectors sectors{};
  double most_intensity{};  ///< NaN: no strip is long enough to be measured.
  double least_temporal{}, most_temporal{};
  double least_holes{}, most_holes{};
  std::uint64_t most_in_dead{};  ///< Pairs of returns nearer than the dead time allows.
};

std::ostream& operator<<(std::ostream& out, const Gate& gate) {
  return out << gate.sensor << (gate.sectors == Sectors::kEven ? " even" : " odd");
}

class RealPreset : public testing::TestWithParam<Gate> {};

TEST_P(RealPreset, MeasuresItsSensorsPlanesAsTheSensorDid) {
  const Gate& gate = GetParam();
  const bool is_bag = gate.capture.empty();
  const std::filesystem::path file =
      RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/" + gate.capture + ".pcap";
  const std::string why = is_bag         ? WhyNoHesaiBag(gate.sensor)
                          : exists(file) ? ""
                                         : file.string() + " is not there";
  if (!why.empty()) GTEST_SKIP() << why;
  const TemporaryDirectory folder;
  const auto recording = OpenRecording(is_bag ? CaptureOfHesaiBag(gate.sensor, folder) : file);
  const PresetComparison comparison =
      ComparePreset(*recording, PresetScenario(gate.sensor), gate.sectors);
  std::cout << gate << ": points " << comparison.PointsError() << ", intensity "
            << comparison.IntensityError() << " of " << comparison.intensity.size()
            << " cells, planes " << comparison.PlaneSigmaRatio() << ", turns "
            << comparison.TemporalSigmaRatio() << ", holes " << comparison.HoleRatio() << '\n';
  EXPECT_LT(comparison.PointsError(), kGoalOfPoints);
  if (!std::isnan(gate.most_intensity)) {
    EXPECT_LT(comparison.IntensityError(), gate.most_intensity);
  }
  EXPECT_GT(comparison.TemporalSigmaRatio(), gate.least_temporal);
  EXPECT_LT(comparison.TemporalSigmaRatio(), gate.most_temporal);
  EXPECT_GT(comparison.HoleRatio(), gate.least_holes);
  EXPECT_LT(comparison.HoleRatio(), gate.most_holes);
  EXPECT_LE(comparison.gaps.num_in_dead, gate.most_in_dead);
}

constexpr double kUnmeasured = std::numeric_limits<double>::quiet_NaN();
constexpr double kMayBeNone = -1.0;

INSTANTIATE_TEST_SUITE_P(
    Captures,
    RealPreset,
    testing::Values(
        Gate{"vlp16", "vlp16_dual", Sectors::kEven, kUnmeasured, 0.9, 1.1, 0.7, 1.4},
        Gate{"vlp16", "vlp16_dual", Sectors::kOdd, kGoalOfIntensity, 0.9, 1.1, 0.7, 1.4},
        Gate{"vlp32c", "vlp32c_single", Sectors::kEven, kGoalOfIntensity, 0.8, 1.3, 0.7, 1.4},
        Gate{"vlp32c", "vlp32c_single", Sectors::kOdd, kUnmeasured, 0.8, 1.3, 0.7, 2.0},
        Gate{"pandar64", "pandar64", Sectors::kEven, 0.12, 0.9, 1.1, 0.7, 1.4},
        Gate{"pandar64", "pandar64", Sectors::kOdd, kUnmeasured, 0.9, 1.1, 0.7, 3.5},
        Gate{"vls128", "vls128_single", Sectors::kEven, 0.19, 0.9, 1.1, 0.7, 1.5},
        Gate{"vls128", "vls128_single", Sectors::kOdd, 0.18, 0.9, 1.1, 0.7, 1.7},
        Gate{"xt32", "", Sectors::kEven, 0.21, 0.85, 1.05, kMayBeNone, 1.0},
        Gate{"xt32", "", Sectors::kOdd, kUnmeasured, 0.85, 1.05, kMayBeNone, 1.0},
        // 16 of 8343 pairs are one echo, reported twice.
        Gate{"qt128", "", Sectors::kEven, kUnmeasured, 0.85, 1.05, kMayBeNone, 1.0, 16},
        Gate{"qt128", "", Sectors::kOdd, kUnmeasured, 0.85, 1.05, kMayBeNone, 1.0, 16}),
    [](const auto& test) {
      return test.param.sensor + (test.param.sectors == Sectors::kEven ? "_even" : "_odd");
    });

}  // namespace
}  // namespace railcast
