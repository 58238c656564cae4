#include "analysis/stats/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "analysis/stats/holes.h"
#include "analysis/stats/names.h"
#include "railcast/io/recording.h"
#include "tests/analysis/recorded_frames.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// A wall at 20 m that fills the lower half of the field of view, with the sky above it.
std::shared_ptr<SimpleWorld> WallAndSky() {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {
      {{{{20, -30, -30}, {20, 30, -30}, {20, 30, 0}, {20, -30, 0}}, {{0, 1, 2}, {0, 2, 3}}}, 2, 7}};
  return world;
}

Frame ScanWithDropout(double probability, std::uint32_t index = 0) {
  SimulatorSpec spec{.detector = {.effects = {.sensor_dropout = true}}};
  spec.detector.plausibility.dropout_probability = probability;
  return ScanOnce(WallAndSky(), MakeRaster(60.0, 30.0, 0.25), spec, index);
}

const Table& SectionTableOf(const Section& section, const std::string& key) {
  for (const Table& table : section.tables) {
    if (table.key == key) return table;
  }
  throw std::out_of_range(key);
}

TEST(Dropout, IsTheShareOfBeamsThatMetASurfaceAndBroughtNothingBack) {
  Dropout dropout;
  dropout.Add(Record(ScanWithDropout(0.1)));
  const Estimate share = dropout.Share();
  // Half of the 28,800 beams go into the sky and have nothing to lose.
  EXPECT_NEAR(static_cast<double>(share.num), 14400.0, 240.0);
  // The tolerance is four standard errors; the interval reaches two of them to either side.
  EXPECT_NEAR(share.value, 0.1, 0.01);
  EXPECT_NEAR(share.high - share.low, 4.0 * std::sqrt(0.09 / 14400.0), 0.001);
}

TEST(Dropout, DoesNotCountBeamsOntoTheOwnVehicle) {
  Frame frame = ScanWithDropout(0.1);
  Dropout scene;
  scene.Add(Record(frame));
  // Let every second beam that returned meet the vehicle's nose instead.
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += 2) {
    if (frame.outcome[slot] == Outcome::kReturned) frame.outcome[slot] = Outcome::kEgo;
  }
  Dropout behind_a_nose;
  behind_a_nose.Add(Record(frame));
  const auto num_lost = [](const Dropout& dropout) {
    return dropout.Share().value * static_cast<double>(dropout.Share().num);
  };
  EXPECT_LT(behind_a_nose.Share().num, scene.Share().num);
  EXPECT_NEAR(num_lost(behind_a_nose), num_lost(scene), 1e-6);
}

TEST(Dropout, NamesItsCauses) {
  SimulatorSpec spec{.detector = {.effects = {.threshold = true, .sensor_dropout = true}}};
  spec.detector.plausibility.dropout_probability = 0.05;
  // A reflectivity of 0.5 at 20 m is detected up to an incidence of acos(0.8) = 37 deg, and the
  // incidence is at most 27 deg here; for a threshold of 0.6 the whole wall is too dark.
  spec.detector.plausibility.reference_threshold = 0.6;
  spec.detector.plausibility.reference_range_m = 20.0;
  Dropout dropout;
  dropout.Add(Record(ScanOnce(WallAndSky(), MakeRaster(60.0, 30.0, 0.25), spec)));
  EXPECT_EQ(dropout.Share().value, 1.0);
  const Section section = dropout.MakeSection(Names(RecordingInfo{}));
  const Table& labels = SectionTableOf(section, "dropout_by_label");
  ASSERT_EQ(labels.columns.size(), 5U);
  EXPECT_EQ(labels.columns[3].key, "below_threshold_percent");
  EXPECT_EQ(labels.columns[4].key, "sensor_dropout_percent");
  ASSERT_EQ(labels.rows.size(), 1U);
  EXPECT_EQ(std::get<std::string>(labels.rows[0][0]), "7");
  const auto below = std::get<Estimate>(labels.rows[0][3]);
  const auto missed = std::get<Estimate>(labels.rows[0][4]);
  EXPECT_NEAR(below.value + missed.value, 100.0, 1e-10);
  EXPECT_GT(below.value, 90.0);
}

TEST(Dropout, OfPartsIsThatOfTheWhole) {
  Dropout whole, parts, second;
  whole.Add(Record(ScanWithDropout(0.1, 0)));
  whole.Add(Record(ScanWithDropout(0.1, 1)));
  parts.Add(Record(ScanWithDropout(0.1, 0)));
  second.Add(Record(ScanWithDropout(0.1, 1)));
  AddTo(parts, second);
  EXPECT_EQ(parts.Share().value, whole.Share().value);
  EXPECT_EQ(parts.Share().num, whole.Share().num);
  const Names names{RecordingInfo{}};
  for (const Table& table : whole.MakeSection(names).tables) {
    EXPECT_EQ(SectionTableOf(parts.MakeSection(names), table.key).rows.size(), table.rows.size());
  }
}

TEST(Dropout, IsNotCountedWithoutOutcomes) {
  Dropout dropout;
  dropout.Add(RecordPointsOnly(ScanWithDropout(0.1)));
  EXPECT_TRUE(dropout.is_empty());
  EXPECT_FALSE(dropout.Share().is_enough());
}

TEST(Dropout, OfNothingIsNoNumber) {
  const Frame frame = ScanOnce(std::make_shared<SimpleWorld>(), MakeRaster(60.0, 30.0, 0.25));
  Dropout dropout;
  dropout.Add(Record(frame));
  EXPECT_FALSE(dropout.Share().is_enough());
  EXPECT_EQ(dropout.Share().num, 0U);
}

TEST(Holes, RecoverTheDropoutOfIndependentLosses) {
  for (const double probability : {0.02, 0.18, 0.45}) {
    Holes holes;
    holes.Add(RecordPointsOnly(ScanWithDropout(probability)));
    const Estimate share = holes.Share();
    const double variance = probability * (1.0 - probability);
    EXPECT_NEAR(share.value, probability,
                4.0 * std::sqrt(variance / static_cast<double>(share.num)));
    EXPECT_GT(share.num, 1000U);
  }
}

// With few rows, dropout often removes whole columns.
TEST(Holes, RecoverTheDropoutOfTwoRows) {
  Holes holes;
  for (int i = 0; i < 10; ++i) {
    Frame other = ScanWithDropout(0.5, static_cast<std::uint32_t>(i));
    for (std::size_t slot = 2 * other.width(); slot < other.num_slots(); ++slot) {
      other.range_m[slot] = std::nanf("");
    }
    holes.Add(RecordPointsOnly(other));
  }
  const Estimate share = holes.Share();
  ASSERT_GT(share.num, 900U);
  EXPECT_NEAR(share.value, 0.5, 4.0 * std::sqrt(0.25 / static_cast<double>(share.num)));
}

TEST(Holes, AreNotInTheSky) {
  Holes holes;
  holes.Add(RecordPointsOnly(ScanWithDropout(0.0)));
  EXPECT_EQ(holes.Share().value, 0.0);
  EXPECT_NEAR(holes.Filled().value, 0.5, 0.01);
}

TEST(Holes, AreNotWhereNoBeamWasFired) {
  // Only half of the turn was recorded: the other columns hold no point.
  Frame frame = ScanWithDropout(0.0);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (slot % frame.width() >= frame.width() / 2) frame.range_m[slot] = std::nanf("");
  }
  Holes holes;
  holes.Add(RecordPointsOnly(frame));
  EXPECT_EQ(holes.Share().value, 0.0);
  EXPECT_NEAR(holes.Filled().value, 0.5, 0.01);
}

// Every fourth column meets a mirror of the own vehicle.
TEST(Holes, AreNotWhereTheOwnVehicleIsInTheWay) {
  Frame frame = ScanWithDropout(0.0);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (slot % frame.width() % 4 != 1) continue;
    frame.range_m[slot] = std::nanf("");
    frame.outcome[slot] = Outcome::kEgo;
  }
  RecordedFrame recorded = RecordPointsOnly(frame);
  Holes unknown;
  unknown.Add(recorded);
  EXPECT_GT(unknown.Share().value, 0.1) << "points alone cannot tell";
  recorded.fields.insert("outcome");
  Holes holes;
  holes.Add(recorded);
  EXPECT_EQ(holes.Share().value, 0.0);
  EXPECT_NEAR(holes.Filled().value, 0.5, 0.01);
  Coverage coverage;
  coverage.Add(recorded, nullptr);
  const Section section = coverage.MakeSection();
  // Elsewhere the lowest ring meets the wall everywhere.
  EXPECT_EQ(std::get<Estimate>(SectionTableOf(section, "rings").rows.at(0).at(3)).value, 100.0);
}

TEST(Holes, OfAFrameWithoutAPointOrAGridAreNoNumber) {
  Frame frame = ScanWithDropout(0.0);
  for (float& range_m : frame.range_m) range_m = std::nanf("");
  Holes holes;
  holes.Add(RecordPointsOnly(frame));
  EXPECT_FALSE(holes.Share().is_enough());
  RecordedFrame cloud = RecordPointsOnly(ScanWithDropout(0.0));
  cloud.is_grid = false;
  holes.Add(cloud);
  EXPECT_TRUE(holes.is_empty());
}

// A turn of OT128, half of whose lasers fire every 0.1 deg and half every 0.2 deg. With a table of
// its own for each row of the calibration file, made by other means, 1,366 of 58,871 firings
// between two points of one surface have none. Rows that are found in the elevations differ from it
// at strays: the tolerance is 1 % of these holes.
TEST(Holes, OfARealTurnWithTwoAzimuthStepsAreThoseOfEachRing) {
  const std::filesystem::path file =
      RAILCAST_SHARED_DATA_DIR "/lidar_hesai/captures/ot128_decoded.pcd";
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  Holes holes;
  holes.Add((*OpenRecording(file)->Next())());
  EXPECT_NEAR(static_cast<double>(holes.Share().num), 58'871.0, 589.0);
  EXPECT_NEAR(holes.Share().value, 0.0232, 0.0003);
}

// Left of the x axis the wall is dark (reflectivity 0.1), right of it grey (0.5).
TEST(SmoothHoles, RecoverTheLossesOfEachBrightness) {
  auto world = std::make_shared<SimpleWorld>();
  const auto half = [](float y0, float y1, std::uint16_t material) {
    return Part{{{{20, y0, -9}, {20, y1, -9}, {20, y1, 9}, {20, y0, 9}}, {{0, 1, 2}, {0, 2, 3}}},
                material,
                7};
  };
  world->ground.parts = {half(0, 20, 1), half(-20, 0, 2)};
  SimulatorSpec spec{.detector = {.effects = {.threshold = true, .sensor_dropout = true}}};
  spec.detector.plausibility.dark_dropout_probability = 0.2;
  spec.detector.plausibility.dark_dropout_intensity = 0.2;
  SmoothHoles smooth;
  Frame frame;
  for (std::uint32_t index = 0; index < 20; ++index) {
    frame = ScanOnce(world, MakeRaster(20.0, 10.0, 0.1), spec, index);
    for (std::size_t row = 0; row < frame.rows; ++row) {
      for (std::size_t column = 0; column < frame.columns; ++column) {
        smooth.AddFiring(frame, row, column);
      }
    }
  }
  // The wall is met under at most 11 deg, 6 deg on average.
  for (const double intensity : {0.0993, 0.4967}) {
    const HoleCount& count =
        smooth.by_intensity()[*SmoothHoles::Intensities().Find(intensity)].firings;
    const auto n = static_cast<double>(count.num_expected);
    ASSERT_GT(n, 10'000.0);
    const double lost = 0.2 * std::exp(-intensity / 0.2);
    EXPECT_NEAR(static_cast<double>(count.num_missing), lost * n,
                4.0 * std::sqrt(n * lost) + 0.02 * n * lost)
        << intensity;
  }
}

TEST(SmoothHoles, AreNotInPatternsAndRoughSurfaces) {
  for (const bool is_rough : {false, true}) {
    Frame frame = ScanWithDropout(0.1);
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      if (is_rough) {
        frame.range_m[slot] += slot % 2 == 0 ? 0.04F : -0.04F;
      } else {
        frame.intensity[slot] = slot % 2 == 0 ? 0.1F : 0.2F;
      }
    }
    SmoothHoles smooth;
    for (std::size_t column = 0; column < frame.columns; ++column)
      smooth.AddFiring(frame, 5, column);
    EXPECT_TRUE(smooth.by_intensity().empty()) << is_rough;
  }
}

}  // namespace
}  // namespace railcast
