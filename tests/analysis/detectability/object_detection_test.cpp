#include "analysis/detectability/object_detection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/detectability/approach.h"
#include "analysis/detectability/detect_report.h"
#include "tests/core/io/message_of.h"
#include "tests/core/rail/world/made_track.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// An approach from 100 m, 1 m nearer in each frame, with the given number of points in each frame.
ObjectCourse CourseOf(const std::vector<std::uint32_t>& points) {
  ObjectCourse course{.type = "person", .label = "person", .sightings = {}};
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    course.sightings.push_back({.frame = i,
                                .distance_m = 100.0 - i,
                                .points = points[i],
                                .speed_mps = 10.0,
                                .gradient = 0.0,
                                .approach_mps = 0.0});
  }
  return course;
}

ObjectDetection Detect(const ObjectCourse& course, const DetectionRule& rule = {}) {
  return DetectObject(course, rule, {}, std::nullopt);
}

TEST(Braking, IsTheReactionsWayAndTheBrakes) {
  // docs/physics.md 7.4: 25 km/h, 0.5 m/s^2, 2 s: 62 m; 40 km/h, 0.3: 228 m.
  EXPECT_NEAR(StopOf({}, 25.0 / 3.6, 0.0).distance_m, 62.1, 0.05);
  EXPECT_NEAR(StopOf({.deceleration_mps2 = 0.3}, 40.0 / 3.6, 0.0).distance_m, 228.0, 0.1);
  EXPECT_NEAR(StopOf({}, 10.0, 0.0).time_s, 22.0, 1e-12);
  EXPECT_EQ(StopOf({}, 0.0, 0.0).distance_m, 0.0);
}

TEST(Braking, TakesLongerDownhill) {
  // 10 permil change the deceleration by 0.0980665 m/s^2.
  EXPECT_NEAR(StopOf({}, 10.0, -0.01).distance_m, 20.0 + 50.0 / (0.5 - 0.0980665), 1e-9);
  EXPECT_NEAR(StopOf({}, 10.0, 0.01).distance_m, 20.0 + 50.0 / (0.5 + 0.0980665), 1e-9);
}

TEST(Braking, SaysWhereATrainCannotStop) {
  EXPECT_EQ(
      MessageOf([] { (void)StopOf({}, 10.0, -0.1); }),
      "cannot stop: deceleration + g x gradient must be > 0 (got -0.481 m/s2 at -100 permil)");
}

TEST(DistanceToBox, IsThatOfItsNearestPoint) {
  const Vector3 size_m(4.0, 2.0, 2.0);
  EXPECT_EQ(DistanceToBox({5.0, 0.5, 0.0}, size_m), 3.0);
  EXPECT_EQ(DistanceToBox({5.0, 5.0, 0.0}, size_m), 5.0);
  EXPECT_EQ(DistanceToBox({-1.0, 0.0, 0.9}, size_m), 0.0);
}

TEST(ObjectDetection, ComesWithTheFrameThatCompletesTheRule) {
  // Frames 2, 4 and 6 have enough points; the third of them is within five frames.
  const ObjectDetection detection = Detect(CourseOf({0, 4, 5, 0, 9, 4, 5, 0, 0, 0}));
  EXPECT_EQ(detection.fate, Fate::kDetected);
  EXPECT_EQ(detection.distance_m, 94.0);
  EXPECT_EQ(detection.frame, 6U);
  EXPECT_EQ(detection.missed_frame, 5U);
  EXPECT_FALSE(detection.is_from_start);
  EXPECT_EQ(detection.speed_mps, 10.0);
  EXPECT_EQ(detection.stop_m, 120.0);
  EXPECT_EQ(detection.needed_m, 135.0);
  EXPECT_EQ(detection.spare_m(), -41.0);
  EXPECT_FALSE(detection.is_in_time());
}

TEST(ObjectDetection, KnowsTheLastFrameWithTooFewPoints) {
  const ObjectDetection never = Detect(CourseOf({5, 0, 0, 5, 0, 5}));
  EXPECT_EQ(never.frame, std::nullopt);
  EXPECT_EQ(never.missed_frame, 4U);
  const ObjectDetection at_once = Detect(CourseOf({5, 5, 5, 0}));
  EXPECT_EQ(at_once.frame, 2U);
  EXPECT_EQ(at_once.missed_frame, std::nullopt);
}

TEST(ObjectDetection, NeedsItsFramesTogether) {
  // Never three frames of five.
  EXPECT_EQ(Detect(CourseOf({5, 0, 0, 5, 0, 0, 5, 0, 0, 5, 0})).fate, Fate::kNeverDetected);
  // A rule other than the default.
  const DetectionRule one{.min_points = 9, .min_frames = 1, .of_frames = 1};
  EXPECT_EQ(Detect(CourseOf({0, 8, 0, 9, 9}), one).distance_m, 97.0);
}

TEST(ObjectDetection, CountsFramesOutOfRangeAsEmpty) {
  ObjectCourse course = CourseOf({9, 9, 9, 9});
  // Between them the object was hidden or out of range: the frames are 0, 1, 6 and 7.
  course.sightings[2].frame = 6;
  course.sightings[3].frame = 7;
  EXPECT_EQ(Detect(course).fate, Fate::kNeverDetected);
}

TEST(ObjectDetection, SaysIfTheRunBeganTooNear) {
  EXPECT_TRUE(Detect(CourseOf({7, 7, 7, 7})).is_from_start);
  ObjectCourse entering = CourseOf({7, 7, 7, 7});
  for (Sighting& sighting : entering.sightings) sighting.frame += 20;
  // The object came into range and was detected at once, so its distance is the limit of this
  // sensor.
  EXPECT_FALSE(Detect(entering).is_from_start);
}

TEST(ObjectDetection, EndsAtTheClosestPoint) {
  ObjectCourse course = CourseOf({0, 0, 0, 0, 0, 0, 0, 9, 9, 9, 9, 9});
  // The object is passed in frame 8 and seen behind the vehicle afterwards.
  for (std::uint32_t i = 9; i < 12; ++i) course.sightings[i].distance_m = 92.0 + i;
  EXPECT_EQ(Detect(course).fate, Fate::kNeverDetected);
}

TEST(ObjectDetection, IsOfWhatIsApproached) {
  ObjectCourse away = CourseOf({9, 9, 9, 9, 9});
  for (Sighting& sighting : away.sightings) sighting.distance_m = 200.0 - sighting.distance_m;
  EXPECT_EQ(Detect(away).fate, Fate::kNeverApproached);
  ObjectCourse standing = CourseOf({9, 9, 9, 9, 9});
  for (Sighting& sighting : standing.sightings) sighting.distance_m = 50.0;
  EXPECT_EQ(Detect(standing).fate, Fate::kNeverApproached);
  EXPECT_EQ(Detect({}).fate, Fate::kNeverApproached);
  EXPECT_TRUE(std::isnan(Detect({}).distance_m));
}

TEST(ObjectDetection, AddsTheWayOfWhatComesTowardsUs) {
  ObjectCourse oncoming = CourseOf({9, 9, 9, 9});
  for (Sighting& sighting : oncoming.sightings) sighting.approach_mps = 3.0;
  // The train takes 22 s to stop.
  EXPECT_EQ(Detect(oncoming).needed_m, 135.0 + 66.0);
  for (Sighting& sighting : oncoming.sightings) sighting.approach_mps = -3.0;
  EXPECT_EQ(Detect(oncoming).needed_m, 135.0);
}

TEST(ObjectDetection, TakesTheSpeedThatIsGiven) {
  const ObjectDetection detection = DetectObject(CourseOf({9, 9, 9}), {}, {.margin_m = 5.0}, 2.0);
  EXPECT_EQ(detection.speed_mps, 2.0);
  EXPECT_EQ(detection.needed_m, 4.0 + 4.0 + 5.0);
  EXPECT_TRUE(detection.is_in_time());
}

/// A frame at chainage x of a track that rises 1 in 50, at 20 m/s, with an object 100 m ahead.
RecordedFrame MadeFrame(double x) {
  RecordedFrame recorded;
  const double pitch_rad = -std::atan(0.02);
  recorded.frame.world_from_sensor =
      MakeTransform(RotationFromYawPitchRoll(0.3, pitch_rad, 0.0), Vector3(x, 0.0, 0.0));
  recorded.frame.world_from_sensor_end = recorded.frame.world_from_sensor;
  recorded.frame.world_from_sensor_end.translate(Vector3(2.0, 0.0, 0.0));
  recorded.frame.duration_ns = 100'000'000;
  RecordedObject object{.name = "wagon", .type = "open_wagon", .label = "wagon"};
  object.size_m = Vector3(10.0, 3.0, 3.0);
  object.sensor_from_box.translation() = Vector3(100.0, 0.0, 0.0);
  object.velocity_world_mps = recorded.frame.world_from_sensor.linear() * Vector3(-4.0, 3.0, 0.0);
  object.points = 12;
  recorded.objects = {object};
  return recorded;
}

TEST(Approach, TakesSpeedAndGradientFromThePoses) {
  RunCourses courses;
  AddFrame(MadeFrame(0.0), Transform::Identity(), StraightTrack(), courses);
  AddFrame(MadeFrame(2.0), Transform::Identity(), StraightTrack(), courses);
  EXPECT_EQ(courses.num_frames, 2U);
  const ObjectCourse& course = courses.objects.at("wagon");
  ASSERT_EQ(course.sightings.size(), 2U);
  const Sighting& sighting = course.sightings[1];
  EXPECT_EQ(sighting.frame, 1U);
  EXPECT_NEAR(sighting.distance_m, 95.0, 1e-9);
  EXPECT_EQ(sighting.points, 12U);
  EXPECT_NEAR(sighting.speed_mps, 20.0, 1e-9);
  EXPECT_NEAR(sighting.gradient, 0.02, 1e-12);
  EXPECT_NEAR(sighting.approach_mps, 4.0, 1e-9);
}

TEST(Approach, KnowsHowTheSensorIsMounted) {
  RecordedFrame recorded = MadeFrame(0.0);
  const Transform vehicle_from_sensor =
      MakeTransform(RotationFromYawPitchRoll(0.4, 0.1, 0.0), Vector3(2.0, 0.0, 2.5));
  recorded.frame.world_from_sensor = recorded.frame.world_from_sensor * vehicle_from_sensor;
  recorded.frame.world_from_sensor_end = recorded.frame.world_from_sensor_end * vehicle_from_sensor;
  RunCourses courses;
  AddFrame(recorded, vehicle_from_sensor, StraightTrack(), courses);
  EXPECT_NEAR(courses.objects.at("wagon").sightings[0].gradient, 0.02, 1e-12);
  EXPECT_NEAR(courses.objects.at("wagon").sightings[0].speed_mps, 20.0, 1e-9);
}

RecordingInfo RunOf(Fidelity fidelity) {
  RecordingInfo run;
  run.scenario.emplace().fidelity = fidelity;
  run.origin.emplace();
  return run;
}

TEST(RungUsed, WarnsOfOneRayPerBeam) {
  for (const Fidelity rung : {Fidelity::kGeometry, Fidelity::kPlausibility, Fidelity::kSurface}) {
    const RungUsed used = RungOf({RunOf(rung)});
    EXPECT_EQ(used.InWords(), std::string(NameOf(rung)) + ": one ray per beam");
    EXPECT_THAT(used.Warning(), HasSubstr("sends one ray into each beam"));
    EXPECT_THAT(used.Warning(), HasSubstr("0.62 of the reference's points at 100 m"));
  }
  for (const Fidelity rung : {Fidelity::kFootprint, Fidelity::kReference}) {
    const RungUsed used = RungOf({RunOf(rung)});
    EXPECT_EQ(used.InWords(), std::string(NameOf(rung)) + ": beams with a width");
    EXPECT_THAT(used.Warning(), IsEmpty());
  }
}

TEST(RungUsed, GoesByTheEffectsThatAreOn) {
  RecordingInfo narrowed = RunOf(Fidelity::kFootprint);
  narrowed.scenario->effects["footprint"] = false;
  EXPECT_EQ(RungOf({narrowed}).InWords(), "footprint: one ray per beam");
  RecordingInfo widened = RunOf(Fidelity::kSurface);
  widened.scenario->effects["footprint"] = true;
  EXPECT_EQ(RungOf({widened}).InWords(), "surface: beams with a width");
}

TEST(RungUsed, GoesByWhatAutoChoseInEveryRun) {
  RecordingInfo wide = RunOf(Fidelity::kAuto);
  wide.origin->chosen_effects = {"surface_response", "footprint"};
  RecordingInfo narrow = RunOf(Fidelity::kAuto);
  narrow.origin->chosen_effects = {"surface_response"};
  EXPECT_EQ(RungOf({wide, wide}).InWords(), "auto: beams with a width");
  EXPECT_EQ(RungOf({wide, narrow, wide}).InWords(), "auto: one ray per beam");
  const RungUsed unknown = RungOf({wide, RunOf(Fidelity::kAuto)});
  EXPECT_EQ(unknown.InWords(),
            "auto: not known what was chosen, as a run is unfinished or its clouds are merged");
  EXPECT_THAT(unknown.Warning(), HasSubstr("If the rung that was chosen"));
  RecordingInfo merged = RunOf(Fidelity::kAuto);
  merged.origin.reset();
  EXPECT_EQ(RungOf({merged}).InWords(), unknown.InWords());
}

TEST(RungUsed, StandsWithItsWarningBeforeTheVerdicts) {
  const auto report_of = [](Fidelity rung) {
    return MakeDetectReport({DetectInRun("run", 1, {}, {})}, {}, "railcast-analyze detect", {},
                            RungOf({RunOf(rung)}));
  };
  const Report surface = report_of(Fidelity::kSurface);
  EXPECT_EQ(surface.facts.back().second, "surface: one ray per beam");
  EXPECT_THAT(surface.sections.front().paragraphs.back(), HasSubstr("Use footprint"));
  const Report footprint = report_of(Fidelity::kFootprint);
  for (const std::string& text : footprint.sections.front().paragraphs) {
    EXPECT_THAT(text, testing::Not(HasSubstr("Use footprint")));
  }
}

}  // namespace
}  // namespace railcast
