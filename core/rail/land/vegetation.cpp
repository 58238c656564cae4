#include "core/rail/land/land.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/random.h"
#include "core/rail/structures/cleared.h"

namespace railcast {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr std::array<double, 2> kBothSidesOfTrack = {-1.0, 1.0};

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

Placement MakeTree(const PlantModels& plants,
                   double height_m,
                   const Vector3& ground_m,
                   const std::array<std::uint32_t, 4>& words) {
  const std::vector<PlantModel>& kind =
      UnitFloat(words[0]) < 0.5F ? plants.broadleaves : plants.conifers;
  const auto misfit = [&](const PlantModel& tree) {
    return std::abs(std::log(height_m / tree.height_m));
  };
  const PlantModel& tree = *std::min_element(
      kind.begin(), kind.end(),
      [&](const PlantModel& a, const PlantModel& b) { return misfit(a) < misfit(b); });
  return {.model = tree.model,
          .chunk_from_model =
              Planted(ground_m, Uniform(words[1], 0.0, kTurn_rad), height_m / tree.height_m),
          .instance = 0,
          .sway_height_m = height_m,
          .coarser = tree.coarser};
}

/// Adds the trees of one strip. In a straight strip of constant width, the chainages of a Poisson
/// process have exponentially distributed gaps. In a curve, the strip is longer on the outside and
/// shorter on the inside by the factor 1 - curvature * d. The process is drawn for the largest such
/// factor, and for the widest strip, and thinned to the true one (Lewis, Shedler 1979).
void AddTrees(const ChunkContext& context,
              const PlantModels& plants,
              const Border& border,
              Chunk& chunk) {
  const Strip strip = WidestStrip(context, border);
  constexpr double kHectare_m2 = 1e4;
  const VegetationSpec& spec = context.spec.vegetation;
  const double largest_factor =
      1.0 + context.spec.terrain.half_width_m / context.alignment.tightest_radius_m();
  const double trees_per_m =
      spec.trees_per_hectare / kHectare_m2 * strip.width_m() * largest_factor;
  if (!(trees_per_m > 0.0)) return;
  const auto chunk_key = static_cast<std::uint32_t>(context.chunk);
  const std::uint32_t side_key = strip.side > 0.0 ? 1U : 0U;
  const ClearedAreas cleared(TracksOf(context), Clearing::kTree, context.begin_s_m,
                             context.end_s_m);
  double s_m = context.begin_s_m;
  for (std::uint32_t i = 0;; ++i) {
    const std::uint32_t item = 2U * i + side_key;
    const auto where = RandomWords(context.seed, RandomUse::kTreePlacement, chunk_key, item, 0);
    const auto which = RandomWords(context.seed, RandomUse::kTreePlacement, chunk_key, item, 1);
    s_m -= std::log1p(-Uniform(where[0], 0.0, 1.0)) / trees_per_m;
    if (s_m >= context.end_s_m) return;
    const double d_m = strip.side * Uniform(where[1], strip.inner_m, strip.outer_m);
    const double factor = 1.0 - context.alignment.At(s_m).curvature_per_m * d_m;
    if (Uniform(where[2], 0.0, largest_factor) >= factor) continue;
    const Strip here = StripAt(context, border, s_m);
    if (strip.side * d_m < here.inner_m || strip.side * d_m > here.outer_m) continue;
    if (cleared.Cover(s_m, d_m)) continue;
    const double height_m = Uniform(where[3], spec.tree_height_min_m, spec.tree_height_max_m);
    chunk.placements.push_back(MakeTree(plants, height_m, GroundPoint(context, s_m, d_m), which));
  }
}

/// Pose of a patch on the mean slope of the ground below it.
Eigen::Affine3d LaidOut(const ChunkContext& context, double s_m, double d_m, double yaw_rad) {
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
  return Eigen::Translation3d(middle_m) * rotation * Eigen::AngleAxisd(yaw_rad, Vector3::UnitZ());
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
      const PlantModel& patch = plants.grass[words[2] % plants.grass.size()];
      const double d_m = strip.side * (first_m + spacing_m * row);
      if (cleared.Cover(s_m, d_m)) continue;
      chunk.placements.push_back({.model = patch.model,
                                  .chunk_from_model = LaidOut(context, s_m, d_m, yaw_rad),
                                  .instance = 0,
                                  .coarser = patch.coarser});
    }
  }
}

}  // namespace

void AddVegetation(const ChunkContext& context, const PlantModels& plants, Chunk& chunk) {
  const VegetationSpec& spec = context.spec.vegetation;
  const double edge_m = context.spec.terrain.half_width_m;
  for (const double side : kBothSidesOfTrack) {
    AddTrees(context, plants, {side, spec.tree_min_distance_m, 2.0 * edge_m}, chunk);
    if (!spec.grass) continue;
    AddGrass(context, plants, {side, spec.grass_min_distance_m, spec.grass_max_distance_m}, chunk);
  }
}

}  // namespace railcast
