#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/units.h"
#include "core/rail/base/model_parts.h"
#include "core/rail/ground/plant_dice.h"
#include "core/rail/objects/debris.h"
#include "core/rail/objects/lofted_body.h"

namespace railcast {
namespace {

using Point2 = Eigen::Vector2d;

constexpr std::uint64_t kStoneSeed = 13450;

/// An angular stone about the origin: a ball of radius 1 cut by random planes, whose points lie on
/// `num_rings` rings.
Mesh MakeStone(int num_rings, PlantDice& dice) {
  struct Cut {
    Vector3 normal;
    double distance{};
  };
  std::vector<Cut> cuts;
  for (int i = 0; i < 26; ++i) cuts.push_back({dice.Direction(), dice.Uniform(0.6, 0.95)});
  std::vector<Rib> ribs;
  const int num_sides = 2 * num_rings;
  for (int ring = 0; ring <= num_rings; ++ring) {
    const double polar_rad = std::numbers::pi * ring / num_rings;
    Rib rib;
    for (int side = 0; side < num_sides; ++side) {
      const double azimuth_rad = 2.0 * std::numbers::pi * side / num_sides;
      const bool is_pole = ring == 0 || ring == num_rings;
      const double sine = is_pole ? 0.0 : std::sin(polar_rad);
      const Vector3 out(sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad),
                        std::cos(polar_rad));
      double radius = 1.0;
      for (const Cut& cut : cuts) {
        const double cosine = out.dot(cut.normal);
        if (cosine > 0.0) radius = std::min(radius, cut.distance / cosine);
      }
      rib.emplace_back(radius * out);
    }
    ribs.push_back(std::move(rib));
  }
  return MakeLoftedBody(ribs);
}

/// Turns a stone at random, stretches it by up to a third and lays it down at `middle_m`.
void LayStone(
    const Mesh& stone, const Vector3& middle_m, double radius_m, PlantDice& dice, Mesh& stones) {
  const Eigen::Matrix3d turn = RotationFromYawPitchRoll(
      dice.Uniform(0, kTurn_rad), dice.Uniform(-0.5, 0.5), dice.Uniform(-0.5, 0.5));
  const Vector3 stretch(dice.Uniform(1.0, 1.3), dice.Uniform(0.8, 1.0), dice.Uniform(0.65, 0.85));
  Mesh laid = stone;
  for (Eigen::Vector3f& vertex : laid.vertices) {
    const Vector3 point = radius_m * (turn * stretch.cwiseProduct(vertex.cast<double>()));
    // None reaches below the ground.
    vertex = (middle_m + point).cwiseMax(Vector3(-1e3, -1e3, 0.0)).cast<float>();
  }
  stones.Append(laid);
}

/// Leaves out the triangles that have lost their area, where a stone is cut off at the ground.
Mesh WithoutFlatTriangles(const Mesh& mesh) {
  Mesh sound;
  sound.vertices = mesh.vertices;
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d ab =
        (mesh.vertices[triangle[1]] - mesh.vertices[triangle[0]]).cast<double>();
    const Eigen::Vector3d ac =
        (mesh.vertices[triangle[2]] - mesh.vertices[triangle[0]]).cast<double>();
    if (ab.cross(ac).norm() > 0.0) sound.triangles.push_back(triangle);
  }
  return sound;
}

}  // namespace

Model MakeBoulder(const DebrisSurfaces& surfaces) {
  PlantDice dice(kStoneSeed, 1);
  Model boulder{.name = "boulder", .parts = {}};
  MeshOf(surfaces.stone, boulder) = MakeStone(16, dice);
  ScaleTo({0.80, 0.68, 0.56}, boulder);
  return boulder;
}

Model MakeBallastHeap(const DebrisSurfaces& surfaces) {
  constexpr double kRadius_m = 0.75;
  const double height_m = kRadius_m * std::tan(RadFromDeg(37.0));  // Angle of repose.
  constexpr int kNumStones = 420;
  PlantDice dice(kStoneSeed, 2);
  // The heap's core, on which the visible stones lie.
  constexpr int kNumSides = 40;
  std::vector<Rib> ribs;
  for (const double share :
       {1.0, 0.93, 0.86, 0.78, 0.7, 0.62, 0.54, 0.46, 0.38, 0.29, 0.2, 0.1, 0.03}) {
    Rib rib;
    for (int side = 0; side < kNumSides; ++side) {
      const double angle_rad = kTurn_rad * side / kNumSides;
      const double radius_m = (kRadius_m - 0.04) * share * dice.Uniform(0.97, 1.03);
      const double grain_m = share == 1.0 ? 0.0 : dice.Uniform(-0.025, 0.025);
      rib.emplace_back(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad),
                       (1.0 - share) * (height_m - 0.05) + grain_m);
    }
    ribs.push_back(std::move(rib));
  }
  Mesh stones = MakeLoftedBody(ribs);
  const std::vector<Mesh> shapes = {MakeStone(2, dice), MakeStone(2, dice), MakeStone(2, dice)};
  for (int i = 0; i < kNumStones; ++i) {
    const double radius_m = dice.Uniform(0.026, 0.038);
    const double share = std::sqrt((i + 0.5) / kNumStones);
    const double angle_rad = 2.39996 * i + dice.Uniform(-0.5, 0.5);  // Golden angle.
    const double from_middle_m = share * (kRadius_m - 0.036);
    LayStone(shapes[static_cast<std::size_t>(i) % shapes.size()],
             {from_middle_m * std::cos(angle_rad), from_middle_m * std::sin(angle_rad),
              (1.0 - share) * (height_m - 0.04) + dice.Uniform(0.0, 0.015)},
             radius_m, dice, stones);
  }
  Model heap{.name = "ballast_heap", .parts = {}};
  MeshOf(surfaces.stone, heap) = WithoutFlatTriangles(stones);
  ScaleTo({2.0 * kRadius_m, 2.0 * kRadius_m, height_m}, heap);
  return heap;
}

Model MakeLandslide(const DebrisSurfaces& surfaces) {
  constexpr double kWidth_m = 8.0;
  constexpr double kLength_m = 6.0;
  constexpr double kHeight_m = 1.2;
  constexpr int kNumRibs = 22;
  constexpr int kNumColumns = 26;
  PlantDice dice(kStoneSeed, 3);
  const auto half_width_m = [](double share) {  // From the slope, 0, to the toe, 1.
    return 0.5 * kWidth_m * std::min(1.0, 0.55 + 0.75 * share) *
           std::sqrt(std::max(0.0, 1.0 - std::pow(share, 6.0)));
  };
  const auto height_m = [](double share, double across) {
    return kHeight_m * std::pow(1.0 - share, 0.75) * (1.0 - across * across) *
           (1.0 - 0.25 * std::sin(9.0 * share + 3.0 * across) * share);
  };
  std::vector<Rib> ribs;
  for (int i = 0; i < kNumRibs; ++i) {
    const double share = 0.998 * i / (kNumRibs - 1.0);
    const double y_m = (0.5 - share) * kLength_m;
    Rib rib;
    for (int column = 0; column <= kNumColumns; ++column) {
      const double across = 2.0 * column / kNumColumns - 1.0;
      const double grain = i == 0 ? 1.0 : dice.Uniform(0.85, 1.12);
      rib.emplace_back(across * half_width_m(share), y_m,
                       grain * height_m(share, across) + 0.01 * (1.0 - std::abs(across)));
    }
    // Its underside.
    rib.emplace_back(0.5 * half_width_m(share), y_m, 0.0);
    rib.emplace_back(-0.5 * half_width_m(share), y_m, 0.0);
    ribs.push_back(std::move(rib));
  }
  Model slide{.name = "landslide", .parts = {}};
  MeshOf(surfaces.soil, slide) = MakeLoftedBody(ribs);
  const std::vector<Mesh> shapes = {MakeStone(5, dice), MakeStone(5, dice), MakeStone(5, dice)};
  Mesh stones;
  for (int i = 0; i < 36; ++i) {
    const double share = 1.0 - 0.9 * std::pow(dice.Uniform(0.0, 1.0), 1.5);
    const double across = dice.Uniform(-0.8, 0.8);
    const double radius_m = 0.06 + 0.24 * std::pow(dice.Uniform(0.0, 1.0), 2.5);
    const double beyond = std::min(share, 0.93);
    LayStone(shapes[static_cast<std::size_t>(i) % shapes.size()],
             {across * half_width_m(beyond), (0.5 - beyond) * kLength_m,
              height_m(beyond, across) + 0.3 * radius_m},
             radius_m, dice, stones);
  }
  MeshOf(surfaces.stone, slide) = WithoutFlatTriangles(stones);
  ScaleTo({kWidth_m, kLength_m, kHeight_m}, slide);
  return slide;
}

}  // namespace railcast
