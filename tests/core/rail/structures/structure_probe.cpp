#include "tests/core/rail/structures/structure_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/rail/structures/structures.h"

namespace railcast {
namespace {

/// Distance along a ray to a triangle, or infinity (Möller, Trumbore 1997).
double DistanceTo(const Mesh& mesh,
                  const std::array<std::uint32_t, 3>& triangle,
                  const Vector3& origin,
                  const Vector3& direction) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const Vector3 a = mesh.vertices[triangle[0]].cast<double>();
  const Vector3 ab = mesh.vertices[triangle[1]].cast<double>() - a;
  const Vector3 ac = mesh.vertices[triangle[2]].cast<double>() - a;
  const Vector3 p = direction.cross(ac);
  const double determinant = ab.dot(p);
  if (std::abs(determinant) < 1e-15) return kNone;
  const Vector3 from_a = origin - a;
  const double u = from_a.dot(p) / determinant;
  const Vector3 q = from_a.cross(ab);
  const double v = direction.dot(q) / determinant;
  const double distance = ac.dot(q) / determinant;
  return u < 0.0 || v < 0.0 || u + v > 1.0 || distance < 0.0 ? kNone : distance;
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

const Chunk& StructureProbe::BuiltChunk(int index, bool is_coarse) const {
  const auto [built, is_new] = built_.try_emplace({index, is_coarse});
  if (is_new) built->second = line_.Build(index, is_coarse);
  return built->second;
}

std::optional<double> StructureProbe::HeightBelow_m(const SurfaceClass& surface,
                                                    const Vector3& place,
                                                    bool is_coarse) const {
  const int index = static_cast<int>(std::floor(place.x() / TestLine::kChunkLength_m));
  const Mesh mesh = MeshOfSurface(BuiltChunk(index, is_coarse), surface);
  const Vector3 from_m = line_.WorldFromChunk(index).inverse() * WorldAt(place);
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const auto& triangle : mesh.triangles) {
    nearest_m = std::min(nearest_m, DistanceTo(mesh, triangle, from_m, -Vector3::UnitZ()));
  }
  if (std::isinf(nearest_m)) return std::nullopt;
  return place.z() - nearest_m;
}

std::uint32_t StructureProbe::LabelSeen(const Vector3& from, const Vector3& to) const {
  return Look(from, to).label;
}

StructureProbe::Seen StructureProbe::Look(const Vector3& from, const Vector3& to) const {
  const int index = static_cast<int>(std::floor(to.x() / TestLine::kChunkLength_m));
  const Chunk& chunk = BuiltChunk(index, false);
  const Transform chunk_from_world = line_.WorldFromChunk(index).inverse();
  const Vector3 origin = chunk_from_world * WorldAt(from);
  const Vector3 way = chunk_from_world * WorldAt(to) - origin;
  double nearest_m = way.norm() + 1.0;
  std::uint32_t label = 0;
  const auto look_at = [&](const Model& model, const Eigen::Affine3d& model_from_chunk) {
    const Vector3 begin = model_from_chunk * origin;
    const Vector3 direction = model_from_chunk.linear() * way.normalized();
    for (const Part& part : model.parts) {
      for (const auto& triangle : part.mesh.triangles) {
        const double distance_m = DistanceTo(part.mesh, triangle, begin, direction);
        if (distance_m >= nearest_m) continue;
        nearest_m = distance_m;
        label = part.label;
      }
    }
  };
  look_at(chunk.ground, Eigen::Affine3d::Identity());
  for (const Placement& placement : chunk.placements) {
    look_at(*placement.model, placement.chunk_from_model.inverse());
  }
  return {label, nearest_m};
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
