#include "analysis/extras/preset/preset_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"
#include "tests/analysis/extras/preset/yard.h"
#include "tests/analysis/held_recording.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

using testing::HasSubstr;

// Compares a simulated sensor before known planes with replays of itself, exact and changed.

PresetComparison CompareYard(const ScenarioSpec& recorded, const ScenarioSpec& replayed) {
  HeldRecording recording(RecordYard(recorded));
  return ComparePreset(recording, replayed);
}

TEST(SeenPlanes, AreTheFloorAndTheWall) {
  const auto frames = RecordYard(PresetScenario("vlp16"));
  const auto scan = MakeScanTable(frames[0].frame);
  ASSERT_TRUE(scan);
  const SeenPlanes seen = FindSeenPlanes(frames[0].frame, *scan);
  ASSERT_GE(seen.planes.size(), 2U);
  bool has_floor = false;
  bool has_wall = false;
  for (const SeenPlane& plane : seen.planes) {
    // Far from all, since other planes are pieces of the same faces.
    const double apart_m = std::abs(plane.normal.dot(plane.middle_m));
    constexpr double kSigmas_m = 0.01;  // Noise and bias of channels are below.
    const bool is_floor = plane.is_ground() && std::abs(apart_m - kHeight_m) < kSigmas_m;
    const bool is_wall = std::abs(plane.normal.x()) > 0.999 &&
                         std::abs(apart_m - static_cast<double>(kWall_m)) < kSigmas_m;
    // Level planes through the rings on the wall are no surfaces.
    EXPECT_TRUE(is_floor || is_wall) << plane.normal.transpose() << ", " << apart_m << " m";
    has_floor = has_floor || is_floor;
    has_wall = has_wall || is_wall;
  }
  EXPECT_TRUE(has_floor);
  EXPECT_TRUE(has_wall);
}

// Each ring of such a hedge lies on a level plane, but the surface about its points does not.
TEST(SeenPlanes, AreNotFoundInAHedgeAllAround) {
  RecordedFrame hedge = RecordYard(PresetScenario("vlp16"))[0];
  const auto scan = MakeScanTable(hedge.frame);
  ASSERT_TRUE(scan);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> depth_m(10.0, 12.0);
  for (std::size_t row = 0; row < hedge.frame.rows; ++row) {
    for (std::size_t column = 0; column < hedge.frame.columns; ++column) {
      const std::size_t slot = row * hedge.frame.width() + column * hedge.frame.returns;
      const auto [x, y, z] = scan->Direction(row, column);
      const double range_m = depth_m(random);
      hedge.frame.range_m[slot] = static_cast<float>(range_m);
      hedge.frame.x[slot] = static_cast<float>(range_m * x);
      hedge.frame.y[slot] = static_cast<float>(range_m * y);
      hedge.frame.z[slot] = static_cast<float>(range_m * z);
    }
  }
  EXPECT_TRUE(FindSeenPlanes(hedge.frame, *scan).planes.empty());
}

TEST(SeenPlanes, OfEvenAndOddSectorsShareNoFiring) {
  const auto frames = RecordYard(PresetScenario("vlp16"));
  const auto scan = MakeScanTable(frames[0].frame);
  ASSERT_TRUE(scan);
  const SeenPlanes even = FindSeenPlanes(frames[0].frame, *scan, Sectors::kEven);
  const SeenPlanes odd = FindSeenPlanes(frames[0].frame, *scan, Sectors::kOdd);
  ASSERT_EQ(even.plane.size(), odd.plane.size());
  for (std::size_t i = 0; i < even.plane.size(); ++i) {
    ASSERT_TRUE(even.plane[i] == SeenPlanes::kNone || odd.plane[i] == SeenPlanes::kNone) << i;
  }
}

// The recording has some 45,000 firings on planes: the shares of points have a standard error of
// 0.1 %, and 2,200 holes one of 3 % on either side. A robust sigma of n differences has one of
// 1 / sqrt(2 * 0.37 n): 1.6 % in a bin of 5,000, of which the ratio is the median of a few.
constexpr double kSigmaTolerance = 4.0 * 0.016;

TEST(PresetComparison, FindsNoDifferenceBetweenASensorAndItself) {
  const PresetComparison comparison = CompareYard(LossyVlp16(), LossyVlp16());
  EXPECT_EQ(comparison.num_turns, 3U);
  EXPECT_LT(comparison.PointsError(), 0.01);
  EXPECT_LT(comparison.IntensityError(), 0.02);
  EXPECT_NEAR(comparison.TemporalSigmaRatio(), 1.0, kSigmaTolerance);
  EXPECT_NEAR(comparison.HoleRatio(), 1.0, 0.15);
}

TEST(PresetComparison, FindsTwiceTheNoiseAndHalfTheLosses) {
  ScenarioSpec recorded = LossyVlp16();
  // Without noise that depends on the signal or on the incidence, so that the factor is exact.
  recorded.lidar.receiver.range_noise_scale_m = 0.0;
  recorded.lidar.receiver.pointing_jitter_deg = 0.0;
  ScenarioSpec other = recorded;
  other.lidar.receiver.range_noise_floor_m *= 2.0;
  other.lidar.plausibility.dropout_probability *= 0.5;
  const PresetComparison comparison = CompareYard(recorded, other);
  EXPECT_NEAR(comparison.TemporalSigmaRatio(), 2.0, 2.0 * kSigmaTolerance);
  EXPECT_NEAR(comparison.HoleRatio(), 0.5, 0.08);
  // Points: 97.5 % instead of 95 %.
  EXPECT_NEAR(comparison.PointsError(), 0.975 / 0.95 - 1.0, 0.008);
}

TEST(PresetComparison, FindsFacetsThatAreTooRough) {
  ScenarioSpec other = LossyVlp16();
  for (Material& material : other.materials) {
    if (material.name == "asphalt") material.facet_slope_deg = 50.0;
  }
  const PresetComparison same = CompareYard(LossyVlp16(), LossyVlp16());
  const PresetComparison rough = CompareYard(LossyVlp16(), other);
  EXPECT_GT(rough.IntensityError(), 3.0 * same.IntensityError());
}

IntensityCell CellAt(std::size_t strip, std::size_t step, double recorded, double simulated) {
  return {
      .place = {0, strip, step}, .is_ground = true, .recorded = recorded, .simulated = simulated};
}

// Two materials side by side and a third behind them; the law is off by a tenth at one step.
TEST(LikePieces, HaveOneFactorForEachMaterial) {
  std::vector<IntensityCell> cells;
  for (std::size_t step = 0; step < 4; ++step) {
    cells.push_back(CellAt(0, step, 0.10, 0.5));
    cells.push_back(CellAt(1, step, 0.11, 0.55));
    cells.push_back(CellAt(2, step, 0.30, 0.5));
    cells.push_back(CellAt(2, 4 + step, 0.05, 0.5));
  }
  const std::vector<IntensityCell> pieces = LikePieces(cells);
  ASSERT_EQ(pieces.size(), cells.size());
  std::size_t most = 0;
  for (const IntensityCell& cell : pieces) {
    EXPECT_NEAR(cell.simulated, cell.recorded, 1e-12);
    most = std::max(most, cell.piece);
  }
  EXPECT_EQ(most, 2U);
  // Cut less finely, they are one piece, in which no factor fits.
  EXPECT_EQ(LikePieces(cells, 10.0).back().piece, 0U);
}

TEST(MeansOfSteps, EvenOutWhatLiesSideBySide) {
  std::vector<IntensityCell> pieces{CellAt(0, 0, 0.1, 0.1), CellAt(1, 0, 0.2, 0.1),
                                    CellAt(0, 1, 0.3, 0.4), CellAt(0, 0, 0.5, 0.6)};
  pieces.back().piece = 1;
  const std::vector<IntensityCell> means = MeansOfSteps(pieces);
  ASSERT_EQ(means.size(), 3U);
  EXPECT_NEAR(means[0].recorded, 0.15, 1e-12);
  EXPECT_NEAR(means[0].simulated, 0.1, 1e-12);
  EXPECT_EQ(means[1].recorded, 0.3);
  EXPECT_EQ(means[2].simulated, 0.6);
}

TEST(LikePieces, ThatAreShortAreLeftOut) {
  EXPECT_TRUE(LikePieces({CellAt(0, 0, 0.1, 0.1), CellAt(0, 1, 0.1, 0.1)}).empty());
}

// Every third of the neighbours is of another material.
TEST(RangeExponentLeft, IsThatOfMostNeighbours) {
  std::vector<IntensityCell> cells;
  for (std::size_t strip = 0; strip < 20; ++strip) {
    for (std::size_t step = 0; step < 7; ++step) {
      const double range_m = std::exp2(0.25 * static_cast<double>(step));
      const double material = step < 3 ? 0.1 : step < 6 ? 0.03 : 0.2;
      cells.push_back(CellAt(strip, step, material * std::pow(range_m, -0.7), 0.5 / range_m));
      cells.back().range_m = range_m;
    }
  }
  const Estimate left = RangeExponentLeft(cells);
  EXPECT_NEAR(left.value, 0.3, 1e-9);
  EXPECT_EQ(left.num, 120U);
  EXPECT_FALSE(RangeExponentLeft({cells[0], cells[1]}).is_enough());
}

TEST(CellPoints, HaveAMeanWithoutTheirEnds) {
  CellPoints points;
  points.intensities = {0.9F, 0.1F, 0.2F, 0.2F, 0.0F};
  EXPECT_NEAR(points.MiddleIntensity(), 0.5 / 3.0, 1e-6);
}

TEST(PresetComparison, RefusesASensorOfOtherRings) {
  HeldRecording recording(RecordYard(LossyVlp16()));
  EXPECT_EQ(MessageOf([&] { (void)ComparePreset(recording, PresetScenario("vlp32c")); }),
            ": must have the 32 rings of the scenario's sensor (got 16)");
}

TEST(PresetComparison, RefusesARecordingWithoutPlanes) {
  std::vector<RecordedFrame> frames = RecordYard(LossyVlp16());
  for (RecordedFrame& recorded : frames) recorded.is_grid = false;
  HeldRecording recording(std::move(frames));
  EXPECT_EQ(MessageOf([&] { (void)ComparePreset(recording, LossyVlp16()); }),
            ": must hold a whole turn in which planes are seen (got none)");
}

TEST(PresetComparison, RefusesARecordingWithoutIntensities) {
  std::vector<RecordedFrame> frames = RecordYard(LossyVlp16());
  for (RecordedFrame& recorded : frames) {
    std::ranges::fill(recorded.frame.intensity, std::nanf(""));
  }
  HeldRecording recording(std::move(frames));
  EXPECT_EQ(MessageOf([&] { (void)ComparePreset(recording, LossyVlp16()); }),
            ": must have intensities from 0 to 1 on its planes (got none)");
}

/// Writes a scenario with one of the shipped sensors.
std::string WriteSensorScenario(const TemporaryFolder& folder, const std::string& sensor) {
  const std::string scenarios = ScenariosDir().string();
  return folder
      .Write("sensor.json", R"({"version": 1, "file": ")" + scenarios +
                                R"(/minimal.json", "fidelity": "surface", "lidar": {"file": ")" +
                                scenarios + "/sensors/" + sensor + R"(.json"}})")
      .string();
}

const std::string kVlp16Capture = RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/vlp16_dual.pcap";

TEST(PresetCommand, WritesAReportOfACapture) {
  if (!std::filesystem::exists(kVlp16Capture)) GTEST_SKIP() << kVlp16Capture << " is not there";
  const TemporaryFolder folder;
  const std::string scenario = WriteSensorScenario(folder, "vlp16");
  const auto out = std::filesystem::path(scenario).parent_path() / "out";
  const Ended run = Analyze("preset " + kVlp16Capture + " --scenario " + scenario +
                            " --sectors odd --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  const nlohmann::json report = nlohmann::json::parse(ReadFileWhole(out / "preset.json"));
  EXPECT_EQ(report.at("facts").at("Recording"), "capture of VLP-16");
  EXPECT_EQ(report.at("facts").at("Turns"), "4");
  EXPECT_EQ(report.at("headlines").size(), 9U);
  EXPECT_TRUE(exists(out / "report.html"));
  EXPECT_TRUE(exists(out / "csv" / "preset_by_range.csv"));
}

TEST(PresetCommand, GivesTheSameReportOnAnyNumberOfThreads) {
  if (!std::filesystem::exists(kVlp16Capture)) GTEST_SKIP() << kVlp16Capture << " is not there";
  const TemporaryFolder folder;
  const std::string scenario = WriteSensorScenario(folder, "vlp16");
  const auto text = [&](const std::string& threads) {
    const std::string said = Analyze("preset " + kVlp16Capture + " --scenario " + scenario +
                                     " --format text --threads " + threads)
                                 .said;
    // The command line, which names the number of threads, stands in the first lines.
    return said.substr(said.find("Error of points"));
  };
  EXPECT_EQ(text("1"), text("3"));
}

TEST(PresetCommand, RefusesASensorThatDoesNotFit) {
  if (!std::filesystem::exists(kVlp16Capture)) GTEST_SKIP() << kVlp16Capture << " is not there";
  const TemporaryFolder folder;
  const Ended run = Analyze("preset " + kVlp16Capture + " --scenario " +
                            WriteSensorScenario(folder, "vls128") + " --format text");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, HasSubstr("must have the 128 rings of the scenario's sensor (got 16)"));
}

}  // namespace
}  // namespace railcast
