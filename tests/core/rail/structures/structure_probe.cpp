#include "tests/core/rail/structures/structure_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/rail/structures/structures.h"
#include "tests/support/ray_cast.h"

namespace railcast {
namespace {

/// All parts of a chunk in its frame, or those of one surface alone.
std::vector<Part> PartsOfChunk(const Chunk& chunk, const std::optional<SurfaceClass>& surface) {
  std::vector<Part> parts = chunk.ground.parts;
  for (const Placement& placement : chunk.placements) {
    for (Part part : placement.model->parts) {
      for (Eigen::Vector3f& vertex : part.mesh.vertices) {
        vertex = (placement.chunk_from_model * vertex.cast<double>()).cast<float>();
      }
      parts.push_back(std::move(part));
    }
  }
  if (surface) parts = {{MeshOfSurface(chunk, *surface), surface->material, surface->label}};
  return parts;
}

}  // namespace

std::vector<Eigen::Vector2d> StructureProbe::SectionOf(const SurfaceClass& surface,
                                                       double s_m) const {
  const AxisPoint axis = line_.alignment().At(s_m);
  return CutAt(
      surface, s_m,
      MakeTransform(RotationFromYawPitchRoll(axis.heading_rad, 0.0, 0.0), axis.position_m));
}

std::vector<Eigen::Vector2d> StructureProbe::CantedSectionOf(const SurfaceClass& surface,
                                                             double s_m) const {
  return CutAt(surface, s_m, line_.alignment().WorldFromTrack(s_m));
}

std::vector<Eigen::Vector2d> StructureProbe::CutAt(const SurfaceClass& surface,
                                                   double s_m,
                                                   const Transform& world_from_plane) const {
  const int chunk = static_cast<int>(std::floor(s_m / TestLine::kChunkLength_m));
  Chunk structures;
  AddStructures(line_.Context(chunk), structures);
  const Mesh mesh = MeshOfSurface(structures, surface);
  const Transform plane_from_chunk = world_from_plane.inverse() * line_.WorldFromChunk(chunk);
  std::vector<Eigen::Vector2d> cut;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3 a = plane_from_chunk * mesh.vertices[triangle[i]].cast<double>();
      const Vector3 b = plane_from_chunk * mesh.vertices[triangle[(i + 1) % 3]].cast<double>();
      if ((a.x() < 0.0) == (b.x() < 0.0)) continue;
      const Vector3 point = a - a.x() / (b.x() - a.x()) * (b - a);
      cut.emplace_back(point.y(), point.z());
    }
  }
  return cut;
}

Vector3 StructureProbe::WorldAt(const Vector3& place) const {
  const Vector3 on_axis_m = line_.alignment().WorldFromTrack(place.x(), place.y()).translation();
  return on_axis_m + Vector3(0.0, 0.0, place.z());
}

StructureProbe::Seen StructureProbe::Look(const Vector3& from,
                                          const Vector3& to,
                                          const std::optional<SurfaceClass>& surface,
                                          bool is_coarse) const {
  static const TraceDevice device;
  const int index = static_cast<int>(std::floor(to.x() / TestLine::kChunkLength_m));
  const SurfaceClass only = surface.value_or(SurfaceClass{});
  const auto [it, is_new] = built_.try_emplace({index, is_coarse, only.label, only.material});
  Built& built = it->second;
  if (is_new) {
    built.model.parts = PartsOfChunk(line_.Build(index, is_coarse), surface);
    built.scene = SceneOf(device, built.model);
  }
  const Transform chunk_from_world = line_.WorldFromChunk(index).inverse();
  const Vector3 origin = chunk_from_world * WorldAt(from);
  const Vector3 target = chunk_from_world * WorldAt(to);
  const Ray ray = RayThrough(origin, target);
  const float beyond_m = static_cast<float>((target - origin).norm()) + 1.0F;
  const RayHit hit = CastRays(*built.scene, {&ray, 1}, beyond_m).front();
  if (hit.surface == 0) return {0, static_cast<double>(beyond_m)};
  return {built.model.parts[hit.surface - 1].label, static_cast<double>(hit.range_m)};
}

StructureProbe::Seen StructureProbe::Look(const Vector3& from, const Vector3& to) const {
  return Look(from, to, std::nullopt, false);
}

std::uint32_t StructureProbe::LabelSeen(const Vector3& from, const Vector3& to) const {
  return Look(from, to).label;
}

std::optional<double> StructureProbe::HeightBelow_m(const SurfaceClass& surface,
                                                    const Vector3& place,
                                                    bool is_coarse) const {
  constexpr double kDeep_m = 1000.0;
  const Seen seen = Look(place, place - kDeep_m * Vector3::UnitZ(), surface, is_coarse);
  if (seen.label == 0) return std::nullopt;
  return place.z() - seen.distance_m;
}

double LeastOf(const std::vector<Eigen::Vector2d>& points, int axis) {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& point : points) least = std::min(least, point[axis]);
  return least;
}

double MostOf(const std::vector<Eigen::Vector2d>& points, int axis) {
  double most = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& point : points) most = std::max(most, point[axis]);
  return most;
}

}  // namespace railcast
