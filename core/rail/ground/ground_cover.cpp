#include "core/rail/ground/terrain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/landform/landform.h"
#include "core/rail/track/cross_section.h"

namespace railcast {
namespace {

/// The track about a place of the chunk: cross-sections so close that the nearest one tells how far
/// away the tracks are, within 2 cm.
class NearbyTracks {
 public:
  explicit NearbyTracks(const ChunkContext& context) {
    constexpr double kSpacing_m = 2.5;
    const double length_m = context.end_s_m - context.begin_s_m;
    const int num_steps = std::max(1, static_cast<int>(std::ceil(length_m / kSpacing_m)));
    for (int i = 0; i <= num_steps; ++i) {
      sections_.emplace_back(context, context.begin_s_m + length_m * i / num_steps);
      const Vector3 middle_m = sections_.back().PointAt(0.0, 0.0);
      middles_m_.push_back(middle_m.head<2>());
      lefts_.push_back((sections_.back().PointAt(1.0, 0.0) - middle_m).head<2>());
    }
  }

  /// Distance from the nearest track; of what is high above the formation, at least
  /// kFormationEdge_m.
  [[nodiscard]] double Distance_m(const Vector3& point_m) const {
    const Eigen::Vector2d place_m = point_m.head<2>();
    std::size_t nearest = 0;
    double least_m2 = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < middles_m_.size(); ++i) {
      const double squared_m2 = (place_m - middles_m_[i]).squaredNorm();
      if (squared_m2 < least_m2) nearest = i;
      least_m2 = std::min(least_m2, squared_m2);
    }
    const double d_m = (place_m - middles_m_[nearest]).dot(lefts_[nearest]);
    const double distance_m = sections_[nearest].DistanceFromTracks_m(d_m);
    if (distance_m >= kFormationEdge_m) return distance_m;
    // The hill above a tunnel is no formation.
    constexpr double kHill_m = 1.5;
    const double formation_m = sections_[nearest].FormationHeight_m(d_m);
    const double rise_m = point_m.z() - sections_[nearest].PointAt(d_m, formation_m).z();
    return rise_m > kHill_m ? kFormationEdge_m : distance_m;
  }

 private:
  std::vector<CrossSection> sections_;
  std::vector<Eigen::Vector2d> middles_m_;
  std::vector<Eigen::Vector2d> lefts_;
};

bool IsMeadow(std::uint64_t seed, const Eigen::Vector2d& place_m) {
  constexpr double kWidth_m = 70.0;
  constexpr double kLength_m = 110.0;
  constexpr double kTurn = 0.35;  // Parcels seldom lie along the axes of the map.
  constexpr float kMeadows = 0.55F;
  const Eigen::Vector2d turned_m = Eigen::Rotation2Dd(kTurn) * place_m;
  const auto column = static_cast<std::int32_t>(std::floor(turned_m.x() / kWidth_m));
  // Neighbouring rows of parcels are offset.
  const double shifted_m = turned_m.y() + 0.4 * kLength_m * column;
  const auto row = static_cast<std::int32_t>(std::floor(shifted_m / kLength_m));
  const auto words = RandomWords(seed, RandomUse::kFields, static_cast<std::uint32_t>(column),
                                 static_cast<std::uint32_t>(row));
  return UnitFloat(words[0]) < kMeadows;
}

/// A mesh that takes triangles of another.
class Excerpt {
 public:
  explicit Excerpt(const Mesh& of) : of_(of) {}

  void Take(const std::array<std::uint32_t, 3>& triangle) {
    std::array<std::uint32_t, 3> taken{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto next = static_cast<std::uint32_t>(mesh_.vertices.size());
      const auto [vertex, is_new] = vertices_.try_emplace(triangle[i], next);
      if (is_new) mesh_.vertices.push_back(of_.vertices[triangle[i]]);
      taken[i] = vertex->second;
    }
    mesh_.triangles.push_back(taken);
  }
  [[nodiscard]] const Mesh& mesh() const { return mesh_; }

 private:
  const Mesh& of_;
  Mesh mesh_;
  std::unordered_map<std::uint32_t, std::uint32_t> vertices_;
};

}  // namespace

void AddGround(const ChunkContext& context, const Mesh& ground, Chunk& chunk) {
  if (context.spec.terrain.cover == GroundCover::kSoil) {
    MeshOf(context.surfaces.ground, chunk.ground).Append(ground);
    return;
  }
  const NearbyTracks tracks(context);
  const Transform world_from_chunk = context.chunk_from_world.inverse();
  Excerpt gravel(ground);
  Excerpt meadow(ground);
  Excerpt field(ground);
  for (const auto& triangle : ground.triangles) {
    Vector3 middle_m = Vector3::Zero();
    for (const std::uint32_t vertex : triangle) middle_m += ground.vertices[vertex].cast<double>();
    middle_m /= 3.0;
    const double distance_m = tracks.Distance_m(middle_m);
    if (distance_m < kFormationEdge_m) {
      gravel.Take(triangle);
    } else if (distance_m < kVerge_m ||
               IsMeadow(context.seed, (world_from_chunk * middle_m).head<2>())) {
      meadow.Take(triangle);
    } else {
      field.Take(triangle);
    }
  }
  const RailSurfaces& surfaces = context.surfaces;
  for (const auto& [surface, excerpt] :
       {std::pair(&surfaces.gravel, &gravel), std::pair(&surfaces.meadow, &meadow),
        std::pair(&surfaces.ground, &field)}) {
    if (!excerpt->mesh().triangles.empty()) {
      MeshOf(*surface, chunk.ground).Append(excerpt->mesh());
    }
  }
}

}  // namespace railcast
