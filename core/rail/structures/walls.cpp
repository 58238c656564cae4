#include <cmath>
#include <numbers>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/landform/ground_rise.h"
#include "core/rail/structures/structure_track.h"
#include "core/rail/structures/structures.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

/// Feet of walls below top of rail; the ground beside the track lies 0.7 m below it and undulates
/// farther away.
constexpr double kWallFoot_m = 1.8;

constexpr double kPanelThickness_m = 0.12;
constexpr double kPostWidth_m = 0.16;  ///< HEB 160.

constexpr double kCopingHeight_m = 0.2;
constexpr double kCopingOverhang_m = 0.05;

/// Mats of EN 10223-7: rods of 6 mm every 50 mm, and every 200 mm two lying ones of 8 mm.
constexpr double kRodRadius_m = 0.003;
constexpr double kRodSpacing_m = 0.05;
constexpr double kCrossRodRadius_m = 0.004;
constexpr double kCrossRodSpacing_m = 0.2;
constexpr double kWireRadius_m = 0.0015;
constexpr int kNumWires = 6;
constexpr double kFencePostWidth_m = 0.06;
constexpr double kFenceFoot_m = 0.3;  ///< How far posts reach below the ground.
constexpr double kFenceGap_m = 0.05;  ///< Between the ground and the mats.

/// A rod or wire as a prism of three sides that is as wide as the rod, seen from all sides on
/// average: its outline is as long as the rod's (Cauchy).
Mesh MakeThinRod(const Vector3& begin_m, const Vector3& end_m, double radius_m) {
  const double corner_m = 2.0 * std::numbers::pi * radius_m / (3.0 * std::numbers::sqrt3);
  const Vector3 along = (end_m - begin_m).normalized();
  const Vector3 across =
      along.cross(std::abs(along.z()) < 0.9 ? Vector3::UnitZ() : Vector3::UnitX()).normalized();
  const Vector3 up = along.cross(across);
  Mesh rod;
  for (const Vector3& end : {begin_m, end_m}) {
    for (int corner = 0; corner < 3; ++corner) {
      const double angle_rad = 2.0 * std::numbers::pi * corner / 3.0;
      rod.vertices.emplace_back(
          (end + corner_m * (std::cos(angle_rad) * across + std::sin(angle_rad) * up))
              .cast<float>());
    }
  }
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::uint32_t next = (i + 1) % 3;
    rod.triangles.push_back({i, i + 3, next + 3});
    rod.triangles.push_back({i, next + 3, next});
  }
  return rod;
}

/// Two neighbouring feet of a fence on the ground.
struct Panel {
  Vector3 begin_m;
  Vector3 end_m;

  [[nodiscard]] Vector3 At(double fraction, double height_m) const {
    return begin_m + fraction * (end_m - begin_m) + height_m * Vector3::UnitZ();
  }
};

void AddMat(const Panel& panel, double height_m, Mesh& mesh) {
  const auto num_rods = std::max(
      1, static_cast<int>(std::lround((panel.end_m - panel.begin_m).norm() / kRodSpacing_m)));
  for (int i = 0; i < num_rods; ++i) {
    const double at = (i + 0.5) / num_rods;
    mesh.Append(MakeThinRod(panel.At(at, kFenceGap_m), panel.At(at, height_m), kRodRadius_m));
  }
  const Vector3 along = (panel.end_m - panel.begin_m).normalized();
  const Vector3 aside = (kRodRadius_m + kCrossRodRadius_m) * along.cross(Vector3::UnitZ());
  for (double at_m = kFenceGap_m; at_m <= height_m; at_m += kCrossRodSpacing_m) {
    for (const double side : {-1.0, 1.0}) {
      mesh.Append(MakeThinRod(panel.At(0.0, at_m) + side * aside,
                              panel.At(1.0, at_m) + side * aside, kCrossRodRadius_m));
    }
  }
}

void AddLineWires(const Panel& panel, double height_m, Mesh& mesh) {
  for (int i = 1; i <= kNumWires; ++i) {
    const double at_m = height_m * i / kNumWires - kWireRadius_m;
    mesh.Append(MakeThinRod(panel.At(0.0, at_m), panel.At(1.0, at_m), kWireRadius_m));
  }
}

}  // namespace

void AddStructure(const ChunkContext& context, const NoiseWallSpec& wall, Chunk& chunk) {
  const StructureTrack track(context, wall.track);
  const double side = SignOf(wall.side);
  const double far_m = wall.distance_m + kPanelThickness_m;
  const auto frame_at = [&](double s_m) { return track.Upright(s_m); };
  const auto stretch = StretchInChunk(track, RangeOf(wall), side * far_m, frame_at);
  if (!stretch) return;
  AppendSweptSolid(
      *stretch, OnSide(RectangleOutline(wall.distance_m, -kWallFoot_m, far_m, wall.height_m), side),
      MeshOf(context.surfaces.structures.noise_wall, chunk.ground));
  const double half_m = 0.5 * kPostWidth_m;
  const Mesh post =
      MakeBox({Vector3(-half_m, -half_m, -kWallFoot_m), Vector3(half_m, half_m, wall.height_m)});
  const double middle_m = side * (wall.distance_m + 0.5 * kPanelThickness_m);
  for (const double s_m : track.Places(RangeOf(wall), wall.post_spacing_m)) {
    MeshOf(context.surfaces.structures.noise_wall_post, chunk.ground)
        .Append(post, frame_at(s_m) * Eigen::Translation3d(0.0, middle_m, 0.0));
  }
}

std::vector<ClearedArea> ClearedBy(const NoiseWallSpec& wall) {
  return ClearedBeside(wall, wall.distance_m, wall.distance_m + kPanelThickness_m);
}

void AddStructure(const ChunkContext& context, const FenceSpec& fence, Chunk& chunk) {
  const StructureTrack track(context, fence.track);
  const double side = SignOf(fence.side);
  const auto foot_at = [&](double s_m) {
    return GroundPoint(context, s_m, track.offset_m(s_m) + side * fence.distance_m);
  };
  const double length_m = fence.end_s_m - fence.begin_s_m;
  const double step_m = length_m / std::max(1.0, std::ceil(length_m / fence.post_spacing_m));
  const double half_m = 0.5 * kFencePostWidth_m;
  const Mesh post = MakeBox(
      {Vector3(-half_m, -half_m, -kFenceFoot_m), Vector3(half_m, half_m, fence.height_m + half_m)});
  Mesh fence_mesh;
  for (const double s_m : track.Places(RangeOf(fence), fence.post_spacing_m)) {
    const Vector3 foot_m = foot_at(s_m);
    Transform chunk_from_post = track.Upright(s_m);
    chunk_from_post.translation() = foot_m;
    fence_mesh.Append(post, chunk_from_post);
    // Each post carries the panel up to the next one.
    if (s_m + 0.5 * step_m > fence.end_s_m) continue;
    const Panel panel{.begin_m = foot_m, .end_m = foot_at(s_m + step_m)};
    if (fence.fence == FenceType::kMesh) {
      AddMat(panel, fence.height_m, fence_mesh);
    } else {
      AddLineWires(panel, fence.height_m, fence_mesh);
    }
  }
  if (fence_mesh.triangles.empty()) return;
  MeshOf(context.surfaces.structures.fence, chunk.ground).Append(fence_mesh);
}

std::vector<ClearedArea> ClearedBy(const FenceSpec& fence) {
  const double half_m = 0.5 * kFencePostWidth_m;
  return ClearedBeside(fence, fence.distance_m - half_m, fence.distance_m + half_m);
}

void AddStructure(const ChunkContext& context, const RetainingWallSpec& wall, Chunk& chunk) {
  const StructureTrack track(context, wall.track);
  const double side = SignOf(wall.side);
  const double top_m = wall.distance_m + kRetainingBatter * wall.height_m;
  const double foot_m = wall.distance_m - kRetainingBatter * wall.depth_m;
  const double back_m = BackOf_m(wall);
  const auto stretch = StretchInChunk(track, RangeOf(wall), side * back_m,
                                      [&](double s_m) { return track.Upright(s_m); });
  if (!stretch) return;
  const double below_coping_m = wall.height_m - kCopingHeight_m;
  const double face_m = top_m - kRetainingBatter * kCopingHeight_m;
  const Outline outline_m{{foot_m, -wall.depth_m},
                          {face_m, below_coping_m},
                          {face_m - kCopingOverhang_m, below_coping_m},
                          {face_m - kCopingOverhang_m, wall.height_m},
                          {back_m, wall.height_m},
                          {back_m, -wall.depth_m}};
  AppendSweptSolid(*stretch, OnSide(outline_m, side),
                   MeshOf(context.surfaces.structures.retaining_wall, chunk.ground));
}

std::vector<ClearedArea> ClearedBy(const RetainingWallSpec& wall) {
  return ClearedBeside(wall, wall.distance_m - kRetainingBatter * wall.depth_m, BackOf_m(wall));
}

}  // namespace railcast
