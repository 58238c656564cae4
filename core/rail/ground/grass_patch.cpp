#include "core/rail/ground/plant_models.h"

#include <algorithm>
#include <cmath>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/ground/plant_parts.h"

namespace railcast {
namespace {

// The blades of coarser patches. What they lack in area makes up for their covering each other less
// than the blades of a tuft do (docs/detail.md).
constexpr BladeMerger kBladeMergers[] = {{.num = 2, .area = 0.992},
                                         {.num = 4, .area = 0.96},
                                         {.num = 8, .area = 0.92},
                                         {.num = 16, .area = 0.885}};
// Where a blade is as wide as 1.8 spacings of the rays, and as a third of a beam. Blades as wide as
// two thirds of a beam fill more of one beam and less of the next: those that are detected were up
// to 8 % brighter.
constexpr double kRaySpacingPerBlade_m = 0.0061;
constexpr double kBeamWidthPerBlade_m = 0.033;

/// A blade that leans over towards its tip.
Blade MakeBlade(const Vector3& foot_m, double height_m, PlantDice& dice) {
  const double azimuth_rad = dice.Uniform(0.0, kTurn_rad);
  const double lean = dice.Uniform(0.1, 0.6);
  const Vector3 over = lean * height_m * Vector3(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
  const double twist_rad = dice.Uniform(0.0, kTurn_rad);
  const Vector3 half_width_m =
      0.5 * dice.Uniform(0.008, 0.014) * Vector3(std::cos(twist_rad), std::sin(twist_rad), 0.0);
  return {foot_m, over, half_width_m, height_m};
}

}  // namespace

PlantModel MakeGrassPatch(const std::string& name, const RailSurfaces& surfaces, PlantDice dice) {
  constexpr int kNumTufts = 80;
  constexpr int kBladesPerTuft = 8;
  constexpr double kTuftRadius_m = 0.07;
  constexpr double kReach_m = 0.5 * kGrassPatch_m;
  std::vector<Blade> blades;
  for (int tuft = 0; tuft < kNumTufts; ++tuft) {
    const double x_m = dice.Uniform(-kReach_m, kReach_m);
    const double y_m = dice.Uniform(-kReach_m, kReach_m);
    const double height_m = dice.Uniform(0.20, 0.40);
    for (int blade = 0; blade < kBladesPerTuft; ++blade) {
      const Vector3 foot_m(x_m + dice.Uniform(-kTuftRadius_m, kTuftRadius_m),
                           y_m + dice.Uniform(-kTuftRadius_m, kTuftRadius_m), 0.0);
      blades.push_back(MakeBlade(foot_m, std::max(0.15, height_m * dice.Uniform(0.6, 1.0)), dice));
    }
  }
  const auto make = [&](const BladeMerger& merger) {
    Model patch{.name = name, .parts = {}, .is_foliage = true};
    if (merger.num > 1) patch.name.append("_").append(std::to_string(merger.num));
    MeshOf(surfaces.grass, patch) = GrassOf(blades, merger);
    return std::make_shared<const Model>(std::move(patch));
  };
  std::vector<CoarserModel> coarser;
  for (const BladeMerger& merger : kBladeMergers) {
    coarser.push_back({make(merger), kRaySpacingPerBlade_m * static_cast<double>(merger.num),
                       kBeamWidthPerBlade_m * static_cast<double>(merger.num)});
  }
  PlantModel patch{make({}), std::make_shared<const std::vector<CoarserModel>>(std::move(coarser))};
  patch.height_m = patch.model->Bounds().max().z();
  return patch;
}

}  // namespace railcast
