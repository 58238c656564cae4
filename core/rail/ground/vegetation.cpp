#include "core/rail/ground/plant_models.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "core/base/random.h"
#include "core/rail/base/noise_field.h"
#include "core/rail/clearance/cleared.h"
#include "core/rail/landform/ground_rise.h"
#include "railcast/world_spec.h"

namespace railcast {
namespace {

/// Where trees stand: in woods with clearings between them, which are the high places of a noise
/// over the plan on a lattice of the spec's size, with half of its variance on one of a third of
/// it. A share of the land of VegetationSpec::woods_share is wooded; the edges are ragged.
class Woods {
 public:
  Woods(const VegetationSpec& spec, std::uint64_t seed)
      : share_(spec.woods_share),
        size_m_(spec.woods_size_m),
        outline_(seed, RandomUse::kWoods, 0),
        edge_(seed, RandomUse::kWoods, 1) {}

  /// Whether a tree at a place of the world stands in a wood. @param draw Uniform in [0, 1).
  [[nodiscard]] bool HaveTreeAt(const Eigen::Vector2d& place_m, float draw) const {
    if (share_ >= 1.0) return true;
    if (share_ <= 0.0) return false;
    /// Width of the edge, as a share of the land: trees become fewer over it.
    constexpr double kEdge = 0.1;
    const Eigen::Vector2d at = place_m / size_m_;
    const double noise =
        std::sqrt(0.5) * (outline_.At(at.x(), at.y()) + edge_.At(3.0 * at.x(), 3.0 * at.y()));
    // The noise is about normal, so that this is about uniform in [0, 1].
    const double rank = 0.5 * std::erfc(noise * std::numbers::sqrt2 / 2.0);
    return rank + kEdge * (static_cast<double>(draw) - 0.5) < share_;
  }

 private:
  double share_;
  double size_m_;
  NoiseField outline_;
  NoiseField edge_;
};

double Uniform(std::uint32_t word, double low, double high) {
  return low + (high - low) * static_cast<double>(UnitFloat(word));
}

/// Range of lateral positions on one side of the line, measured outwards: `side` * d.
struct Strip {
  double side{};  ///< 1 left, -1 right.
  double inner_m{};
  double outer_m{};

  [[nodiscard]] double width_m() const { return outer_m - inner_m; }
};

/// A strip that follows the outermost track on its side.
struct Border {
  double side{};
  double least_m{};  ///< Distances beyond that track.
  double most_m{};
};

/// The strip of a border at one chainage, limited to the ground.
Strip StripAt(const ChunkContext& context, const Border& border, double s_m) {
  // A track that is parallel to the alignment clears the whole line, as if it continued.
  constexpr double kBeyondEnd_m = 10.0;
  double outermost_m = -std::numeric_limits<double>::infinity();
  for (const TrackCourse& track : context.tracks) {
    const bool is_near =
        s_m > track.begin_s_m() - kBeyondEnd_m && s_m < track.end_s_m() + kBeyondEnd_m;
    if (!is_near && !track.is_parallel()) continue;
    outermost_m = std::max(outermost_m, border.side * track.OffsetWithin_m(s_m));
  }
  if (std::isinf(outermost_m)) outermost_m = 0.0;
  return {.side = border.side,
          .inner_m = outermost_m + border.least_m,
          .outer_m = std::min(outermost_m + border.most_m, context.spec.terrain.half_width_m)};
}

/// The strip that holds those of a border all over the chunk.
Strip WidestStrip(const ChunkContext& context, const Border& border) {
  constexpr int kNumSamples = 50;
  Strip widest = StripAt(context, border, context.begin_s_m);
  for (int i = 1; i <= kNumSamples; ++i) {
    const double s_m = std::lerp(context.begin_s_m, context.end_s_m, 1.0 * i / kNumSamples);
    const Strip here = StripAt(context, border, s_m);
    widest.inner_m = std::min(widest.inner_m, here.inner_m);
    widest.outer_m = std::max(widest.outer_m, here.outer_m);
  }
  return widest;
}

/// Pose of an upright plant at a point of the ground.
Eigen::Affine3d Planted(const Vector3& ground_m, double yaw_rad, double scale) {
  return Eigen::Translation3d(ground_m) * Eigen::AngleAxisd(yaw_rad, Vector3::UnitZ()) *
         Eigen::Scaling(scale);
}

/// The plant of the kind that is closest in height, scaled to it.
Placement MakePlant(const std::vector<PlantModel>& kind,
                    double height_m,
                    const Vector3& ground_m,
                    double yaw_rad) {
  const auto misfit = [&](const PlantModel& plant) {
    return std::abs(std::log(height_m / plant.height_m));
  };
  const PlantModel& plant = *std::min_element(
      kind.begin(), kind.end(),
      [&](const PlantModel& a, const PlantModel& b) { return misfit(a) < misfit(b); });
  return {.model = plant.model,
          .chunk_from_model = Planted(ground_m, yaw_rad, height_m / plant.height_m),
          .instance = 0,
          .coarser = plant.coarser};
}

Placement MakeTree(const PlantModels& plants,
                   double height_m,
                   const Vector3& ground_m,
                   const std::array<std::uint32_t, 4>& words) {
  const auto& kind = UnitFloat(words[0]) < 0.5F ? plants.broadleaves : plants.conifers;
  Placement tree = MakePlant(kind, height_m, ground_m, Uniform(words[1], 0.0, kTurn_rad));
  tree.sway_height_m = height_m;
  return tree;
}

/// Whether the ground reaches as far as this.
bool IsOnGround(const ChunkContext& context, double s_m, double d_m) {
  return context.land == nullptr || std::abs(d_m) <= context.land->width().At(s_m, d_m);
}

/// Where a plant stands, and its random numbers.
struct PlantPlace {
  double s_m{};
  double d_m{};
  std::uint32_t size{};  ///< A random word.
  std::array<std::uint32_t, 4> words{};
};

/// Calls `plant(place)` for the places of a Poisson process in one strip. In a straight strip of
/// constant width, their chainages have exponentially distributed gaps. In a curve, the strip is
/// longer on the outside and shorter on the inside by the factor 1 - curvature * d. The process is
/// drawn for the largest such factor, and for the widest strip, and thinned to the true one (Lewis,
/// Shedler 1979).
template <class Plant>
void Scatter(const ChunkContext& context,
             const Border& border,
             double plants_per_hectare,
             RandomUse use,
             const Plant& plant) {
  const Strip strip = WidestStrip(context, border);
  constexpr double kHectare_m2 = 1e4;
  const double largest_factor =
      1.0 + context.spec.terrain.half_width_m / context.alignment.tightest_radius_m();
  const double plants_per_m = plants_per_hectare / kHectare_m2 * strip.width_m() * largest_factor;
  if (!(plants_per_m > 0.0)) return;
  const auto chunk_key = static_cast<std::uint32_t>(context.chunk);
  const std::uint32_t side_key = strip.side > 0.0 ? 1U : 0U;
  const ClearedAreas cleared(TracksOf(context), Clearing::kTree, context.begin_s_m,
                             context.end_s_m);
  double s_m = context.begin_s_m;
  for (std::uint32_t i = 0;; ++i) {
    const std::uint32_t item = 2U * i + side_key;
    const auto where = RandomWords(context.seed, use, chunk_key, item, 0);
    s_m -= std::log1p(-Uniform(where[0], 0.0, 1.0)) / plants_per_m;
    if (s_m >= context.end_s_m) return;
    const double d_m = strip.side * Uniform(where[1], strip.inner_m, strip.outer_m);
    const double factor = 1.0 - context.alignment.At(s_m).curvature_per_m * d_m;
    if (Uniform(where[2], 0.0, largest_factor) >= factor) continue;
    const Strip here = StripAt(context, border, s_m);
    if (strip.side * d_m < here.inner_m || strip.side * d_m > here.outer_m) continue;
    if (cleared.Cover(s_m, d_m) || !IsOnGround(context, s_m, d_m)) continue;
    plant(PlantPlace{s_m, d_m, where[3], RandomWords(context.seed, use, chunk_key, item, 1)});
  }
}

void AddTrees(const ChunkContext& context,
              const PlantModels& plants,
              const Border& border,
              Chunk& chunk) {
  const VegetationSpec& spec = context.spec.vegetation;
  const Woods woods(spec, context.seed);
  const Transform world_from_chunk = context.chunk_from_world.inverse();
  Scatter(context, border, spec.trees_per_hectare, RandomUse::kTreePlacement,
          [&](const PlantPlace& place) {
            const Vector3 ground_m = GroundPoint(context, place.s_m, place.d_m);
            const Vector3 world_m = world_from_chunk * ground_m;
            if (!woods.HaveTreeAt(world_m.head<2>(), UnitFloat(place.words[2]))) return;
            const double height_m =
                Uniform(place.size, spec.tree_height_min_m, spec.tree_height_max_m);
            chunk.placements.push_back(MakeTree(plants, height_m, ground_m, place.words));
          });
}

void AddBushes(const ChunkContext& context,
               const PlantModels& plants,
               const Border& border,
               Chunk& chunk) {
  constexpr double kLeastHeight_m = 0.5;
  constexpr double kMostHeight_m = 2.5;
  Scatter(context, border, context.spec.vegetation.bushes_per_hectare, RandomUse::kBushPlacement,
          [&](const PlantPlace& place) {
            // Low ones are the most frequent.
            const double size = std::pow(Uniform(place.size, 0.0, 1.0), 2);
            chunk.placements.push_back(MakePlant(plants.bushes,
                                                 std::lerp(kLeastHeight_m, kMostHeight_m, size),
                                                 GroundPoint(context, place.s_m, place.d_m),
                                                 Uniform(place.words[0], 0.0, kTurn_rad)));
          });
}

/// Adds a patch of grass, turned by `yaw_rad`, on the mean slope of the ground below it.
void AddPatch(const ChunkContext& context,
              const PlantModel& patch,
              const GroundPlace& place,
              double yaw_rad,
              Chunk& chunk) {
  const auto [s_m, d_m] = place;
  constexpr double kReach_m = 0.35 * kGrassPatch_m;
  const Vector3 back_m = GroundPoint(context, s_m - kReach_m, d_m);
  const Vector3 ahead_m = GroundPoint(context, s_m + kReach_m, d_m);
  const Vector3 right_m = GroundPoint(context, s_m, d_m - kReach_m);
  const Vector3 left_m = GroundPoint(context, s_m, d_m + kReach_m);
  const Vector3 normal = (ahead_m - back_m).cross(left_m - right_m).normalized();
  Eigen::Matrix3d rotation;
  rotation.col(2) = normal;
  rotation.col(0) = (ahead_m - back_m - normal * normal.dot(ahead_m - back_m)).normalized();
  rotation.col(1) = normal.cross(rotation.col(0));
  const Vector3 middle_m = 0.25 * (back_m + ahead_m + right_m + left_m);
  chunk.placements.push_back({.model = patch.model,
                              .chunk_from_model = Eigen::Translation3d(middle_m) * rotation *
                                                  Eigen::AngleAxisd(yaw_rad, Vector3::UnitZ()),
                              .instance = 0,
                              .coarser = patch.coarser});
}

void AddGrass(const ChunkContext& context,
              const PlantModels& plants,
              const Border& border,
              Chunk& chunk) {
  const ClearedAreas cleared(TracksOf(context), Clearing::kGrass, context.begin_s_m,
                             context.end_s_m);
  const auto first_along = static_cast<std::int64_t>(std::ceil(context.begin_s_m / kGrassPatch_m));
  const std::uint32_t side_key = border.side > 0.0 ? 1U : 0U;
  for (std::int64_t along = first_along;; ++along) {
    const double s_m = static_cast<double>(along) * kGrassPatch_m;
    if (s_m >= context.end_s_m) return;
    const Strip strip = StripAt(context, border, s_m);
    if (strip.width_m() < kGrassPatch_m) continue;
    const int num_rows = static_cast<int>(std::lround(strip.width_m() / kGrassPatch_m));
    const double first_m = strip.inner_m + 0.5 * kGrassPatch_m;
    const double spacing_m =
        num_rows > 1 ? (strip.width_m() - kGrassPatch_m) / (num_rows - 1) : 0.0;
    for (int row = 0; row < num_rows; ++row) {
      const auto item = 2U * static_cast<std::uint32_t>(row) + side_key;
      const auto words = RandomWords(context.seed, RandomUse::kGrassPlacement,
                                     static_cast<std::uint32_t>(along), item);
      // A multiple of a quarter turn keeps the patch on its square; a small extra angle hides the
      // repetition.
      const double yaw_rad =
          0.25 * kTurn_rad * std::floor(Uniform(words[0], 0.0, 4.0)) + Uniform(words[1], -0.2, 0.2);
      const double d_m = strip.side * (first_m + spacing_m * row);
      if (cleared.Cover(s_m, d_m)) continue;
      AddPatch(context, plants.grass[words[2] % plants.grass.size()], {s_m, d_m}, yaw_rad, chunk);
    }
  }
}

/// Adds the grass beyond the strip of AddGrass(): patches at random places, one for each 2 x 2 m
/// next to the strip and ever fewer outwards.
void AddFadingGrass(const ChunkContext& context,
                    const PlantModels& plants,
                    const Border& border,
                    Chunk& chunk) {
  const double fade_m = context.spec.vegetation.grass_fade_m;
  const ClearedAreas cleared(TracksOf(context), Clearing::kGrass, context.begin_s_m,
                             context.end_s_m);
  const auto first_along = static_cast<std::int64_t>(std::ceil(context.begin_s_m / kGrassPatch_m));
  const std::uint32_t side_key = border.side > 0.0 ? 1U : 0U;
  for (std::int64_t along = first_along;; ++along) {
    const double middle_s_m = static_cast<double>(along) * kGrassPatch_m;
    if (middle_s_m >= context.end_s_m) return;
    const Strip strip = StripAt(context, border, middle_s_m);
    const auto num_rows =
        static_cast<std::uint32_t>(std::ceil(std::max(0.0, strip.width_m()) / kGrassPatch_m));
    for (std::uint32_t row = 0; row < num_rows; ++row) {
      const auto words = RandomWords(context.seed, RandomUse::kGrassFade,
                                     static_cast<std::uint32_t>(along), 2U * row + side_key);
      const double beyond_m = kGrassPatch_m * (row + Uniform(words[0], 0.0, 1.0));
      const double stays = 1.0 - beyond_m / fade_m;
      if (stays <= 0.0 || Uniform(words[1], 0.0, 1.0) >= stays * stays) continue;
      const double s_m = middle_s_m + Uniform(words[2], -0.5, 0.5) * kGrassPatch_m;
      const double d_m = strip.side * (strip.inner_m + beyond_m);
      if (strip.inner_m + beyond_m > strip.outer_m) continue;
      if (cleared.Cover(s_m, d_m) || !IsOnGround(context, s_m, d_m)) continue;
      AddPatch(context, plants.grass[words[3] % plants.grass.size()], {s_m, d_m},
               Uniform(words[3], 0.0, kTurn_rad), chunk);
    }
  }
}

}  // namespace

void AddVegetation(const ChunkContext& context, const PlantModels& plants, Chunk& chunk) {
  const VegetationSpec& spec = context.spec.vegetation;
  const double edge_m = context.spec.terrain.half_width_m;
  for (const double side : {-1.0, 1.0}) {
    AddTrees(context, plants, {side, spec.tree_min_distance_m, 2.0 * edge_m}, chunk);
    AddBushes(context, plants, {side, spec.bush_min_distance_m, 2.0 * edge_m}, chunk);
    if (!spec.grass) continue;
    AddGrass(context, plants, {side, spec.grass_min_distance_m, spec.grass_max_distance_m}, chunk);
    if (!(spec.grass_fade_m > 0.0)) continue;
    AddFadingGrass(context, plants,
                   {side, spec.grass_max_distance_m, spec.grass_max_distance_m + spec.grass_fade_m},
                   chunk);
  }
}

}  // namespace railcast
