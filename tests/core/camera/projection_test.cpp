#include <gtest/gtest.h>

#include <cmath>
#include <iomanip>
#include <sstream>

#include "core/base/units.h"
#include "core/camera/lens.h"
#include "railcast/scenario.h"
#include "tests/core/camera/seen.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

// The demo with everything at rest, so that all firings see what the camera sees at the stamp.
ScenarioSpec StandingScene() {
  ScenarioSpec spec = ReadScenario(ScenariosDir() / "st_gallen_approach.json");
  spec.fidelity = Fidelity::kGeometry;
  spec.vehicle.motion = {};
  for (ObjectSpec& object : spec.world.objects) object.motion.reset();
  return spec;
}

// By how much depths may differ.
constexpr double kAgreement_m = 0.02;

constexpr std::uint32_t kPixelStep = 3;

// A firing table whose beams go through the centres of each kPixelStep-th pixel, row by row.
std::string TableOfPixels(const CameraSpec& camera) {
  std::ostringstream table;
  table << "azimuth_deg,elevation_deg,time_us\n" << std::setprecision(17);
  for (std::uint32_t v = 0; v < camera.height_px; v += kPixelStep) {
    for (std::uint32_t u = 0; u < camera.width_px; u += kPixelStep) {
      // Found without the lens's own inversion: by steps towards the pixel, each nearer.
      Eigen::Vector2d place(0, 0);
      for (int i = 0; i < 200; ++i) {
        place += (Eigen::Vector2d(u, v) - SeenAt(camera, {place.x(), place.y(), 1.0})) /
                 static_cast<double>(camera.width_px);
      }
      table << DegFromRad(std::atan2(-place.x(), 1.0)) << ","
            << DegFromRad(std::atan2(-place.y(), std::hypot(1.0, place.x()))) << ",0\n";
    }
  }
  return table.str();
}

TEST(CameraAndLidar, AgreeInEveryReturnWhoseBeamGoesThroughAPixel) {
  ScenarioSpec spec = StandingScene();
  spec.camera = CameraSpec{.width_px = 480, .height_px = 270, .horizontal_fov_deg = 60};
  spec.camera->distortion = DistortionSpec{-0.2, 0.05, 0.001, 0.001, 0.0};
  const TemporaryFolder folder;
  spec.lidar.scan.pattern =
      FiringTableSpec{folder.Write("pixels.csv", TableOfPixels(*spec.camera))};
  const auto simulator = MakeSimulator(spec, 2);
  CameraImage image;
  const Frame frame = FrameBy(*simulator);
  MakeCamera(spec)->Render(*simulator, 0, image);
  ASSERT_EQ(frame.num_slots(), 160U * 90U);
  const Transform camera_from_sensor =
      VehicleFromCamera(spec).inverse() * VehicleFromSensor(spec.lidar.mount);
  std::size_t num_exceptions = 0;
  std::size_t num_returns = 0;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    const std::size_t pixel = kPixelStep * (i / 160 * image.width_px + i % 160);
    const bool is_return = frame.outcome[i] == Outcome::kReturned;
    num_returns += is_return;
    const double z = (camera_from_sensor * PointAt(frame, i)).z();
    const bool is_deep =
        is_return && !(std::abs(z - static_cast<double>(image.depth_m[pixel])) <= kAgreement_m);
    num_exceptions += is_deep || frame.label[i] != image.label[pixel] ||
                      frame.instance[i] != image.instance[pixel];
  }
  EXPECT_GT(num_returns, 8000U);
  // Beams that graze an edge: directions differ in the last bit of float32.
  EXPECT_LE(num_exceptions, 3U);
}

// The four pixels around a place in the image.
struct Neighbours {
  double a, b;  ///< Place between them: 0 to 1 from left to right, from top to bottom.
  std::array<std::size_t, 4> pixels;
};

std::optional<Neighbours> NeighboursOf(const CameraImage& image, const Eigen::Vector2d& seen) {
  const int u = static_cast<int>(std::floor(seen.x()));
  const int v = static_cast<int>(std::floor(seen.y()));
  if (u < 0 || v < 0 || u + 1 >= static_cast<int>(image.width_px) ||
      v + 1 >= static_cast<int>(image.height_px)) {
    return std::nullopt;
  }
  const std::size_t first =
      static_cast<std::size_t>(v) * image.width_px + static_cast<std::size_t>(u);
  return Neighbours{seen.x() - u,
                    seen.y() - v,
                    {first, first + 1, first + image.width_px, first + image.width_px + 1}};
}

// The depth between four pixels that show one plane: 1 / z is linear across its image.
double DepthBetween(const CameraImage& image, const Neighbours& around) {
  const auto inverse = [&](std::size_t i) {
    return 1.0 / static_cast<double>(image.depth_m[around.pixels[i]]);
  };
  const auto [a, b, pixels] = around;
  return 1.0 / ((1 - b) * ((1 - a) * inverse(0) + a * inverse(1)) +
                b * ((1 - a) * inverse(2) + a * inverse(3)));
}

// What the returns of a frame and the image say of each other.
struct Projection {
  std::size_t num_returns = 0;
  std::size_t num_strange = 0;    ///< None of the four pixels has the return's label and instance.
  std::size_t num_on_things = 0;  ///< All four have them, within 60 m.
  std::size_t num_deep = 0;       ///< Of these: another depth than the plane through the four.
};

Projection ProjectionOf(const Frame& frame, const ScenarioSpec& spec, const CameraImage& image) {
  const Transform camera_from_sensor =
      VehicleFromCamera(spec).inverse() * VehicleFromSensor(spec.lidar.mount);
  Projection counts;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (frame.outcome[i] != Outcome::kReturned) continue;
    const Vector3 point = camera_from_sensor * PointAt(frame, i);
    const auto around = NeighboursOf(image, SeenAt(*spec.camera, point));
    if (!around) continue;
    const auto num_same = std::ranges::count_if(around->pixels, [&](std::size_t pixel) {
      return image.label[pixel] == frame.label[i] && image.instance[pixel] == frame.instance[i];
    });
    ++counts.num_returns;
    counts.num_strange += num_same == 0;
    if (num_same < 4 || frame.true_range_m[i] > 60) continue;
    ++counts.num_on_things;
    counts.num_deep += std::abs(DepthBetween(image, *around) - point.z()) > kAgreement_m;
  }
  return counts;
}

TEST(CameraAndLidar, AgreeInReturnsBetweenThePixels) {
  ScenarioSpec spec = StandingScene();
  spec.world.vegetation = {.trees_per_hectare = 0.0, .grass = false};
  spec.camera = CameraSpec{.width_px = 1920, .height_px = 1080, .horizontal_fov_deg = 60};
  spec.camera->mount = MountSpec{.position_m = {2.2, 0.0, 2.6}, .yaw_deg = 1.0, .pitch_deg = 3.0};
  const auto simulator = MakeSimulator(spec, 2);
  CameraImage image;
  const Frame frame = FrameBy(*simulator);
  MakeCamera(spec)->Render(*simulator, 0, image);
  const Projection counts = ProjectionOf(frame, spec, image);
  // 14,148 returns; 34 on slivers narrower than a pixel. Of the 11,284 between four pixels of one
  // thing, 576 are on edges of stones, sleepers and wagons, where these four do not show one plane.
  EXPECT_GT(counts.num_returns, 14'000U);
  EXPECT_LT(static_cast<double>(counts.num_strange),
            0.005 * static_cast<double>(counts.num_returns));
  EXPECT_GT(counts.num_on_things, 10'000U);
  EXPECT_LT(static_cast<double>(counts.num_deep), 0.07 * static_cast<double>(counts.num_on_things));
}

// What two evaluations of one formula may differ by, at thousands of pixels.
constexpr double kRounding_px = 1e-8;

CameraSpec Distorted(const DistortionSpec& distortion) {
  return {.width_px = 1280, .height_px = 960, .horizontal_fov_deg = 80, .distortion = distortion};
}

const DistortionSpec kBarrel{-0.28, 0.09, 0.0012, -0.0008, -0.011};
const DistortionSpec kPincushion{0.11, 0.02, -0.001, 0.0015, 0.004};

TEST(Lens, HasTheFieldOfViewFromEdgeToEdge) {
  const CameraSpec spec{.width_px = 1920, .height_px = 1080, .horizontal_fov_deg = 60};
  const Lens lens(spec);
  const double edge = std::tan(std::acos(-1.0) / 6.0);
  EXPECT_NEAR(lens.DirectionAt(-0.5, 539.5)->x(), -edge, 1e-12);
  EXPECT_NEAR(lens.DirectionAt(1919.5, 539.5)->x(), edge, 1e-12);
  EXPECT_NEAR(lens.DirectionAt(959.5, 539.5)->norm(), 0.0, 1e-12);
  // Pixels are square.
  EXPECT_NEAR(lens.DirectionAt(0, 1079.5)->y(), edge * 1080 / 1920, 1e-12);
}

TEST(Lens, SeesPointsWhereOpenCvDoes) {
  for (const DistortionSpec& distortion : {DistortionSpec{}, kBarrel, kPincushion}) {
    const CameraSpec spec = Distorted(distortion);
    const Lens lens(spec);
    for (const Vector3& point : {Vector3(0, 0, 1), Vector3(1.5, 0.7, 3), Vector3(-4, 2, 6.5)}) {
      EXPECT_NEAR((lens.Project(point) - SeenAt(spec, point)).norm(), 0.0, kRounding_px);
    }
  }
}

TEST(Lens, LooksFromEachPixelToWhatIsSeenThere) {
  for (const DistortionSpec& distortion : {DistortionSpec{}, kBarrel, kPincushion}) {
    const CameraSpec spec = Distorted(distortion);
    ASSERT_TRUE(IsInvertible(spec));
    const Lens lens(spec);
    for (double v = 0; v < 960; v += 53) {
      for (double u = 0; u < 1280; u += 53) {
        const auto direction = lens.DirectionAt(u, v);
        ASSERT_TRUE(direction);
        const Eigen::Vector2d seen = SeenAt(spec, {direction->x(), direction->y(), 1.0});
        EXPECT_NEAR((seen - Eigen::Vector2d(u, v)).norm(), 0.0, kRounding_px);
      }
    }
  }
}

// Newton's method with full steps fails at single pixels of these, between those at which it does
// not.
TEST(Lens, LooksFromEveryPixelOfAStronglyDistortedImage) {
  const DistortionSpec bulge{
      .k1 = 0.07290808313923929, .k2 = 0.10442730907766491, .k3 = -0.03009446520991182};
  const DistortionSpec oblique{.k1 = -2.030788525242204,
                               .k2 = 2.80237634311493,
                               .p2 = 0.1996657507758857,
                               .k3 = 3.571066935680261};
  for (const DistortionSpec& distortion : {bulge, oblique}) {
    const CameraSpec spec{
        .width_px = 320, .height_px = 240, .horizontal_fov_deg = 110, .distortion = distortion};
    ASSERT_TRUE(IsInvertible(spec));
    const Lens lens(spec);
    for (std::uint32_t v = 0; v < spec.height_px; ++v) {
      for (std::uint32_t u = 0; u < spec.width_px; ++u) {
        const auto direction = lens.DirectionAt(u, v);
        ASSERT_TRUE(direction) << u << ", " << v;
        const Eigen::Vector2d seen = SeenAt(spec, {direction->x(), direction->y(), 1.0});
        ASSERT_NEAR((seen - Eigen::Vector2d(u, v)).norm(), 0.0, 1e-9) << u << ", " << v;
      }
    }
  }
}

TEST(Lens, IsNotInvertibleWhereTwoDirectionsFallTogether) {
  // x (1 - 0.5 x^2) has its largest value, 0.54, at x = 0.82, that is at a field of view of 57
  // degrees without distortion.
  CameraSpec spec = Distorted({.k1 = -0.5});
  spec.height_px = 1;
  spec.horizontal_fov_deg = 56;
  EXPECT_TRUE(IsInvertible(spec));
  spec.horizontal_fov_deg = 58;
  EXPECT_FALSE(IsInvertible(spec));
}

TEST(CameraName, CanBeAFolder) {
  for (const char* good : {"camera", "front_2", "0"}) EXPECT_TRUE(IsCameraName(good)) << good;
  for (const char* bad : {"", "..", "a/b", "Front", "a b", "caf\xC3\xA9"}) {
    EXPECT_FALSE(IsCameraName(bad)) << bad;
  }
  EXPECT_TRUE(IsCameraName(std::string(64, 'a')));
  EXPECT_FALSE(IsCameraName(std::string(65, 'a')));
}

}  // namespace
}  // namespace railcast
