#include "railcast/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/camera/colors.h"
#include "core/scene/shapes.h"
#include "tests/core/camera/seen.h"
#include "tests/core/io/message_of.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

const CameraSpec kSmall{.width_px = 90, .height_px = 50, .horizontal_fov_deg = 90};
constexpr std::uint32_t kBoxLabel = 7;

std::unique_ptr<Simulator> SimulatorOf(std::shared_ptr<const World> world, int num_threads = 2) {
  const SimulatorSpec spec{.detector = {.range_max_m = 100.0}};
  return std::make_unique<Simulator>(std::move(world), MakeRaster(10, 10, 1), TestMaterials(), spec,
                                     num_threads);
}

CameraImage Render(Simulator& simulator, std::uint32_t frame = 0, const CameraSpec& spec = kSmall) {
  CameraImage image;
  Camera(spec, ForwardOptical(), TestMaterials()).Render(simulator, frame, image);
  return image;
}

// A cube of 2 m whose middle is at the origin of its own axes.
std::shared_ptr<const Model> Cube() {
  Mesh mesh = MakeWall(-1.0F, 1.0F);
  for (const double turn : {1.0, 2.0, 3.0}) {
    mesh.Append(MakeWall(-1.0F, 1.0F),
                MakeTransform(RotationFromYawPitchRoll(turn * std::acos(0.0), 0, 0), {0, 0, 0}));
  }
  return std::make_shared<Model>(Model{"cube", {{std::move(mesh), 3, kBoxLabel}}});
}

Transform At(double x, double y, double z) {
  return MakeTransform(Eigen::Matrix3d::Identity(), {x, y, z});
}

TEST(Camera, HoldsTheDepthOfAWallAlongTheAxisInEveryPixel) {
  const auto world = WorldOfParts({{MakeWall(20.0F, 1000.0F), 2, 5}});
  const CameraImage image = Render(*SimulatorOf(world));
  ASSERT_EQ(image.num_pixels(), 4500U);
  for (std::size_t i = 0; i < image.num_pixels(); ++i) {
    EXPECT_NEAR(static_cast<double>(image.depth_m[i]), 20.0, 1e-5);
    EXPECT_EQ(image.label[i], 5U);
    EXPECT_EQ(image.instance[i], 0U);
  }
}

TEST(Camera, HasNeitherDepthNorLabelWhereNothingIsWithinRange) {
  const auto world = WorldOfParts({{MakeWall(100.1F, 1000.0F), 2, 5}});
  world->AddObject(Cube(), At(12.0, 0, 0));
  const CameraImage image = Render(*SimulatorOf(world));
  std::size_t num_hit = 0;
  for (std::size_t i = 0; i < image.num_pixels(); ++i) {
    const bool is_hit = image.label[i] != 0;
    num_hit += is_hit;
    EXPECT_EQ(std::isnan(image.depth_m[i]), !is_hit);
    EXPECT_EQ(image.instance[i], is_hit ? 1U : 0U);
  }
  // A square of 2 m at 11 m, focal length 45 pixels: 8.2 x 8.2 pixels about the middle of the
  // image, which is between two pixels.
  EXPECT_EQ(num_hit, 8U * 8U);
}

TEST(Camera, ShowsMovingObjectsWhereTheyAreAtTheStamp) {
  auto world = std::make_shared<SimpleWorld>();
  world->AddObject(Cube(), At(11.0, 0, 0), Vector3(0, -10, 0));
  world->velocity_chunk_mps = Vector3(10, 0, 0);
  const auto simulator = SimulatorOf(world);
  const CameraImage image = Render(*simulator, 2);
  // After 0.2 s the vehicle is 2 m ahead and the cube 2 m to the right: 8 m away, its middle at
  // 44.5 + 45 * 2 / 8 = 55.75.
  EXPECT_EQ(image.stamp_ns, 200'000'000);
  EXPECT_NEAR(image.world_from_camera.translation().x(), 2.0, 1e-12);
  double sum = 0.0;
  double num = 0.0;
  for (std::size_t column = 0; column < image.width_px; ++column) {
    const std::size_t i = 25U * image.width_px + column;
    if (image.label[i] != kBoxLabel || std::abs(image.depth_m[i] - 8.0F) > 1e-4F) continue;
    sum += static_cast<double>(column);
    num += 1.0;
  }
  EXPECT_NEAR(num, 45.0 * 2.0 / 8.0, 1.0);
  EXPECT_NEAR(sum / num, 55.75, 0.5);
}

bool AreSame(const CameraImage& a, const CameraImage& b) {
  const auto same_float = [](float x, float y) {
    return x == y || (std::isnan(x) && std::isnan(y));
  };
  return a.rgb == b.rgb && a.label == b.label && a.instance == b.instance &&
         std::equal(a.depth_m.begin(), a.depth_m.end(), b.depth_m.begin(), b.depth_m.end(),
                    same_float);
}

TEST(Camera, DependsOnTheFrameAloneAndNotOnTheNumberOfThreads) {
  const auto world = WorldOfParts({{MakeFloor(-2.0F, 200.0F), 2, 4}});
  world->AddObject(Cube(), At(11.0, 0, 0), Vector3(0, -3, 0));
  world->velocity_chunk_mps = Vector3(5, 0, 0);
  const CameraImage expected = Render(*SimulatorOf(world, 1), 3);
  const auto simulator = SimulatorOf(world, 8);
  EXPECT_FALSE(AreSame(Render(*simulator, 4), expected));
  EXPECT_TRUE(AreSame(Render(*simulator, 3), expected));
  EXPECT_TRUE(AreSame(Render(*SimulatorOf(world, 2), 3), expected));
}

TEST(Camera, LeavesTheFramesOfItsSensorAsTheyAre) {
  auto world = std::make_shared<SimpleWorld>();
  world->AddObject(Cube(), At(11.0, 0, 0), Vector3(0, -3, 0));
  Frame before;
  Frame after;
  const auto simulator = SimulatorOf(world);
  simulator->Scan(1, before);
  (void)Render(*simulator, 1);
  simulator->Scan(1, after);
  EXPECT_EQ(before.label, after.label);
  EXPECT_EQ(before.true_range_m.size(), after.true_range_m.size());
}

// The radiance of a byte of sRGB (IEC 61966-2-1).
double RadianceOf(std::uint8_t byte) {
  const double encoded = byte / 255.0;
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

// A wire of 40 mm, slanted, 40 m ahead of a camera with a focal length of 554 pixels, is 0.554
// pixels wide, so that the rays through the centres of most columns' pixels miss it. In each
// column, what it takes from the light of the wall behind is this width times the contrast. Without
// sun a surface that is upright, or upright on average, has 0.6 times its reflectance.
TEST(Camera, ShowsAThinWireWithoutGaps) {
  const CameraSpec spec{.width_px = 640, .height_px = 100, .horizontal_fov_deg = 60};
  auto world = std::make_shared<SimpleWorld>();
  const std::vector<Vector3> points_m = {{40.0, -30.0, -0.7}, {40.0, 30.0, 0.9}};
  world->wires = {{1, kBoxLabel, 0.02, points_m}};
  world->ground = {
      "wall",
      {{MakeWall(60.0F, 1000.0F), 2, 5}, {MakeTube(points_m, 0.02, 16), 1, kBoxLabel, true}}};
  SimulatorSpec cloudy{.detector = {.range_max_m = 100.0}};
  cloudy.detector.weather.sun.illuminance_klx = 0.0;
  Simulator simulator(world, MakeRaster(10, 10, 1), TestMaterials(), cloudy, 2);
  const CameraImage image = Render(simulator, 0, spec);
  const auto materials = MaterialColors(TestMaterials());
  const double contrast = 0.6 * (materials[2].y() - materials[1].y());
  const double width_px = 0.04 / 40.0 * 320.0 / std::tan(std::acos(-1.0) / 6.0);
  // The wall as its byte has it: half a step of it in each of 100 rows would be half of the sum.
  const double wall = RadianceOf(image.rgb[1]);
  EXPECT_NEAR(wall, 0.6 * materials[2].y(), 0.002);
  std::size_t num_labelled = 0;
  for (std::size_t column = 0; column < spec.width_px; ++column) {
    double taken = 0.0;
    std::size_t num_rows = 0;
    for (std::size_t row = 0; row < spec.height_px; ++row) {
      const std::size_t i = row * spec.width_px + column;
      taken += wall - RadianceOf(image.rgb[3 * i + 1]);
      if (image.label[i] == kBoxLabel) ++num_rows;
    }
    // 1.4 % for the samples of the Gaussian. The wire is in four pixels of a column, each of which
    // a byte has to half a step, 0.0021 of 0.133.
    EXPECT_NEAR(taken / (width_px * contrast), 1.0, 0.014 + 0.063) << column;
    num_labelled += num_rows;
  }
  // Labels are those of the centres, exactly.
  EXPECT_NEAR(static_cast<double>(num_labelled), 640.0 * width_px, 10.0);
}

TEST(Camera, RejectsADistortionThatCannotBeInverted) {
  CameraSpec spec = kSmall;
  spec.distortion = DistortionSpec{.k1 = -1.0};
  EXPECT_EQ(MessageOf([&] { Camera(spec, ForwardOptical(), TestMaterials()); }),
            "/distortion: must be invertible over the whole image");
}

}  // namespace
}  // namespace railcast
