#include "viewer/composition/composer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "tests/analysis/recorded_frames.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/viewer/composition/shared_clouds.h"
#include "tests/viewer/made_run.h"
#include "viewer/overlays/overlays.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

RecordingInfo LabelledInfo() {
  RecordingInfo info;
  info.labels = ExampleLabels();
  return info;
}

/// A sequence from a moving vehicle, with the latest frame first.
struct MovingRun {
  TemporaryDirectory directory;
  RecordingInfo info;
  ShownFrames frames;

  explicit MovingRun(const std::string& fidelity = "plausibility") {
    MakeRun(directory.path() / "run", fidelity);
    const auto recording = OpenRecording(directory.path() / "run");
    info = recording->info();
    for (RecordedFrame& recorded : ReadAll(*recording)) {
      frames.insert(frames.begin(), Shared(std::move(recorded)));
    }
  }
};

/// Returns the distance of a point from a box's surface.
double DistanceToSurface_m(const Vector3& point_m, const Eigen::AlignedBox3d& box) {
  const double outside_m = box.exteriorDistance(point_m);
  if (outside_m > 0.0) return outside_m;
  return std::min((point_m - box.min()).minCoeff(), (box.max() - point_m).minCoeff());
}

Eigen::AlignedBox3d BoundsOf(const Model& model) {
  Eigen::AlignedBox3d box;
  for (const Part& part : model.parts) {
    for (const auto& vertex : part.mesh.vertices) box.extend(vertex.cast<double>().eval());
  }
  return box;
}

// A scan takes 0.1 s, and a = v^2 / r = 0.8 m/s^2. Poses within the scan are interpolated linearly,
// which is off the true path by a dt^2 / 8 = 1 mm. Rounding of float32 at 50 m is 4 um.
constexpr double kMotionTolerance_m = 1.2e-3;

TEST(Compose, PutsWhatStandsInOnePlaceFromAMovingVehiclesFrames) {
  const MovingRun run("geometry");
  Composer composer(run.info);
  const Composition composition = composer.Compose(run.frames, By("label"));
  ASSERT_THAT(composition.clouds, SizeIs(kRunFrames));
  EXPECT_TRUE(composition.clouds[0].view_from_sensor.isApprox(Transform::Identity(), 0.0));
  const auto world = MakeWorld(*run.info.scenario);
  const Frame& latest = run.frames[0]->frame();
  const Transform crate_from_view =
      world->WorldFromObject(0, latest.stamp_ns).inverse() * latest.world_from_sensor;
  const Eigen::AlignedBox3d crate = BoundsOf(*world->objects()[0].model);
  for (const PlacedCloud& cloud : composition.clouds) {
    const Frame& frame = cloud.shown->frame();
    std::size_t num_points = 0;
    for (std::size_t i = 0; i < cloud.shown->num_points(); ++i) {
      if (frame.instance[cloud.shown->slots[i]] != world->objects()[0].instance) continue;
      ++num_points;
      const Eigen::Map<const Eigen::Vector3f> seen_m(&cloud.shown->positions_m[3 * i]);
      const Vector3 place_m = crate_from_view * cloud.view_from_sensor * seen_m.cast<double>();
      ASSERT_NEAR(DistanceToSurface_m(place_m, crate), 0.0, kMotionTolerance_m) << frame.index;
    }
    EXPECT_GT(num_points, 100U) << "of frame " << frame.index;
  }
}

TEST(Compose, LeavesOutEarlierFramesWithoutPoses) {
  const auto posed = Posed({{1, 2, 3}}, Transform::Identity());
  const auto earlier = Posed({{1, 2, 3}}, MakeTransform(Eigen::Matrix3d::Identity(), {-1, 0, 0}));
  const auto bare = SharedCloud({{4, 5, 6}});
  Composer composer{RecordingInfo{}};
  const auto shown_of = [&](const ShownFrames& frames) {
    ShownFrames shown;
    for (const auto& cloud : composer.Compose(frames, By("height")).clouds) {
      shown.push_back(cloud.shown);
    }
    return shown;
  };
  EXPECT_THAT(shown_of({posed, bare, earlier}), ElementsAre(posed, earlier));
  EXPECT_THAT(shown_of({bare, posed, earlier}), ElementsAre(bare));
}

TEST(Compose, HasALegendOfTheFrameAndLabelsOfTheRecording) {
  Composer composer(LabelledInfo());
  const Composition composition = composer.Compose({LabelledCloud()}, By("label"));
  ASSERT_THAT(composition.coloring.categories, SizeIs(3));
  EXPECT_EQ(composition.coloring.categories[1].name, "rail");
  ASSERT_THAT(composition.clouds, SizeIs(1));
  const Rgb unlabelled = composition.coloring.categories[0].rgb;
  EXPECT_THAT(composition.clouds[0].colors,
              ElementsAre(Rgb{230, 159, 0}, Rgb{213, 94, 0}, unlabelled));
  EXPECT_EQ(composition.labels.labels(), ExampleLabels().labels());
  const Composition none = composer.Compose({}, By("label"));
  EXPECT_THAT(none.clouds, IsEmpty());
  EXPECT_EQ(none.labels.labels(), ExampleLabels().labels());
}

TEST(Compose, MakesAllButTheLabelsSelectedFaint) {
  Composer composer(LabelledInfo());
  Choices choices = By("label");
  const Composition all = composer.Compose({LabelledCloud()}, choices);
  EXPECT_THAT(all.clouds[0].is_faint, IsEmpty());
  choices.labels = {12};
  const Composition selected = composer.Compose({LabelledCloud()}, choices);
  EXPECT_EQ(selected.clouds[0].colors, all.clouds[0].colors);
  EXPECT_THAT(selected.clouds[0].is_faint, ElementsAre(true, false, true));
}

TEST(Compose, KeepsTheScaleThatIsChosen) {
  Composer composer{RecordingInfo{}};
  Choices choices = By("height");
  choices.ends = {{0.0, 6.0}};
  choices.map = ColorMap::kMagma;
  const Composition composition = composer.Compose({SharedCloud({{1, 2, 3}, {4, 5, 6}})}, choices);
  EXPECT_EQ(composition.coloring.ends, choices.ends);
  EXPECT_EQ(composition.coloring.map, ColorMap::kMagma);
  EXPECT_EQ(composition.clouds[0].colors[1], MapColor(ColorMap::kMagma, 1.0));
}

TEST(Compose, TakesAMapOfTwoEndsForDifferencesAlone) {
  Composer composer{RecordingInfo{}};
  const auto shown = Shared(Record(ExampleFrame(3)));
  EXPECT_EQ(composer.Compose({shown}, By("noise")).coloring.map, ColorMap::kCoolwarm);
  EXPECT_EQ(composer.Compose({shown}, By("range")).coloring.map, ColorMap::kViridis);
}

TEST(Compose, SaysWhichFileLacksTheField) {
  Composer composer{RecordingInfo{}};
  EXPECT_EQ(MessageOf([&] {
              (void)composer.Compose({SharedCloud({{1, 2, 3}})}, By("power"));
            }),
            "a.pcd: has no field power to color by (has: range, height, x, y)");
}

TEST(Compose, ShowsEveryFiringThatBroughtNothingBack) {
  const MovingRun run;
  Composer composer(run.info);
  Choices choices = By("label");
  EXPECT_THAT(composer.Compose({run.frames[0]}, choices).empty_beams.segments, IsEmpty());
  choices.empty_beams = true;
  const Composition composition = composer.Compose({run.frames[0]}, choices);
  EXPECT_THAT(composition.empty_beams.segments, Not(IsEmpty()));
  std::size_t num_empty = 0;
  for (const Category& kind : composition.beam_kinds) {
    EXPECT_EQ(kind.name.rfind("no return: ", 0), 0U) << kind.name;
    num_empty += kind.num_points;
  }
  EXPECT_EQ(num_empty + run.frames[0]->num_points(), run.frames[0]->frame().num_slots());
  EXPECT_GT(num_empty, 0U);
}

TEST(Compose, DrawsEachOverlayThatIsChosen) {
  const MovingRun run;
  Composer composer(run.info);
  const auto segments_with = [&](bool OverlayChoices::*overlay) {
    Choices choices = By("label");
    choices.overlays.*overlay = true;
    EXPECT_EQ(composer.Missing(*run.frames[0], choices), "");
    const Composition composition = composer.Compose({run.frames[0]}, choices);
    return std::pair(composition.overlays.segments.size(), composition.surfaces.size());
  };
  EXPECT_EQ(composer.Compose({run.frames[0]}, By("label")).overlays.segments.size(), 0U);
  EXPECT_GE(segments_with(&OverlayChoices::boxes).first, 12U) << "the edges of one box";
  for (const auto overlay :
       {&OverlayChoices::track, &OverlayChoices::gauge, &OverlayChoices::frustum,
        &OverlayChoices::axes, &OverlayChoices::rings}) {
    EXPECT_GT(segments_with(overlay).first, 0U);
    EXPECT_EQ(segments_with(overlay).second, 0U);
  }
  EXPECT_EQ(segments_with(&OverlayChoices::mesh), std::pair(std::size_t{0}, std::size_t{2}));
}

TEST(Compose, SaysWhatCannotBeDrawnAndWhy) {
  const MovingRun run;
  const auto bare = SharedCloud({{1, 2, 3}});
  const Composer without_scenario{RecordingInfo{}};
  const Composer with_scenario(run.info);
  for (const auto overlay :
       {&OverlayChoices::track, &OverlayChoices::gauge, &OverlayChoices::mesh}) {
    Choices choices;
    choices.overlays.*overlay = true;
    EXPECT_EQ(without_scenario.Missing(*bare, choices),
              overlay == &OverlayChoices::track
                  ? "no track is found: no ground is seen"
                  : "gauge and surfaces need the scenario, which is not known");
    EXPECT_EQ(with_scenario.Missing(*bare, choices),
              "track, gauge and surfaces need the sensor's pose, which is not known");
  }
  EXPECT_EQ(without_scenario.Missing(*bare, {.overlays = {.boxes = true}}),
            "boxes need a sequence's objects, or a scenario and poses");
  EXPECT_EQ(with_scenario.Missing(*bare, {.overlays = {.boxes = true}}), "") << "it may show none";
  EXPECT_EQ(without_scenario.Missing(*bare, {.empty_beams = true}),
            "beams without return need a frame in which every firing has its place");
  EXPECT_EQ(without_scenario.Missing(*bare, {.overlays = {.axes = true, .rings = true}}), "");
}

TEST(Compose, AimsEmptyBeamsAsTheFrameOfASensorThatDoesNotRepeat) {
  const TemporaryDirectory directory;
  static_cast<void>(
      MakeSequence(directory.path() / "run",
                   {.sensor = "mid40_like", .start_frame = kRunBegins, .num_frames = 1}));
  const auto recording = OpenRecording(directory.path() / "run");
  const std::vector<RecordedFrame> recorded = ReadAll(*recording);
  Composer composer(recording->info());
  Choices choices = By("height");
  choices.empty_beams = true;
  const auto shown = Shared(RecordedFrame(recorded.at(0)));
  const auto drawn = composer.Compose({shown}, choices).empty_beams.segments;
  const ScanPattern first = BuildScanPattern(recording->info().scenario->lidar.scan);
  const auto expected =
      DrawEmptyBeams(recorded[0], BeamsOf(PatternOfFrame(first, kRunBegins))).segments;
  const auto others = DrawEmptyBeams(recorded[0], BeamsOf(first)).segments;
  ASSERT_EQ(drawn.size(), expected.size());
  ASSERT_GT(drawn.size(), 100U);
  for (std::size_t i = 0; i < drawn.size(); ++i) ASSERT_EQ(drawn[i].to_m, expected[i].to_m);
  EXPECT_NE(drawn[50].to_m, others[50].to_m);
  choices.overlays.frustum = true;
  EXPECT_EQ(composer.Missing(*shown, choices),
            "the frustum needs a sensor whose firings are a grid");
}

TEST(Compose, KnowsThatMergedCloudsHaveNoSingleSensor) {
  MovingRun run;
  const Choices choices = [] {
    Choices with = By("label");
    with.overlays.frustum = true;
    return with;
  }();
  EXPECT_FALSE(Composer(run.info).Compose({run.frames[0]}, choices).is_origin_on_rails);
  run.info.kind = "merged clouds";
  Composer composer(run.info);
  EXPECT_EQ(composer.Missing(*run.frames[0], choices),
            "the frustum needs the frames of one sensor, and these are of several");
  const Composition composition = composer.Compose({run.frames[0]}, choices);
  EXPECT_TRUE(composition.is_origin_on_rails);
  EXPECT_THAT(composition.overlays.segments, IsEmpty());
}

TEST(Compose, LeavesOutOverlaysThatCannotBeDrawn) {
  Composer composer{RecordingInfo{}};
  Choices choices = By("height");
  choices.overlays = {.mesh = true, .boxes = true, .track = true, .gauge = true};
  const Composition composition = composer.Compose({SharedCloud({{1, 2, 3}})}, choices);
  EXPECT_THAT(composition.overlays.segments, IsEmpty());
  EXPECT_THAT(composition.surfaces, IsEmpty());
}

}  // namespace
}  // namespace railcast
