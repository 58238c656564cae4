// Draws are keyed by (seed, use, frame, item, block). Keys that are neighbours in any part must
// give independent draws, no two keys may give the same words, and switching an effect must not
// change another's draws. A generator that all effects share in turn fails the last.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "tests/stability/regime.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr std::array kUses = {
    RandomUse::kSensorDropout,
    RandomUse::kRain,
    RandomUse::kSnow,
    RandomUse::kNoise,
    RandomUse::kDetection,
    RandomUse::kRangeNoise,
    RandomUse::kChannelBias,
    RandomUse::kPointing,
    RandomUse::kClutter,
    RandomUse::kFogEcho,
    RandomUse::kFalseAlarm,
    RandomUse::kFootprint,
    RandomUse::kCover,
    RandomUse::kInterference,
    RandomUse::kSpray,
    RandomUse::kSensorKey,
    RandomUse::kFogPatches,
    RandomUse::kRecordedDetection,
    RandomUse::kGroundRoughness,
    RandomUse::kBallastRoughness,
    RandomUse::kTreePlacement,
    RandomUse::kGrassPlacement,
    RandomUse::kPlantShape,
    RandomUse::kGusts,
    RandomUse::kTreeSway,
    RandomUse::kSpanSway,
    RandomUse::kPuddles,
    RandomUse::kRandomWeather,
};

constexpr std::uint32_t kNumDraws = 20'000;
// The correlation of n independent pairs has a standard deviation of 1 / sqrt(n), a runs statistic
// one of 1. Five of them are exceeded with a probability of 6e-7; fewer than 500 comparisons are
// made, and the seeds are fixed.
constexpr double kNumSigmas = 5.0;

using Draws = std::vector<double>;

Draws Draw(const std::function<std::uint32_t(std::uint32_t)>& word) {
  Draws draws;
  for (std::uint32_t i = 0; i < kNumDraws; ++i) draws.push_back(word(i) * 0x1p-32 - 0.5);
  return draws;
}

void ExpectUncorrelated(const Draws& a, const Draws& b, const std::string& what) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  // The variance of a draw is 1/12.
  const double correlation = 12.0 * sum / static_cast<double>(a.size());
  EXPECT_LE(std::abs(correlation), kNumSigmas / std::sqrt(static_cast<double>(a.size()))) << what;
}

// Runs above and below the median, standardised (Wald and Wolfowitz 1940).
double RunsStatistic(const Draws& draws) {
  double num_above = 0.0;
  double num_runs = 1.0;
  for (std::size_t i = 0; i < draws.size(); ++i) {
    num_above += draws[i] > 0.0 ? 1.0 : 0.0;
    if (i > 0 && (draws[i] > 0.0) != (draws[i - 1] > 0.0)) num_runs += 1.0;
  }
  const auto n = static_cast<double>(draws.size());
  const double product = 2.0 * num_above * (n - num_above);
  const double mean = product / n + 1.0;
  const double variance = product * (product - n) / (n * n * (n - 1.0));
  return (num_runs - mean) / std::sqrt(variance);
}

std::string NameOf(RandomUse use) {
  return "use " + std::to_string(static_cast<std::uint32_t>(use));
}

TEST(RandomNumbers, OfNeighbouringBeamsFramesBlocksAndWordsAreUncorrelated) {
  for (const RandomUse use : kUses) {
    const auto word = [&](std::uint32_t frame, std::uint32_t item, std::uint32_t block,
                          std::size_t k) { return RandomWords(9, use, frame, item, block)[k]; };
    const Draws beams = Draw([&](std::uint32_t i) { return word(4, i, 0, 0); });
    ExpectUncorrelated(beams, Draw([&](auto i) { return word(4, i + 1, 0, 0); }), NameOf(use));
    ExpectUncorrelated(beams, Draw([&](auto i) { return word(5, i, 0, 0); }), NameOf(use));
    ExpectUncorrelated(beams, Draw([&](auto i) { return word(4, i, 1, 0); }), NameOf(use));
    for (std::size_t k = 1; k < 4; ++k) {
      ExpectUncorrelated(beams, Draw([&](auto i) { return word(4, i, 0, k); }), NameOf(use));
    }
    ExpectUncorrelated(beams, Draw([&](auto i) { return RandomWords(10, use, 4, i, 0)[0]; }),
                       NameOf(use));
  }
}

TEST(RandomNumbers, OfDifferentEffectsInTheSameBeamAreUncorrelated) {
  std::vector<Draws> draws;
  for (const RandomUse use : kUses) {
    draws.push_back(Draw([&](std::uint32_t i) { return RandomWords(9, use, 4, i)[0]; }));
  }
  for (std::size_t a = 0; a < kUses.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      ExpectUncorrelated(draws[a], draws[b], NameOf(kUses[a]) + " and " + NameOf(kUses[b]));
    }
  }
}

TEST(RandomNumbers, HaveAsManyRunsOverBeamsAndOverFramesAsChanceHas) {
  for (const RandomUse use : kUses) {
    const Draws beams = Draw([&](std::uint32_t i) { return RandomWords(9, use, 4, i)[0]; });
    const Draws frames = Draw([&](std::uint32_t i) { return RandomWords(9, use, i, 4)[0]; });
    EXPECT_LE(std::abs(RunsStatistic(beams)), kNumSigmas) << NameOf(use);
    EXPECT_LE(std::abs(RunsStatistic(frames)), kNumSigmas) << NameOf(use);
  }
}

// A simple generator, x' = a x + c mod 2^32 seeded by the beam, fails such tests.
TEST(RandomNumbers, OfAGeneratorSeededByTheBeamAreCorrelated) {
  const Draws beams = Draw([](std::uint32_t i) { return 1664525U * i + 1013904223U; });
  EXPECT_GT(std::abs(RunsStatistic(beams)), 10.0 * kNumSigmas);
  const Draws ours = Draw([](std::uint32_t i) { return RandomWords(9, kUses[0], 0, i, 0)[0]; });
  RecordRegime("draws of neighbouring beams",
               {"a generator seeded by the beam: " + TwoDigits(std::abs(RunsStatistic(beams))) +
                    " σ from the runs of chance",
                TwoDigits(std::abs(RunsStatistic(ours))) + " σ"});
}

// Equal words of 128 bits would mean equal counters: a million of them collide by chance once in
// 1e27.
TEST(RandomNumbers, NoCounterIsUsedTwice) {
  std::vector<std::array<std::uint32_t, 4>> words;
  constexpr std::uint32_t kLast = 0xFFFFFFFFU;
  for (const RandomUse use : kUses) {
    for (const std::uint32_t block : {0U, 1U, 2U, 100U, kLast}) {
      for (const std::uint32_t frame : {0U, 1U, 2U, 3U, 16U, 100U, 4711U, kLast}) {
        for (std::uint32_t item = 0; item < 1500; ++item) {
          words.push_back(RandomWords(9, use, frame, item, block));
        }
        words.push_back(RandomWords(9, use, frame, kLast, block));
      }
    }
  }
  EXPECT_GT(words.size(), 1'000'000U);
  std::sort(words.begin(), words.end());
  EXPECT_EQ(std::adjacent_find(words.begin(), words.end()), words.end());
}

/// An effect that draws random numbers or drops beams, its switch, and the outcome that it gives to
/// the beams it affects.
struct Effect {
  const char* name;
  bool EffectSet::*is_on;
  Outcome outcome;
};
constexpr std::array kEffects = {
    Effect{"threshold", &EffectSet::threshold, Outcome::kBelowThreshold},
    Effect{"rain", &EffectSet::rain, Outcome::kRainAbsorbed},
    Effect{"snow", &EffectSet::snow, Outcome::kClutter},
    Effect{"sensor_dropout", &EffectSet::sensor_dropout, Outcome::kSensorDropout},
};

SimulatorSpec AllOn() {
  SimulatorSpec spec{.detector = {.seed = 42,
                                  .effects = {.threshold = true,
                                              .rain = true,
                                              .snow = true,
                                              .noise = true,
                                              .sensor_dropout = true}}};
  spec.detector.weather.rain_rate_mmph = 40.0;
  spec.detector.weather.snow_rate_mmph = 8.0;
  spec.detector.weather.snow_intensity = 0.9;
  spec.detector.plausibility.dropout_probability = 0.1;
  spec.detector.plausibility.reference_range_m = 150.0;
  return spec;
}

/// Scans level ground from 30 m on, and sky, so that some beams have each outcome.
Frame ScanPlain(const EffectSet& effects) {
  const auto world = WorldOfParts({{MakeFloor(-6.0F, 1000.0F), 1, 1}});
  SimulatorSpec spec = AllOn();
  spec.detector.effects = effects;
  return ScanOnce(world, MakeRaster(60, 20, 0.25), spec, 7);
}

bool HasSameBits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

TEST(RandomNumbers, SwitchingAnyEffectLeavesTheBeamsItDoesNotTouchBitForBit) {
  const Frame all = ScanPlain(AllOn().detector.effects);
  for (const Effect& effect : kEffects) {
    EffectSet without = AllOn().detector.effects;
    without.*effect.is_on = false;
    const Frame frame = ScanPlain(without);
    std::size_t num_touched = 0;
    for (std::size_t slot = 0; slot < all.num_slots(); ++slot) {
      if (all.outcome[slot] == effect.outcome) {
        ++num_touched;
        continue;
      }
      // An echo of a snowflake below the threshold is reported only without the threshold.
      if (frame.outcome[slot] == Outcome::kClutter && all.outcome[slot] != Outcome::kClutter) {
        EXPECT_EQ(effect.is_on, &EffectSet::threshold);
        continue;
      }
      ASSERT_EQ(all.outcome[slot], frame.outcome[slot]) << effect.name;
      ASSERT_EQ(all.label[slot], frame.label[slot]) << effect.name;
      ASSERT_TRUE(HasSameBits(all.x[slot], frame.x[slot])) << effect.name;
      ASSERT_TRUE(HasSameBits(all.range_m[slot], frame.range_m[slot])) << effect.name;
      ASSERT_TRUE(HasSameBits(all.true_range_m[slot], frame.true_range_m[slot])) << effect.name;
    }
    EXPECT_GT(num_touched, 300U) << effect.name;
  }
}

TEST(RandomNumbers, SwitchingNoiseMovesPointsAndNothingElse) {
  EffectSet without = AllOn().detector.effects;
  without.noise = false;
  const Frame all = ScanPlain(AllOn().detector.effects);
  const Frame frame = ScanPlain(without);
  EXPECT_EQ(all.outcome, frame.outcome);
  EXPECT_EQ(all.label, frame.label);
  EXPECT_NE(all.x, frame.x);
}

/// Returns which beams of a sphere of 40 m radius an effect alone affects, standardised to mean 0
/// and variance 1. For noise: which measured ranges are too long.
std::vector<double> TakenBy(bool EffectSet::*effect, std::uint32_t frame_index) {
  const auto world = WorldOfParts({{MakeSphere(40.0, 90, 180), 3, 1}});
  SimulatorSpec spec = AllOn();
  spec.detector.effects = {};
  spec.detector.effects.*effect = true;
  const Frame frame = ScanOnce(world, MakeRaster(60, 30, 0.25), spec, frame_index);
  std::vector<double> taken;
  double mean = 0.0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const bool is_taken =
        frame.outcome[slot] != Outcome::kReturned || frame.range_m[slot] > frame.true_range_m[slot];
    taken.push_back(is_taken ? 1.0 : 0.0);
    mean += taken.back() / static_cast<double>(frame.num_slots());
  }
  EXPECT_GT(mean, 0.05);
  for (double& value : taken) value = (value - mean) / std::sqrt(mean * (1.0 - mean));
  return taken;
}

TEST(RandomNumbers, OfAFramesEffectsBeamsAndSuccessorAreUncorrelated) {
  const std::array effects = {&EffectSet::rain, &EffectSet::snow, &EffectSet::noise,
                              &EffectSet::sensor_dropout};
  for (const auto effect : effects) {
    const std::vector<double> taken = TakenBy(effect, 4);
    const double bound = kNumSigmas / std::sqrt(static_cast<double>(taken.size()));
    const auto correlation = [&](const std::vector<double>& other, std::size_t shift) {
      double sum = 0.0;
      for (std::size_t i = 0; i + shift < taken.size(); ++i) sum += taken[i] * other[i + shift];
      return sum / static_cast<double>(taken.size());
    };
    // Correlation with the neighbour in the row.
    EXPECT_LE(std::abs(correlation(taken, 1)), bound);
    // Correlation with the neighbour in the column.
    EXPECT_LE(std::abs(correlation(taken, 240)), bound);
    EXPECT_LE(std::abs(correlation(TakenBy(effect, 5), 0)), bound);
    for (const auto other : effects) {
      if (other == effect) continue;
      EXPECT_LE(std::abs(correlation(TakenBy(other, 4), 0)), bound);
    }
  }
}

/// Returns the noise of each beam from one generator that the effects share in turn, each drawing
/// only while it is switched on.
std::vector<double> NoiseOfSharedGenerator(bool with_rain) {
  std::mt19937 generator(42);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> noise;
  for (std::uint32_t beam = 0; beam < kNumDraws; ++beam) {
    const bool is_lost = with_rain && uniform(generator) < 0.1;
    noise.push_back(is_lost ? std::nan("") : uniform(generator));
  }
  return noise;
}

TEST(RandomNumbers, OfASharedGeneratorMoveWhenAnEffectIsSwitchedOn) {
  const std::vector<double> without = NoiseOfSharedGenerator(false);
  const std::vector<double> with = NoiseOfSharedGenerator(true);
  std::size_t num_same = 0;
  std::size_t num_kept = 0;
  for (std::size_t beam = 0; beam < without.size(); ++beam) {
    if (std::isnan(with[beam])) continue;
    ++num_kept;
    num_same += with[beam] == without[beam] ? 1 : 0;
  }
  RecordRegime("an effect switched on",
               {"a shared generator: the noise of " + std::to_string(num_same) + " of " +
                    std::to_string(num_kept) + " beams that it does not touch stays",
                "that of all stays, bit for bit"});
  EXPECT_LT(num_same, num_kept / 100);
}

}  // namespace
}  // namespace railcast
