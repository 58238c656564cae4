#include "viewer/scene/compose.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/rail/rail_world.h"
#include "core/scenario/scenario.h"
#include "tests/analysis/recorded_frames.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/viewer/made_run.h"
#include "tests/viewer/pick/shown_cloud.h"
#include "viewer/color/field_values.h"

namespace railcast {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

std::shared_ptr<const ShownFrame> Shared(RecordedFrame recorded) {
  return std::make_shared<const ShownFrame>(MakeShownFrame(std::move(recorded)));
}

std::shared_ptr<const ShownFrame> SharedCloud(const std::vector<Vector3>& points_m) {
  return Shared(RecordedCloud("a.pcd", points_m));
}

/// Points of the labels 1, 12 and 0.
std::shared_ptr<const ShownFrame> LabelledCloud() {
  RecordedFrame recorded = RecordedCloud("a.pcd", {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}});
  recorded.fields.emplace("label");
  recorded.frame.label = {1, 12, 0};
  return Shared(std::move(recorded));
}

/// Places in the world, seen from there.
std::shared_ptr<const ShownFrame> Posed(const std::vector<Vector3>& points_world_m,
                                        const Transform& world_from_sensor) {
  std::vector<Vector3> points_m;
  for (const Vector3& point_m : points_world_m) {
    points_m.push_back(world_from_sensor.inverse() * point_m);
  }
  RecordedFrame recorded = RecordedCloud("a.pcd", points_m);
  recorded.has_pose = true;
  recorded.frame.world_from_sensor = world_from_sensor;
  return Shared(std::move(recorded));
}

RecordingInfo LabelledInfo() {
  RecordingInfo info;
  info.labels = ExampleLabels();
  return info;
}

Choices By(const std::string& field) {
  return {.color_by = field};
}

/// A sequence of a moving vehicle, its latest frame first.
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

/// How far a point is from a box's surface.
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

// A scan is 0.1 s long and a = v^2 / r = 0.8 m/s^2. Where it was between is interpolated linearly:
// a dt^2 / 8 = 1 mm beside its way. float32 at 50 m is 4 um.
constexpr double kMotionTolerance_m = 1.2e-3;

TEST(Compose, PutsWhatStandsInOnePlaceFromAMovingVehiclesFrames) {
  const MovingRun run("geometry");
  Composer composer(run.info);
  const Scene scene = composer.Compose(run.frames, By("label"));
  ASSERT_THAT(scene.clouds, SizeIs(kRunFrames));
  EXPECT_TRUE(scene.clouds[0].view_from_sensor.isApprox(Transform::Identity(), 0.0));
  const auto world = MakeWorld(*run.info.scenario);
  const Frame& latest = run.frames[0]->frame();
  const Transform crate_from_view =
      world->WorldFromObject(0, latest.stamp_ns).inverse() * latest.world_from_sensor;
  const Eigen::AlignedBox3d crate = BoundsOf(*world->objects()[0].model);
  for (const PlacedCloud& cloud : scene.clouds) {
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
  const Scene scene = composer.Compose({LabelledCloud()}, By("label"));
  ASSERT_THAT(scene.coloring.categories, SizeIs(3));
  EXPECT_EQ(scene.coloring.categories[1].name, "rail");
  ASSERT_THAT(scene.clouds, SizeIs(1));
  const Rgb unlabelled = scene.coloring.categories[0].rgb;
  EXPECT_THAT(scene.clouds[0].colors, ElementsAre(Rgb{230, 159, 0}, Rgb{213, 94, 0}, unlabelled));
  EXPECT_EQ(scene.labels.labels(), ExampleLabels().labels());
  const Scene none = composer.Compose({}, By("label"));
  EXPECT_THAT(none.clouds, IsEmpty());
  EXPECT_EQ(none.labels.labels(), ExampleLabels().labels());
}

TEST(Compose, MakesAllButTheLabelsSelectedFaint) {
  Composer composer(LabelledInfo());
  Choices choices = By("label");
  const auto all = composer.Compose({LabelledCloud()}, choices).clouds[0].colors;
  choices.labels = {12};
  const auto selected = composer.Compose({LabelledCloud()}, choices).clouds[0].colors;
  ASSERT_THAT(selected, SizeIs(3));
  EXPECT_EQ(selected[1], all[1]);
  for (const std::size_t faint : {std::size_t{0}, std::size_t{2}}) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      // Five parts of grey and one of its own.
      EXPECT_EQ(selected[faint][channel], (all[faint][channel] + 5 * 60) / 6);
    }
  }
}

TEST(Compose, KeepsTheScaleThatIsChosen) {
  Composer composer{RecordingInfo{}};
  Choices choices = By("height");
  choices.ends = {{0.0, 6.0}};
  choices.map = ColorMap::kMagma;
  const Scene scene = composer.Compose({SharedCloud({{1, 2, 3}, {4, 5, 6}})}, choices);
  EXPECT_EQ(scene.coloring.ends, choices.ends);
  EXPECT_EQ(scene.coloring.map, ColorMap::kMagma);
  EXPECT_EQ(scene.clouds[0].colors[1], MapColor(ColorMap::kMagma, 1.0));
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
  const Scene scene = composer.Compose({run.frames[0]}, choices);
  EXPECT_THAT(scene.empty_beams.segments, Not(IsEmpty()));
  std::size_t num_empty = 0;
  for (const Category& kind : scene.beam_kinds) {
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
    const Scene scene = composer.Compose({run.frames[0]}, choices);
    return std::pair(scene.overlays.segments.size(), scene.surfaces.size());
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
              "track, gauge and surfaces need the scenario, which is not known");
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

TEST(Compose, LeavesOutOverlaysThatCannotBeDrawn) {
  Composer composer{RecordingInfo{}};
  Choices choices = By("height");
  choices.overlays = {.mesh = true, .boxes = true, .track = true, .gauge = true};
  const Scene scene = composer.Compose({SharedCloud({{1, 2, 3}})}, choices);
  EXPECT_THAT(scene.overlays.segments, IsEmpty());
  EXPECT_THAT(scene.surfaces, IsEmpty());
}

TEST(FitChoices, FillsInTheFieldAndTheEndsOfItsScale) {
  Choices by_height;
  FitChoices(*SharedCloud({{1, 2, 3}, {1, 2, 5}}), by_height);
  EXPECT_EQ(by_height.color_by, "height");
  EXPECT_EQ(by_height.ends, (std::array{3.0, 5.0}));
  Choices by_label;
  FitChoices(*LabelledCloud(), by_label);
  EXPECT_EQ(by_label.color_by, "label");
  EXPECT_EQ(by_label.ends, std::nullopt);
}

TEST(FitChoices, KeepsWhatIsChosen) {
  Choices choices = By("range");
  choices.ends = {{2.0, 90.0}};
  FitChoices(*LabelledCloud(), choices);
  EXPECT_EQ(choices.color_by, "range");
  EXPECT_EQ(choices.ends, (std::array{2.0, 90.0}));
}

TEST(FitChoices, RefusesWhatCannotBeDone) {
  const auto fault = [](const ShownFrame& shown, Choices choices) {
    return MessageOf([&] { FitChoices(shown, choices); });
  };
  const auto bare = SharedCloud({{1, 2, 3}});
  EXPECT_EQ(fault(*bare, By("power")),
            "a.pcd: has no field power to color by (has: range, height, x, y)");
  EXPECT_EQ(fault(*bare, {.color_by = "height", .labels = {12}}),
            "a.pcd: has no field label to select by");
  EXPECT_EQ(fault(*LabelledCloud(), {.color_by = "label", .ends = {{0.0, 1.0}}}),
            "a.pcd: field label has no scale with a range");
}

/// So far apart that each is nearest to itself however it is shifted.
const std::vector<Vector3> sparse_world_m = {{100, 0, 0}, {110, 0, 0}, {100, 10, 0}, {100, 0, 20}};

TEST(ComposeDistances, LaysTheSecondWhereItWasInTheFirstsAxes) {
  const Transform first = MakeTransform(RotationFromYawPitchRoll(0.3, 0.0, 0.0), {60, 0, 0});
  const Transform second = MakeTransform(RotationFromYawPitchRoll(-1.2, 0.1, 0.0), {90, 5, 1});
  const auto a = Posed(sparse_world_m, first);
  const auto b = Posed(sparse_world_m, second);
  Choices choices;
  choices.distance_ends_m = {{0.0, 1.0}};
  const Scene scene = ComposeDistances(a, b, choices);
  ASSERT_THAT(scene.clouds, SizeIs(2));
  EXPECT_EQ(scene.clouds[0].shown, a);
  EXPECT_EQ(scene.clouds[1].shown, b);
  EXPECT_TRUE(scene.clouds[0].view_from_sensor.isApprox(Transform::Identity(), 0.0));
  // Products of doubles of some 100 m.
  EXPECT_TRUE(scene.clouds[1].view_from_sensor.isApprox(first.inverse() * second, 1e-13));
  EXPECT_EQ(scene.coloring.title, "to the other's nearest point [m]");
  // The same places: float32 at 50 m is 4 um, a step of colours 1 mm.
  for (const PlacedCloud& cloud : scene.clouds) {
    EXPECT_THAT(cloud.colors, Each(MapColor(ColorMap::kViridis, 0.0)));
  }
}

TEST(ComposeDistances, ColoursByHowFarTheOtherIsAway) {
  const auto a = SharedCloud(sparse_world_m);
  std::vector<Vector3> shifted_m = sparse_world_m;
  for (std::size_t i = 0; i < shifted_m.size(); ++i)
    shifted_m[i].z() += 0.5 * static_cast<double>(i);
  Choices choices;
  choices.distance_ends_m = {{0.0, 2.0}};
  const Scene scene = ComposeDistances(a, SharedCloud(shifted_m), choices);
  EXPECT_TRUE(scene.clouds[1].view_from_sensor.isApprox(Transform::Identity(), 0.0));
  EXPECT_EQ(scene.coloring.ends, choices.distance_ends_m);
  for (const PlacedCloud& cloud : scene.clouds) {
    ASSERT_THAT(cloud.colors, SizeIs(4));
    for (std::size_t i = 0; i < 4; ++i) {
      const Rgb exact = MapColor(ColorMap::kViridis, 0.25 * static_cast<double>(i));
      for (std::size_t channel = 0; channel < 3; ++channel) {
        // The scale's table has 1024 steps.
        EXPECT_NEAR(cloud.colors[i][channel], exact[channel], 1.0);
      }
    }
  }
}

TEST(ComposeDistances, FitsItsScaleToTheFirstsDistances) {
  const auto a = SharedCloud({{100, 0, 0}, {110, 0, 0}});
  const auto b = SharedCloud({{100, 0, 0.25}, {110, 0, 1.5}});
  const Scene scene = ComposeDistances(a, b, {});
  EXPECT_EQ(scene.coloring.ends, (std::array{0.25, 1.5}));
  EXPECT_THAT(scene.clouds[0].colors,
              ElementsAre(MapColor(ColorMap::kViridis, 0.0), MapColor(ColorMap::kViridis, 1.0)));
}

TEST(ComposeDistances, HasNoColoursWhereThereIsNothingNear) {
  const Scene scene = ComposeDistances(SharedCloud(sparse_world_m), SharedCloud({}), {});
  EXPECT_THAT(scene.clouds[0].colors, Each(kNoValueColor));
  EXPECT_THAT(scene.clouds[1].colors, IsEmpty());
}

}  // namespace
}  // namespace railcast
