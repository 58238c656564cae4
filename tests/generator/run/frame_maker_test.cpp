#include "generator/run/frame_maker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"
#include "tests/support/frame_bytes.h"

namespace railcast {
namespace {

// Period of sensor front; that of roof is half as long.
constexpr std::int64_t kFrame_ns = 100'000'000;

// A vehicle at 400 m that runs at 10 m/s, a wagon that stands at 440 m on the same track, and a
// person walking beside it.
ScenarioSpec TwoSensorScenario() {
  const TemporaryDirectory folder;
  WriteFileWhole(folder.path() / "scenario.json", R"({
    "version": 1,
    "lidars": [
      {"name": "front", "range_max_m": 90, "mount": {"position_m": [1, 0, 2.5]},
       "scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 40,
                "vertical_fov_deg": 16, "angular_resolution_deg": 0.5}}},
      {"name": "roof", "range_max_m": 50, "mount": {"position_m": [0, 0, 4]},
       "scan": {"rate_hz": 20, "pattern": {"type": "raster", "horizontal_fov_deg": 360,
                "vertical_fov_deg": 40, "angular_resolution_deg": 1}}}
    ],
    "world": {
      "alignment": {
        "course": {"type": "elements", "elements": [{"type": "straight", "length_m": 1000}]}
      },
      "tracks": [{"name": "main"}, {"name": "second", "offset_m": 4}],
      "objects": [
        {"name": "wagon", "type": "open_wagon", "s_m": 440},
        {"name": "walker", "type": "person", "s_m": 420, "d_m": -3,
         "motion": {"profile": [{"time_s": 0, "speed_mps": 1.5}]}}
      ]
    },
    "vehicle": {"start_s_m": 400, "motion": {"profile": [{"time_s": 0, "speed_mps": 10}]},
                "ego_boxes_m": [[-18, -1.45, 0.3, 0.5, 1.45, 2]]},
    "materials": ")" + kScenariosFolder + R"(materials/railway.json",
    "labels": ")" + kScenariosFolder + R"(labels.json"
  })");
  return ReadScenario(folder.path() / "scenario.json");
}

struct OwnedRun {
  explicit OwnedRun(const ScenarioSpec& scenario = TwoSensorScenario(), int num_threads = 2)
      : commanded(scenario, num_threads) {}

  Frame Scan(std::size_t sensor, std::uint32_t index) {
    Frame frame;
    commanded.At(sensor, index).Scan(index, frame);
    return frame;
  }
  std::string Bytes(std::size_t sensor, std::uint32_t index) {
    const Frame frame = Scan(sensor, index);
    return FrameBytes(frame);
  }

  FrameMaker commanded;
};

Command Place(const std::string& name, double s_m, double d_m = 0.0) {
  PlaceObject place;
  place.object.name = name;
  place.object.type = ObjectType::kPerson;
  place.object.s_m = s_m;
  place.object.d_m = d_m;
  return place;
}

Command Rain(double rate_mmph) {
  SetWeather rain;
  rain.weather.rain_rate_mmph = rate_mmph;
  return rain;
}

// Commands of several kinds, some of them between the boundaries of frames.
std::vector<TimedCommand> Everything() {
  return {{0, Place("early", 425.0)},
          {2 * kFrame_ns, SetSpeed{14.0, 2.0}},
          {2 * kFrame_ns, Rain(40.0)},
          {5 * kFrame_ns / 2, RemoveObject{"wagon"}},
          {4 * kFrame_ns, Place("late", 418.0)},
          {5 * kFrame_ns, Stop{}},
          {6 * kFrame_ns, RemoveObject{"early"}}};
}

std::size_t PointsOn(const Frame& frame, std::uint32_t instance) {
  return static_cast<std::size_t>(
      std::count(frame.instance.begin(), frame.instance.end(), instance));
}

TEST(FrameMaker, AFrameDoesNotDependOnThoseMadeBeforeItNorOnTheNumberOfThreads) {
  OwnedRun forward(TwoSensorScenario(), 2);
  forward.commanded.Apply(Everything());
  std::map<std::pair<std::size_t, std::uint32_t>, std::string> frames;
  for (const std::size_t sensor : {0U, 1U}) {
    for (std::uint32_t index = 0; index < 8; ++index) {
      frames[{sensor, index}] = forward.Bytes(sensor, index);
    }
  }
  OwnedRun backward(TwoSensorScenario(), 1);
  backward.commanded.Apply(Everything());
  for (std::uint32_t index = 8; index-- > 0;) {
    for (const std::size_t sensor : {1U, 0U}) {
      EXPECT_EQ(backward.Bytes(sensor, index), (frames[{sensor, index}])) << sensor << index;
    }
  }
}

TEST(FrameMaker, MakesTheFramesLiveThatALogMakesLater) {
  const std::vector<TimedCommand> commands = Everything();
  OwnedRun live;
  std::vector<std::string> frames;
  auto next = commands.begin();
  for (std::uint32_t index = 0; index < 8; ++index) {
    for (; next != commands.end() && next->time_ns <= index * kFrame_ns; ++next) {
      live.commanded.Apply(next->command, next->time_ns);
    }
    frames.push_back(live.Bytes(0, index));
    live.commanded.ForgetBefore(index * kFrame_ns);
    EXPECT_LE(live.commanded.states().size(), 2U);
  }
  OwnedRun replay;
  replay.commanded.Apply(commands);
  for (std::uint32_t index : {3U, 7U, 0U, 1U, 2U, 6U, 5U, 4U}) {
    EXPECT_EQ(replay.Bytes(0, index), frames[index]) << index;
  }
}

TEST(FrameMaker, WithoutCommandsMakesTheScenariosOwnFrames) {
  const ScenarioSpec scenario = TwoSensorScenario();
  OwnedRun run(scenario);
  for (const std::size_t sensor : {0U, 1U}) {
    const std::string name = SensorNames(scenario)[sensor];
    const auto alone = MakeSimulator(PickSensor(scenario, name), 2);
    for (const std::uint32_t index : {0U, 5U, 2U}) {
      Frame frame;
      alone->Scan(index, frame);
      EXPECT_EQ(run.Bytes(sensor, index), FrameBytes(frame)) << name << index;
    }
  }
}

TEST(FrameMaker, ShowsAPlacedPersonFromItsTimeOnUntilItIsRemoved) {
  OwnedRun run;
  run.commanded.Apply(Place("bob", 420.0), 2 * kFrame_ns);
  run.commanded.Apply(RemoveObject{"bob"}, 4 * kFrame_ns);
  constexpr std::uint32_t kBob = 4;  // The ids 1 to 3 belong to wagon, walker and ego.
  for (std::uint32_t index = 0; index < 6; ++index) {
    const Frame frame = run.Scan(0, index);
    const bool is_there = index == 2 || index == 3;
    EXPECT_EQ(PointsOn(frame, kBob) > 10, is_there) << index << " " << PointsOn(frame, kBob);
    EXPECT_GT(PointsOn(frame, 1), 100U);
  }
  // The other sensor sees it at the same times, which have other frame numbers there.
  EXPECT_EQ(PointsOn(run.Scan(1, 3), kBob), 0U);
  EXPECT_GT(PointsOn(run.Scan(1, 4), kBob), 0U);
  EXPECT_GT(PointsOn(run.Scan(1, 7), kBob), 0U);
  EXPECT_EQ(PointsOn(run.Scan(1, 8), kBob), 0U);
}

TEST(FrameMaker, LetsWhatStoodBehindARemovedObjectBeSeen) {
  OwnedRun run;
  run.commanded.Apply(RemoveObject{"wagon"}, 2 * kFrame_ns);
  EXPECT_GT(PointsOn(run.Scan(0, 1), 1), 100U);
  EXPECT_EQ(PointsOn(run.Scan(0, 2), 1), 0U);
  EXPECT_GT(PointsOn(run.Scan(0, 1), 1), 100U);
}

TEST(FrameMaker, StopsTheVehicleAfterItsBrakingDistance) {
  OwnedRun run;
  run.commanded.Apply(Stop{}, 10 * kFrame_ns);
  // 10 m before the command, then 10^2 / (2 x 1.3) m of braking.
  const double stopped_s_m = 410.0 + 100.0 / 2.6;
  const Frame frame = run.Scan(0, 200);
  EXPECT_NEAR(frame.world_from_sensor.translation().x(), stopped_s_m + 1.0, 1e-9);
  EXPECT_EQ(frame.world_from_sensor.matrix(), frame.world_from_sensor_end.matrix());
  EXPECT_NEAR(run.Scan(0, 10).world_from_sensor.translation().x(), 411.0, 1e-9);
}

TEST(FrameMaker, ChangesTheWeatherOfPoints) {
  OwnedRun run;
  run.commanded.Apply(Rain(2000.0), 2 * kFrame_ns);
  const auto num_absorbed = [&](std::uint32_t index) {
    const Frame frame = run.Scan(0, index);
    return std::count(frame.outcome.begin(), frame.outcome.end(), Outcome::kRainAbsorbed);
  };
  EXPECT_EQ(num_absorbed(1), 0);
  EXPECT_GT(num_absorbed(2), 100);
  EXPECT_EQ(num_absorbed(0), 0);
}

TEST(FrameMaker, StartsAnewWhenItIsReset) {
  OwnedRun run;
  const std::string first = run.Bytes(0, 1);
  run.commanded.Apply(Place("bob", 420.0), 0);
  run.commanded.Apply(Rain(20.0), 7 * kFrame_ns);
  EXPECT_NE(run.Bytes(0, 1), first);
  run.commanded.Apply(Reset{}, 0);
  EXPECT_EQ(run.Bytes(0, 1), first);
  // Instance ids begin anew as well.
  run.commanded.Apply(Place("eve", 420.0), 0);
  EXPECT_EQ(run.commanded.StateAt(0).world->objects().back().instance, 4U);
}

TEST(FrameMaker, KeepsNothingOfAnObjectThatIsGone) {
  OwnedRun run;
  run.commanded.Apply(Place("bob", 420.0), 0);
  static_cast<void>(run.Scan(0, 0));
  static_cast<void>(run.Scan(1, 0));
  const std::weak_ptr<const Model> model = run.commanded.StateAt(0).world->objects().back().model;
  run.commanded.Apply(Reset{}, 0);
  static_cast<void>(run.Scan(0, 0));
  EXPECT_FALSE(model.expired());
  static_cast<void>(run.Scan(1, 0));
  EXPECT_TRUE(model.expired());
}

TEST(FrameMaker, RefusesACommandAndChangesNothing) {
  OwnedRun run;
  run.commanded.Apply(Place("bob", 420.0), kFrame_ns);
  const auto refusal = [&](const Command& command) {
    return MessageOf([&] { run.commanded.Apply(command, 2 * kFrame_ns); });
  };
  EXPECT_EQ(refusal(Place("bob", 430.0)), "command: /object/name: must be unique (got \"bob\")");
  EXPECT_EQ(refusal(Place("eve", 1001.0)),
            "command: /object/s_m: must lie on track \"main\", from 0 to 1000 m (got 1001)");
  EXPECT_EQ(refusal(RemoveObject{"ego"}),
            "command: /name: must be the name of an object that is there (got \"ego\")");
  EXPECT_EQ(run.commanded.states().size(), 2U);
  EXPECT_EQ(MessageOf([&] {
              run.commanded.Apply({{15 * kFrame_ns, RemoveObject{"nobody"}}});
            }),
            "at 1.5 s: command: /name: must be the name of an object that is there (got "
            "\"nobody\")");
}

TEST(FrameMaker, SaysWhenTheVehicleLeavesItsTrack) {
  OwnedRun run;
  run.commanded.Apply(SetSpeed{100.0, 10.0}, 0);
  // 10 t + 5 t^2 = 600 m is reached at 10 s; a scan that begins shortly before ends beyond it.
  EXPECT_NO_THROW(static_cast<void>(run.commanded.At(0, 98)));
  EXPECT_EQ(MessageOf([&] { static_cast<void>(run.commanded.At(0, 100)); }),
            "command: the vehicle leaves track \"main\", from 0 to 1000 m, at frame 100 (10 s)");
}

}  // namespace
}  // namespace railcast
