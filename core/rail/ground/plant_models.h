#pragma once

#include <tbb/collaborative_call_once.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/chunk/chunk_context.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

inline constexpr double kTurn_rad = 2.0 * std::numbers::pi;
inline constexpr double kGoldenAngle_rad = 2.39996;  ///< Between successive leaves of many plants.

/// Sequence of random numbers for the shape of one plant.
class PlantDice {
 public:
  PlantDice(std::uint64_t seed, std::uint32_t plant) : seed_(seed), plant_(plant) {}

  double Uniform(double low, double high) {
    if (next_ % 4 == 0) words_ = RandomWords(seed_, RandomUse::kPlantShape, plant_, next_ / 4);
    return low + (high - low) * static_cast<double>(UnitFloat(words_[next_++ % 4]));
  }
  /// Uniform on the unit sphere (by Archimedes' theorem).
  Vector3 Direction() {
    const double z = Uniform(-1.0, 1.0);
    const double azimuth_rad = Uniform(0.0, kTurn_rad);
    const double sine = std::sqrt(1.0 - z * z);
    return {sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), z};
  }
  /// Random vector within a ball, denser towards its centre.
  Vector3 Offset(double radius_m) { return Uniform(0.0, radius_m) * Direction(); }

 private:
  std::uint64_t seed_;
  std::uint32_t plant_;
  std::uint32_t next_ = 0;
  std::array<std::uint32_t, 4> words_{};
};

inline constexpr double kGrassPatch_m = 2.0;

/// A plant in full detail, and in less where sensors cannot tell (docs/results/detail.md).
struct PlantModel {
  std::shared_ptr<const Model> model;
  std::shared_ptr<const std::vector<CoarserModel>> coarser;
  double height_m{};  ///< Height of the highest leaf.
};

/// A square patch of side kGrassPatch_m about the origin: 640 blades in tufts, 15 to 40 cm high, 8
/// to 14 mm wide, with 3 triangles each. The leaf area index is about 0.4 (a meadow has 1 to 4), so
/// that the ground shows through. Roots extend 0.15 m into the ground. Coarser patches have 1/2 to
/// 1/16 of the blades, which are wider.
[[nodiscard]] PlantModel MakeGrassPatch(const std::string& name,
                                        const RailSurfaces& surfaces,
                                        PlantDice dice);

/// Plants that are placed many times. Frames: origin where the plant emerges from the ground, z up.
/// Roots extend slightly below, so that no plant hovers over uneven ground.
struct PlantModels {
  std::vector<PlantModel> broadleaves;  ///< In order of height.
  std::vector<PlantModel> conifers;     ///< In order of height.
  std::vector<PlantModel> grass;        ///< Square patches of kGrassPatch_m.
  std::vector<PlantModel> bushes;       ///< In order of height.
};

/// Makes two broad-leaved trees (7.5 and 11 m), two spruces (7 and 12 m), three patches of grass
/// and two bushes (1 and 2 m), which are low broad-leaved trees with leaves down to the ground.
///
/// Trees consist of trunk, branches and twigs as tapering tubes, and of single leaves. Leaves are
/// triangles of about 8 x 9 cm (spruces: shoots of 11 x 5 cm) at random positions about the twigs,
/// with spherically distributed normals (G = 0.5, docs/physics.md 3.5). Their number is leaf area
/// index x projected crown area / leaf area. To stay below 20 000 triangles per tree, the index is
/// 3.2 (closed stands have 3 to 5) and the leaves are as large as they come beside railway lines.
/// Coarser trees have 1/2 to 1/16 of the leaves, which are larger.
///
/// Of vertical beams, 18 to 26 % pass through the crowns (measured); exp(-G index) is 20 %.
///
/// Plants are made on all threads of the caller's TBB arena.
[[nodiscard]] PlantModels MakePlantModels(const RailSurfaces& surfaces, std::uint64_t seed);

/// The plants of a world, made by whoever needs them first: a world that is only looked into has
/// none. Whoever needs them meanwhile helps to make them. Thread-safe.
class PlantsOnDemand {
 public:
  PlantsOnDemand(const RailSurfaces& surfaces, std::uint64_t seed)
      : surfaces_(surfaces), seed_(seed) {}

  [[nodiscard]] const PlantModels& Get() const {
    tbb::collaborative_call_once(once_, [this] { plants_ = MakePlantModels(surfaces_, seed_); });
    return plants_;
  }

 private:
  RailSurfaces surfaces_;
  std::uint64_t seed_;
  mutable tbb::collaborative_once_flag once_;
  mutable PlantModels plants_;
};

/// Adds the trees and the grass of a chunk, standing on the ground of AddTerrain.
///
/// Trees form a Poisson process with VegetationSpec's density per hectare in plan, on both sides,
/// from its minimum distance beyond the axis of the outermost track to the edge of the ground; half
/// are broad-leaved. Heights are uniform within the spec's limits; the model closest in height is
/// scaled to the exact height.
///
/// Grass consists of one patch every 2 m along the line, in as many parallel rows as fill the strip
/// between its minimum and maximum distance beyond the axis of the outermost track. A strip
/// narrower than a patch has none. Patches lie on the slope of the ground.
///
/// With VegetationSpec::woods_share below 1, trees stand in woods only. Bushes form a
/// Poisson process, too; low ones are the most frequent. With grass_fade_m, patches of grass follow
/// beyond the strip at random places, ever fewer outwards. Nothing stands where the strip of ground
/// has narrowed.
///
/// Random numbers are keyed by (seed, chunk, plant), so chunks do not depend on each other.
void AddVegetation(const ChunkContext& context, const PlantModels& plants, Chunk& chunk);

/// Trunk, branch or twig: a tapering tube about a line.
struct Stem {
  std::vector<Vector3> line;
  double foot_radius_m{};
  double tip_radius_m{};
  int sides{};
};

/// Stems as tubes.
[[nodiscard]] Mesh WoodOf(std::span<const Stem> stems);

/// Stems with tubes of four sides instead of trunks, and with flat triangles of about `width_m` at
/// their foot instead of branches and twigs thinner than twice that. There are as many of them as
/// have the same area in projection, on average over all directions.
[[nodiscard]] Mesh FlattenedWood(std::span<const Stem> stems, double width_m);

/// How leaves are merged.
struct LeafMerger {
  std::size_t num = 1;    ///< Leaves that become one.
  double widening = 1.0;  ///< Factor of its width; the rest of its area is due to its length.
  double area = 1.0;  ///< Factor of the area of all; below 1 for leaves that hide each other less.
};

/// Keeps one of several leaves that are next to each other, enlarged about its centre. Which one is
/// drawn at equal steps of the sum of their areas, so that they stay as evenly distributed as they
/// were, in the same directions.
/// @param leaves Triangles without common corners, the third of which is the tip.
[[nodiscard]] Mesh MergedLeaves(const Mesh& leaves, const LeafMerger& merger);

}  // namespace railcast
