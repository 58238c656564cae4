#include "generator/extras/insert/insert_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "railcast/rail_world.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/made_sequence.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/track/bars.h"
#include "tests/generator/extras/insert/plan/plan_project.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr double kSpline_m = 0.01;  // Of a spline through places 10 m apart on an arc of 500 m.

std::string Box(const std::string& place) {
  return R"(, "objects": [{"name": "box", "type": "box", "size_m": [0.5, 0.5, 0.5], )" + place +
         "}]";
}

/// So that there is no remark on the rung.
const std::string kNamedRung = R"("fidelity": "plausibility", )";

/// The objects of a plan for a run eastwards at 20 m/s, or the message about what is wrong.
struct PlannedRun {
  explicit PlannedRun(const std::string& rest,
                      const std::string& recording = "{}",
                      const std::vector<PosedCloud>& clouds = StraightRun(30, 20.0)) {
    const fs::path source = WriteReceived(folder.path() / "run", clouds);
    const fs::path file = WritePlan(folder.path(), recording, rest, VelodyneOfPlan() + kNamedRung);
    message = MessageOf([&] { plan = ReadInsertPlan(file, source); });
    for (std::size_t at = 0; (at = message.find(folder.path().string() + "/")) != message.npos;) {
      message.erase(at, folder.path().string().size() + 1);
    }
  }
  [[nodiscard]] Vector3 PlaceOf(std::size_t object, double time_s = 0.0) const {
    return plan.world->WorldFromObject(object, std::llround(time_s * 1e9)).translation();
  }

  TemporaryDirectory folder;
  InsertPlan plan;
  std::string message;
};

TEST(InsertPlan, MeasuresChainageFromWhereTheVehicleIsInTheFirstFrame) {
  const PlannedRun run(Box(R"("s_m": 40, "d_m": 2, "h_m": 0.3)"));
  ASSERT_EQ(run.message, "no error");
  EXPECT_LT((run.PlaceOf(0) - Vector3(40.0, 2.0, 0.3)).norm(), 1e-6);
  EXPECT_EQ(run.plan.first_stamp_ns, 5'000'000'000);
  EXPECT_EQ(run.plan.frame_times_ns.size(), 30U);
  EXPECT_EQ(run.plan.frame_times_ns[29], 2'900'000'000);
}

TEST(InsertPlan, MeasuresFromWhereTheVehicleIsInAFrameIfThePlanNamesOne) {
  const PlannedRun run(Box(R"("s_m": 120, "d_m": -1, "h_m": 0, "frame": 10)"));
  ASSERT_EQ(run.message, "no error");
  EXPECT_LT((run.PlaceOf(0) - Vector3(140.0, -1.0, 0.0)).norm(), 1e-6);
}

TEST(InsertPlan, PlacesInTheWorldAndInTheAxesOfTheSensor) {
  const PlannedRun world(Box(R"("x_m": 33, "y_m": 4, "h_m": 0)"));
  ASSERT_EQ(world.message, "no error");
  EXPECT_LT((world.PlaceOf(0) - Vector3(33.0, 4.0, 0.0)).norm(), 1e-6);
  const PlannedRun sensor(Box(R"("x_m": 33, "y_m": 4, "h_m": 0, "frame": 29)"));
  ASSERT_EQ(sensor.message, "no error");
  EXPECT_LT((sensor.PlaceOf(0) - Vector3(58.0 + 33.0, 4.0, 0.0)).norm(), 1e-6);
}

TEST(InsertPlan, ChainageRisesTheWayAVehicleFacesThatRunsBackwards) {
  std::vector<PosedCloud> clouds = StraightRun(30, 20.0);
  for (PosedCloud& cloud : clouds) cloud.heading_rad = std::numbers::pi;
  const PlannedRun run(Box(R"("s_m": 10, "d_m": 1, "h_m": 0)"), "{}", clouds);
  ASSERT_EQ(run.message, "no error");
  EXPECT_LT((run.PlaceOf(0) - Vector3(-10.0, -1.0, 0.0)).norm(), 1e-6);
}

TEST(InsertPlan, ThingsThatMoveKeepTheTimesOfTheRecording) {
  const PlannedRun run(Box(R"("s_m": 60, "d_m": 5, "h_m": 0, "motion": {"path": {"points": [)"
                           R"({"s_m": 60, "d_m": -5}], "speed_mps": 2, )"
                           R"("acceleration_mps2": 100, "start_at_vehicle_s_m": 20}})"));
  ASSERT_EQ(run.message, "no error");
  EXPECT_LT((run.PlaceOf(0, 1.0) - Vector3(60.0, 5.0, 0.0)).norm(), 1e-3);
  // The vehicle comes to chainage 20 after 1 s; starting costs 0.02 m.
  EXPECT_LT((run.PlaceOf(0, 2.0) - Vector3(60.0, 3.0, 0.0)).norm(), 0.05);
}

TEST(InsertPlan, TrainsRunAlongTheDrivenPath) {
  const PlannedRun run(R"(, "trains": [{"name": "t", "s_m": 200, "vehicles": [)"
                       R"({"type": "open_wagon"}], "motion": {"profile": [{"time_s": 0, )"
                       R"("speed_mps": 10}]}}])");
  ASSERT_EQ(run.message, "no error");
  EXPECT_NEAR(run.PlaceOf(0, 2.0).x() - run.PlaceOf(0, 0.0).x(), 20.0, 1e-6);
  EXPECT_NEAR(run.PlaceOf(0).z(), 0.0, 1e-6);
}

TEST(InsertPlan, TakesTheMountFromTheTrackThatTheCloudsShow) {
  const TemporaryDirectory folder;
  std::vector<std::string> points;
  for (const Eigen::Vector3f& point_m :
       PointsOfBars(2.5, {{0.4 + 0.7535, 0.072, 0.17}, {0.4 - 0.7535, 0.072, 0.17}})) {
    points.push_back(std::to_string(point_m.x()) + " " + std::to_string(point_m.y()) + " " +
                     std::to_string(point_m.z()));
  }
  const fs::path source = WriteReceived(folder.path() / "run", StraightRun(2, 20.0), points);
  const fs::path file =
      WritePlan(folder.path(), R"({"track": "found"})", "", VelodyneOfPlan() + kNamedRung);
  const InsertPlan plan = ReadInsertPlan(file, source);
  const MountSpec& mount = plan.scenario.lidar.mount;
  EXPECT_NEAR(mount.position_m[1], -0.4, 0.01);
  EXPECT_NEAR(mount.position_m[2], 2.33, 0.01);
  EXPECT_THAT(plan.remarks, Contains(StartsWith("the sensor is 2.3")));

  const std::string placed = R"("lidar": {"file": ")" RAILCAST_SOURCE_DIR
                             R"(/scenarios/sensors/vlp16.json", "mount": {"yaw_deg": 1}}, )";
  const fs::path both = WritePlan(folder.path(), R"({"track": "found"})", "", placed);
  EXPECT_THAT(MessageOf([&] { (void)ReadInsertPlan(both, source); }),
              HasSubstr("/lidar/mount: must be left out beside world.recording.track, which finds "
                        "it"));
}

TEST(InsertPlan, HasTheRungThatWhatIsPutInNeedsUnlessItNamesOne) {
  const TemporaryDirectory folder;
  const fs::path source = WriteReceived(folder.path() / "run", StraightRun(3, 0.0));
  const auto plan_with = [&](const std::string& keys) {
    return ReadInsertPlan(WritePlan(folder.path(), "{}", "", VelodyneOfPlan() + keys), source);
  };
  const auto begin = [](const InsertPlan& plan) { return plan.remarks.at(0).substr(0, 25); };
  const InsertPlan own = plan_with("");
  EXPECT_EQ(own.scenario.fidelity, Fidelity::kFootprint);
  EXPECT_EQ(own.remarks.at(0),
            "the rung is footprint, which edges, shadows, noise and texture of what is put in "
            "need: the plan's fidelity may say otherwise");
  EXPECT_THAT(own.identity.scenario_json, HasSubstr("\"fidelity\": \"footprint\""));
  for (const Fidelity rung : {Fidelity::kPlausibility, Fidelity::kSurface, Fidelity::kAuto}) {
    const InsertPlan named = plan_with("\"fidelity\": \"" + std::string(NameOf(rung)) + "\", ");
    EXPECT_EQ(named.scenario.fidelity, rung);
    EXPECT_NE(begin(named), "the rung is footprint, wh");
  }
  // Effects of the published model are of no other rung.
  const InsertPlan published = plan_with(R"("effects": {"rain": true}, )");
  EXPECT_EQ(published.scenario.fidelity, Fidelity::kPlausibility);
  EXPECT_EQ(begin(published), "the rung is plausibility,");
  EXPECT_EQ(plan_with(R"("effects": {"clutter": false}, )").scenario.fidelity,
            Fidelity::kFootprint);
}

TEST(InsertPlan, TheVehicleMovesAsRecorded) {
  const PlannedRun run("");
  ASSERT_EQ(run.message, "no error");
  const World& world = *run.plan.world;
  EXPECT_LT((world.WorldFromVehicle(1'250'000'000).translation() - Vector3(25, 0, 0)).norm(), 1e-9);
  EXPECT_EQ(world.HomeChunk(0), 0);
  EXPECT_EQ(world.HomeChunk(2'600'000'000), 1);
  EXPECT_LT((world.WorldFromChunk(1).translation() - Vector3(50, 0, 0)).norm(), 1e-9);
}

TEST(InsertPlan, ASensorThatStandsHasItsVehicleAtTheOrigin) {
  const TemporaryDirectory folder;
  fs::create_directories(folder.path() / "clouds");
  WriteReceived(folder.path() / "received", StraightRun(1, 0.0));
  for (const std::string name : {"0.pcd", "1.pcd"}) {
    fs::copy_file(folder.path() / "received/cloud.pcd", folder.path() / "clouds" / name);
  }
  const fs::path file =
      WritePlan(folder.path(), R"({"poses": "standing"})", Box(R"("s_m": -30, "d_m": 0, "h_m": 1)"),
                VelodyneOfPlan() + kNamedRung);
  const InsertPlan plan = ReadInsertPlan(file, folder.path() / "clouds");
  EXPECT_TRUE(plan.world->WorldFromVehicle(50'000'000).isApprox(Transform::Identity()));
  EXPECT_LT((plan.world->WorldFromObject(0, 0).translation() - Vector3(-30, 0, 1)).norm(), 1e-9);
  EXPECT_THAT(plan.frame_times_ns, ElementsAre(0, 100'000'000));
  EXPECT_THAT(plan.remarks,
              ElementsAre("the frames have no stamps: they are taken to be 1/10 s apart, as the "
                          "sensor's rate_hz says",
                          HasSubstr("intensities")));
}

TEST(InsertPlan, FindsLineGroundAndSensorOfASequence) {
  const TemporaryDirectory folder;
  const MadeSequence made = MakeSequence(folder.path() / "run", {.num_frames = 40});
  const fs::path file = WritePlan(
      folder.path(), "{}",
      R"(, "objects": [{"name": "box", "type": "box", "size_m": [0.5, 0.5, 0.5], "s_m": 30, )"
      R"("d_m": 4, "frame": 10}, {"name": "flag", "type": "box", "size_m": [1, 1, 1], "s_m": 50, )"
      R"("d_m": -2, "h_m": 1.5}])",
      kNamedRung);
  const InsertPlan plan = ReadInsertPlan(file, folder.path() / "run");
  const auto world = MakeWorld(made.scenario);
  const Vector3 flag = world->alignment().WorldFromTrack(300.0, -2.0, 1.5).translation();
  EXPECT_LT((plan.world->WorldFromObject(1, 0).translation() - flag).norm(), kSpline_m);
  ScenarioSpec with_box = made.scenario;
  ObjectSpec same_box;
  same_box.name = "box";
  same_box.s_m = 250.0 + 20.0 + 30.0;
  same_box.d_m = 4.0;
  same_box.size_m = {0.5, 0.5, 0.5};
  with_box.world.objects = {same_box};
  const Vector3 box = MakeWorld(with_box)->WorldFromObject(0, 0).translation();
  const Vector3 placed = plan.world->WorldFromObject(0, 0).translation();
  EXPECT_LT((placed - box).head<2>().norm(), kSpline_m);
  // The box of the scenario stands on the lowest of five places, and the ground's roughness is
  // 0.04 m.
  EXPECT_NEAR(placed.z(), box.z(), 0.1);
  EXPECT_EQ(plan.scenario.lidar, made.scenario.lidar);
  ASSERT_EQ(plan.remarks.size(), 3U);
  EXPECT_EQ(plan.remarks[0], "the sensor is Vir2Rail of the recording's scenario");
  EXPECT_THAT(plan.remarks[1], StartsWith("\"box\": stands on recorded ground "));
  // The recording has a wagon with the number 1.
  EXPECT_EQ(plan.world->objects()[0].instance, 2U);
  EXPECT_EQ(plan.world->objects()[1].instance, 3U);
  for (const std::int64_t time_ns : {0, 730'000'000}) {
    EXPECT_LT((plan.world->WorldFromVehicle(time_ns).translation() -
               world->WorldFromVehicle(time_ns).translation())
                  .norm(),
              0.002);
  }
}

TEST(InsertPlan, FollowsTheSlopeOfTheRecordedGround) {
  // Ground that rises by 1 in 10 to the left, 2.5 m below the sensor at the axis.
  std::vector<std::string> points;
  for (int i = 0; i < 40; ++i) {
    for (int k = 0; k < 40; ++k) {
      const double y = -2.0 + 0.1 * k;
      points.push_back(std::to_string(8.0 + 0.1 * i) + " " + std::to_string(y) + " " +
                       std::to_string(-2.5 + 0.1 * y));
    }
  }
  const TemporaryDirectory folder;
  const fs::path source = WriteReceived(folder.path() / "run", StraightRun(3, 0.0), points);
  const auto place = [&](const std::string& rest) {
    const fs::path file =
        WritePlan(folder.path(), "{}", Box(R"("s_m": 10, "d_m": 1)" + rest), VelodyneOfPlan());
    return ReadInsertPlan(file, source).world->WorldFromObject(0, 0);
  };
  const Transform upright = place("");
  EXPECT_LT((upright.translation() - Vector3(10.0, 1.0, 0.1)).norm(), 1e-3);
  EXPECT_TRUE(upright.linear().isIdentity(1e-9));
  const Vector3 up = place(R"(, "follow": "ground")").linear().col(2);
  EXPECT_LT((up - Vector3(0.0, -0.1, 1.0).normalized()).norm(), 1e-3);
}

TEST(InsertPlan, ThingsThatWaitStayOnTheirGroundUntilTheyGo) {
  // Ground that rises by 1 in 10 to the left.
  std::vector<std::string> points;
  for (int i = 0; i < 60; ++i) {
    for (int k = 0; k < 60; ++k) {
      const double y = -3.0 + 0.1 * k;
      points.push_back(std::to_string(7.0 + 0.1 * i) + " " + std::to_string(y) + " " +
                       std::to_string(-2.5 + 0.1 * y));
    }
  }
  const TemporaryDirectory folder;
  const fs::path source = WriteReceived(folder.path() / "run", StraightRun(30, 0.0), points);
  const fs::path file = WritePlan(
      folder.path(), "{}",
      Box(R"("s_m": 10, "d_m": 1.5, "motion": {"path": {"points": [)"
          R"({"s_m": 10, "d_m": -1.5}], "speed_mps": 2, "acceleration_mps2": 100, "start_s": 1.5}})"),
      VelodyneOfPlan());
  const InsertPlan plan = ReadInsertPlan(file, source);
  const auto height_m = [&](double time_s) {
    return plan.world->WorldFromObject(0, std::llround(time_s * 1e9)).translation().z();
  };
  EXPECT_NEAR(height_m(0.0), 0.15, 0.01);
  EXPECT_NEAR(height_m(1.4), 0.15, 0.01);
  EXPECT_NEAR(height_m(2.0), 0.05, 0.02);
}

TEST(InsertPlan, FindsTheGroundNearASensorThatLooksDown) {
  std::vector<std::string> points;
  for (int i = 0; i < 60; ++i) {
    for (int k = 0; k < 60; ++k) {
      points.push_back(std::to_string(-1.0 + 0.1 * i) + " " + std::to_string(-3.0 + 0.1 * k) +
                       " -2.4");
    }
  }
  const TemporaryDirectory folder;
  const fs::path source = WriteReceived(folder.path() / "run", StraightRun(3, 0.0), points);
  const fs::path file =
      WritePlan(folder.path(), "{}", Box(R"("s_m": 2, "d_m": 0)"), VelodyneOfPlan());
  const InsertPlan plan = ReadInsertPlan(file, source);
  ASSERT_TRUE(plan.places.at(0).has_ground);
  EXPECT_NEAR(plan.world->WorldFromObject(0, 0).translation().z(), 0.1, 1e-3);
}

TEST(InsertPlan, TakesARowOfPointsForNoGround) {
  std::vector<std::string> points;
  for (int i = 0; i < 60; ++i) points.push_back("10 " + std::to_string(0.1 * i - 3.0) + " -2.4");
  const TemporaryDirectory folder;
  const fs::path source = WriteReceived(folder.path() / "run", StraightRun(3, 0.0), points);
  const fs::path file =
      WritePlan(folder.path(), "{}", Box(R"("s_m": 10, "d_m": 0)"), VelodyneOfPlan());
  EXPECT_FALSE(ReadInsertPlan(file, source).places.at(0).has_ground);
}

TEST(InsertPlan, SaysWhereThingsWereAskedForAndWhereTheyAre) {
  const PlannedRun run(Box(R"("s_m": 120, "d_m": -1, "h_m": 0.5, "frame": 10)"));
  ASSERT_EQ(run.plan.places.size(), 1U);
  const PlacedThing& place = run.plan.places[0];
  EXPECT_EQ(place.asked, "frame 10, s_m 120, d_m -1, h_m 0.5");
  EXPECT_NEAR(place.s_m, 140.0, 1e-6);
  EXPECT_NEAR(place.d_m, -1.0, 1e-6);
  EXPECT_NEAR(place.h_m, 0.5, 1e-6);
  EXPECT_FALSE(place.is_on_ground);
}

TEST(InsertPlan, FindsTheSensorOfACaptureAndTheGroundAboutIt) {
  const fs::path capture = RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/vls128_single.pcap";
  if (!fs::exists(capture)) GTEST_SKIP() << "needs " << capture;
  const TemporaryDirectory folder;
  const fs::path file = WritePlan(folder.path(), R"({"poses": "standing"})",
                                  Box(R"("x_m": 8, "y_m": 0)"), kNamedRung);
  const InsertPlan plan = ReadInsertPlan(file, capture);
  EXPECT_EQ(plan.scenario.lidar.name, "VLS-128");
  EXPECT_EQ(plan.remarks.at(0),
            "the sensor is VLS-128, as the packets say, with its preset and 2.5 m above the rails: "
            "the plan's lidar may say otherwise");
  EXPECT_TRUE(plan.places.at(0).has_ground) << plan.remarks.at(1);
  EXPECT_LT(plan.places[0].ground_residual_m, 0.04);
  ASSERT_GT(plan.frame_times_ns.size(), 2U);
  const auto period_ns = static_cast<double>(plan.frame_times_ns[2] - plan.frame_times_ns[1]);
  EXPECT_NEAR(period_ns, 1e8, 5e6);
}

TEST(InsertPlan, SaysWhereNoGroundWasFound) {
  const PlannedRun run(Box(R"("s_m": 40, "d_m": 3)"));
  ASSERT_EQ(run.message, "no error");
  EXPECT_LT((run.PlaceOf(0) - Vector3(40.0, 3.0, 0.0)).norm(), 1e-6);
  EXPECT_THAT(run.plan.remarks,
              ElementsAre("\"box\": no recorded ground was found within 3 m of it; it stands in "
                          "the plane of the rails",
                          HasSubstr("intensities")));
}

TEST(InsertPlan, TakesALineThatIsGiven) {
  const std::string line =
      R"({"alignment": {"course": {"type": "elements", "elements": [)"
      R"({"type": "straight", "length_m": 900}]}, "origin_m": [-200, 1, 0.5]}})";
  const PlannedRun run(Box(R"("s_m": 260, "d_m": 2, "h_m": 0)"), line);
  ASSERT_EQ(run.message, "no error");
  EXPECT_LT((run.PlaceOf(0) - Vector3(60.0, 3.0, 0.5)).norm(), 1e-6);
  const PlannedRun ahead(Box(R"("s_m": 60, "frame": 10, "h_m": 0)"), line);
  EXPECT_LT((ahead.PlaceOf(0) - Vector3(80.0, 1.0, 0.5)).norm(), 1e-6);
  const PlannedRun far(Box(R"("s_m": 260)"),
                       R"({"alignment": {"course": {"type": "elements", "elements": [)"
                       R"({"type": "straight", "length_m": 900}]}, "origin_m": [0, 150, 0]}})");
  EXPECT_EQ(far.message,
            "run: frame 0: the vehicle must be within 100 m of the plan's alignment, in whose "
            "world the poses are (got 150 m)");
  const PlannedRun bad(Box(R"("s_m": 260)"),
                       R"({"alignment": {"course": {"type": "elements", "elements": [)"
                       R"({"type": "straight", "length_m": -3}]}}})");
  EXPECT_EQ(bad.message,
            "plan.json: /world/recording/alignment/course/elements/0/length_m: must be >= 0.001 "
            "and <= 10000000 (got -3)");
}

TEST(InsertPlan, ThePageShowsAPlanThatCanBeRead) {
  const fs::path root = RAILCAST_SOURCE_DIR;
  const std::string page = ReadFileWhole(root / "docs/insert.md");
  const std::string fence = "```json\n";
  const std::size_t begin = page.find(fence, page.find("## The plan")) + fence.size();
  const std::string text = page.substr(begin, page.find("```", begin) - begin);
  const ScenarioSpec plan = ReadScenarioText(text, root / "plan.json");
  EXPECT_TRUE(plan.world.recording.has_value());
  EXPECT_EQ(plan.world.objects.at(0).frame, 120U);
}

TEST(InsertPlan, NamesTheFaultsOfAPlanWhereTheUserWroteThem) {
  EXPECT_EQ(PlannedRun(Box(R"("s_m": 5, "frame": 30)")).message,
            "plan.json: /world/objects/0/frame: must be a frame of the recording, 0 to 29 (got "
            "30)");
  EXPECT_EQ(PlannedRun(Box(R"("s_m": 5000)")).message,
            "plan.json: /world/objects/0/s_m: must put it on the line, between chainage -1000 and "
            "1058 m (got 5000)");
  EXPECT_THAT(PlannedRun(Box(R"("s_m": 5, "colour": 3)")).message,
              StartsWith("plan.json: /world/objects/0/colour: unknown key, must be "));
  EXPECT_THAT(PlannedRun(Box(R"("s_m": 5, "label": "dragon")")).message,
              StartsWith("plan.json: /world/objects/0/label: unknown label"));
  EXPECT_EQ(PlannedRun(R"(, "vegetation": {"grass": false}, "detail": "full")").message,
            "plan.json: /world/vegetation: must be left out of a plan, whose world is a "
            "recording\nplan.json: /world/detail: must be left out of a plan, whose world is a "
            "recording");
  EXPECT_EQ(PlannedRun(R"(, "tracks": [{"name": "main"}, {"name": "siding", "offset_m": 5, )"
                       R"("start_s_m": 10}])")
                .message,
            "plan.json: /world/tracks/1: must have only name and offset_m beside a driven path; "
            "others need /world/recording/alignment (got \"siding\")");
  EXPECT_EQ(PlannedRun(Box(R"("longitude_deg": 5, "latitude_deg": 5, "frame": 3)")).message,
            "plan.json: /world/objects/0/frame: must not be given beside longitude_deg (got 3)");
}

TEST(InsertPlan, SaysWhatARecordingLacks) {
  const TemporaryDirectory folder;
  WriteReceived(folder.path() / "run", StraightRun(2, 20.0));
  fs::remove(folder.path() / "run/frames.csv");
  const fs::path clouds = folder.path() / "run";
  const fs::path file = WritePlan(folder.path(), "{}", "", VelodyneOfPlan());
  EXPECT_EQ(MessageOf([&] { (void)ReadInsertPlan(file, clouds); }),
            clouds.string() +
                ": pose: missing; /world/recording/poses of the plan must be "
                "\"standing\" or \"registered\"");
  const fs::path no_sensor = WritePlan(folder.path(), R"({"poses": "standing"})", "");
  EXPECT_EQ(MessageOf([&] { (void)ReadInsertPlan(no_sensor, clouds); }),
            no_sensor.string() +
                ": /lidar: missing: this recording does not say which sensor made it, and no "
                "spinning sensor is found: it has no field ring, and its elevations do not form "
                "rings; name a sensor's file, such as \"sensors/vlp16.json\" (got directory of "
                "point clouds)");
}

TEST(InsertPlan, IsNoScenarioNorTheOtherWayRound) {
  const TemporaryDirectory folder;
  const fs::path plan =
      WritePlan(folder.path(), "{}", Box(R"("s_m": 5, "frame": 1)"), VelodyneOfPlan());
  EXPECT_THAT(CheckScenario(plan),
              ElementsAre(plan.string() + ": /world/recording: must be left out: this is a plan "
                                          "for railcast-generate insert, not a scenario"));
  const MadeSequenceSpec spec{.object = R"({"name": "w", "type": "open_wagon", "s_m": 3, )"
                                        R"("frame": 4})"};
  const fs::path scenario = folder.path() / "scenario.json";
  WriteFileWhole(scenario, MadeScenario(spec));
  EXPECT_THAT(CheckScenario(scenario),
              ElementsAre(scenario.string() + ": /world/objects/0/frame: must be left out: only "
                                              "recordings have frames (got 4)"));
  WriteFileWhole(scenario, MadeScenario({}));
  EXPECT_EQ(
      MessageOf([&] { (void)ReadInsertPlan(scenario, folder.path()); }).substr(0, 120),
      (scenario.string() + ": /world/recording: missing\n" + scenario.string()).substr(0, 120));
}

}  // namespace
}  // namespace railcast
