#include "generator/extras/survey/wire_finder.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "core/base/joined_sets.h"
#include "core/points/nearest_points.h"
#include "core/points/point_spread.h"

namespace railcast {
namespace {

/// Contact lines hang higher than vehicles of the loading gauge (EN 15273) are.
constexpr double kLeastHeight_m = 4.0;
constexpr double kMostAside_m = 20.0;
constexpr float kMostSlope = 0.3F;
/// Neighbouring points of a wire are at most so far off the line of each other, with 3 % of their
/// distance.
constexpr float kOffLine_m = 0.05F;
constexpr float kOffLineShare = 0.03F;
constexpr std::size_t kLeastPoints = 8;
constexpr double kLeastLength_m = 4.0;
constexpr double kWireStep_m = 2.0;
/// The radius of contact wires of 100 mm2 and the reflectivity of copper: a beam that is wider than
/// the wire says nothing about either.
constexpr float kRadius_m = 0.006F;
constexpr double kWireReflectivity = 0.4;

bool IsHigh(const MadeSurfel& surfel, const DrivenWay& way) {
  const auto squared_m2 = [&](const Transform& place) {
    return (place.translation() - surfel.center_m).head<2>().squaredNorm();
  };
  const auto nearest = std::ranges::min_element(way.world_from_body, {}, squared_m2);
  const double above_m = surfel.center_m.z() - nearest->translation().z() + way.above_rail_m;
  const Vector3 offset_m = nearest->inverse() * surfel.center_m;
  return above_m >= kLeastHeight_m && std::abs(offset_m.y()) <= kMostAside_m;
}

/// Groups candidates, given by their indices, that follow one another along a line.
std::map<std::size_t, std::vector<std::size_t>> Chains(const std::vector<MadeSurfel>& surfels,
                                                       const std::vector<std::size_t>& candidates) {
  if (candidates.empty()) return {};
  const Vector3 origin_m = surfels[candidates.front()].center_m;
  std::vector<Eigen::Vector3f> points_m;
  for (const std::size_t i : candidates) {
    points_m.emplace_back((surfels[i].center_m - origin_m).cast<float>());
  }
  const NearestSearch search(points_m);
  JoinedSets groups(candidates.size());
  std::vector<std::uint32_t> found;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Eigen::Vector3f direction = surfels[candidates[i]].half_u_m.normalized();
    search.FindWithin(points_m[i], kLongestWireGap_m, found);
    for (const std::uint32_t other : found) {
      if (other <= i) continue;
      const Eigen::Vector3f offset_m = points_m[other] - points_m[i];
      const Eigen::Vector3f other_direction = surfels[candidates[other]].half_u_m.normalized();
      const float allowed_m = kOffLine_m + kOffLineShare * offset_m.norm();
      const bool follows = offset_m.cross(direction).norm() <= allowed_m &&
                           offset_m.cross(other_direction).norm() <= allowed_m;
      if (follows) groups.Join(i, other);
    }
  }
  std::map<std::size_t, std::vector<std::size_t>> chains;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    chains[groups.SetOf(i)].push_back(candidates[i]);
  }
  return chains;
}

/// The points of a chain in the plane and the height over a line along it.
struct Chain {
  Vector3 origin_m = Vector3::Zero();
  Eigen::Matrix3d world_from_chain;  ///< x along it, z up.
  std::vector<Vector3> points_m;     ///< By x.

  /// The parabola through the points about `x_m`; nothing where they are too few.
  [[nodiscard]] std::optional<Vector3> At(double x_m) const {
    constexpr double kWindow_m = 4.0;
    std::vector<Vector3> near;
    for (const Vector3& point_m : points_m) {
      if (std::abs(point_m.x() - x_m) <= kWindow_m) near.push_back(point_m);
    }
    if (near.size() < 4) return std::nullopt;
    Eigen::MatrixX3d powers(near.size(), 3);
    Eigen::MatrixX2d values_m(near.size(), 2);
    for (Eigen::Index i = 0; i < std::ssize(near); ++i) {
      const Vector3& point_m = near[static_cast<std::size_t>(i)];
      const double t_m = point_m.x() - x_m;
      powers.row(i) << 1.0, t_m, t_m * t_m;
      values_m.row(i) = point_m.tail<2>();
    }
    const Eigen::MatrixX2d fitted = powers.completeOrthogonalDecomposition().solve(values_m);
    return origin_m + world_from_chain * Vector3(x_m, fitted(0, 0), fitted(0, 1));
  }
};

Chain ChainOf(const std::vector<MadeSurfel>& surfels, const std::vector<std::size_t>& members) {
  Chain chain;
  for (const std::size_t i : members) chain.origin_m += surfels[i].center_m;
  chain.origin_m /= static_cast<double>(members.size());
  std::vector<Eigen::Vector3f> in_plan_m;
  for (const std::size_t i : members) {
    in_plan_m.emplace_back((surfels[i].center_m - chain.origin_m).cast<float>());
    in_plan_m.back().z() = 0.0F;
  }
  const Vector3 along = SpreadOf(in_plan_m).axes.col(2);
  chain.world_from_chain << along.x(), -along.y(), 0.0, along.y(), along.x(), 0.0, 0.0, 0.0, 1.0;
  for (const std::size_t i : members) {
    chain.points_m.push_back(chain.world_from_chain.transpose() *
                             (surfels[i].center_m - chain.origin_m));
  }
  std::ranges::sort(chain.points_m, {}, [](const Vector3& point_m) { return point_m.x(); });
  return chain;
}

/// The wires of a chain: several where it has gaps.
void AddWiresOf(const Chain& chain, std::uint16_t label, std::vector<FoundWire>& wires) {
  for (std::size_t begin = 0; begin < chain.points_m.size();) {
    std::size_t end = begin + 1;
    while (end < chain.points_m.size() &&
           chain.points_m[end].x() - chain.points_m[end - 1].x() <= double{kLongestWireGap_m}) {
      ++end;
    }
    const double begin_m = chain.points_m[begin].x();
    const double length_m = chain.points_m[end - 1].x() - begin_m;
    begin = end;
    if (length_m < kLeastLength_m) continue;
    const auto num_steps = static_cast<int>(std::ceil(length_m / kWireStep_m));
    FoundWire wire{.points_m = {}, .label = label};
    for (int i = 0; i <= num_steps; ++i) {
      if (const auto point_m = chain.At(begin_m + length_m * i / num_steps)) {
        wire.points_m.push_back(*point_m);
      }
    }
    if (wire.points_m.size() >= 2) wires.push_back(std::move(wire));
  }
}

std::uint16_t MajorityLabel(const std::vector<MadeSurfel>& surfels,
                            const std::vector<std::size_t>& members) {
  std::map<std::uint16_t, std::size_t> votes;
  for (const std::size_t i : members) ++votes[surfels[i].surface.label];
  const auto most =
      std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second; });
  return most->first == SurveyLabels::kObject ? SurveyLabels::kWire : most->first;
}

}  // namespace

std::vector<FoundWire> TakeWires(const DrivenWay& way, std::vector<MadeSurfel>& surfels) {
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const MadeSurfel& surfel = surfels[i];
    if (surfel.kind != SurfelKind::kLinear || way.world_from_body.empty()) continue;
    if (std::abs(surfel.half_u_m.normalized().z()) > kMostSlope || !IsHigh(surfel, way)) continue;
    candidates.push_back(i);
  }
  std::vector<FoundWire> wires;
  std::vector<bool> is_wire(surfels.size());
  for (const auto& [first, members] : Chains(surfels, candidates)) {
    if (members.size() < kLeastPoints) continue;
    const std::size_t num_before = wires.size();
    AddWiresOf(ChainOf(surfels, members), MajorityLabel(surfels, members), wires);
    if (wires.size() == num_before) continue;
    for (const std::size_t i : members) is_wire[i] = true;
  }
  std::vector<MadeSurfel> kept;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    if (!is_wire[i] && !surfels[i].is_sparse) kept.push_back(surfels[i]);
  }
  surfels = std::move(kept);
  return wires;
}

void AddWires(const std::vector<FoundWire>& wires,
              std::map<std::array<std::int32_t, 2>, SurveyTile>& tiles) {
  const std::uint8_t level = SurveyLevelOf(kWireReflectivity);
  for (const FoundWire& wire : wires) {
    const SurveyTile* last = nullptr;
    for (std::size_t i = 0; i + 1 < wire.points_m.size(); ++i) {
      SurveyTile& tile = TileAt(0.5 * (wire.points_m[i] + wire.points_m[i + 1]), tiles);
      const auto in_tile = [&](const Vector3& point_m) {
        return Eigen::Vector3f((point_m - tile.Origin_m()).cast<float>());
      };
      if (&tile != last) {
        tile.wires.push_back({{level, wire.label}, kRadius_m, {in_tile(wire.points_m[i])}});
      }
      tile.wires.back().points_m.push_back(in_tile(wire.points_m[i + 1]));
      last = &tile;
    }
  }
}

}  // namespace railcast
