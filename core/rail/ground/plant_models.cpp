#include "core/rail/ground/plant_models.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "core/rail/base/rail_surfaces.h"

namespace railcast {
namespace {

constexpr double kRoot_m = 0.3;

struct TreeForm {
  std::string name;
  double height_m{};
  double crown_base_m{};
  double crown_radius_m{};
  double trunk_radius_m{};
};

/// A twig, about which leaves are placed.
struct Twig {
  Vector3 begin_m;
  Vector3 end_m;
};

struct Leaf {
  double length_m{};
  double width_m{};
  double scatter_m{};  ///< Distance from its twig.
  double along{};      ///< 1 = along the twig, 0 = random direction.
  /// Area of merged leaves by level, as a share of that of the leaves they stand for. What is
  /// missing makes up for their hiding each other less and for their reaching out of the crown:
  /// trees of all levels stop as many beams (measured by the tests).
  std::array<double, 4> merged_areas{};
};

constexpr double kLeafAreaIndex = 3.2;
constexpr Leaf kBroadLeaf{.length_m = 0.09,
                          .width_m = 0.08,
                          .scatter_m = 0.28,
                          .along = 0.0,
                          .merged_areas = {0.975, 0.94, 0.92, 0.885}};
constexpr Leaf kNeedleShoot{.length_m = 0.11,
                            .width_m = 0.05,
                            .scatter_m = 0.14,
                            .along = 0.5,
                            .merged_areas = {0.94, 0.87, 0.835, 0.79}};

/// A random unit vector perpendicular to `direction`.
Vector3 PerpendicularTo(const Vector3& direction, PlantDice& dice) {
  Vector3 other = direction.cross(dice.Direction());
  while (other.norm() < 0.1) other = direction.cross(dice.Direction());
  return other.normalized();
}

void AddLeaf(const Twig& twig, const Leaf& leaf, PlantDice& dice, Mesh& leaves) {
  const Vector3 along = twig.end_m - twig.begin_m;
  const Vector3 middle_m =
      twig.begin_m + dice.Uniform(0.0, 1.0) * along + dice.Offset(leaf.scatter_m);
  const Vector3 tip =
      (leaf.along * along.normalized() + (1.0 - leaf.along) * dice.Direction()).normalized();
  const double size = dice.Uniform(0.8, 1.2);
  const Vector3 half_length_m = 0.5 * size * leaf.length_m * tip;
  const Vector3 half_width_m = 0.5 * size * leaf.width_m * PerpendicularTo(tip, dice);
  const auto first = static_cast<std::uint32_t>(leaves.vertices.size());
  leaves.vertices.emplace_back((middle_m - half_length_m - half_width_m).cast<float>());
  leaves.vertices.emplace_back((middle_m - half_length_m + half_width_m).cast<float>());
  leaves.vertices.emplace_back((middle_m + half_length_m).cast<float>());
  leaves.triangles.push_back({first, first + 1, first + 2});
}

/// Distributes leaves evenly over the length of all twigs.
Mesh MakeLeaves(const TreeForm& form,
                std::span<const Twig> twigs,
                const Leaf& leaf,
                PlantDice& dice) {
  const double projection_m2 = std::numbers::pi * form.crown_radius_m * form.crown_radius_m;
  const double leaf_m2 = 0.5 * leaf.length_m * leaf.width_m;
  const double num_leaves = kLeafAreaIndex * projection_m2 / leaf_m2;
  double length_m = 0.0;
  for (const Twig& twig : twigs) length_m += (twig.end_m - twig.begin_m).norm();
  Mesh leaves;
  double due = 0.0;
  for (const Twig& twig : twigs) {
    due += num_leaves * (twig.end_m - twig.begin_m).norm() / length_m;
    for (; due >= 1.0; due -= 1.0) AddLeaf(twig, leaf, dice, leaves);
  }
  return leaves;
}

/// Centre line of a trunk from below the ground to `top_m`, deviating by up to `wander_m` per
/// metre.
std::vector<Vector3> TrunkLine(double top_m, double wander_m, PlantDice& dice) {
  std::vector<Vector3> line = {{0, 0, -kRoot_m}, {0, 0, 0}};
  const int num_pieces = static_cast<int>(std::ceil(top_m));
  for (int i = 1; i <= num_pieces; ++i) {
    line.emplace_back(line.back().x() + dice.Uniform(-wander_m, wander_m),
                      line.back().y() + dice.Uniform(-wander_m, wander_m), top_m * i / num_pieces);
  }
  return line;
}

/// The point on the trunk's centre line at a height above the ground.
Vector3 OnTrunk(const std::vector<Vector3>& line, double height_m) {
  std::size_t i = 1;
  while (i + 2 < line.size() && line[i + 1].z() < height_m) ++i;
  const double t = (height_m - line[i].z()) / (line[i + 1].z() - line[i].z());
  return line[i] + t * (line[i + 1] - line[i]);
}

Vector3 Slanting(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::cos(azimuth_rad),
          std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

/// Distance from a point within the crown's ellipsoid to its surface.
double ReachInCrown(const TreeForm& form, const Vector3& from_m, const Vector3& direction) {
  const double half_height_m = 0.5 * (form.height_m - form.crown_base_m);
  const Vector3 scale(1.0 / form.crown_radius_m, 1.0 / form.crown_radius_m, 1.0 / half_height_m);
  const Vector3 p = scale.cwiseProduct(from_m - Vector3(0, 0, form.crown_base_m + half_height_m));
  const Vector3 d = scale.cwiseProduct(direction);
  const double b = p.dot(d);
  const double discriminant = b * b - d.squaredNorm() * (p.squaredNorm() - 1.0);
  if (discriminant <= 0.0) return 0.0;
  return std::max(0.0, (std::sqrt(discriminant) - b) / d.squaredNorm());
}

/// One of a tree's coarser forms. Of 2 and of 4 leaves, one stays as wide as it is, since the width
/// decides how much of a beam a leaf covers; no beam within range is wide enough for the others.
struct TreeLevel {
  std::size_t num{};
  double widening{};
  double beam_width_m{};
};
constexpr std::array<TreeLevel, 4> kTreeLevels = {
    {{2, 1.0, 0.0}, {4, 1.0, 0.0}, {8, 2.0, 1.0}, {16, 4.0, 2.0}}};

/// The tree and its coarser forms.
PlantModel AssembleTree(const std::string& name,
                        std::span<const Stem> stems,
                        const Mesh& leaves,
                        const Leaf& leaf,
                        const RailSurfaces& surfaces) {
  // A leaf of a level then has an area of 1.8 x 1.8 spacings.
  constexpr double kRaySpacingPerPiece = 0.55;
  const auto make = [&](const std::string& model_name, Mesh wood, Mesh foliage) {
    Model tree{.name = model_name, .parts = {}, .is_foliage = true};
    MeshOf(surfaces.bark, tree) = std::move(wood);
    MeshOf(surfaces.leaf, tree) = std::move(foliage);
    return std::make_shared<const Model>(std::move(tree));
  };
  std::vector<CoarserModel> coarser;
  for (std::size_t i = 0; i < kTreeLevels.size(); ++i) {
    const TreeLevel& level = kTreeLevels[i];
    const double piece_m = std::sqrt(static_cast<double>(level.num)) * leaf.length_m;
    coarser.push_back(
        {make(name + "_" + std::to_string(level.num), FlattenedWood(stems, 0.5 * piece_m),
              MergedLeaves(leaves, {level.num, level.widening, leaf.merged_areas[i]})),
         kRaySpacingPerPiece * piece_m, level.beam_width_m});
  }
  PlantModel tree{make(name, WoodOf(stems), leaves),
                  std::make_shared<const std::vector<CoarserModel>>(std::move(coarser))};
  tree.height_m = tree.model->Bounds().max().z();
  return tree;
}

PlantModel MakeBroadleaf(const TreeForm& form, const RailSurfaces& surfaces, PlantDice dice) {
  constexpr int kNumBranches = 26;
  constexpr int kTwigsPerBranch = 6;
  std::vector<Stem> stems;
  std::vector<Twig> twigs;
  const std::vector<Vector3> trunk = TrunkLine(0.93 * form.height_m, 0.07, dice);
  stems.push_back({trunk, form.trunk_radius_m, 0.02, 8});
  for (int i = 0; i < kNumBranches; ++i) {
    const double t = (i + 0.5) / kNumBranches;
    const double foot_z_m = form.crown_base_m + t * (0.92 * form.height_m - form.crown_base_m);
    const Vector3 foot_m = OnTrunk(trunk, foot_z_m);
    const double elevation_rad = RadFromDeg(10.0 + 50.0 * t + dice.Uniform(-10.0, 10.0));
    const double azimuth_rad = kGoldenAngle_rad * i + dice.Uniform(-0.4, 0.4);
    const Vector3 direction = Slanting(azimuth_rad, elevation_rad);
    const double length_m =
        std::max(0.5, dice.Uniform(0.75, 0.98) * ReachInCrown(form, foot_m, direction));
    const Vector3 middle_m = foot_m + 0.5 * length_m * direction + dice.Offset(0.08 * length_m);
    const Vector3 tip_m = foot_m + length_m * direction + Vector3(0, 0, 0.10 * length_m);
    stems.push_back({{foot_m, middle_m, tip_m}, 0.012 + 0.012 * length_m, 0.006, 5});
    twigs.push_back({middle_m, tip_m});
    for (int k = 0; k < kTwigsPerBranch; ++k) {
      const double along = 0.3 + 0.7 * (k + 0.5) / kTwigsPerBranch;
      const Vector3 at_m = along < 0.5 ? foot_m + 2.0 * along * (middle_m - foot_m)
                                       : middle_m + (2.0 * along - 1.0) * (tip_m - middle_m);
      const Vector3 sideways = PerpendicularTo(direction, dice);
      const Vector3 twig_direction = (0.6 * direction + 0.8 * sideways).normalized();
      const double reach_m = ReachInCrown(form, at_m, twig_direction);
      const double twig_m =
          std::clamp(0.45 * length_m * dice.Uniform(0.7, 1.3), 0.2, std::max(0.25, reach_m));
      const Twig twig{at_m, at_m + twig_m * twig_direction};
      stems.push_back({{twig.begin_m, twig.end_m}, 0.007, 0.003, 3});
      twigs.push_back(twig);
    }
  }
  return AssembleTree(form.name, stems, MakeLeaves(form, twigs, kBroadLeaf, dice), kBroadLeaf,
                      surfaces);
}

/// Adds slightly hanging shoots on both sides of a spruce's branch, shorter towards its tip.
void AddSideShoots(const Vector3& foot_m,
                   const Vector3& tip_m,
                   PlantDice& dice,
                   std::vector<Twig>& twigs) {
  constexpr double kSpacing_m = 0.16;
  const Vector3 along = tip_m - foot_m;
  const double length_m = along.norm();
  const Vector3 left = Vector3::UnitZ().cross(along).normalized();
  for (double at_m = 0.2 * length_m; at_m < length_m; at_m += kSpacing_m) {
    for (const double side : {-1.0, 1.0}) {
      const double shoot_m = 0.1 + 0.40 * (length_m - at_m) * dice.Uniform(0.7, 1.1);
      const Vector3 direction =
          (0.6 * along / length_m + side * 0.8 * left + Vector3(0, 0, dice.Uniform(-0.35, 0.0)))
              .normalized();
      const Vector3 begin_m = foot_m + along * (at_m / length_m);
      twigs.push_back({begin_m, begin_m + shoot_m * direction});
    }
  }
}

PlantModel MakeSpruce(const TreeForm& form, const RailSurfaces& surfaces, PlantDice dice) {
  constexpr int kBranchesPerWhorl = 5;
  constexpr double kWhorlSpacing_m = 0.36;
  std::vector<Stem> stems;
  std::vector<Twig> twigs;
  const std::vector<Vector3> trunk = TrunkLine(form.height_m - 0.15, 0.01, dice);
  stems.push_back({trunk, form.trunk_radius_m, 0.01, 8});
  const double crown_m = form.height_m - form.crown_base_m;
  for (double z_m = form.crown_base_m; z_m < form.height_m - 0.25; z_m += kWhorlSpacing_m) {
    const double t = (z_m - form.crown_base_m) / crown_m;
    const double first_azimuth_rad = dice.Uniform(0.0, kTurn_rad);
    for (int i = 0; i < kBranchesPerWhorl; ++i) {
      const Vector3 foot_m = OnTrunk(trunk, z_m + dice.Uniform(-0.5, 0.5) * kWhorlSpacing_m);
      const double azimuth_rad =
          first_azimuth_rad + kTurn_rad * i / kBranchesPerWhorl + dice.Uniform(-0.25, 0.25);
      const double length_m =
          (0.25 + (form.crown_radius_m - 0.25) * (1.0 - t)) * dice.Uniform(0.75, 1.0);
      const double elevation_rad = RadFromDeg(-18.0 + 60.0 * t * t + dice.Uniform(-6.0, 6.0));
      const Vector3 tip_m = foot_m + length_m * Slanting(azimuth_rad, elevation_rad);
      stems.push_back({{foot_m, tip_m}, 0.008 + 0.008 * length_m, 0.004, 3});
      twigs.push_back({foot_m + 0.3 * (tip_m - foot_m), tip_m});
      AddSideShoots(foot_m, tip_m, dice, twigs);
    }
  }
  const Vector3 top_m(trunk.back().x(), trunk.back().y(), form.height_m);
  twigs.push_back({OnTrunk(trunk, form.height_m - 0.7), top_m});
  return AssembleTree(form.name, stems, MakeLeaves(form, twigs, kNeedleShoot, dice), kNeedleShoot,
                      surfaces);
}

}  // namespace

PlantModels MakePlantModels(const RailSurfaces& surfaces, std::uint64_t seed) {
  RailSurfaces of_bushes = surfaces;
  of_bushes.leaf = surfaces.bush_leaf;
  of_bushes.bark = surfaces.bush_bark;
  const TreeForm broadleaves[] = {{"broadleaf_low", 7.5, 1.6, 2.1, 0.10},
                                  {"broadleaf_high", 11.0, 2.8, 2.3, 0.14}};
  const TreeForm spruces[] = {{"spruce_low", 7.0, 0.6, 1.6, 0.09},
                              {"spruce_high", 12.0, 1.4, 2.0, 0.15}};
  const TreeForm bushes[] = {{"bush_low", 1.0, 0.05, 0.6, 0.015},
                             {"bush_high", 2.0, 0.1, 1.0, 0.025}};
  const char* const grass[] = {"grass_a", "grass_b", "grass_c"};
  PlantModels plants{
      std::vector<PlantModel>(std::size(broadleaves)), std::vector<PlantModel>(std::size(spruces)),
      std::vector<PlantModel>(std::size(grass)), std::vector<PlantModel>(std::size(bushes))};
  std::uint32_t plant = 0;
  std::vector<std::function<void()>> works;
  const auto make = [&](std::vector<PlantModel>& kind, const auto& make_one) {
    for (std::size_t i = 0; i < kind.size(); ++i) {
      works.emplace_back(
          [&kind, i, dice = PlantDice(seed, plant++), make_one] { kind[i] = make_one(i, dice); });
    }
  };
  make(plants.broadleaves, [&](std::size_t i, const PlantDice& dice) {
    return MakeBroadleaf(broadleaves[i], surfaces, dice);
  });
  make(plants.conifers, [&](std::size_t i, const PlantDice& dice) {
    return MakeSpruce(spruces[i], surfaces, dice);
  });
  make(plants.grass, [&](std::size_t i, const PlantDice& dice) {
    return MakeGrassPatch(grass[i], surfaces, dice);
  });
  make(plants.bushes, [&](std::size_t i, const PlantDice& dice) {
    return MakeBroadleaf(bushes[i], of_bushes, dice);
  });
  tbb::parallel_for(
      std::size_t{0}, works.size(), [&](std::size_t i) { works[i](); }, tbb::simple_partitioner{});
  return plants;
}

}  // namespace railcast
