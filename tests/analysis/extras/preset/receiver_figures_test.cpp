#include "analysis/extras/preset/receiver_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "analysis/extras/preset/preset_comparison.h"
#include "core/base/units.h"
#include "tests/analysis/extras/preset/yard.h"

namespace railcast {
namespace {

/// What a made recording shows.
struct Truth {
  double noise{}, gain{}, texture{}, range_noise_m{};
  double base{}, near_last_m{};  ///< Firings lost at edges; none more with the near side first.
  double speed_m{};              ///< Ahead, a turn.
  double gain_by_range{};
  std::size_t rows = 40;
};

constexpr std::size_t kColumns = 1800;
constexpr std::size_t kPanel = 30;  // Columns.

// A round wall at 10 m, before which every other stretch of 30 firings meets a panel, at 3 m in the
// lower rings and at 6 m in the upper ones.
std::vector<RecordedFrame> MakeTurns(const Truth& truth, std::size_t num_turns = 4) {
  constexpr double kStep_rad = 2.0 * 3.14159265358979 / static_cast<double>(kColumns);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> even;
  std::vector<double> gain(truth.rows), texture(truth.rows * kColumns);
  for (double& value : gain) value = truth.gain * normal(random);
  for (double& value : texture) value = truth.texture * normal(random);
  std::mt19937 random_by_range(7);
  std::vector<std::array<double, 3>> waves(truth.rows);  // As core/detect/kernels/measurement.h.
  for (auto& wave : waves) {
    for (double& number : wave) number = normal(random_by_range);
  }
  const auto gain_by_range = [&](std::size_t row, double range_m) {
    const auto& [b, c, d] = waves[row];
    const double turn_rad = d * std::log(range_m) / kGainLogRange;
    return truth.gain_by_range * (b * std::cos(turn_rad) + c * std::sin(turn_rad));
  };
  std::vector<RecordedFrame> turns(num_turns);
  for (std::size_t turn = 0; turn < num_turns; ++turn) {
    Frame& frame = turns[turn].frame;
    frame.Resize(static_cast<std::uint32_t>(truth.rows), kColumns, 1);
    turns[turn].is_grid = true;
    turns[turn].fields = {"x", "y", "z", "intensity", "range_m", "ring", "column"};
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      const std::size_t row = slot / kColumns;
      const std::size_t column = slot % kColumns;
      const double azimuth_rad = -kStep_rad * static_cast<double>(column);
      const double elevation_rad =
          RadFromDeg(20.0 * static_cast<double>(row) / static_cast<double>(truth.rows) - 10.0);
      const double near_m = row < truth.rows / 2 ? 3.0 : 6.0;
      const bool is_near = column / kPanel % 2 == 1;
      const bool is_before = column % kPanel == kPanel - 1;  // The last firing before an edge.
      const double lost =
          truth.base + (is_near ? 0.0 : truth.near_last_m) * (1.0 / near_m - 0.1) / kStep_rad;
      const double range_m = (is_near ? near_m : 10.0) + truth.range_noise_m * normal(random) -
                             truth.speed_m * static_cast<double>(turn) * std::cos(azimuth_rad);
      const bool is_lost = is_before && even(random) < lost;
      frame.range_m[slot] = is_lost ? NAN : static_cast<float>(range_m);
      frame.x[slot] =
          frame.range_m[slot] * static_cast<float>(std::cos(elevation_rad) * std::cos(azimuth_rad));
      frame.y[slot] =
          frame.range_m[slot] * static_cast<float>(std::cos(elevation_rad) * std::sin(azimuth_rad));
      frame.z[slot] = frame.range_m[slot] * static_cast<float>(std::sin(elevation_rad));
      frame.intensity[slot] = static_cast<float>(
          0.18 * std::exp(gain[row] + gain_by_range(row, is_near ? near_m : 10.0) + texture[slot] +
                          truth.noise * normal(random)));
    }
  }
  return turns;
}

// At four standard errors of normal samples, but for the gain: 38 channels, of which each figure
// takes three.
TEST(ReceiverFigures, AreThoseOfAMadeRecording) {
  const Truth truth{.noise = 0.09,
                    .gain = 0.14,
                    .texture = 0.05,
                    .range_noise_m = 0.007,
                    .base = 0.1,
                    .near_last_m = 0.01};
  const ReceiverFigures figures = FindReceiverFigures(MakeTurns(truth));
  EXPECT_FALSE(figures.has_moved);
  EXPECT_NEAR(figures.intensity_noise.robust.value, truth.noise, 0.003);
  EXPECT_NEAR(figures.intensity_noise.rms.value, truth.noise, 0.003);
  EXPECT_NEAR(figures.range_noise_m.robust.value, truth.range_noise_m, 2e-4);
  EXPECT_NEAR(figures.channel_gain.value, truth.gain, 4.0 * truth.gain / std::sqrt(2.0 * 38.0));
  for (const TwoDeviations& texture : figures.texture) {
    EXPECT_NEAR(texture.robust.value, truth.texture, 0.005);
    EXPECT_NEAR(texture.rms.value, truth.texture, 0.005);
  }
  // 40 rings with 60 edges in 4 turns, of which a quarter each loses 0.1, 0.1, 0.77 and 0.29.
  EXPECT_NEAR(figures.jumps.share.value, 0.315, 4.0 * 0.4 / std::sqrt(9600.0));
  EXPECT_NEAR(figures.jumps.base.value, truth.base, 0.03);
  EXPECT_NEAR(figures.jumps.common_m.value, 0.0, 0.001);
  EXPECT_NEAR(figures.jumps.aside_m.value, truth.near_last_m, 0.001);
  for (const Estimate& estimate : {figures.intensity_noise.rms, figures.jumps.base,
                                   figures.jumps.aside_m, figures.channel_gain}) {
    EXPECT_LT(estimate.low, estimate.value);
    EXPECT_GT(estimate.high, estimate.value);
  }
}

// Intensities and ranges as sensors store them. Where a step is no smaller than what is measured,
// it is not what is measured, and the interval holds the truth.
TEST(ReceiverFigures, SeeThroughSteps) {
  const Truth truth{.noise = 0.03, .texture = 0.1, .range_noise_m = 0.002};
  for (const double steps : {0.1, 0.3, 0.7, 1.0, 1.5, 2.5, 5.0}) {
    SCOPED_TRACE(steps);
    std::vector<RecordedFrame> turns = MakeTurns(truth);
    const auto round = [](float& value, double step) {
      value = static_cast<float>(step * std::round(static_cast<double>(value) / step));
    };
    for (RecordedFrame& turn : turns) {
      for (float& range_m : turn.frame.range_m) round(range_m, steps * truth.range_noise_m);
      for (float& of : turn.frame.intensity) round(of, steps * truth.noise * 0.18);
    }
    const ReceiverFigures figures = FindReceiverFigures(turns);
    // All intensities of a step of 5 deviations are in one place of it, which hides most.
    if (steps < 5.0) {
      EXPECT_NEAR(figures.intensity_noise.robust.value, truth.noise, 0.1 * truth.noise);
    }
    EXPECT_LE(figures.intensity_noise.robust.low, 1.01 * truth.noise);
    EXPECT_GE(figures.intensity_noise.robust.high, 0.99 * truth.noise);
    // All ranges are in the middle between two steps, or beside it.
    EXPECT_LE(figures.range_noise_m.robust.low, 1.01 * truth.range_noise_m);
    EXPECT_GE(figures.range_noise_m.robust.high, 0.99 * truth.range_noise_m);
  }
}

// At four standard errors of the variance of 198 channels.
TEST(ReceiverFigures, TellGainsByRangeFromThoseAtAllRanges) {
  constexpr std::size_t kChannels = 198;
  struct Parts {
    double at_all_ranges, by_range;
  };
  for (const Parts parts : {Parts{0.2, 0.0}, Parts{0.0, 0.2}, Parts{0.12, 0.18}}) {
    const ReceiverFigures figures = FindReceiverFigures(MakeTurns({.noise = 0.05,
                                                                   .gain = parts.at_all_ranges,
                                                                   .gain_by_range = parts.by_range,
                                                                   .rows = kChannels + 2},
                                                                  1));
    const double all = std::pow(parts.at_all_ranges, 2) + std::pow(parts.by_range, 2);
    const double most_off = 4.0 * all * std::sqrt(2.0 / static_cast<double>(kChannels));
    const auto variance = [](const Estimate& part) { return part.value * std::abs(part.value); };
    EXPECT_NEAR(variance(figures.gain_at_all_ranges), std::pow(parts.at_all_ranges, 2), most_off);
    EXPECT_NEAR(variance(figures.gain_by_range), std::pow(parts.by_range, 2), most_off);
    EXPECT_EQ(figures.gain_by_range.low > 0.0, parts.by_range > 0.0);
  }
}

TEST(ReceiverFigures, DoNotTellNoiseOfASensorThatMoves) {
  const ReceiverFigures figures = FindReceiverFigures(
      MakeTurns({.noise = 0.09, .texture = 0.05, .range_noise_m = 0.007, .speed_m = 0.03}));
  EXPECT_TRUE(figures.has_moved);
  EXPECT_FALSE(figures.intensity_noise.rms.is_enough());
  EXPECT_NEAR(figures.texture[1].rms.value, std::hypot(0.09, 0.05), 0.005);
}

TEST(ReceiverFigures, OfOneTurnAndOfNoEdgesAreNotEnough) {
  std::vector<RecordedFrame> turns = MakeTurns({.range_noise_m = 0.007}, 1);
  for (std::size_t slot = 0; slot < turns[0].frame.num_slots(); ++slot) {
    if (turns[0].frame.range_m[slot] < 8.0F) turns[0].frame.range_m[slot] = NAN;
  }
  const ReceiverFigures figures = FindReceiverFigures(turns);
  EXPECT_FALSE(figures.range_noise_m.robust.is_enough());
  EXPECT_FALSE(figures.jumps.share.is_enough());
  EXPECT_FALSE(figures.jumps.base.is_enough());
  EXPECT_TRUE(figures.texture[1].robust.is_enough());
}

std::string Text(const Estimate& estimate, double scale, const char* format = "%.1f") {
  if (!estimate.is_enough()) return "–";
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), format, scale * estimate.value);
  return text.data();
}

std::string WithEnds(const Estimate& estimate) {
  if (!estimate.is_enough()) return "–";
  std::array<char, 60> text{};
  std::snprintf(text.data(), text.size(), "%.1f [%.1f, %.1f]", 1e3 * estimate.value,
                1e3 * estimate.low, 1e3 * estimate.high);
  return text.data();
}

std::string RowOf(const std::string& sensor, const ReceiverFigures& figures) {
  const auto both = [&](const TwoDeviations& of, double scale) {
    if (figures.has_moved) return std::string("moving");
    if (!of.rms.is_enough()) return std::string("–");
    return Text(of.robust, scale) + " (" + Text(of.rms, scale) + ")";
  };
  std::string row = "| " + sensor + " | " + both(figures.intensity_noise, 100.0) + " | " +
                    Text(figures.channel_gain, 100.0) + " | ";
  for (const TwoDeviations& texture : figures.texture) {
    row +=
        Text(texture.robust, 1.0, "%.2f") + (&texture == &figures.texture.back() ? " | " : " / ");
  }
  for (const TwoDeviations& texture : figures.texture) {
    row += Text(texture.rms, 1.0, "%.2f") + (&texture == &figures.texture.back() ? " | " : " / ");
  }
  return row + Text(figures.jumps.share, 100.0) + " | " + Text(figures.jumps.base, 1.0, "%.2f") +
         " | " + WithEnds(figures.jumps.common_m) + " | " + WithEnds(figures.jumps.aside_m) +
         " | " + Text(figures.holes, 100.0, "%.2f") + " | " + both(figures.range_noise_m, 1e3) +
         " |";
}

std::string RowOfGains(const std::string& sensor, const ReceiverFigures& figures) {
  std::string row = "| " + sensor;
  for (const Estimate& part : {figures.gain_at_all_ranges, figures.gain_by_range}) {
    row += " | " + Text(part, 100.0);
    if (part.is_enough()) {
      row +=
          " [" + Text({part.low, 0, 0, 1}, 100.0) + ", " + Text({part.high, 0, 0, 1}, 100.0) + "]";
    }
  }
  return row + " | " + std::to_string(figures.gain_by_range.num) + " |";
}

// A preset has what was measured to the interval, and nothing where this holds 0.
void ExpectMeasured(double preset, const Estimate& measured) {
  if (measured.low <= 0.0) {
    EXPECT_EQ(preset, 0.0);
    return;
  }
  EXPECT_GE(preset, measured.low);
  EXPECT_LE(preset, measured.high);
}

// The tables of docs/results/validation.md.
TEST(RealReceivers, ShowWhatThePageSays) {
  const std::string shared = RAILCAST_SHARED_DATA_DIR;
  const std::string nebula = shared + "/lidar_packets_nebula/";
  struct Recording {
    std::string sensor, path;
    std::string preset{};  ///< With measured intensities; empty if there is none.
  };
  const std::vector<Recording> recordings = {
      {"VLS-128", nebula + "vls128_single.pcap", "vls128"},
      {"VLP-16", nebula + "vlp16_dual.pcap", "vlp16"},
      {"VLP-32C", nebula + "vlp32c_single.pcap", "vlp32c"},
      {"Pandar64", nebula + "pandar64.pcap", "pandar64"},
      {"Pandar40P", shared + "/lidar_hesai_more/40p.db3", "pandar40p"},
      {"XT32", shared + "/lidar_hesai/captures/xt32.db3", "xt32"},
      {"QT128", shared + "/lidar_hesai/captures/qt128.db3", "qt128"},
      {"QT64", shared + "/lidar_hesai_more/qt64.db3"},
      {"HDL-32E", shared + "/lidar_velodyne_more/hdl32e.pcap"},
      {"OS1-128", shared + "/lidar_ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap"},
      {"OS2-128", shared + "/lidar_ouster/OS-2-128-U1_v2.3.0_1024x10.pcap"}};
  std::ifstream file(RAILCAST_SOURCE_DIR "/docs/results/validation.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  std::size_t num = 0;
  for (const auto& [sensor, path, preset] : recordings) {
    if (!std::filesystem::exists(path)) continue;
    ++num;
    SCOPED_TRACE(sensor);
    const ReceiverFigures figures = FindReceiverFigures(WholeTurns(*OpenRecording(path)));
    for (const std::string& row : {RowOf(sensor, figures), RowOfGains(sensor, figures)}) {
      std::puts(row.c_str());
      EXPECT_TRUE(page.find(row) != std::string::npos) << row;
    }
    if (preset.empty()) continue;
    const ReceiverSpec receiver = PresetScenario(preset).lidar.receiver;
    ExpectMeasured(receiver.intensity_noise, figures.intensity_noise.robust);
    ExpectMeasured(receiver.channel_gain_variation, figures.gain_by_range);
    ExpectMeasured(receiver.channel_gain, receiver.channel_gain_variation > 0.0
                                              ? figures.gain_at_all_ranges
                                              : figures.channel_gain);
  }
  ScenarioSpec scenario = PresetScenario("vls128");
  for (Material& material : scenario.materials) material.reflectivity = 0.45;
  const std::string ours = RowOf("ours, a yard", FindReceiverFigures(RecordYard(scenario)));
  std::puts(ours.c_str());
  EXPECT_TRUE(page.find(ours) != std::string::npos) << ours;
  if (num == 0) GTEST_SKIP() << "no captures in " << shared;
}

}  // namespace
}  // namespace railcast
