#include "generator/extras/insert/plan/recorded_intensities.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "generator/extras/insert/firing_finder.h"
#include "generator/extras/insert/inserter.h"
#include "generator/extras/insert/plan/recorded_run.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/closed_loop.h"
#include "tests/generator/extras/insert/plan/plan_project.h"
#include "tests/support/frame_bytes.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr double kNoise = 0.1;
constexpr double kTexture = 0.3;
constexpr std::uint32_t kTurns = 4;

/// Walls about the sensor, as far away to each side.
std::vector<LoopThing> WallsAt(double distance_m) {
  const double width_m = 2.0 * distance_m;
  std::vector<LoopThing> walls;
  for (const double side : {-1.0, 1.0}) {
    walls.push_back({side * distance_m, 0.0, {0.1, width_m, 8.0}});
    walls.push_back({0.0, side * distance_m, {width_m, 0.1, 8.0}});
  }
  return walls;
}

/// A VLP-32C that stands, before things with intensities of 0.1 to 0.25.
LoopSensor StandingSensor(double noise, double texture) {
  LoopSensor sensor{ReadMinimalWith("vlp32c"), {}};
  ScenarioSpec& scenario = sensor.scenario;
  scenario.fidelity = Fidelity::kSurface;
  scenario.lidar.mount.position_m = {0.0, 0.0, 4.0};
  scenario.lidar.receiver.intensity_noise = noise;
  scenario.lidar.receiver.channel_gain = scenario.lidar.receiver.channel_gain_variation = 0.0;
  for (Material& material : scenario.materials) {
    material.reflectivity = 0.22;
    material.texture = texture;
  }
  sensor.pattern = BuildScanPattern(scenario.lidar.scan);
  return sensor;
}

std::vector<RecordedFirings> RecordWalls(const LoopSensor& sensor, double distance_m) {
  const auto world = std::make_shared<SimpleWorld>();
  AddThings(sensor.scenario, WallsAt(distance_m), *world);
  std::vector<RecordedFirings> turns;
  for (std::uint32_t i = 0; i < kTurns; ++i) {
    turns.push_back(RecordedOf(ScanLoop(sensor, world, i), sensor.pattern));
    ForgetOwnFields(turns.back());
  }
  return turns;
}

std::vector<RecordedFrame> FramesOf(const std::vector<RecordedFirings>& turns) {
  std::vector<RecordedFrame> frames;
  for (const RecordedFirings& turn : turns) frames.push_back(turn.recorded);
  return frames;
}

/// Leaves what was put in alone.
RecordedFrame AddedAlone(InsertedFrame inserted) {
  Frame& frame = inserted.recorded.frame;
  std::vector<bool> is_added(frame.num_slots(), false);
  for (const SlotEdit& edit : inserted.edits) is_added[edit.slot] = edit.is_added;
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!is_added[slot]) frame.x[slot] = frame.range_m[slot] = frame.intensity[slot] = kNaN;
  }
  return std::move(inserted.recorded);
}

std::vector<InsertedFrame> InsertInto(const std::vector<RecordedFirings>& turns,
                                      const InsertPlan& plan,
                                      int num_threads) {
  Inserter inserter(plan, num_threads);
  std::vector<InsertedFrame> inserted;
  for (const RecordedFirings& turn : turns) {
    inserted.push_back(inserter.Insert(turn, static_cast<std::uint32_t>(inserted.size())));
  }
  return inserted;
}

/// The texture from cell to cell by which the materials get the measured one.
double CellTexture(const RecordedIntensities& recorded, ScenarioSpec scenario) {
  for (Material& material : scenario.materials) material.texture = 0.0;
  (void)UseIntensities(recorded, scenario);
  return scenario.materials.front().texture;
}

/// Four standard errors of both, if they are independent.
double Within(const JackknifedFigure& a, const JackknifedFigure& b = {.error = 0.0}) {
  return 4.0 * std::hypot(a.error, b.error);
}

// The walls are met under up to 45 deg, where a footprint is longer: V is 5 % less, by which the
// texture is measured 3 % too small.
TEST(RecordedIntensities, AreThoseWithWhichTheRecordingWasMade) {
  const LoopSensor sensor = StandingSensor(kNoise, kTexture);
  const RecordedIntensities recorded = IntensitiesOf(FramesOf(RecordWalls(sensor, 6.0)), 1.0);
  EXPECT_EQ(recorded.why_not, "");
  EXPECT_NEAR(recorded.noise.value, kNoise, Within(recorded.noise));
  EXPECT_LT(recorded.noise.error, 0.002);
  const double relative = recorded.texture.error / recorded.texture.value;
  EXPECT_LT(relative, 0.05);
  EXPECT_NEAR(CellTexture(recorded, sensor.scenario), kTexture, (4.0 * relative + 0.03) * kTexture);
}

TEST(RecordedIntensities, AreThoseOfWhatIsPutIn) {
  const std::vector<RecordedFirings> turns = RecordWalls(StandingSensor(kNoise, kTexture), 6.0);
  const RecordedIntensities recorded = IntensitiesOf(FramesOf(turns), 1.0);
  LoopSensor plain = StandingSensor(0.0, 0.0);
  plain.scenario.seed = 7;
  EXPECT_THAT(UseIntensities(recorded, plain.scenario), HasSubstr("as measured on the recording"));
  const auto walls = ThingsAlone(plain.scenario, WallsAt(4.0));
  walls->velocity_chunk_mps.setZero();
  const InsertPlan plan = PlanOf(plain.scenario, walls, plain.pattern);
  const std::vector<InsertedFrame> inserted = InsertInto(turns, plan, 1);
  const std::vector<InsertedFrame> of_threads = InsertInto(turns, plan, 4);
  std::vector<RecordedFrame> added;
  for (std::uint32_t i = 0; i < kTurns; ++i) {
    EXPECT_EQ(FrameBytes(inserted[i].recorded.frame), FrameBytes(of_threads[i].recorded.frame));
    added.push_back(AddedAlone(inserted[i]));
  }
  const RecordedIntensities ours = IntensitiesOf(std::move(added), 1.0);
  EXPECT_EQ(ours.why_not, "");
  EXPECT_NEAR(ours.noise.value, recorded.noise.value, Within(ours.noise, recorded.noise));
  const double relative = std::hypot(recorded.texture.error / recorded.texture.value,
                                     ours.texture.error / ours.texture.value);
  EXPECT_NEAR(CellTexture(ours, plain.scenario) / plain.scenario.materials.front().texture, 1.0,
              4.0 * relative);
}

TEST(RecordedIntensities, StayThoseOfTheFilesWhereTheRecordingDoesNotTell) {
  const LoopSensor sensor = StandingSensor(kNoise, kTexture);
  std::vector<RecordedFrame> turns = FramesOf(RecordWalls(sensor, 6.0));
  const auto said = [&](const std::vector<RecordedFrame>& of) {
    ScenarioSpec plan = sensor.scenario;
    std::string text = UseIntensities(IntensitiesOf(of, 1.0), plan);
    const bool is_as_it_was =
        plan.lidar == sensor.scenario.lidar && plan.materials == sensor.scenario.materials;
    EXPECT_NE(is_as_it_was, text.find("as measured") != std::string::npos) << text;
    return text;
  };
  EXPECT_THAT(said({}), HasSubstr("are not known: it has no whole turn as a grid"));
  EXPECT_THAT(said({turns[0]}), HasSubstr("are not known: it has one whole turn only"));
  for (float& range_m : turns[1].frame.range_m) range_m += 0.02F;
  EXPECT_THAT(said({turns[0], turns[1]}), HasSubstr("are not known: its sensor moved"));
  EXPECT_THAT(said({turns[2], turns[2]}), HasSubstr("as measured"));
}

TEST(RecordedIntensities, GiveWayToThePlansOwn) {
  const LoopSensor sensor = StandingSensor(kNoise, kTexture);
  RecordedIntensities recorded = IntensitiesOf(FramesOf(RecordWalls(sensor, 6.0)), 1.0);
  ScenarioSpec plan = StandingSensor(0.05, 0.1).scenario;
  recorded.wants_noise = false;
  EXPECT_THAT(UseIntensities(recorded, plan), Not(HasSubstr("noise of")));
  EXPECT_EQ(plan.lidar.receiver.intensity_noise, 0.05);
  EXPECT_EQ(plan.materials.front().texture, 0.1);
  plan.materials.front().texture = 0.0;
  (void)UseIntensities(recorded, plan);
  EXPECT_GT(plan.materials.front().texture, 0.2);
}

TEST(RecordedIntensities, StayThoseOfTheFilesWhereAFigureIsNotToldFromZero) {
  RecordedIntensities recorded{.noise = {.value = 0.05, .error = 0.03},
                               .texture = {.num_parts = 7, .num = 2000}};
  ScenarioSpec plan = StandingSensor(0.07, 0.0).scenario;
  const ScenarioSpec before = plan;
  const std::string said = UseIntensities(recorded, plan);
  EXPECT_THAT(said, HasSubstr("noise of the sensor's file, since 0.05 is less than twice"));
  EXPECT_THAT(said, HasSubstr("(2000 pairs of returns) lie in 7 of the 10 directions"));
  EXPECT_EQ(plan.lidar, before.lidar);
  EXPECT_EQ(plan.materials, before.materials);
  recorded.noise = {.value = 0.0, .error = 0.0};
  (void)UseIntensities(recorded, plan);
  EXPECT_EQ(plan.lidar.receiver.intensity_noise, 0.0);
}

TEST(RealIntensities, GiveWayToThoseOfAPlanOnWhichAnotherBuilds) {
  const fs::path recording = RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/vls128_single.pcap";
  if (!fs::exists(recording)) GTEST_SKIP() << "no " << recording;
  const TemporaryDirectory folder;
  const std::string sensor = "\"" RAILCAST_SOURCE_DIR "/scenarios/sensors/vls128.json\"";
  const auto noise_with = [&](const std::string& lidar) {
    WritePlan(folder.path(), R"({"poses": "standing"})", "",
              R"("fidelity": "surface", "lidar": )" + lidar + ", ");
    WriteFileWhole(folder.path() / "own.json", R"({"version": 1, "file": "plan.json", "seed": 3})");
    return ReadRecordedRun(folder.path() / "own.json", recording)
        .plan.lidar.receiver.intensity_noise;
  };
  EXPECT_EQ(noise_with(R"({"file": )" + sensor + R"(, "receiver": {"intensity_noise": 0.02}})"),
            0.02);
  EXPECT_NE(noise_with(sensor), ReadMinimalWith("vls128").lidar.receiver.intensity_noise);
}

/// Puts walls between the sensor of a capture and most that it has met.
void PutWallsInto(const fs::path& recording) {
  if (!fs::exists(recording)) GTEST_SKIP() << "no " << recording;
  const TemporaryDirectory folder;
  std::string walls;
  for (const LoopThing& wall : WallsAt(2.0)) {
    const auto number = [](double value) { return std::to_string(value); };
    walls += std::string(walls.empty() ? "" : ", ") + R"({"name": "wall)" +
             std::to_string(walls.size()) +
             R"(", "type": "box", "material": "concrete", "frame": 0, "x_m": )" +
             number(wall.ahead_m) + ", \"y_m\": " + number(wall.left_m) +
             ", \"h_m\": -2, \"size_m\": [" + number(wall.size_m.x()) + ", " +
             number(wall.size_m.y()) + ", 9]}";
  }
  InsertPlan plan =
      ReadInsertPlan(WritePlan(folder.path(), R"({"poses": "standing"})",
                               ", \"objects\": [" + walls + "]", R"("fidelity": "surface", )"),
                     recording);
  EXPECT_THAT(plan.remarks.back(), HasSubstr("as measured on the recording's smooth surfaces"));
  for (Material& material : plan.scenario.materials) material.reflectivity = 0.22;
  const RecordedIntensities recorded =
      MeasureIntensities(folder.path() / "plan.json", StandingSensor(0.0, 0.0).scenario, recording,
                         {Transform::Identity()})
          .value();
  EXPECT_NEAR(plan.scenario.lidar.receiver.intensity_noise, recorded.noise.value,
              0.02 * recorded.noise.value);
  const auto opened = OpenRecording(recording);
  FiringFinder finder(opened->info(), plan.scenario.lidar.scan, false);
  Inserter inserter(plan, 0);
  std::vector<RecordedFrame> added;
  for (std::uint32_t frame = 0; frame < plan.frame_times_ns.size(); ++frame) {
    added.push_back(AddedAlone(inserter.Insert(finder.Find((*opened->Next())()), frame)));
  }
  const RecordedIntensities ours = IntensitiesOf(std::move(added), 1.0);
  EXPECT_EQ(ours.why_not, "");
  EXPECT_NEAR(ours.noise.value, recorded.noise.value, Within(ours.noise, recorded.noise));
  EXPECT_NEAR(CellTexture(ours, plan.scenario), plan.scenario.materials.front().texture,
              4.0 * plan.scenario.materials.front().texture *
                  std::hypot(recorded.texture.error / recorded.texture.value,
                             ours.texture.error / ours.texture.value));
}

TEST(RealIntensities, OfAVls128AreThoseOfWhatIsPutIn) {
  PutWallsInto(RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/vls128_single.pcap");
}

TEST(RealIntensities, OfAVlp32cAreThoseOfWhatIsPutIn) {
  PutWallsInto(RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/vlp32c_single.pcap");
}

}  // namespace
}  // namespace railcast
