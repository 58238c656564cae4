#include "core/rail/land/plant_models.h"

#include <algorithm>
#include <cmath>

#include "core/rail/model_parts.h"

namespace railcast {
namespace {

constexpr double kGrassRoot_m = 0.15;

/// Adds a blade of two pieces that leans over towards its tip.
void AddBlade(const Vector3& foot_m, double height_m, PlantDice& dice, Mesh& grass) {
  const double azimuth_rad = dice.Uniform(0.0, kTurn_rad);
  const double lean = dice.Uniform(0.1, 0.6);
  const Vector3 over = lean * height_m * Vector3(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
  const double twist_rad = dice.Uniform(0.0, kTurn_rad);
  const Vector3 half_width_m =
      0.5 * dice.Uniform(0.008, 0.014) * Vector3(std::cos(twist_rad), std::sin(twist_rad), 0.0);
  const Vector3 middle_m = foot_m + 0.25 * over + Vector3(0, 0, 0.6 * height_m);
  const Vector3 tip_m = foot_m + over + Vector3(0, 0, height_m);
  const Vector3 root_m = foot_m - Vector3(0, 0, kGrassRoot_m);
  const auto first = static_cast<std::uint32_t>(grass.vertices.size());
  for (const Vector3& corner :
       {Vector3(root_m - half_width_m), Vector3(root_m + half_width_m),
        Vector3(middle_m - half_width_m), Vector3(middle_m + half_width_m), tip_m}) {
    grass.vertices.emplace_back(corner.cast<float>());
  }
  grass.triangles.push_back({first, first + 1, first + 3});
  grass.triangles.push_back({first, first + 3, first + 2});
  grass.triangles.push_back({first + 2, first + 3, first + 4});
}

}  // namespace

Model MakeGrassPatch(const std::string& name, const RailSurfaces& surfaces, PlantDice dice) {
  constexpr int kNumTufts = 80;
  constexpr int kBladesPerTuft = 8;
  constexpr double kTuftRadius_m = 0.07;
  constexpr double kReach_m = 0.5 * kGrassPatch_m;
  Model patch{.name = name, .parts = {}, .is_foliage = true};
  Mesh& grass = MeshOf(surfaces.grass, patch);
  for (int tuft = 0; tuft < kNumTufts; ++tuft) {
    const double x_m = dice.Uniform(-kReach_m, kReach_m);
    const double y_m = dice.Uniform(-kReach_m, kReach_m);
    const double height_m = dice.Uniform(0.20, 0.40);
    for (int blade = 0; blade < kBladesPerTuft; ++blade) {
      const Vector3 foot_m(x_m + dice.Uniform(-kTuftRadius_m, kTuftRadius_m),
                           y_m + dice.Uniform(-kTuftRadius_m, kTuftRadius_m), 0.0);
      AddBlade(foot_m, std::max(0.15, height_m * dice.Uniform(0.6, 1.0)), dice, grass);
    }
  }
  return patch;
}

}  // namespace railcast
