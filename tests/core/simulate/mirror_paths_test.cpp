// Tests effect `mirror_paths` through the whole simulator, against mirror images in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include "railcast/effects.h"
#include "railcast/simulator.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/frame_bytes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr std::uint16_t kGlass = 1;
constexpr std::uint16_t kPlaster = 2;
constexpr std::uint16_t kSoil = 3;
constexpr std::uint32_t kMirrorLabel = 4;
constexpr std::uint32_t kMirroredLabel = 15;
constexpr std::uint32_t kImageLabel = 30;
constexpr double kMirrored_m = 30.0;
constexpr double kMirror_m = -2.0;
constexpr double kGlassF0 = 0.08;

MaterialLibrary MirrorMaterials() {
  return MaterialLibrary(
      {{.name = "glass", .reflectivity = 0.02, .specular_f0 = kGlassF0, .height_rms_um = 0.0},
       {.name = "plaster", .reflectivity = 0.5, .retroreflectance = 3.0},
       {.name = "soil", .reflectivity = 0.25, .facet_slope_deg = 20.0, .holds_puddles = true}});
}

/// A floor 2 m below the sensor and, 30 m ahead, a wall that is an object.
std::shared_ptr<SimpleWorld> WallBehindAFloor(std::uint16_t floor_material = kGlass) {
  const auto world = WorldOfParts(
      {{MakeFloor(static_cast<float>(kMirror_m), 100.0F), floor_material, kMirrorLabel}});
  auto wall = std::make_shared<Model>();
  wall->parts = {{MakeWall(static_cast<float>(kMirrored_m), 20.0F), kPlaster, kMirroredLabel}};
  world->AddObject(std::move(wall), Transform::Identity());
  return world;
}

/// No noise; the image is the last echo of its beam.
SimulatorSpec WithMirrors() {
  SimulatorSpec spec{.detector = {.effects = {.surface_response = true,
                                              .extinction = true,
                                              .mirror_paths = true,
                                              .detection = true}}};
  spec.detector.weather.fog_density_per_m = 0.005;
  spec.detector.receiver.return_mode = ReturnMode::kLast;
  spec.detector.clutter_labels.mirror_image = kImageLabel;
  return spec;
}

Frame ScanMirrors(const std::shared_ptr<const World>& world,
                  const SimulatorSpec& spec,
                  int num_threads = 0) {
  return FrameBy(
      Simulator(world, MakeRaster(40.0, 20.0, 0.5), MirrorMaterials(), spec, num_threads));
}

std::size_t NumImages(const Frame& frame) {
  std::size_t num = 0;
  for (const std::uint32_t label : frame.label) num += label == kImageLabel ? 1 : 0;
  return num;
}

using Reflectance = std::function<double(double cosine)>;

double OfGlass(double cosine) {
  return kGlassF0 + (1.0 - kGlassF0) * std::pow(1.0 - cosine, 5.0);
}

double OfWater(double cosine) {
  const double a = std::acos(cosine);
  const double b = std::asin(std::sin(a) / 1.33);
  return 0.5 * (std::pow(std::sin(a - b) / std::sin(a + b), 2) +
                std::pow(std::tan(a - b) / std::tan(a + b), 2));
}

/// A beam's image of the wall in a level mirror.
struct Image {
  bool is_seen{};
  double range_m{};
  double power_ratio{};
};

// Beams below the horizon that reach the mirror before the wall go on to the wall: over R1 + R2
// they cover the same distance ahead as if they went straight on.
Image ImageOf(const Vector3& direction, double mirror_m, const Reflectance& reflectance) {
  Image image;
  if (direction.z() >= 0.0) return image;
  const double first_m = kMirror_m / direction.z();  // Of the ground, even below water.
  image.range_m = kMirrored_m / direction.x();
  image.is_seen = first_m < image.range_m && image.range_m - first_m > 0.64 &&
                  std::abs(image.range_m * direction.y()) < 20.0 &&
                  2.0 * mirror_m - image.range_m * direction.z() < 20.0;
  const double fresnel = reflectance(-direction.z());
  const double cosine = direction.x();
  const double rho = 0.5 * cosine + 3.0 * std::pow(cosine, 5.0);
  image.power_ratio = fresnel * fresnel * rho / (image.range_m * image.range_m) / 2.5e-6 *
                      std::exp(-2.0 * 0.005 * image.range_m);
  return image;
}

void ExpectImagesOfTheWall(const Frame& frame, double mirror_m, const Reflectance& reflectance) {
  const ScanPattern pattern = MakeRaster(40.0, 20.0, 0.5);
  std::size_t num_images = 0;
  for (std::size_t firing = 0; firing < pattern.num_firings(); ++firing) {
    const std::size_t slot =
        std::size_t{pattern.row[firing]} * pattern.columns + pattern.column[firing];
    const Vector3 direction = DirectionOf(pattern, firing);
    const Image image = ImageOf(direction, mirror_m, reflectance);
    const bool is_detected = image.is_seen && image.power_ratio > 1.0;
    ASSERT_EQ(frame.label[slot] == kImageLabel, is_detected) << firing;
    if (!is_detected) continue;
    ++num_images;
    EXPECT_EQ(frame.outcome[slot], Outcome::kClutter);
    EXPECT_EQ(frame.instance[slot], 1U);  // The wall is the first object.
    EXPECT_EQ(frame.material[slot], kPlaster);
    EXPECT_TRUE(std::isnan(frame.footprint_share[slot]));
    // float32 rounds places 30 m away to 2 micrometres, a few times over.
    EXPECT_NEAR(frame.range_m[slot], image.range_m, 3e-5);
    // Below the floor, exactly where the mirror image of the wall is.
    EXPECT_NEAR(frame.x[slot], kMirrored_m, 3e-5);
    EXPECT_NEAR(frame.z[slot], image.range_m * direction.z(), 3e-5);
    EXPECT_LT(frame.z[slot], mirror_m);
    EXPECT_NEAR(static_cast<double>(frame.power_ratio[slot]) / image.power_ratio, 1.0, 3e-5);
  }
  EXPECT_GT(num_images, 900U);
}

TEST(MirrorPaths, ShowTheMirrorImageOfAWall) {
  ExpectImagesOfTheWall(ScanMirrors(WallBehindAFloor(), WithMirrors()), kMirror_m, &OfGlass);
}

TEST(MirrorPaths, ShowItInAPuddleAtTheLevelOfItsWater) {
  SimulatorSpec spec = WithMirrors();
  spec.detector.weather.puddle_share = 1.0;
  ExpectImagesOfTheWall(ScanMirrors(WallBehindAFloor(kSoil), spec), kMirror_m + 0.03, &OfWater);
}

// A slope that rises away from the sensor, x = 30 m + z. From the sensor's own image, at the height
// 2 m for a mirror at m, the beams reach it after (30 m + 2 m) / (dx + dz), under another angle
// than straight on.
TEST(MirrorPaths, ShowASlopeFromTheSideOfItsImage) {
  const ScanPattern pattern = MakeRaster(40.0, 20.0, 0.5);
  for (const bool is_water : {false, true}) {
    auto world = std::make_shared<SimpleWorld>();
    const Mesh slope{{{10, -20, -20}, {10, 20, -20}, {50, 20, 20}, {50, -20, 20}},
                     {{0, 1, 2}, {0, 2, 3}}};
    world->ground.parts = {
        {MakeFloor(static_cast<float>(kMirror_m), 100.0F), is_water ? kSoil : kGlass, kMirrorLabel},
        {slope, kPlaster, kMirroredLabel}};
    SimulatorSpec spec = WithMirrors();
    spec.detector.weather.puddle_share = 1.0;
    const Frame frame = ScanMirrors(world, spec);
    const double mirror_m = is_water ? kMirror_m + 0.03 : kMirror_m;
    std::size_t num_images = 0;
    for (std::size_t firing = 0; firing < pattern.num_firings(); ++firing) {
      const std::size_t slot =
          std::size_t{pattern.row[firing]} * pattern.columns + pattern.column[firing];
      if (frame.label[slot] != kImageLabel) continue;
      ++num_images;
      const Vector3 d = DirectionOf(pattern, firing);
      const double range_m = (30.0 + 2.0 * mirror_m) / (d.x() + d.z());
      EXPECT_NEAR(frame.range_m[slot], range_m, 3e-5);
      const double fresnel = is_water ? OfWater(-d.z()) : OfGlass(-d.z());
      const double cosine = (d.x() + d.z()) / std::sqrt(2.0);
      const double rho = 0.5 * cosine + 3.0 * std::pow(cosine, 5.0);
      const double power_ratio =
          fresnel * fresnel * rho / (range_m * range_m) / 2.5e-6 * std::exp(-2.0 * 0.005 * range_m);
      EXPECT_NEAR(static_cast<double>(frame.power_ratio[slot]) / power_ratio, 1.0, 3e-5);
    }
    EXPECT_GT(num_images, 500U);
  }
}

// Beams that lie on one plane are left to their central ray by the rung footprint; the image needs
// no other ray.
TEST(MirrorPaths, AreTheSameForBeamsOfAWidth) {
  SimulatorSpec spec = WithMirrors();
  spec.detector.effects.footprint = true;
  ExpectImagesOfTheWall(ScanMirrors(WallBehindAFloor(), spec), kMirror_m, &OfGlass);
  spec.detector.effects.dense_footprint = true;
  ExpectImagesOfTheWall(ScanMirrors(WallBehindAFloor(), spec), kMirror_m, &OfGlass);
}

// Up to 13 m the floor is met under 81 deg at most. A standard deviation of the beam, 0.375 mrad,
// changes the share that enters and leaves, (1 - F)^2, by 0.3 % there, the mean over the beam less.
// Without that share the own echo would be up to three times as strong.
TEST(MirrorPaths, LeaveTheMirrorAsLittleOnEveryRung) {
  SimulatorSpec spec = WithMirrors();
  spec.detector.receiver.return_mode = ReturnMode::kFirst;
  const Frame rays = ScanMirrors(WallBehindAFloor(), spec);
  spec.detector.effects.footprint = spec.detector.effects.dense_footprint = true;
  const Frame beams = ScanMirrors(WallBehindAFloor(), spec);
  std::size_t num = 0;
  for (std::size_t slot = 0; slot < rays.num_slots(); ++slot) {
    if (rays.label[slot] != kMirrorLabel || !(rays.true_range_m[slot] < 13.0F)) continue;
    ++num;
    EXPECT_NEAR(beams.intensity[slot] / rays.intensity[slot], 1.0F, 0.01F) << slot;
  }
  EXPECT_GT(num, 50U);
}

TEST(MirrorPaths, EndAtTheGreatestRange) {
  SimulatorSpec spec = WithMirrors();
  spec.detector.range_max_m = 31.0;
  const Frame frame = ScanMirrors(WallBehindAFloor(), spec);
  EXPECT_GT(NumImages(frame), 0U);
  EXPECT_LT(NumImages(frame), NumImages(ScanMirrors(WallBehindAFloor(), WithMirrors())));
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (frame.label[slot] != kImageLabel) continue;
    EXPECT_LE(frame.range_m[slot], 31.0F);
  }
}

TEST(MirrorPaths, EndAtWhatStandsBetween) {
  const auto world = WallBehindAFloor();
  auto screen = std::make_shared<Model>();
  screen->parts = {{MakeWall(29.0F, 20.0F), kPlaster, kMirroredLabel}};
  world->AddObject(std::move(screen), Transform::Identity());
  const Frame frame = ScanMirrors(world, WithMirrors());
  EXPECT_GT(NumImages(frame), 900U);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    // Images begin up to 5 cm behind the mirror.
    const float mirror_x_m = frame.x[slot] * static_cast<float>(kMirror_m) / frame.z[slot];
    if (frame.label[slot] != kImageLabel || mirror_x_m > 28.95F) continue;
    EXPECT_EQ(frame.instance[slot], 2U);
  }
}

// A pane 10 m ahead shows the sensor's own vehicle, whose end is 3 m behind the sensor, 23 m away.
TEST(MirrorPaths, ShowTheOwnVehicleInAPane) {
  const auto world = WorldOfParts({{MakeWall(10.0F, 30.0F), kGlass, kMirrorLabel}});
  auto vehicle = std::make_shared<Model>();
  vehicle->parts = {{MakeWall(-3.0F, 30.0F), kPlaster, 26}};
  world->AddObject(std::move(vehicle), Transform::Identity(), Vector3::Zero(), true);
  const Frame frame = ScanMirrors(world, WithMirrors());
  EXPECT_EQ(NumImages(frame), frame.num_slots());
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    EXPECT_EQ(frame.instance[slot], 1U);
    EXPECT_NEAR(frame.x[slot], 23.0F, 3e-5F);
  }
}

// The wall moves away at 50 m/s: in the beams of a frame it is where it is when they are fired.
TEST(MirrorPaths, ShowMovingThingsWhereTheyAre) {
  const auto world =
      WorldOfParts({{MakeFloor(static_cast<float>(kMirror_m), 100.0F), kGlass, kMirrorLabel}});
  auto wall = std::make_shared<Model>();
  wall->parts = {{MakeWall(0.0F, 20.0F), kPlaster, kMirroredLabel}};
  Transform place = Transform::Identity();
  place.translation() = Vector3(kMirrored_m, 0.0, 0.0);
  world->AddObject(std::move(wall), place, Vector3(50.0, 0.0, 0.0));
  const Frame frame = ScanMirrors(world, WithMirrors());
  EXPECT_GT(NumImages(frame), 500U);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (frame.label[slot] != kImageLabel) continue;
    EXPECT_NEAR(frame.x[slot], 30.0 + 50e-9 * frame.time_ns[slot], 1e-4);
  }
}

TEST(MirrorPaths, AreNotPartOfThePublishedRungs) {
  for (const Fidelity rung : {Fidelity::kGeometry, Fidelity::kPlausibility}) {
    SimulatorSpec spec = WithMirrors();
    spec.detector.effects = EffectsOfRung(rung);
    spec.detector.weather = {};
    spec.detector.weather.puddle_share = 1.0;
    EXPECT_FALSE(spec.detector.effects.mirror_paths);
    const std::string with = FrameBytes(ScanMirrors(WallBehindAFloor(kSoil), spec));
    spec.detector.weather.puddle_share = 0.0;
    EXPECT_EQ(FrameBytes(ScanMirrors(WallBehindAFloor(kSoil), spec)), with);
  }
}

TEST(MirrorPaths, ChangeNothingWithoutAMirror) {
  SimulatorSpec spec = WithMirrors();
  spec.detector.effects = EffectsOfRung(Fidelity::kSurface);
  const Frame with = ScanMirrors(WallBehindAFloor(kSoil), spec);
  spec.detector.effects.mirror_paths = false;
  EXPECT_EQ(FrameBytes(ScanMirrors(WallBehindAFloor(kSoil), spec)), FrameBytes(with));
}

SimulatorSpec PuddlesOnEveryRung(std::uint64_t ground_seed, Fidelity rung = Fidelity::kFootprint) {
  SimulatorSpec spec = WithMirrors();
  spec.detector.effects = EffectsOfRung(rung);
  spec.detector.weather.puddle_share = 0.4;
  spec.detector.ground_seed = ground_seed;
  return spec;
}

TEST(MirrorPaths, AreTheSameAtAnyNumberOfThreads) {
  const auto world = WallBehindAFloor(kSoil);
  const std::string one = FrameBytes(ScanMirrors(world, PuddlesOnEveryRung(1), 1));
  EXPECT_EQ(FrameBytes(ScanMirrors(world, PuddlesOnEveryRung(1), 2)), one);
  EXPECT_EQ(FrameBytes(ScanMirrors(world, PuddlesOnEveryRung(1), 8)), one);
  EXPECT_NE(FrameBytes(ScanMirrors(world, PuddlesOnEveryRung(2), 8)), one);
}

// Puddles lie where the world's seed puts them. Another seed of the sensor moves the noise, not
// them; beams that meet no puddle draw the same with and without the effect.
TEST(MirrorPaths, LeaveTheDrawsOfOtherBeamsAlone) {
  const auto world = WallBehindAFloor(kSoil);
  SimulatorSpec spec = PuddlesOnEveryRung(1, Fidelity::kSurface);
  const Frame with = ScanMirrors(world, spec);
  spec.detector.effects.mirror_paths = false;
  const Frame without = ScanMirrors(world, spec);
  std::size_t num_same = 0;
  std::size_t num_images = 0;
  for (std::size_t slot = 0; slot < with.num_slots(); ++slot) {
    num_images += with.label[slot] == kImageLabel ? 1 : 0;
    // The first surface's incidence on level water and on the level floor are alike; its own power
    // tells whether water covers it.
    if (with.label[slot] == kImageLabel || with.power_ratio[slot] != without.power_ratio[slot]) {
      continue;
    }
    ++num_same;
    EXPECT_EQ(with.range_m[slot], without.range_m[slot]);
    EXPECT_EQ(with.outcome[slot], without.outcome[slot]);
  }
  EXPECT_GT(num_images, 100U);
  EXPECT_GT(num_same, 2000U);
  // The echo of the wall above the horizon is never touched.
  for (std::size_t slot = 20 * with.columns; slot < with.num_slots(); ++slot) {
    ASSERT_NE(with.label[slot], kImageLabel);
    ASSERT_EQ(with.x[slot], without.x[slot]);
  }
}

TEST(MirrorPaths, AreExplainedAsTheyAreScanned) {
  const auto world = WallBehindAFloor();
  Simulator simulator(world, MakeRaster(40.0, 20.0, 0.5), MirrorMaterials(), WithMirrors(), 0);
  const Frame frame = FrameBy(simulator);
  std::size_t num_told = 0;
  for (std::uint32_t firing = 0; firing < frame.num_slots(); firing += 37) {
    const FiringStory story = simulator.Explain(0, firing);
    bool is_told = false;
    for (const FiringStory::Echo& echo : story.echoes) {
      is_told = is_told || (echo.label == kImageLabel && echo.slot == story.slot);
    }
    EXPECT_EQ(is_told, frame.label[story.slot] == kImageLabel) << firing;
    for (const FiringStory::Step& step : story.steps) {
      if (step.effect == "mirror_paths") num_told += step.num_added_echoes;
    }
  }
  EXPECT_GT(num_told, 20U);
}

}  // namespace
}  // namespace railcast
