#include "viewer/frames/frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/io/cloud/scan_motion.h"
#include "railcast/io/cloud_files.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "tests/analysis/recorded_frames.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/stream/stream_example.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/viewer/made_run.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAreArray;

ScenarioSpec Minimal() {
  return ReadScenario(fs::path(RAILCAST_SOURCE_DIR) / "scenarios" / "minimal.json");
}

TEST(Frames, HaveTheNamesOfAScenarioThatIsGiven) {
  const TemporaryDirectory directory;
  std::string bytes;
  EncodePcd(ExampleFrame(0), FieldSelection("x,y,z,label"), PcdEncoding::kBinary, bytes);
  WriteFileWhole(directory.path() / "a.pcd", bytes);
  RecordedFrames frames(directory.path() / "a.pcd");
  const ScenarioSpec scenario = Minimal();
  frames.UseScenario(scenario);
  EXPECT_EQ(frames.info().labels.labels(), scenario.labels);
  EXPECT_EQ(frames.info().materials.at(0), "none");
  EXPECT_EQ(frames.info().materials.at(1), scenario.materials.at(0).name);
  EXPECT_TRUE(frames.info().scenario);
}

TEST(Frames, TakeTheirOwnScenarioAgain) {
  const TemporaryDirectory directory;
  const fs::path run = directory.path() / "run";
  const MadeSequence made = MakeRun(run);
  RecordedFrames frames(run);
  frames.UseScenario(made.scenario);
  frames.UseScenario(ReadScenario(run / "scenario.resolved.json"));
  EXPECT_EQ(ResolvedScenarioJson(*frames.info().scenario), ResolvedScenarioJson(made.scenario));
  EXPECT_EQ(frames.Get(0)->recorded->objects.at(0).name, "wagon") << "as the sequence says";
}

TEST(Frames, RefuseAScenarioThatIsNotTheirOwn) {
  const TemporaryDirectory directory;
  const fs::path run = directory.path() / "run";
  const MadeSequence made = MakeRun(run);
  RecordedFrames frames(run);
  EXPECT_EQ(
      MessageOf([&] { frames.UseScenario(Minimal()); }),
      run.string() + ": has a scenario of its own: --scenario must be the same or be left out");
  EXPECT_EQ(ResolvedScenarioJson(*frames.info().scenario), ResolvedScenarioJson(made.scenario));
}

TEST(WorldObjects, AreWhereTheirPointsAreSeen) {
  const TemporaryDirectory directory;
  const MadeSequence made = MakeRun(directory.path() / "run", "geometry");
  const auto world = MakeWorld(made.scenario);
  for (RecordedFrame& recorded : ReadAll(directory.path() / "run")) {
    const auto objects = ObjectsAt(*world, LabelTable(made.scenario.labels), recorded.frame);
    ASSERT_EQ(objects.size(), 1U);
    EXPECT_EQ(objects[0].name, "crate");
    EXPECT_EQ(objects[0].type, "box");
    EXPECT_EQ(objects[0].label, "wagon");
    // The mesh is stored in float32.
    EXPECT_TRUE(objects[0].size_m.isApprox(Vector3(2, 3, 4), 1e-6));
    const ShownFrame shown = MakeShownFrame(std::move(recorded));
    std::size_t num_points = 0;
    for (std::size_t i = 0; i < shown.num_points(); ++i) {
      if (shown.frame().instance[shown.slots[i]] != objects[0].instance) continue;
      ++num_points;
      const Eigen::Map<const Eigen::Vector3f> point_m(&shown.positions_m[3 * i]);
      const Vector3 in_box_m = objects[0].sensor_from_box.inverse() * point_m.cast<double>();
      // The point is on a face, within the 1 mm that the vehicle's path bends during the scan.
      constexpr double kMotionTolerance_m = 1.2e-3;
      const Vector3 beyond_m = in_box_m.cwiseAbs() - Vector3(1.0, 1.5, 2.0);
      EXPECT_NEAR(beyond_m.maxCoeff(), 0.0, kMotionTolerance_m);
    }
    EXPECT_GT(num_points, 100U);
  }
}

TEST(WorldObjects, HaveTheirVelocities) {
  const TemporaryDirectory directory;
  const MadeSequence made =
      MakeSequence(directory.path() / "run",
                   {.object = R"({"name": "wagon", "type": "open_wagon", "s_m": 300, )"
                              R"("motion": {"profile": [{"time_s": 0, "speed_mps": 30}]}})",
                    .num_frames = 1});
  const auto world = MakeWorld(made.scenario);
  const Frame& frame = made.frames.at(0);
  const auto objects = ObjectsAt(*world, LabelTable(made.scenario.labels), frame);
  ASSERT_EQ(objects.size(), 1U);
  // On bogies up to 10 m apart, the middle of the wagon is 10^2 / 8 / 500 m = 25 mm nearer to the
  // centre of the curve of 500 m radius, and slower by as much in 500 m.
  EXPECT_NEAR(objects[0].velocity_world_mps.norm(), 30.0, 30.0 * 0.025 / 500.0);
  const Vector3 forward = (frame.world_from_sensor * objects[0].sensor_from_box).linear().col(0);
  EXPECT_GT(objects[0].velocity_world_mps.normalized().dot(forward), 0.999);
}

constexpr std::size_t kSlots = 1000;

/// A frame of `num_slots` slots with a point in each.
std::shared_ptr<const ShownFrame> Full(std::size_t num_slots, std::size_t num_foreign = 0) {
  RecordedFrame recorded;
  recorded.frame.Resize(1, static_cast<std::uint32_t>(num_slots), 1);
  recorded.foreign.resize(num_foreign, {"curvature", std::vector<float>(num_slots)});
  return std::make_shared<const ShownFrame>(MakeShownFrame(std::move(recorded)));
}

TEST(NumBytesOf, IsWhatAFrameTakesPerSlotAndPoint) {
  // Per slot: x, y, z, intensity, power_ratio, range_m, time_ns, column, label, instance,
  // true_range_m, incidence_rad, footprint_share and mixed_share of 4 bytes; ring and material of
  // 2; return_index, return_count and outcome of 1. Per point: x, y, z and the slot.
  constexpr std::size_t kPerSlot = 14 * 4 + 2 * 2 + 3;
  constexpr std::size_t kPerPoint = 16;
  EXPECT_EQ(NumBytesOf(*Full(kSlots)) - NumBytesOf(*Full(0)), kSlots * (kPerSlot + kPerPoint));
}

TEST(NumBytesOf, CountsForeignFields) {
  EXPECT_EQ(NumBytesOf(*Full(kSlots, 3)) - NumBytesOf(*Full(kSlots)), kSlots * 3 * 4);
}

TEST(FrameShelf, KeepsWhatItsBytesAllow) {
  const std::size_t each = NumBytesOf(*Full(kSlots));
  FrameShelf shelf({.num_bytes = 3 * each});
  for (std::size_t place = 0; place < 3; ++place) shelf.Put(place, Full(kSlots));
  EXPECT_EQ(shelf.size(), 3U);
  EXPECT_EQ(shelf.num_bytes(), 3 * each);
  shelf.Put(3, Full(1));
  EXPECT_EQ(shelf.Find(0), nullptr);
  for (std::size_t place = 1; place < 4; ++place) EXPECT_TRUE(shelf.Find(place)) << place;
  EXPECT_EQ(shelf.num_bytes(), 2 * each + NumBytesOf(*Full(1)));
}

TEST(FrameShelf, KeepsTheLastHoweverLarge) {
  FrameShelf shelf({.num_bytes = 1});
  const auto last = Full(kSlots);
  shelf.Put(0, Full(kSlots));
  shelf.Put(1, last);
  EXPECT_EQ(shelf.Find(0), nullptr);
  EXPECT_EQ(shelf.Find(1), last);
  EXPECT_EQ(shelf.num_bytes(), NumBytesOf(*last));
}

TEST(FrameShelf, KeepsNoMoreFramesThanItMay) {
  FrameShelf shelf({.num_frames = 2});
  for (std::size_t place = 0; place < 5; ++place) shelf.Put(place, Full(1));
  EXPECT_EQ(shelf.size(), 2U);
  EXPECT_EQ(shelf.Find(2), nullptr);
  EXPECT_TRUE(shelf.Find(3));
}

TEST(FrameShelf, KeepsWhatWasUsedLast) {
  FrameShelf shelf({.num_frames = 2});
  shelf.Put(0, Full(1));
  shelf.Put(1, Full(1));
  EXPECT_TRUE(shelf.Use(0));
  shelf.Put(2, Full(1));
  EXPECT_TRUE(shelf.Find(0));
  EXPECT_EQ(shelf.Find(1), nullptr);
  EXPECT_EQ(shelf.Use(1), nullptr);
}

TEST(FrameShelf, ForgetsTheOldestWhatWasFoundOnly) {
  FrameShelf shelf({.num_frames = 2});
  shelf.Put(0, Full(1));
  shelf.Put(1, Full(1));
  EXPECT_TRUE(shelf.Find(0));
  shelf.Put(2, Full(1));
  EXPECT_EQ(shelf.Find(0), nullptr);
}

/// A frame with every field, of 4800 firings, two of ten with a point, during which the sensor
/// moved by 3 m and turned by 0.1 rad.
RecordedFrame MovingFrame() {
  Frame frame = StreamFrame(3);
  frame.world_from_sensor_end =
      frame.world_from_sensor *
      MakeTransform(RotationFromYawPitchRoll(0.1, 0.0, 0.02), Vector3(3.0, 0.15, 0.0));
  return Record(std::move(frame));
}

/// Returns the recorded positions of all slots that have a point.
std::vector<float> RecordedPositions(const Frame& frame) {
  std::vector<float> positions_m;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (std::isnan(frame.x[slot])) continue;
    for (const auto* axis : {&frame.x, &frame.y, &frame.z}) positions_m.push_back((*axis)[slot]);
  }
  return positions_m;
}

TEST(ShownFrame, HasThePointsOfAllSlotsThatHaveOne) {
  const RecordedFrame recorded = MovingFrame();
  std::vector<std::uint32_t> slots;
  for (std::uint32_t slot = 0; slot < recorded.frame.num_slots(); ++slot) {
    if (HasPoint(recorded.frame.outcome[slot])) slots.push_back(slot);
  }
  const ShownFrame shown = MakeShownFrame(recorded);
  EXPECT_EQ(shown.slots, slots);
  EXPECT_EQ(shown.positions_m.size(), 3 * slots.size());
  EXPECT_EQ(shown.num_points(), slots.size());
  EXPECT_EQ(shown.recorded->fields, recorded.fields);
}

TEST(ShownFrame, PutsPointsWhereTheyWereAtTheStamp) {
  const ShownFrame shown = MakeShownFrame(MovingFrame());
  const Frame& frame = shown.frame();
  const ScanMotion motion(frame);
  double furthest_m = 0.0;
  for (std::size_t i = 0; i < shown.num_points(); ++i) {
    const std::uint32_t slot = shown.slots[i];
    const Vector3 seen_m =
        Eigen::Vector3f(frame.x[slot], frame.y[slot], frame.z[slot]).cast<double>();
    const Eigen::Vector3f expected_m = motion.AtStamp(seen_m, frame.time_ns[slot]).cast<float>();
    const Eigen::Map<const Eigen::Vector3f> shown_m(&shown.positions_m[3 * i]);
    ASSERT_EQ(expected_m, shown_m) << i;
    furthest_m = std::max(furthest_m, (seen_m - shown_m.cast<double>()).norm());
  }
  // The sensor moves by 3 m until the last firings, and 0.1 rad at 300 m is 30 m.
  EXPECT_GT(furthest_m, 3.0);
}

TEST(ShownFrame, PutsPointsOfMovingObjectsWhereTheirBoxesAre) {
  RecordedFrame recorded = MovingFrame();
  const std::vector<float> standing_m = MakeShownFrame(recorded).positions_m;
  recorded.frame.instance.assign(recorded.frame.num_slots(), 5);
  recorded.objects = {{.name = "wagon",
                       .type = "open_wagon",
                       .label = "wagon",
                       .instance = 5,
                       .velocity_world_mps = Vector3(-20.0, 10.0, 0.0)}};
  const ShownFrame shown = MakeShownFrame(recorded);
  const Frame& frame = shown.frame();
  for (std::size_t i = 0; i < shown.num_points(); ++i) {
    const std::uint32_t slot = shown.slots[i];
    const double time_s =
        frame.outcome[slot] == Outcome::kClutter ? 0.0 : 1e-9 * frame.time_ns[slot];
    const Vector3 way_m =
        frame.world_from_sensor.linear().transpose() * Vector3(-20.0 * time_s, 10.0 * time_s, 0.0);
    const Vector3 moved_m =
        Eigen::Map<const Eigen::Vector3f>(&standing_m[3 * i]).cast<double>() -
        Eigen::Map<const Eigen::Vector3f>(&shown.positions_m[3 * i]).cast<double>();
    // Rounding of float32 at 300 m.
    ASSERT_LT((moved_m - way_m).norm(), 1e-4) << i;
  }
}

TEST(ShownFrame, LeavesPointsWhereTheyAreIfTheMotionIsNotKnown) {
  RecordedFrame without_times = MovingFrame();
  without_times.fields.erase("time_ns");
  RecordedFrame without_pose = MovingFrame();
  without_pose.has_pose = false;
  RecordedFrame of_one_moment = MovingFrame();
  of_one_moment.frame.duration_ns = 0;
  for (const RecordedFrame& recorded : {without_times, without_pose, of_one_moment}) {
    EXPECT_THAT(MakeShownFrame(recorded).positions_m,
                ElementsAreArray(RecordedPositions(recorded.frame)));
  }
}

TEST(ShownFrame, MayHaveNoPoints) {
  EXPECT_EQ(MakeShownFrame({}).num_points(), 0U);
}

}  // namespace
}  // namespace railcast
