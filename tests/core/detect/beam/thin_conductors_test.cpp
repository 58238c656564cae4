#include "core/detect/beam/thin_conductors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "core/detect/beam/wire_in_beam.h"
#include "railcast/lidar.h"
#include "tests/support/ray_cast.h"

namespace railcast {
namespace {

constexpr double kSigmaH_rad = 0.75e-3;
constexpr double kSigmaV_rad = 0.375e-3;
const BeamShape kVlp16Beam{Eigen::Vector3f::UnitZ(), kSigmaH_rad, kSigmaV_rad};

void SetRay(RayTile& rays, std::size_t i, const Vector3& origin_m, const Vector3& direction) {
  SetRay(rays, i, {origin_m.cast<float>(), direction.cast<float>()}, 0.0F);
}

/// Columns of beams 4 mrad apart around a point, from a sensor that moves by 0.5 m during the scan.
std::unique_ptr<RayTile> RasterTowards(const Vector3& target_m, std::size_t num_columns = 16) {
  auto rays = std::make_unique<RayTile>();
  rays->num_rays = kTileSize;
  const Vector3 forward = target_m.normalized();
  const Vector3 left = Vector3::UnitZ().cross(forward).normalized();
  for (std::size_t i = 0; i < kTileSize; ++i) {
    const double x = 0.004 * (static_cast<double>(i % num_columns) - 7.3);
    const std::size_t row = i / num_columns;
    const double y = 0.004 * (static_cast<double>(row) - 7.4);
    const double time = static_cast<double>(i) / kTileSize - 0.5;
    SetRay(*rays, i, {0.4 * time, 0.3 * time, 0.0},
           (forward + x * left + y * forward.cross(left)).normalized());
  }
  return rays;
}

Vector3 OriginOf(const RayTile& rays, std::size_t i) {
  return Eigen::Vector3f(rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]).cast<double>();
}

Vector3 DirectionOf(const RayTile& rays, std::size_t i) {
  return Eigen::Vector3f(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i])
      .cast<double>();
}

/// Beams in random directions from random origins within a few metres.
std::unique_ptr<RayTile> ScatteredRays() {
  auto rays = std::make_unique<RayTile>();
  rays->num_rays = kTileSize;
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < kTileSize; ++i) {
    const Vector3 origin_m{normal(engine), normal(engine), normal(engine)};
    SetRay(*rays, i, origin_m,
           Vector3{normal(engine), normal(engine), normal(engine)}.normalized());
  }
  return rays;
}

/// Contact wires, messenger wires and droppers of two tracks, and wires in all directions.
WireSet MakeWires() {
  WireSet wires;
  for (const double y_m : {0.1, 4.2}) {
    std::vector<Vector3> contact_m, messenger_m;
    for (int i = -60; i <= 60; ++i) {
      const double x_m = 5.0 * i;
      contact_m.emplace_back(x_m, y_m + 0.02 * (i % 12), 3.0);
      messenger_m.emplace_back(x_m, y_m, 4.0 + 2e-4 * (x_m - 30.0) * (x_m - 30.0) / 4.0);
      wires.Add({contact_m.back(), messenger_m.back()}, 2.25e-3, 3);
    }
    wires.Add(contact_m, 6e-3, 1);
    wires.Add(messenger_m, 5.25e-3, 2);
  }
  std::mt19937 engine(5);
  std::normal_distribution<double> normal(0.0, 15.0);
  for (int i = 0; i < 200; ++i) {
    const Vector3 begin_m{normal(engine), normal(engine), normal(engine)};
    const Vector3 run_m{normal(engine), normal(engine), normal(engine)};
    wires.Add({begin_m, begin_m + 0.3 * run_m, begin_m + 0.5 * run_m}, 6e-3, 4);
  }
  return wires;
}

/// Tests every beam against every segment, without the bounds that CaptureWires uses.
std::vector<WireCapture> CaptureSlowly(const RayTile& rays,
                                       const BeamShape& shape,
                                       const WireSet& wires) {
  std::vector<WireCapture> captures;
  for (std::uint32_t i = 0; i < rays.num_rays; ++i) {
    WideBeam beam{.origin_m = OriginOf(rays, i),
                  .direction = DirectionOf(rays, i),
                  .horizontal = {},
                  .vertical = {},
                  .sigma_horizontal_rad = shape.sigma_horizontal_rad,
                  .sigma_vertical_rad = shape.sigma_vertical_rad};
    beam.direction.normalize();
    beam.horizontal = shape.up_window.cast<double>().cross(beam.direction).normalized();
    beam.vertical = beam.direction.cross(beam.horizontal);
    for (const WireSegment& wire : wires.segments) {
      const WireInBeam found = FindWireInBeam(beam, wire);
      if (!(found.share > kLeastWireShare)) continue;
      captures.push_back({i, wire.surface, static_cast<float>(found.range_m),
                          static_cast<float>(found.share), static_cast<float>(found.spread_m),
                          static_cast<float>(found.sin_axis)});
    }
  }
  std::stable_sort(captures.begin(), captures.end(),
                   [](const WireCapture& a, const WireCapture& b) {
                     return a.lane != b.lane ? a.lane < b.lane : a.range_m < b.range_m;
                   });
  return captures;
}

std::vector<WireCapture> Capture(const RayTile& rays,
                                 const WireSet& wires,
                                 const BeamShape& shape = kVlp16Beam) {
  std::vector<WireCapture> captures;
  CaptureWires(rays, shape, wires, captures);
  return captures;
}

void ExpectSame(const std::vector<WireCapture>& a, const std::vector<WireCapture>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].lane, b[i].lane);
    EXPECT_EQ(a[i].surface, b[i].surface);
    EXPECT_EQ(a[i].range_m, b[i].range_m);
    EXPECT_EQ(a[i].share, b[i].share);
    EXPECT_EQ(a[i].spread_m, b[i].spread_m);
    EXPECT_EQ(a[i].sin_axis, b[i].sin_axis);
  }
}

TEST(CaptureWires, FindsWhatEveryBeamAgainstEverySegmentFinds) {
  const WireSet wires = MakeWires();
  std::size_t num_found = 0;
  for (const Vector3& target_m :
       {Vector3(60, 0, 3), Vector3(20, 0, 3), Vector3(200, 2, 3), Vector3(-30, 4, 4),
        Vector3(1, 5, 1), Vector3(0.1, 0.1, 3), Vector3(5, -20, -8)}) {
    for (const std::size_t num_columns : {16U, 4U, 128U}) {
      const auto rays = RasterTowards(target_m, num_columns);
      for (const double scale : {0.0, 0.3, 1.0, 6.0}) {  // Up to 1 deg full angle.
        const BeamShape shape{Eigen::Vector3f::UnitZ(), scale * kSigmaH_rad, scale * kSigmaV_rad};
        const auto captures = Capture(*rays, wires, shape);
        ExpectSame(captures, CaptureSlowly(*rays, shape, wires));
        num_found += captures.size();
      }
    }
  }
  EXPECT_GT(num_found, 6000U);
  const auto scattered = ScatteredRays();
  const BeamShape wide{Eigen::Vector3f::UnitZ(), 6.0 * kSigmaH_rad, 6.0 * kSigmaV_rad};
  const auto captures = Capture(*scattered, wires, wide);
  ExpectSame(captures, CaptureSlowly(*scattered, wide, wires));
  EXPECT_GT(captures.size(), 10U);
}

TEST(CaptureWires, ABeamsCapturesDoNotDependOnItsTile) {
  const WireSet wires = MakeWires();
  const auto raster = RasterTowards({60, 0, 3});
  const auto scattered = ScatteredRays();
  const auto alone = Capture(*raster, wires);
  ASSERT_GT(alone.size(), 100U);
  // Mix every fourth beam of the raster with beams in all directions.
  auto mixed = std::make_unique<RayTile>(*scattered);
  const auto is_raster = [](std::uint32_t lane) { return lane % 4 == 0; };
  for (std::uint32_t i = 0; i < kTileSize; ++i) {
    if (!is_raster(i)) continue;
    SetRay(*mixed, i, OriginOf(*raster, i), DirectionOf(*raster, i));
  }
  const auto keep = [&](std::vector<WireCapture> captures) {
    std::erase_if(captures, [&](const WireCapture& c) { return !is_raster(c.lane); });
    return captures;
  };
  ExpectSame(keep(alone), keep(Capture(*mixed, wires)));
  EXPECT_GT(keep(alone).size(), 20U);
}

TEST(CaptureWires, TwoWiresInABeamAreTwoCapturesTheNearerFirst) {
  WireSet wires;
  wires.Add({{60, -3, 0.01}, {60, 3, 0.01}}, 6e-3, 8);
  wires.Add({{50, -3, -0.01}, {50, 3, -0.01}}, 6e-3, 9);
  auto rays = std::make_unique<RayTile>();
  rays->num_rays = kPacketSize;
  for (std::size_t i = 0; i < kPacketSize; ++i) {
    SetRay(*rays, i, Vector3::Zero(), Vector3(i == 5 ? 1.0 : -1.0, 0.0, 0.0));
  }
  std::vector<WireCapture> captures(1);  // Captures that exist already must be kept.
  CaptureWires(*rays, kVlp16Beam, wires, captures);
  ASSERT_EQ(captures.size(), 3U);
  EXPECT_EQ(captures[1].lane, 5U);
  EXPECT_EQ(captures[2].lane, 5U);
  EXPECT_EQ(captures[1].surface, 9U);
  EXPECT_EQ(captures[2].surface, 8U);
  EXPECT_NEAR(captures[1].range_m, 50.0F, 0.01F);
  EXPECT_NEAR(captures[2].range_m, 60.0F, 0.01F);
}

TEST(CaptureWires, TurningEverythingChangesNothing) {
  const auto rays = RasterTowards({60, 0, 3});
  WireSet wires;
  std::vector<std::vector<Vector3>> lines;
  for (int i = 0; i < 12; ++i) {
    lines.push_back({Vector3(60, -4, 1.5 + 0.25 * i), Vector3(62, 4, 1.75 + 0.25 * i)});
  }
  for (const auto& line : lines) wires.Add(line, 6e-3, 1);
  const BeamShape wide{Eigen::Vector3f::UnitZ(), kSigmaH_rad, kSigmaH_rad};
  const auto before = Capture(*rays, wires, wide);
  ASSERT_GT(before.size(), 50U);
  for (const double angle_rad : {0.5 * std::numbers::pi, 0.4, 2.0}) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angle_rad, Vector3(1, 2, 3).normalized()).toRotationMatrix();
    auto turned = std::make_unique<RayTile>();
    turned->num_rays = kTileSize;
    for (std::size_t i = 0; i < kTileSize; ++i) {
      SetRay(*turned, i, turn * OriginOf(*rays, i), turn * DirectionOf(*rays, i));
    }
    WireSet turned_wires;
    for (const auto& line : lines) turned_wires.Add({turn * line[0], turn * line[1]}, 6e-3, 1);
    const auto after =
        Capture(*turned, turned_wires,
                {(turn * Vector3::UnitZ()).cast<float>(), wide.sigma_horizontal_rad, kSigmaH_rad});
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
      EXPECT_EQ(after[i].lane, before[i].lane);
      // Rounding turns a beam by 1e-7 rad, which is 1.3e-4 sigma. A share changes by at most
      // 2 a phi'(1) = 0.48 * 6e-3 / (60 * 0.75e-3) = 0.065 per sigma.
      EXPECT_NEAR(after[i].share, before[i].share, 1e-5F);
      EXPECT_NEAR(after[i].range_m, before[i].range_m, 1e-3F);
    }
  }
}

TEST(CaptureWires, NothingIsFoundWhereThereIsNothing) {
  const auto rays = RasterTowards({60, 0, 3});
  EXPECT_TRUE(Capture(*rays, {}).empty());
  EXPECT_TRUE(Capture(RayTile{}, MakeWires()).empty());
}

// Every beam captures what it would of wires that stand still where they are at its own time.
TEST(CaptureWires, FindsMovingWiresWhereTheyAreAtTheBeamsTime) {
  const std::vector<Vector3> points_m = {{30.0, -40.0, 1.0}, {30.5, 0.0, 0.9}, {31.0, 40.0, 1.1}};
  const std::vector<Vector3> moves_m = {{0.0, 0.0, 0.3}, {0.2, 0.0, -0.4}, {-0.1, 0.0, 0.2}};
  WireSet moving;
  moving.Add(points_m, 6e-3, 1, moves_m);
  std::size_t num_expected = 0;
  std::size_t num_captures = 0;
  for (int target = -8; target <= 8; ++target) {
    const auto rays = RasterTowards({30.0, 1.1 * target, 1.0});
    for (std::size_t i = 0; i < kTileSize; ++i) {
      rays->shutter[i] = static_cast<float>(i % 8) / 7.0F;
    }
    std::vector<WireCapture> captures;
    CaptureWires(*rays, kVlp16Beam, moving, captures);
    num_captures += captures.size();
    for (std::uint32_t k = 0; k < 8; ++k) {
      std::vector<Vector3> now_m = points_m;
      for (std::size_t p = 0; p < 3; ++p) now_m[p] += k / 7.0 * moves_m[p];
      WireSet still;
      still.Add(now_m, 6e-3, 1);
      for (const WireCapture& expected : CaptureSlowly(*rays, kVlp16Beam, still)) {
        if (expected.lane % 8 != k) continue;
        ++num_expected;
        const auto found = std::find_if(captures.begin(), captures.end(), [&](const auto& capture) {
          return capture.lane == expected.lane &&
                 std::fabs(capture.range_m - expected.range_m) < 1e-3F;
        });
        ASSERT_NE(found, captures.end()) << expected.lane;
        EXPECT_NEAR(found->share, expected.share, 2e-3F * expected.share + 1e-5F);
      }
    }
  }
  EXPECT_EQ(num_captures, num_expected);
  EXPECT_GT(num_expected, 100U);
}

/// A strip of even width through the whole beam at an angle to the horizontal.
WireCapture StripAt(double angle_rad, float offset, float half_width) {
  return {
      .strip = {{static_cast<float>(std::cos(angle_rad)), static_cast<float>(std::sin(angle_rad))},
                offset,
                -6.0F,
                6.0F,
                {half_width, half_width}}};
}

double ShareBetween(double begin, double end) {
  return 0.5 * (std::erf(end / std::numbers::sqrt2) - std::erf(begin / std::numbers::sqrt2));
}

TEST(HiddenShare, OfACrossingWireIsTheBeamOnTheCrossing) {
  const WireCapture level = StripAt(0.0, 0.3F, 0.01F);
  const double up_rad = 0.5 * std::numbers::pi;
  for (const float half_width : {0.05F, 0.4F, 0.7F}) {
    for (const float place : {0.0F, 0.75F, -1.5F}) {
      // An axis that points up has its positive side to the left.
      const WireCapture front[] = {StripAt(up_rad, -place, half_width)};
      const auto at = static_cast<double>(place);
      const auto half = static_cast<double>(half_width);
      EXPECT_NEAR(HiddenShare(level, front), ShareBetween(at - half, at + half), 1e-4);
    }
  }
  // At 30 degrees the crossing is twice as long, and lies where the axes cross.
  const WireCapture slanting[] = {StripAt(std::numbers::pi / 6.0, 0.0F, 0.2F)};
  const double middle = 0.3 * std::sqrt(3.0);
  EXPECT_NEAR(HiddenShare(level, slanting), ShareBetween(middle - 0.4, middle + 0.4), 1e-3);
}

TEST(HiddenShare, OfTheSameStripIsAllAndOfOverlappingOnesIsCountedOnce) {
  const WireCapture level = StripAt(0.0, 0.3F, 0.01F);
  const WireCapture thicker[] = {StripAt(0.0, 0.3F, 0.02F)};
  EXPECT_NEAR(HiddenShare(level, thicker), 1.0, 1e-6);
  const WireCapture beside[] = {StripAt(0.0, 0.4F, 0.02F)};
  EXPECT_EQ(HiddenShare(level, beside), 0.0F);
  const double up_rad = 0.5 * std::numbers::pi;
  const WireCapture two[] = {StripAt(up_rad, 0.0F, 0.4F), StripAt(up_rad, -0.3F, 0.4F)};
  EXPECT_NEAR(HiddenShare(level, two), ShareBetween(-0.4, 0.7), 1e-4);
  EXPECT_EQ(HiddenShare(level, {}), 0.0F);
}

}  // namespace
}  // namespace railcast
