#include "core/camera/colors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/camera/seen.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr double kDegree_rad = 0.017453292519943295;

// What a byte of sRGB leaves open: half a step of 1/255, at most 2.4 / 1.055 as much in linear
// light at the bright end.
constexpr double kHalfStep = 0.5 / 255.0 * 2.4 / 1.055;

// The linear value of a byte (IEC 61966-2-1, the inverse of what the camera applies).
double Linear(std::uint8_t byte) {
  const double encoded = byte / 255.0;
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

CameraImage RenderIn(const WeatherSpec& weather,
                     std::shared_ptr<const World> world,
                     const CameraSpec& spec,
                     const Transform& vehicle_from_camera = ForwardOptical()) {
  SimulatorSpec simulator_spec;
  simulator_spec.detector.weather = weather;
  Simulator simulator(std::move(world), MakeRaster(10, 10, 1), TestMaterials(), simulator_spec, 2);
  CameraImage image;
  Camera(spec, vehicle_from_camera, TestMaterials()).Render(simulator, 0, image);
  return image;
}

double Green(const CameraImage& image, std::size_t column, std::size_t row) {
  return Linear(image.rgb[3 * (row * image.width_px + column) + 1]);
}

TEST(Daylight, EncodesLinearLightAsSrgb) {
  for (const int byte : {0, 1, 10, 11, 55, 127, 200, 254, 255}) {
    const auto linear = static_cast<float>(Linear(static_cast<std::uint8_t>(byte)));
    EXPECT_EQ(SrgbBytes(Radiance::Constant(linear))[1], byte);
  }
  EXPECT_EQ(SrgbBytes(Radiance(-1.0F, 0.0F, 7.0F)), (std::array<std::uint8_t, 3>{0, 0, 255}));
}

TEST(Daylight, ShowsAWhiteLevelSurfaceInTheOpenAsWhite) {
  for (const double illuminance_klx : {0.0, 30.0, 100.0}) {
    WeatherSpec weather;
    weather.sun.illuminance_klx = illuminance_klx;
    const Daylight daylight(weather, Eigen::Matrix3d::Identity());
    const Radiance white = daylight.Surface(Radiance::Ones(), {0, 0, 1}, true);
    EXPECT_NEAR(static_cast<double>(white.y()), 1.0, 1e-5);
  }
}

// Koschmieder: L exp(-alpha R) + L_horizon (1 - exp(-alpha R)) with alpha = ln 20 / visibility.
TEST(Daylight, FadesSurfacesIntoTheHorizonByTheExtinctionOfFog) {
  constexpr double kVisibility_m = 120.0;
  const CameraSpec spec{.width_px = 64, .height_px = 4, .horizontal_fov_deg = 1.0};
  WeatherSpec fog;
  fog.visibility_m = kVisibility_m;
  const double horizon = Green(RenderIn(fog, std::make_shared<SimpleWorld>(), spec), 32, 1);
  for (const double range_m : {10.0, 60.0, 120.0, 250.0}) {
    for (const std::uint16_t material : {std::uint16_t{1}, std::uint16_t{3}}) {
      const auto world =
          WorldOfParts({{MakeWall(static_cast<float>(range_m), 50.0F), material, 5}});
      const double clear = Green(RenderIn({}, world, spec), 32, 2);
      const double left = std::exp(-std::log(20.0) * range_m / kVisibility_m);
      EXPECT_NEAR(Green(RenderIn(fog, world, spec), 32, 2), left * clear + (1.0 - left) * horizon,
                  2.0 * kHalfStep);
    }
  }
}

TEST(Daylight, CastsShadowsWhereTheSunIsHidden) {
  // The camera hangs between a roof of 4 m x 4 m, 10 m above the floor, and the floor, and looks
  // down. The sun stands in the east at 45 degrees, so that the shadow is 10 m west of the roof.
  const auto world = WorldOfParts({{MakeFloor(0.0F, 60.0F), 2, 4}, {MakeFloor(10.0F, 2.0F), 3, 5}});
  WeatherSpec weather;
  weather.sun = {.illuminance_klx = 100.0, .azimuth_deg = 0.0, .elevation_deg = 45.0};
  Transform down = Transform::Identity();
  down.linear().col(0) = -Vector3::UnitY();
  down.linear().col(1) = -Vector3::UnitX();
  down.linear().col(2) = -Vector3::UnitZ();
  down.translation() = Vector3(-10.0, 0.0, 8.0);
  // Focal length 100 pixels: 12.5 pixels a metre on the floor.
  const CameraSpec spec{.width_px = 200, .height_px = 100, .horizontal_fov_deg = 90.0};
  const CameraImage image = RenderIn(weather, world, spec, down);
  const double lit = Green(image, 20, 20);
  const double dark = Green(image, 100, 50);
  // Direct light of 1 (full sun) times sin 45 degrees, and a diffuse light of 0.2 (docs/camera.md).
  EXPECT_NEAR(lit / dark, (std::sin(45.0 * kDegree_rad) + 0.2) / 0.2, 0.1);
  EXPECT_NEAR(lit, 0.5, kHalfStep);
  std::size_t num_dark = 0;
  for (std::size_t row = 0; row < 100; ++row) {
    for (std::size_t column = 0; column < 200; ++column) {
      const bool is_dark = Green(image, column, row) < 0.5 * (lit + dark);
      num_dark += is_dark;
      const bool is_inside = column >= 75 && column < 125 && row >= 25 && row < 75;
      EXPECT_EQ(is_dark, is_inside) << column << ", " << row;
    }
  }
  EXPECT_EQ(num_dark, 50U * 50U);
}

TEST(Daylight, ShowsTheSunWhereItStands) {
  WeatherSpec weather;
  weather.sun = {.illuminance_klx = 100.0, .azimuth_deg = 10.0, .elevation_deg = 5.0};
  // 20 pixels a degree, so that the disc of 0.54 degrees has a diameter of 11.
  const CameraSpec spec{.width_px = 800, .height_px = 400, .horizontal_fov_deg = 40.0};
  const CameraImage image = RenderIn(weather, std::make_shared<SimpleWorld>(), spec);
  const Vector3 to_sun(std::cos(5 * kDegree_rad) * std::cos(10 * kDegree_rad),
                       std::cos(5 * kDegree_rad) * std::sin(10 * kDegree_rad),
                       std::sin(5 * kDegree_rad));
  const Eigen::Vector2d seen = SeenAt(spec, ForwardOptical().inverse() * to_sun);
  const auto column = static_cast<std::size_t>(std::lround(seen.x()));
  const auto row = static_cast<std::size_t>(std::lround(seen.y()));
  EXPECT_EQ(Green(image, column, row), 1.0);
  EXPECT_LT(Green(image, column + 8, row), 1.0);
  EXPECT_LT(Green(image, column, row - 8), 1.0);
}

TEST(Daylight, WhitensUpwardSurfacesUnderSnowAndDarkensWetOnes) {
  const Eigen::Vector3f up(0, 0, 1);
  const Eigen::Vector3f side(1, 0, 0);
  const Radiance grey = Radiance::Constant(0.2F);
  const Eigen::Matrix3d no_turn = Eigen::Matrix3d::Identity();
  WeatherSpec wet;
  wet.wetness = 1.0;
  EXPECT_NEAR(static_cast<double>(Daylight(wet, no_turn).Surface(grey, up, true).y()), 0.6 * 0.2,
              1e-6);
  WeatherSpec snow;
  snow.snow_cover = 1.0;
  EXPECT_NEAR(static_cast<double>(Daylight(snow, no_turn).Surface(grey, up, true).y()), 0.91, 1e-5);
  EXPECT_EQ(Daylight(snow, no_turn).Surface(grey, side, true).y(),
            Daylight({}, no_turn).Surface(grey, side, true).y());
}

}  // namespace
}  // namespace railcast
