// Triangles a thousand to a hundred thousand times as long as wide, in strips and fans. Each beam
// must hit the wall, and the sliver that it is aimed at.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "tests/stability/regime.h"
#include "tests/support/ray_cast.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"
#include "tests/support/triangle_search.h"

namespace railcast {
namespace {

/// The wall's plane x = 0 is oblique and 50 m away, so that no coordinate is a round number.
Transform WindowFromWall() {
  return MakeTransform(RotationFromYawPitchRoll(0.4, 0.1, 0.3), {50.0, 0.7, -0.4});
}

/// A wall of slivers that belong to parts 0 and 1 in turn; part k has label k + 1.
class SliverWall {
 public:
  explicit SliverWall(const Transform& mesh_from_wall) : mesh_from_wall_(mesh_from_wall) {}

  void Add(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, int part) {
    Mesh& mesh = model_.parts[static_cast<std::size_t>(part)].mesh;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Eigen::Vector2d& place : {a, b, c}) {
      mesh.vertices.emplace_back(
          (mesh_from_wall_ * Vector3(0.0, place.x(), place.y())).cast<float>());
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  [[nodiscard]] const Model& model() const { return model_; }

 private:
  Transform mesh_from_wall_;
  Model model_{"slivers", {{{}, 2, 1}, {{}, 2, 2}}};
};

/// Upright strips of `width_m`, each of two slivers, side by side over 2 m.
SliverWall Strips(double width_m,
                  double aspect,
                  const Transform& mesh_from_wall = WindowFromWall()) {
  SliverWall wall(mesh_from_wall);
  const double half_m = 0.5 * aspect * width_m;
  const int count = static_cast<int>(std::lround(2.0 / width_m));
  for (int i = 0; i < count; ++i) {
    const double y_m = -1.0 + i * width_m;
    const double next_m = -1.0 + (i + 1) * width_m;
    wall.Add({y_m, -half_m}, {next_m, -half_m}, {next_m, half_m}, i % 2);
    wall.Add({y_m, -half_m}, {next_m, half_m}, {y_m, half_m}, i % 2);
  }
  return wall;
}

constexpr double kFanRadius_m = 10.0;

/// Slivers with a common apex, `width_m` wide at the rim.
SliverWall FanOf(double width_m, int count) {
  SliverWall wall(WindowFromWall());
  const auto rim = [&](int i) {
    const double angle_rad = (i - 0.5 * count) * width_m / kFanRadius_m;
    return Eigen::Vector2d(kFanRadius_m * std::cos(angle_rad), kFanRadius_m * std::sin(angle_rad));
  };
  for (int i = 0; i < count; ++i) wall.Add({0.0, 0.0}, rim(i), rim(i + 1), i % 2);
  return wall;
}

/// A beam and the sliver that it is aimed at: 0 or 1, or -1 if it is too near to a border to tell.
struct Aimed {
  Ray ray;
  int part{};
};

// Rounding moves a beam by some micrometres at 50 m.
constexpr double kTooNear_m = 2e-5;

int PartAt(double across, double width_m) {
  const double strip = std::floor(across);
  const double inside_m = (across - strip) * width_m;
  if (inside_m < kTooNear_m || inside_m > width_m - kTooNear_m) return -1;
  return static_cast<int>(strip) % 2;
}

Aimed AimAt(const Eigen::Vector2d& place_m, int part) {
  return {RayThrough(Vector3(0.1, -0.2, 0.3),
                     WindowFromWall() * Vector3(0.0, place_m.x(), place_m.y())),
          part};
}

constexpr std::uint32_t kNumBeams = 20'000;

/// Aims half of the beams anywhere and half at the borders.
std::vector<Aimed> AtStrips(double width_m) {
  std::vector<Aimed> beams;
  for (std::uint32_t i = 0; i < kNumBeams; ++i) {
    const auto words = RandomWords(1, RandomUse::kFootprint, 0, i);
    const double y = 0.05 + 1.9 * words[0] * 0x1p-32;
    const double across = i % 2 == 0 ? y / width_m : std::round(y / width_m);
    const double z_m = 8.0 * (words[1] * 0x1p-32 - 0.5);
    beams.push_back(AimAt({-1.0 + across * width_m, z_m}, PartAt(across, width_m)));
  }
  return beams;
}

std::vector<Aimed> AtFan(double width_m, int count) {
  std::vector<Aimed> beams;
  for (std::uint32_t i = 0; i < kNumBeams; ++i) {
    const auto words = RandomWords(2, RandomUse::kFootprint, 0, i);
    const double part = 1.0 + (count - 2.0) * words[0] * 0x1p-32;
    const double across = i % 2 == 0 ? part : std::round(part);
    const double radius_m = 0.05 + 9.9 * words[1] * 0x1p-32;
    const double angle_rad = (across - 0.5 * count) * width_m / kFanRadius_m;
    beams.push_back(AimAt({radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad)},
                          PartAt(across, width_m * radius_m / kFanRadius_m)));
  }
  return beams;
}

double RangeOf(const Ray& ray) {
  const Vector3 normal = WindowFromWall().linear().col(0);
  const Vector3 direction = ray.direction.cast<double>();
  return normal.dot(WindowFromWall().translation() - ray.origin_m.cast<double>()) /
         normal.dot(direction);
}

void ExpectEverySliverIsHit(const std::string& name,
                            const SliverWall& wall,
                            const std::vector<Aimed>& beams) {
  std::vector<Ray> rays;
  for (const Aimed& beam : beams) rays.push_back(beam.ray);
  const TraceDevice device;
  const std::vector<RayHit> hits = CastRays(*SceneOf(device, wall.model()), rays, 300.0F);
  std::size_t num_lost = 0;
  std::size_t num_told = 0;
  std::size_t num_other_part = 0;
  double worst_m = 0.0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (hits[i].surface == 0) {
      ++num_lost;
      continue;
    }
    worst_m =
        std::max(worst_m, std::abs(static_cast<double>(hits[i].range_m) - RangeOf(beams[i].ray)));
    if (beams[i].part < 0) continue;
    ++num_told;
    num_other_part += hits[i].surface != static_cast<std::uint32_t>(beams[i].part) + 1 ? 1 : 0;
  }
  // Brute force is slow, so it takes only part of the beams.
  constexpr std::size_t kNumSimple = 1500;
  std::size_t num_lost_by_textbook = 0;
  for (std::size_t i = 0; i < kNumSimple; ++i) {
    const auto simple = SearchTriangles<float>(wall.model().parts, Eigen::Isometry3f::Identity(),
                                               rays[i].origin_m, rays[i].direction);
    num_lost_by_textbook += std::isinf(simple.range_m) ? 1 : 0;
  }
  if (name.ends_with("1e5:1")) {
    RecordRegime("slivers, " + name,
                 {"textbook intersection in float32: " +
                      TwoDigits(100.0 * static_cast<double>(num_lost_by_textbook) / kNumSimple) +
                      " % of the beams lost",
                  std::to_string(num_lost + num_other_part) + " lost or mislabelled, ranges to " +
                      TwoDigits(1e3 * worst_m) + " mm"});
  }
  EXPECT_EQ(num_lost, 0U) << name;
  EXPECT_EQ(num_other_part, 0U) << name;
  EXPECT_GT(num_told, 500U) << name;
  EXPECT_LE(worst_m, 2e-4) << name;
  EXPECT_GT(num_lost_by_textbook, kNumSimple / 100) << name;
}

TEST(SkinnyTriangles, StripsOfSliversLoseNoBeam) {
  ExpectEverySliverIsHit("strips 1000:1", Strips(1e-2, 1e3), AtStrips(1e-2));
  ExpectEverySliverIsHit("strips 1e5:1", Strips(1e-3, 1e5), AtStrips(1e-3));
}

TEST(SkinnyTriangles, FansOfSliversLoseNoBeam) {
  ExpectEverySliverIsHit("fan 1000:1", FanOf(1e-2, 600), AtFan(1e-2, 600));
  ExpectEverySliverIsHit("fan 1e5:1", FanOf(1e-4, 4000), AtFan(1e-4, 4000));
}

/// Returns the largest error of the angle of incidence over a raster that meets the wall.
double WorstIncidence_rad(const std::shared_ptr<SimpleWorld>& world) {
  const ScanPattern pattern = MakeRaster(1.8, 4, 0.02);
  const Frame frame = ScanOnce(world, pattern);
  double worst_rad = 0.0;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const std::size_t slot = pattern.row[i] * pattern.columns + pattern.column[i];
    if (frame.label[slot] == 0) continue;
    const double truth_rad =
        std::acos(std::abs(DirectionOf(pattern, i).dot(WindowFromWall().linear().col(0))));
    worst_rad =
        std::max(worst_rad, std::abs(static_cast<double>(frame.incidence_rad[slot]) - truth_rad));
  }
  EXPECT_GT(worst_rad, 0.0);
  return worst_rad;
}

// Rounding of its corners tilts a sliver: 2 um at 50 m from the origin are 2 mrad across 1 mm. In a
// frame of its own it is not tilted, which is why each model has one.
TEST(SkinnyTriangles, LeanWhereTheirModelIsFarFromItsOrigin) {
  auto far = std::make_shared<SimpleWorld>();
  far->ground = Strips(1e-3, 1e5).model();
  auto own = std::make_shared<SimpleWorld>();
  own->AddObject(std::make_shared<Model>(Strips(1e-3, 1e5, Transform::Identity()).model()),
                 WindowFromWall());
  const double far_rad = WorstIncidence_rad(far);
  const double own_rad = WorstIncidence_rad(own);
  RecordRegime("incidence on slivers 1 mm wide",
               {"model 50 m from its origin: " + TwoDigits(1e3 * far_rad) + " mrad off",
                "model about its own origin: " + TwoDigits(1e3 * own_rad) + " mrad off"});
  EXPECT_GT(far_rad, 1e-3);
  EXPECT_LE(own_rad, 2e-6);
}

}  // namespace
}  // namespace railcast
