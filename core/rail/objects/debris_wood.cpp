#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/units.h"
#include "core/rail/base/model_parts.h"
#include "core/rail/ground/plant_dice.h"
#include "core/rail/ground/plant_parts.h"
#include "core/rail/objects/debris.h"
#include "core/rail/objects/lofted_body.h"

namespace railcast {
namespace {

constexpr std::uint64_t kWoodSeed = 1998;

/// Wood and leaves that lie on the ground.
struct FallenWood {
  std::vector<Stem> stems;
  Mesh leaves;
};

/// What would be below the ground is bent to lie on it.
Vector3 OnGround(const Vector3& point_m, double least_m) {
  return {point_m.x(), point_m.y(), std::max(point_m.z(), least_m)};
}

/// A triangle of 12 x 13 cm near a twig, which stands for two leaves of 8 x 9 cm.
void AddFallenLeaf(const Vector3& middle_m, PlantDice& dice, Mesh& leaves) {
  const Vector3 tip = dice.Direction();
  Vector3 across = tip.cross(dice.Direction());
  while (across.norm() < 0.1) across = tip.cross(dice.Direction());
  const double size = dice.Uniform(0.8, 1.2);
  const Vector3 length_m = 0.065 * size * tip;
  const Vector3 width_m = 0.06 * size * across.normalized();
  const auto first = static_cast<std::uint32_t>(leaves.vertices.size());
  for (const Vector3& corner_m :
       {Vector3(middle_m - length_m - width_m), Vector3(middle_m - length_m + width_m),
        Vector3(middle_m + length_m)}) {
    leaves.vertices.emplace_back(OnGround(corner_m, 0.005 + 0.01 * size).cast<float>());
  }
  leaves.triangles.push_back({first, first + 1, first + 2});
}

/// Something that grows out of wood.
struct Shoot {
  Vector3 foot_m;
  Vector3 direction;
  double length_m{};
  double radius_m{};
};

/// Adds a shoot with `num_twigs` twigs, each of which has `num_leaves` leaves.
void AddShoot(
    const Shoot& shoot, int num_twigs, int num_leaves, PlantDice& dice, FallenWood& wood) {
  const Vector3 middle_m = OnGround(
      shoot.foot_m + 0.5 * shoot.length_m * shoot.direction + dice.Offset(0.06 * shoot.length_m),
      0.04);
  const Vector3 tip_m = OnGround(
      shoot.foot_m + shoot.length_m * shoot.direction + dice.Offset(0.1 * shoot.length_m), 0.05);
  wood.stems.push_back({{shoot.foot_m, middle_m, tip_m}, shoot.radius_m, 0.005, 5});
  for (int i = 0; i < num_twigs; ++i) {
    const double along = 0.35 + 0.65 * (i + 0.5) / num_twigs;
    const Vector3 at_m = along < 0.5
                             ? Vector3(shoot.foot_m + 2.0 * along * (middle_m - shoot.foot_m))
                             : Vector3(middle_m + (2.0 * along - 1.0) * (tip_m - middle_m));
    const Vector3 direction = (shoot.direction + 0.9 * dice.Direction()).normalized();
    const Vector3 end_m =
        OnGround(at_m + dice.Uniform(0.3, 0.5) * shoot.length_m * direction, 0.03);
    wood.stems.push_back({{at_m, end_m}, 0.006, 0.003, 3});
    for (int leaf = 0; leaf < num_leaves; ++leaf) {
      const Vector3 near_m = at_m + dice.Uniform(0.2, 1.1) * (end_m - at_m) + dice.Offset(0.15);
      AddFallenLeaf(near_m, dice, wood.leaves);
    }
  }
}

Model ModelOfWood(const char* name, const FallenWood& wood, const DebrisSurfaces& surfaces) {
  Model model{.name = name, .parts = {}};
  MeshOf(surfaces.bark, model) = WoodOf(wood.stems);
  MeshOf(surfaces.leaf, model) = wood.leaves;
  return model;
}

/// A plate of roots and earth, upright about the foot of the trunk.
Mesh MakeRootPlate(double y_m, double z_m, double radius_m, PlantDice& dice) {
  constexpr int kNumSides = 18;
  std::vector<Rib> ribs;
  for (const auto& [ahead_m, share] : {std::array{-0.22, 0.45}, std::array{-0.12, 0.95},
                                       std::array{0.05, 0.9}, std::array{0.30, 0.35}}) {
    Rib rib;
    for (int side = 0; side < kNumSides; ++side) {
      const double angle_rad = kTurn_rad * side / kNumSides;
      const double here_m = share * radius_m * dice.Uniform(0.8, 1.1);
      rib.push_back(OnGround(
          {here_m * std::cos(angle_rad), y_m + ahead_m, z_m + here_m * std::sin(angle_rad)}, 0.0));
    }
    ribs.push_back(std::move(rib));
  }
  return MakeLoftedBody(ribs);
}

}  // namespace

Model MakeBranch(const DebrisSurfaces& surfaces) {
  PlantDice dice(kWoodSeed, 1);
  FallenWood wood;
  wood.stems.push_back({{{-1.25, 0.0, 0.04},
                         {-0.6, 0.06, 0.07},
                         {0.0, 0.02, 0.10},
                         {0.6, -0.06, 0.09},
                         {1.1, 0.02, 0.06}},
                        0.035,
                        0.006,
                        7});
  for (int i = 0; i < 9; ++i) {
    const double x_m = -0.45 + 0.17 * i;
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const Vector3 direction =
        Vector3(0.75, side * dice.Uniform(0.6, 0.9), dice.Uniform(-0.1, 0.45)).normalized();
    AddShoot({{x_m, 0.0, 0.085}, direction, dice.Uniform(0.40, 0.65), 0.011}, 3, 24, dice, wood);
  }
  Model branch = ModelOfWood("branch", wood, surfaces);
  ScaleTo({2.5, branch.Bounds().sizes().y(), branch.Bounds().sizes().z()}, branch);
  return branch;
}

Model MakeFallenTree(const DebrisSurfaces& surfaces) {
  PlantDice dice(kWoodSeed, 2);
  FallenWood wood;
  const std::vector<Vector3> trunk = {{0.05, -4.9, 0.50}, {0.0, -3.8, 0.36}, {-0.06, -2.5, 0.27},
                                      {0.0, -1.0, 0.25},  {0.08, 0.5, 0.28}, {0.02, 2.0, 0.36},
                                      {-0.08, 3.4, 0.48}, {0.0, 4.6, 0.60}};
  wood.stems.push_back({trunk, 0.19, 0.02, 10});
  constexpr int kNumBranches = 32;
  for (int i = 0; i < kNumBranches; ++i) {
    const double along = (i + 0.5) / kNumBranches;
    const double y_m = -1.2 + 5.6 * along;
    std::size_t piece = 1;
    while (trunk[piece].y() < y_m) ++piece;
    const Vector3 on_piece = trunk[piece] - trunk[piece - 1];
    const Vector3 foot_m =
        trunk[piece - 1] + on_piece * ((y_m - trunk[piece - 1].y()) / on_piece.y());
    const double around_rad = 2.39996 * i + dice.Uniform(-0.3, 0.3);  // Golden angle.
    const double lean_rad = RadFromDeg(dice.Uniform(35.0, 60.0));
    // Those below are bent aside.
    const Vector3 direction = Vector3(std::sin(lean_rad) * std::cos(around_rad), std::cos(lean_rad),
                                      std::sin(lean_rad) * std::max(-0.1, std::sin(around_rad)))
                                  .normalized();
    const double length_m = (2.5 - 1.6 * along) * dice.Uniform(0.8, 1.1);
    AddShoot({foot_m, direction, length_m, 0.012 + 0.014 * length_m}, 3, 28, dice, wood);
  }
  Model tree = ModelOfWood("fallen_tree", wood, surfaces);
  MeshOf(surfaces.bark, tree).Append(MakeRootPlate(-4.8, 0.48, 0.75, dice));
  StandOnOrigin(tree);
  return tree;
}

}  // namespace railcast
