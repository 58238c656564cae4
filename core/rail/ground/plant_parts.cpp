#include "core/rail/ground/plant_models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/rail/base/rail_surfaces.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr double kGrassRoot_m = 0.15;
constexpr int kSidesOfTrunk = 8;

void AddTriangle(const std::array<Vector3, 3>& corners_m, Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vector3& corner_m : corners_m) mesh.vertices.emplace_back(corner_m.cast<float>());
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// A tube whose radius decreases linearly.
Mesh TubeOf(const Stem& stem) {
  std::vector<double> radii_m;
  for (std::size_t i = 0; i < stem.line.size(); ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(stem.line.size() - 1);
    radii_m.push_back(stem.foot_radius_m + t * (stem.tip_radius_m - stem.foot_radius_m));
  }
  return MakeTube(stem.line, radii_m, stem.sides);
}

/// Circumference over radius of a tube whose corners are at its radius.
double Circumference(int sides) {
  return 2.0 * sides * std::sin(std::numbers::pi / sides);
}

/// Turns thin stems into flat triangles, whose sum of areas follows that of the stems.
class Flattener {
 public:
  explicit Flattener(double width_m) : width_m_(width_m) {}

  void Add(const Stem& stem, Mesh& mesh) {
    const auto num_pieces = static_cast<double>(stem.line.size() - 1);
    for (std::size_t i = 0; i + 1 < stem.line.size(); ++i) {
      const double t = (static_cast<double>(i) + 0.5) / num_pieces;
      const double radius_m = stem.foot_radius_m + t * (stem.tip_radius_m - stem.foot_radius_m);
      const Vector3 along_m = stem.line[i + 1] - stem.line[i];
      const double length_m = along_m.norm();
      // Turned about its axis, a convex tube is as wide as its circumference over pi on average
      // (Cauchy), and a ribbon as 2 / pi of its width.
      due_m2_ += 0.5 * Circumference(stem.sides) * radius_m * length_m;
      const double base_m = 2.0 * due_m2_ / length_m;
      if (base_m < width_m_) continue;
      due_m2_ = 0.0;
      turn_rad_ += kGoldenAngle_rad;
      const Vector3 across =
          Eigen::AngleAxisd(turn_rad_, along_m / length_m) * along_m.unitOrthogonal();
      const Vector3 half_m = 0.5 * base_m * across;
      AddTriangle({stem.line[i] - half_m, stem.line[i] + half_m, stem.line[i + 1]}, mesh);
    }
  }

 private:
  double width_m_;
  double due_m2_ = 0.0;
  double turn_rad_ = 0.0;
};

/// The same stem with four sides and the same circumference.
Stem Squared(Stem stem) {
  const double factor = Circumference(stem.sides) / Circumference(4);
  stem.foot_radius_m *= factor;
  stem.tip_radius_m *= factor;
  stem.sides = 4;
  return stem;
}

struct Sample {
  std::vector<std::size_t> items;
  double area_m2{};  ///< Area that each of them stands for.
};

/// One of every `num` items, which are drawn at equal steps of the sum of their areas: with a
/// probability proportional to their area and evenly along their order.
Sample SampledByArea(std::span<const double> areas_m2, std::size_t num) {
  const double sum_m2 = std::accumulate(areas_m2.begin(), areas_m2.end(), 0.0);
  const std::size_t num_kept = std::max<std::size_t>(1, areas_m2.size() / num);
  Sample sample{{}, sum_m2 / static_cast<double>(num_kept)};
  double passed_m2 = -0.5 * sample.area_m2;
  for (std::size_t i = 0; i < areas_m2.size(); ++i) {
    passed_m2 += areas_m2[i];
    for (; passed_m2 > 0.0; passed_m2 -= sample.area_m2) sample.items.push_back(i);
  }
  return sample;
}

/// A blade of grass of two pieces, of which the upper one tapers and leans over.
struct Blade {
  Vector3 foot_m;
  Vector3 over_m;        ///< From the foot to below the tip.
  Vector3 half_width_m;  ///< Horizontal.
  double height_m{};
};

/// How blades of grass are merged.
struct BladeMerger {
  std::size_t num = 1;  ///< Blades that become one, which is wider.
  double area = 1.0;  ///< Factor of the area of all; below 1 for blades that hide each other less.
};

void AddBlade(const Blade& blade, Mesh& grass) {
  const Vector3 middle_m = blade.foot_m + 0.25 * blade.over_m + Vector3(0, 0, 0.6 * blade.height_m);
  const Vector3 tip_m = blade.foot_m + blade.over_m + Vector3(0, 0, blade.height_m);
  const Vector3 root_m = blade.foot_m - Vector3(0, 0, kGrassRoot_m);
  const auto first = static_cast<std::uint32_t>(grass.vertices.size());
  for (const Vector3& corner :
       {Vector3(root_m - blade.half_width_m), Vector3(root_m + blade.half_width_m),
        Vector3(middle_m - blade.half_width_m), Vector3(middle_m + blade.half_width_m), tip_m}) {
    grass.vertices.emplace_back(corner.cast<float>());
  }
  grass.triangles.push_back({first, first + 1, first + 3});
  grass.triangles.push_back({first, first + 3, first + 2});
  grass.triangles.push_back({first + 2, first + 3, first + 4});
}

/// Three triangles for each blade. Roots extend 0.15 m into the ground. Which of neighbouring
/// blades stands for all is drawn as in MergedLeaves().
Mesh GrassOf(std::span<const Blade> blades, const BladeMerger& merger) {
  std::vector<double> areas_m2;
  for (const Blade& blade : blades) {
    areas_m2.push_back(blade.half_width_m.norm() * blade.height_m);
  }
  Mesh grass;
  if (merger.num == 1) {
    for (const Blade& blade : blades) AddBlade(blade, grass);
    return grass;
  }
  const Sample sample = SampledByArea(areas_m2, merger.num);
  for (const std::size_t i : sample.items) {
    Blade blade = blades[i];
    blade.half_width_m *= merger.area * sample.area_m2 / areas_m2[i];
    AddBlade(blade, grass);
  }
  return grass;
}

// The blades of coarser patches. What they lack in area makes up for their covering each other less
// than the blades of a tuft do (docs/results/detail.md).
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

Mesh WoodOf(std::span<const Stem> stems) {
  Mesh wood;
  for (const Stem& stem : stems) wood.Append(TubeOf(stem));
  return wood;
}

Mesh FlattenedWood(std::span<const Stem> stems, double width_m) {
  Mesh wood;
  Flattener flattener(width_m);
  for (const Stem& stem : stems) {
    if (stem.foot_radius_m < width_m && stem.sides < kSidesOfTrunk) {
      flattener.Add(stem, wood);
    } else {
      wood.Append(TubeOf(Squared(stem)));
    }
  }
  return wood;
}

Mesh MergedLeaves(const Mesh& leaves, const LeafMerger& merger) {
  const auto corner = [&](std::size_t leaf, std::size_t k) {
    return Vector3(leaves.vertices[leaves.triangles[leaf][k]].cast<double>());
  };
  std::vector<double> areas_m2;
  for (std::size_t leaf = 0; leaf < leaves.triangles.size(); ++leaf) {
    const Vector3 first_m = corner(leaf, 0);
    areas_m2.push_back(0.5 * (corner(leaf, 1) - first_m).cross(corner(leaf, 2) - first_m).norm());
  }
  const Sample sample = SampledByArea(areas_m2, merger.num);
  Mesh merged;
  for (const std::size_t leaf : sample.items) {
    const double growth = merger.area * sample.area_m2 / areas_m2[leaf];
    const Vector3 centre_m = (corner(leaf, 0) + corner(leaf, 1) + corner(leaf, 2)) / 3.0;
    const Vector3 foot_m = 0.5 * (corner(leaf, 0) + corner(leaf, 1));
    const Vector3 side_m = 0.5 * merger.widening * (corner(leaf, 1) - corner(leaf, 0));
    const Vector3 along_m = growth / merger.widening * (corner(leaf, 2) - foot_m);
    AddTriangle({centre_m - along_m / 3.0 - side_m, centre_m - along_m / 3.0 + side_m,
                 centre_m + 2.0 / 3.0 * along_m},
                merged);
  }
  return merged;
}

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
