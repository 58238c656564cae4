#include "generator/extras/survey/surfel_maker.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/points/nearest_points.h"
#include "core/points/point_spread.h"

namespace railcast {
namespace {

using Cell2 = std::array<std::int32_t, 2>;
using Indices = std::vector<std::uint32_t>;

/// Neighbours that determine the plane of a surface, or what may be a line, as AdaSplats has it for
/// lines: more of them smooth over what a beam at a grazing angle meets.
constexpr std::size_t kNeighbors = 13;
constexpr std::size_t kNeighborsOfSparse = 120;
/// Shares of the points' spread from which on they are a line, and no surface.
constexpr float kLeastLinearity = 0.9F;
constexpr float kMostScatter = 0.06F;
/// An isolated point has fewer neighbours within the greatest gap.
constexpr std::size_t kLeastNeighbors = 4;
/// For surfaces whose reflectance is not known.
constexpr double kUnknownReflectivity = 0.3;
/// Below this cosine of incidence, echoes say little about the reflectivity.
constexpr float kLeastCosine = 0.2F;
constexpr double kGroundCell_m = 1.0;
/// Level surfaces are ground up to this much above the lowest one in their cell and those about it,
/// ...
constexpr double kGroundLayer_m = 0.3;
/// ... and may be stood upon up to this much, as platforms.
constexpr double kHighestFloor_m = 1.2;

Cell2 CellAt(const Vector3& point_m, double edge_m) {
  return {static_cast<std::int32_t>(std::floor(point_m.x() / edge_m)),
          static_cast<std::int32_t>(std::floor(point_m.y() / edge_m))};
}

/// How points spread about their mean.
struct Spread {
  Eigen::Vector3f mean_m;
  Eigen::Matrix3f axes;         ///< Columns: of least to greatest spread.
  Eigen::Vector3f variance_m2;  ///< In the same order.

  [[nodiscard]] float linearity() const { return 1.0F - variance_m2[1] / variance_m2[2]; }
  [[nodiscard]] float scatter() const { return variance_m2[0] / variance_m2[2]; }
};

/// The points of a tile and those beside it.
class TilePoints {
 public:
  TilePoints(const SurveyVoxels& cloud, const Indices& indices, const Vector3& origin_m)
      : origin_m_(origin_m), search_(PointsOf(cloud, indices, origin_m)) {}

  [[nodiscard]] const Eigen::Vector3f& At(std::size_t i) const { return search_.points_m()[i]; }
  [[nodiscard]] const Vector3& origin_m() const { return origin_m_; }
  /// The nearest points by distance, the point itself first.
  void FindNearest(std::size_t i, std::size_t num, Indices& found) const {
    search_.FindNearest(At(i), num, found);
  }
  [[nodiscard]] Spread SpreadOf(const Indices& indices) const {
    std::vector<Eigen::Vector3f> points_m;
    points_m.reserve(indices.size());
    for (const std::uint32_t index : indices) points_m.push_back(At(index));
    const PointSpread spread = ::railcast::SpreadOf(points_m);
    constexpr float kLeast_m2 = 1e-10F;
    return {spread.mean_m.cast<float>(), spread.axes.cast<float>(),
            spread.variances_m2.cast<float>().cwiseMax(kLeast_m2)};
  }

 private:
  static std::vector<Eigen::Vector3f> PointsOf(const SurveyVoxels& cloud,
                                               const Indices& indices,
                                               const Vector3& origin_m) {
    std::vector<Eigen::Vector3f> points_m;
    for (const std::uint32_t index : indices) {
      points_m.emplace_back((cloud.MeanOf(cloud.voxels()[index]) - origin_m).cast<float>());
    }
    return points_m;
  }

  Vector3 origin_m_;
  NearestSearch search_;
};

Indices First(const Indices& indices, std::size_t num) {
  return {indices.begin(),
          indices.begin() + std::min(std::ssize(indices), static_cast<std::ptrdiff_t>(num))};
}

/// How far a rectangle reaches from its centre to its four sides.
struct Reach {
  std::array<float, 4> to_m{};  ///< +u, -u, +v, -v; 0 where nothing is on that side.
  [[nodiscard]] bool is_closed() const { return std::ranges::min(to_m) > 0.0F; }
};

struct Axes {
  Eigen::Vector3f center_m, u, v, normal;
};

/// Between which points there is a surface: those at most so far apart, or neighbours in the eyes
/// of the sensor, whatever their distance.
struct Gap {
  float most_m;
  float spacing_m;       ///< Spacing of the sensor's beams, across them.
  Eigen::Vector3f view;  ///< Towards the sensor; 0 if that is not known.

  [[nodiscard]] bool IsBridged(const Eigen::Vector3f& offset_m) const {
    constexpr float kBeams = 1.5F;  // So that four beams are neighbours along both diagonals.
    return offset_m.norm() <= most_m ||
           (offset_m - offset_m.dot(view) * view).norm() <= kBeams * spacing_m;
  }
};

/// Looks for the nearest point of the same surface on each side.
Reach ReachOf(const TilePoints& points,
              const Indices& neighbors,
              const Axes& axes,
              const Gap& gap) {
  constexpr float kSameSurface_m = 0.05F;
  constexpr float kSteepest = 0.5F;
  Reach reach;
  for (const std::uint32_t neighbor : neighbors) {
    const Eigen::Vector3f offset_m = points.At(neighbor) - axes.center_m;
    const float a_m = axes.u.dot(offset_m);
    const float b_m = axes.v.dot(offset_m);
    const float distance_m = std::hypot(a_m, b_m);
    if (distance_m < 1e-4F || !gap.IsBridged(offset_m)) continue;
    const float off_m = std::abs(axes.normal.dot(offset_m));
    if (off_m > std::max(kSameSurface_m, kSteepest * std::min(distance_m, gap.most_m))) continue;
    const bool is_along = std::abs(a_m) >= std::abs(b_m);
    const std::size_t side = is_along ? (a_m > 0.0F ? 0 : 1) : (b_m > 0.0F ? 2 : 3);
    if (reach.to_m[side] == 0.0F) reach.to_m[side] = distance_m;
  }
  return reach;
}

class TileSurfels {
 public:
  TileSurfels(const SurveyVoxels& cloud, const SurfelRules& rules, const TilePoints& points)
      : cloud_(cloud), rules_(rules), points_(points) {}

  /// Makes the surfel of point `i`, which is that of voxel `index`, if it has neighbours.
  void Add(std::size_t i, std::uint32_t index, std::vector<MadeSurfel>& made) {
    points_.FindNearest(i, kNeighbors, neighbors_);
    if (neighbors_.size() <= kLeastNeighbors) return;
    MadeSurfel surfel{.voxel = index};
    const SurveyVoxel& voxel = cloud_.voxels()[index];
    const Eigen::Vector3f view = voxel.view_sum.normalized();
    const Gap gap{static_cast<float>(rules_.max_gap_m), voxel.spacing_m, view};
    const std::uint32_t fourth = neighbors_[kLeastNeighbors];
    if (DistanceToFourth_m(i) > rules_.max_gap_m && AddSparse(i, index, made)) return;
    if (!gap.IsBridged(points_.At(fourth) - points_.At(i))) return;
    const Axes axes = AxesOf(i, view, surfel.kind);
    Size(i, axes, gap, surfel);
    const float cosine = voxel.view_sum.isZero() ? 1.0F : std::abs(axes.normal.dot(view));
    const double reflectance = voxel.num_reflectances == 0
                                   ? kUnknownReflectivity
                                   : double{voxel.reflectance_sum} / voxel.num_reflectances /
                                         double{std::max(kLeastCosine, cosine)};
    surfel.surface = {SurveyLevelOf(reflectance), voxel.label};
    made.push_back(surfel);
  }

 private:
  [[nodiscard]] double DistanceToFourth_m(std::size_t i) const {
    const std::uint32_t fourth = neighbors_[kLeastNeighbors];
    return double{(points_.At(fourth) - points_.At(i)).norm()};
  }
  /// Adds a point that may be one of a wire, whose points are far from one another.
  bool AddSparse(std::size_t i, std::uint32_t index, std::vector<MadeSurfel>& made) const {
    if (DistanceToFourth_m(i) > double{kLongestWireGap_m}) return false;
    const Spread spread = points_.SpreadOf(First(neighbors_, kLeastNeighbors + 1));
    if (spread.linearity() < kLeastLinearity) return false;
    MadeSurfel surfel{.kind = SurfelKind::kLinear, .is_sparse = true, .voxel = index};
    surfel.center_m = points_.origin_m() + points_.At(i).cast<double>();
    surfel.half_u_m = spread.axes.col(2);
    surfel.half_v_m = spread.axes.col(1);
    surfel.surface = {0, cloud_.voxels()[index].label};
    made.push_back(surfel);
    return true;
  }
  /// Chooses the kind, and with it the plane.
  Axes AxesOf(std::size_t i, const Eigen::Vector3f& view, SurfelKind& kind) {
    const Eigen::Vector3f point_m = points_.At(i);
    Spread spread = points_.SpreadOf(neighbors_);
    if (spread.linearity() > kLeastLinearity) {
      // The nearest points of a sparse surface all lie on one scan line.
      Indices wide;
      points_.FindNearest(i, kNeighborsOfSparse, wide);
      const Spread of_wide = points_.SpreadOf(wide);
      const bool is_line =
          of_wide.linearity() > kLeastLinearity || of_wide.scatter() > kMostScatter;
      if (is_line) {
        kind = SurfelKind::kLinear;
        return Along(point_m, spread.axes.col(2), view);
      }
      spread = of_wide;
      neighbors_ = std::move(wide);
    }
    if (spread.scatter() > kMostScatter) {
      kind = SurfelKind::kOther;
      return view.isZero() ? Along(point_m, spread.axes.col(2), spread.axes.col(0))
                           : Along(point_m, spread.axes.col(2), view);
    }
    kind = SurfelKind::kSurface;
    const Eigen::Vector3f normal = spread.axes.col(0);
    const float off_m = normal.dot(point_m - spread.mean_m);
    return {point_m - off_m * normal, spread.axes.col(2), spread.axes.col(1), normal};
  }

  /// A rectangle along a direction that faces another one as far as it can.
  static Axes Along(const Eigen::Vector3f& center_m,
                    const Eigen::Vector3f& u,
                    const Eigen::Vector3f& facing) {
    Eigen::Vector3f v = facing.cross(u);
    if (v.norm() < 1e-3F) v = u.unitOrthogonal();
    v.normalize();
    return {center_m, u, v, u.cross(v)};
  }

  void Size(std::size_t i, Axes axes, const Gap& gap, MadeSurfel& surfel) {
    const auto least_m = static_cast<float>(cloud_.edge_m());
    const auto factor = static_cast<float>(0.5 * rules_.size_factor);
    Reach reach = ReachOf(points_, neighbors_, axes, gap);
    if (surfel.kind == SurfelKind::kSurface && !reach.is_closed() &&
        neighbors_.size() < kNeighborsOfSparse) {
      Indices wide;
      points_.FindNearest(i, kNeighborsOfSparse, wide);
      reach = ReachOf(points_, wide, axes, gap);
    }
    for (float& to_m : reach.to_m) {
      to_m = to_m > 0.0F ? factor * std::max(to_m, least_m) : 0.5F * least_m;
    }
    if (surfel.kind == SurfelKind::kOther) {
      // Half the diagonal of four beams: what is missing between them is left out by those that
      // pass.
      const float most_m = std::max(0.5F * least_m, std::sqrt(0.5F) * gap.spacing_m);
      for (float& to_m : reach.to_m) to_m = std::min(to_m, most_m);
    }
    if (surfel.kind == SurfelKind::kLinear) {
      constexpr float kOfSpacing = 0.33F;  // As AdaSplats has it for wires and poles.
      reach.to_m[2] = reach.to_m[3] = 0.5F * kOfSpacing * least_m;
    }
    const auto& [right_m, left_m, far_m, near_m] = reach.to_m;
    axes.center_m += 0.5F * (right_m - left_m) * axes.u + 0.5F * (far_m - near_m) * axes.v;
    surfel.center_m = points_.origin_m() + axes.center_m.cast<double>();
    surfel.half_u_m = 0.5F * (right_m + left_m) * axes.u;
    surfel.half_v_m = 0.5F * (far_m + near_m) * axes.v;
  }

  const SurveyVoxels& cloud_;
  const SurfelRules& rules_;
  const TilePoints& points_;
  Indices neighbors_;
};

using VoxelsOfTiles = std::map<Cell2, std::vector<std::uint32_t>>;

/// The voxels of a tile, then those at most `margin_m` beside it.
std::vector<std::uint32_t> WithMargin(const SurveyVoxels& cloud,
                                      const VoxelsOfTiles& tiles,
                                      const VoxelsOfTiles::value_type& tile,
                                      double margin_m) {
  std::vector<std::uint32_t> indices = tile.second;
  const Eigen::Array2d corner_m(tile.first[0] * kSurveyTile_m, tile.first[1] * kSurveyTile_m);
  for (std::int32_t dx = -1; dx <= 1; ++dx) {
    for (std::int32_t dy = -1; dy <= 1; ++dy) {
      const auto beside = tiles.find({tile.first[0] + dx, tile.first[1] + dy});
      if ((dx == 0 && dy == 0) || beside == tiles.end()) continue;
      for (const std::uint32_t index : beside->second) {
        const Eigen::Array2d in_tile_m =
            cloud.MeanOf(cloud.voxels()[index]).head<2>().array() - corner_m;
        const bool is_near =
            (in_tile_m >= -margin_m).all() && (in_tile_m <= kSurveyTile_m + margin_m).all();
        if (is_near) indices.push_back(index);
      }
    }
  }
  return indices;
}

/// Marks level surfels near the lowest ones about them, and names what has no label.
void MarkGround(std::vector<MadeSurfel>& surfels) {
  std::map<Cell2, double> lowest_m;
  const auto is_level = [](const MadeSurfel& surfel) {
    constexpr float kLevel = 0.8F;
    return surfel.kind == SurfelKind::kSurface && std::abs(surfel.Normal().z()) > kLevel;
  };
  for (const MadeSurfel& surfel : surfels) {
    if (!is_level(surfel)) continue;
    const auto [cell, is_new] =
        lowest_m.try_emplace(CellAt(surfel.center_m, kGroundCell_m), surfel.center_m.z());
    if (!is_new) cell->second = std::min(cell->second, surfel.center_m.z());
  }
  for (MadeSurfel& surfel : surfels) {
    const Cell2 cell = CellAt(surfel.center_m, kGroundCell_m);
    double about_m = std::numeric_limits<double>::infinity();
    for (std::int32_t dx = -1; dx <= 1; ++dx) {
      for (std::int32_t dy = -1; dy <= 1; ++dy) {
        const auto beside = lowest_m.find({cell[0] + dx, cell[1] + dy});
        if (beside != lowest_m.end()) about_m = std::min(about_m, beside->second);
      }
    }
    const double above_m = surfel.center_m.z() - about_m;
    surfel.is_ground = is_level(surfel) && above_m <= kHighestFloor_m;
    if (surfel.surface.label != SurveyLabels::kUnknown) continue;
    surfel.surface.label = surfel.is_ground && above_m <= kGroundLayer_m ? SurveyLabels::kGround
                                                                         : SurveyLabels::kObject;
  }
}

}  // namespace

std::vector<MadeSurfel> MakeSurfels(const SurveyVoxels& cloud, const SurfelRules& rules) {
  VoxelsOfTiles tiles;
  for (std::uint32_t i = 0; i < cloud.voxels().size(); ++i) {
    tiles[CellAt(cloud.MeanOf(cloud.voxels()[i]), kSurveyTile_m)].push_back(i);
  }
  std::vector<const VoxelsOfTiles::value_type*> places;
  for (const auto& tile : tiles) places.push_back(&tile);
  std::vector<std::vector<MadeSurfel>> of_tiles(places.size());
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t t) {
    const auto indices = WithMargin(cloud, tiles, *places[t],
                                    std::max(2.0 * rules.max_gap_m, double{kLongestWireGap_m}));
    const Vector3 origin_m = cloud.MeanOf(cloud.voxels()[indices.front()]);
    const TilePoints points(cloud, indices, origin_m);
    TileSurfels maker(cloud, rules, points);
    for (std::size_t i = 0; i < places[t]->second.size(); ++i) {
      maker.Add(i, indices[i], of_tiles[t]);
    }
  });
  std::vector<MadeSurfel> surfels;
  for (const auto& of_tile : of_tiles)
    surfels.insert(surfels.end(), of_tile.begin(), of_tile.end());
  MarkGround(surfels);
  return surfels;
}

SurveyTile& TileAt(const Vector3& place_m, std::map<Cell2, SurveyTile>& tiles) {
  const Cell2 cell = CellAt(place_m, kSurveyTile_m);
  const auto [found, is_new] = tiles.try_emplace(cell);
  SurveyTile& tile = found->second;
  if (is_new) {
    tile.cell = cell;
    tile.base_m = std::floor(place_m.z());
    tile.ground_m.assign(kGroundCells * kGroundCells, std::numeric_limits<float>::quiet_NaN());
  }
  return tile;
}

std::map<Cell2, SurveyTile> TilesOf(const std::vector<MadeSurfel>& surfels) {
  std::map<Cell2, SurveyTile> tiles;
  for (const MadeSurfel& surfel : surfels) {
    SurveyTile& tile = TileAt(surfel.center_m, tiles);
    const Eigen::Vector3f center_m = (surfel.center_m - tile.Origin_m()).cast<float>();
    tile.surfels.push_back({center_m, surfel.half_u_m, surfel.half_v_m, surfel.surface});
    if (!surfel.is_ground) continue;
    const auto index_of = [](float coordinate_m) {
      const auto cell_index =
          static_cast<std::ptrdiff_t>(double{coordinate_m} * kGroundCells / kSurveyTile_m);
      return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(cell_index, 0, kGroundCells - 1));
    };
    float& ground_m = tile.ground_m[index_of(center_m.y()) * kGroundCells + index_of(center_m.x())];
    // The lowest, so that what stands there may sink in slightly, but does not hover.
    ground_m = std::isnan(ground_m) ? center_m.z() : std::min(ground_m, center_m.z());
  }
  return tiles;
}

}  // namespace railcast
