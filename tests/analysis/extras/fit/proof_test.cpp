// Checks that a fit is judged as the replays of `preset` judge it.
#include "analysis/extras/fit/proof.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "analysis/extras/fit/fit_report.h"
#include "tests/analysis/extras/preset/yard.h"

namespace railcast {
namespace {

FittedParameter ParameterOf(const std::string& place, double value) {
  return {place, place, "", {value, value, value, 1000}, ""};
}

constexpr const char* kFloor = "lidar/receiver/range_noise_floor_m";
constexpr const char* kJitter = "lidar/receiver/pointing_jitter_deg";
constexpr const char* kDropout = "lidar/plausibility/dropout_probability";

// The tolerances are those of preset_comparison_test.cpp, of half the points.
constexpr double kNoiseTolerance = 4.0 * 0.023;
constexpr double kHoleTolerance = 0.2;

TEST(FitProof, TakesWhatBringsTheReplayNearerToTheRecording) {
  ScenarioSpec recorded = LossyVlp16();
  recorded.lidar.receiver.range_noise_floor_m *= 2.0;
  const FitProof proof(RecordYard(recorded), "yard");
  FitResult result;
  result.parameters = {ParameterOf(kFloor, recorded.lidar.receiver.range_noise_floor_m),
                       ParameterOf(kDropout, 0.05)};
  const ScenarioSpec preset = PresetScenario("vlp16");
  proof.Judge(preset, result);
  for (const FittedParameter& parameter : result.parameters) {
    EXPECT_EQ(parameter.proof.verdict, ReplayVerdict::kBetter) << parameter.place;
    EXPECT_LT(parameter.proof.before, 0.7) << parameter.place;
  }
  EXPECT_EQ(result.parameters[0].proof.figure, "noise from turn to turn");
  EXPECT_NEAR(result.parameters[0].proof.after, 1.0, kNoiseTolerance);
  EXPECT_EQ(result.parameters[1].proof.figure, "holes");
  EXPECT_NEAR(result.parameters[1].proof.after, 1.0, kHoleTolerance);
  const ScenarioSpec fitted = FittedScenario(preset, result);
  EXPECT_EQ(fitted.lidar.plausibility.dropout_probability, 0.05);
}

TEST(FitProof, TakesOutWhatIsWorse) {
  const ScenarioSpec preset = LossyVlp16();
  const FitProof proof(RecordYard(preset), "yard");
  FitResult result;
  result.parameters = {ParameterOf(kJitter, 0.3), ParameterOf(kDropout, 0.1)};
  proof.Judge(preset, result);
  for (const FittedParameter& parameter : result.parameters) {
    EXPECT_EQ(parameter.proof.verdict, ReplayVerdict::kWorse) << parameter.place;
    EXPECT_GT(parameter.proof.after, 1.5) << parameter.place;
  }
  const ScenarioSpec fitted = FittedScenario(preset, result);
  EXPECT_EQ(ResolvedScenarioJson(fitted), ResolvedScenarioJson(preset));
  EXPECT_EQ(FittedJson(fitted, result), "{\n  \"version\": 1\n}\n");
}

TEST(FitProof, DoesNotTellWhatMakesNoDifference) {
  const ScenarioSpec preset = LossyVlp16();
  const FitProof proof(RecordYard(preset), "yard");
  FitResult result;
  result.parameters = {ParameterOf(kFloor, preset.lidar.receiver.range_noise_floor_m)};
  proof.Judge(preset, result);
  EXPECT_EQ(result.parameters[0].proof.verdict, ReplayVerdict::kNotTold);
  EXPECT_TRUE(result.parameters[0].is_written());
}

TEST(FitProof, CountsTheLossesThatPlanesShow) {
  const FitProof proof(RecordYard(LossyVlp16()), "yard");
  double num = 0.0, num_lost = 0.0;
  for (const auto& [metre, bin] : proof.Losses()) {
    num += static_cast<double>(bin.num);
    num_lost += static_cast<double>(bin.num_lost);
  }
  EXPECT_GT(num, 20'000.0);
  // Four standard errors, and what the preset loses besides.
  EXPECT_NEAR(num_lost / num, 0.05, 4.0 * std::sqrt(0.05 / num) + 0.003);
}

TEST(FittedJson, HoldsWholeObjectsSinceScenariosReplaceThemAsWholes) {
  const ScenarioSpec preset = PresetScenario("xt32");
  FitResult result;
  result.parameters = {ParameterOf(kFloor, 0.0123)};
  const std::string json = FittedJson(FittedScenario(preset, result), result);
  EXPECT_NE(json.find("\"range_noise_floor_m\": 0.0123"), std::string::npos) << json;
  EXPECT_NE(json.find("\"range_at_10_percent_m\": 80.0"), std::string::npos) << json;
  EXPECT_NE(json.find("\"dead_time_ns\": 2.6"), std::string::npos) << json;
}

// Sets the ranges of turns' points back or forth, each slot's by as much in every turn.
void Move(const std::vector<float>& bumps_m, std::vector<RecordedFrame>& turns) {
  for (RecordedFrame& turn : turns) {
    Frame& frame = turn.frame;
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      const float factor = 1.0F + bumps_m[slot] / frame.range_m[slot];
      frame.x[slot] *= factor;
      frame.y[slot] *= factor;
      frame.z[slot] *= factor;
      frame.range_m[slot] += bumps_m[slot];
    }
  }
}

// The floor of a fit to three turns of surfaces on which firings meet bumps of 3 cm.
// @param wave_columns The length of the bumps along a ring; 0 = each firing has its own.
double FloorOf_m(bool has_next, double wave_columns = 0.0) {
  ScenarioSpec scenario = PresetScenario("vlp16");
  scenario.lidar.receiver.range_noise_floor_m = 0.01;
  scenario.lidar.receiver.pointing_jitter_deg = 0.0;
  std::vector<RecordedFrame> turns = RecordYard(scenario);
  std::mt19937_64 random(1);
  std::normal_distribution<float> bump_m(0.0F, 0.03F);
  std::vector<float> bumps_m(turns.front().frame.num_slots());
  for (float& each_m : bumps_m) each_m = bump_m(random);
  const Frame& first = turns.front().frame;
  for (std::size_t slot = 0; wave_columns > 0.0 && slot < bumps_m.size(); ++slot) {
    const double column = static_cast<double>(slot % first.width() / first.returns);
    const double row = static_cast<double>(slot / first.width());
    bumps_m[slot] = static_cast<float>(
        0.042 * std::sin(2.0 * std::numbers::pi * (column / wave_columns + 0.37 * row)));
  }
  Move(bumps_m, turns);
  RecordedTrials trials;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const bool is_followed = has_next && i + 1 < turns.size();
    trials.Add(TakeTrials(turns[i], is_followed ? &turns[i + 1] : nullptr));
  }
  FitSettings settings;
  settings.is_physical = true;
  const FitResult result = FitModel(trials, settings);
  const NoiseFrom alone = wave_columns > 0.0 ? NoiseFrom::kNeighbours : NoiseFrom::kPieces;
  EXPECT_EQ(result.noise_from, has_next ? NoiseFrom::kTurns : alone);
  return result.parameters[1].estimate.value;
}

TEST(Fit, TakesNoRoughnessForNoiseWhereTheSensorStood) {
  // What the signal adds to the floor is below 3 mm here.
  EXPECT_NEAR(FloorOf_m(true), 0.01, 0.002);
  EXPECT_GT(FloorOf_m(false), 0.025);
  // Waves of 42 mm, 40 columns long, bend by 0.4 mm in three firings.
  EXPECT_NEAR(FloorOf_m(false, 40.0), 0.01, 0.002);
}

// At four standard errors. Textures finer than columns would add to the noise.
TEST(Fit, FindsNoiseAndGainOfTheIntensities) {
  ScenarioSpec scenario = PresetScenario("vls128");
  for (Material& material : scenario.materials) {
    material.reflectivity = 0.45;
    material.texture = 0.0;
  }
  // The yard's channels see too few ranges to tell gains by range.
  scenario.lidar.receiver.channel_gain = 0.14;
  scenario.lidar.receiver.channel_gain_variation = 0.0;
  const std::vector<RecordedFrame> turns = RecordYard(scenario);
  const ReceiverFigures figures = FindReceiverFigures(turns);
  FitResult result;
  AddIntensities(figures, result);
  ScenarioSpec plain = scenario;
  plain.lidar.receiver.intensity_noise = plain.lidar.receiver.channel_gain = 0.0;
  plain.lidar.receiver.channel_gain_variation = 0.19;
  FitProof({turns.front()}, "yard").Judge(plain, result);
  ASSERT_EQ(result.parameters.size(), 3U);
  EXPECT_FALSE(result.parameters.back().is_written());
  result.parameters.pop_back();
  for (const FittedParameter& parameter : result.parameters) {
    const Estimate& estimate = parameter.estimate;
    ASSERT_TRUE(parameter.is_written()) << parameter.remark;
    EXPECT_EQ(parameter.proof.verdict, ReplayVerdict::kNotTold);
    EXPECT_NEAR(estimate.value, ScenarioValue(scenario, parameter.place),
                estimate.high - estimate.low);
    EXPECT_NEAR(ScenarioValue(FittedScenario(plain, result), parameter.place), estimate.value,
                1e-5);
  }
  // Else gains would be there twice.
  EXPECT_EQ(FittedScenario(plain, result).lidar.receiver.channel_gain_variation, 0.0);
}

TEST(Fit, GivesNoValueForIntensitiesThatAreNotTold) {
  ReceiverFigures figures;
  figures.has_moved = true;
  figures.channel_gain = {0.05, -0.02, 0.12, 20};
  FitResult result;
  AddIntensities(figures, result);
  EXPECT_EQ(result.parameters[0].remark, "not identified: the sensor moved");
  EXPECT_EQ(result.parameters[1].remark, "not identified: its interval holds 0");
  for (const FittedParameter& parameter : result.parameters) EXPECT_FALSE(parameter.is_written());
}

struct RealSensor {
  std::string name;
  std::string file;
};

std::ostream& operator<<(std::ostream& out, const RealSensor& sensor) {
  return out << sensor.name;
}

class RealFit : public testing::TestWithParam<RealSensor> {};

TEST_P(RealFit, IsNotFartherFromTheRecordingThanThePreset) {
  const auto file = std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / GetParam().file;
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const ScenarioSpec preset = PresetScenario(GetParam().name);
  const auto turns = WholeTurns(*OpenRecording(file));
  const FitProof proof(turns, GetParam().name);
  ASSERT_TRUE(proof.has_planes());
  RecordedTrials trials = ReadTrials({file}, [](std::uint64_t) {});
  trials.losses = proof.Losses();
  FitSettings settings;
  settings.is_physical = true;
  settings.range_at_10_percent_m = preset.lidar.receiver.range_at_10_percent_m;
  settings.snr_at_threshold = preset.lidar.receiver.snr_at_threshold;
  FitResult result = FitModel(trials, settings);
  proof.Judge(preset, result);
  const SeenTurns seen = SeePlanesOf(turns);
  const PresetComparison before = CompareTurns(seen, preset, "");
  const PresetComparison after = CompareTurns(seen, FittedScenario(preset, result), "");
  std::cout << GetParam() << (result.noise_from == NoiseFrom::kTurns ? "" : ", about pieces")
            << ": noise " << before.TemporalSigmaRatio() << " -> " << after.TemporalSigmaRatio()
            << ", holes " << before.HoleRatio() << " -> " << after.HoleRatio() << '\n';
  for (const FittedParameter& parameter : result.parameters) {
    if (parameter.place.empty() || !parameter.estimate.is_enough()) continue;
    std::cout << "  " << parameter.place << ' ' << ScenarioValue(preset, parameter.place) << " -> "
              << parameter.estimate.value << ": " << parameter.proof.figure << ' '
              << parameter.proof.before << " -> " << parameter.proof.after << ' '
              << static_cast<int>(parameter.proof.verdict) << '\n';
  }
  // Values about which the halves do not tell may move either figure by their standard errors.
  EXPECT_LT(std::abs(std::log(after.TemporalSigmaRatio())),
            std::abs(std::log(before.TemporalSigmaRatio())) + 0.05);
  EXPECT_LT(std::abs(after.HoleRatio() - 1.0), std::abs(before.HoleRatio() - 1.0) + 0.1);
}

INSTANTIATE_TEST_SUITE_P(
    Captures,
    RealFit,
    testing::Values(RealSensor{"vlp16", "lidar_packets_nebula/vlp16_dual.pcap"},
                    RealSensor{"vlp32c", "lidar_packets_nebula/vlp32c_single.pcap"},
                    RealSensor{"pandar64", "lidar_packets_nebula/pandar64.pcap"},
                    RealSensor{"vls128", "lidar_packets_nebula/vls128_single.pcap"},
                    RealSensor{"xt32", "lidar_hesai/captures/xt32.db3"},
                    RealSensor{"qt128", "lidar_hesai/captures/qt128.db3"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace railcast
