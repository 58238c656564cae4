#include "tests/bench/simplify.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModHausdorffT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalDeviationT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <array>
#include <cstring>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include "tests/bench/mesh_deviation.h"

namespace railcast {
namespace {

struct ExactTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using EdgeMesh = OpenMesh::TriMesh_ArrayKernelT<ExactTraits>;
using Triangle = std::array<std::uint32_t, 3>;

struct PlaceHash {
  std::size_t operator()(const std::array<std::uint32_t, 3>& bits) const {
    std::size_t hash = 0;
    for (const std::uint32_t word : bits) hash = (hash ^ word) * 0x9E3779B97F4A7C15ULL;
    return hash ^ (hash >> 32U);
  }
};

/// Points that are numbered by their place, so that triangles share those that are in one place.
class Places {
 public:
  std::uint32_t Of(const Eigen::Vector3f& point) {
    std::array<std::uint32_t, 3> bits{};
    const Eigen::Vector3f without_minus_zero = point + Eigen::Vector3f::Zero();
    std::memcpy(bits.data(), without_minus_zero.data(), sizeof(bits));
    const auto [it, is_new] =
        number_of_.try_emplace(bits, static_cast<std::uint32_t>(points_.size()));
    if (is_new) points_.push_back(point);
    return it->second;
  }
  [[nodiscard]] const std::vector<Eigen::Vector3f>& points() const { return points_; }

 private:
  std::vector<Eigen::Vector3f> points_;
  std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, PlaceHash> number_of_;
};

/// Builds a mesh from triangles, each with the vertices that it uses.
class MeshGatherer {
 public:
  void Add(const std::array<Eigen::Vector3f, 3>& corners) {
    Triangle triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      triangle[i] = places_.Of(corners[i]);
    }
    mesh_.triangles.push_back(triangle);
  }
  [[nodiscard]] Mesh Take() {
    mesh_.vertices = places_.points();
    return std::move(mesh_);
  }

 private:
  Places places_;
  Mesh mesh_;
};

/// All parts as one mesh of OpenMesh.
class EdgeMeshOfParts {
 public:
  explicit EdgeMeshOfParts(const std::vector<Mesh>& parts) : aside_(parts.size()) {
    // What OpenMesh cannot hold it would print.
    omerr().disable();
    edges_.request_vertex_status();
    edges_.request_edge_status();
    edges_.request_halfedge_status();
    edges_.request_face_status();
    edges_.request_face_normals();
    edges_.add_property(part_of_);
    AddVertices(parts);
    for (std::size_t p = 0; p < parts.size(); ++p) AddTriangles(parts[p], p);
    edges_.update_face_normals();
    LockSeams();
  }

  void Collapse(const SimplifyLimits& limits) {
    using OpenMesh::Decimater::DecimaterT;
    using OpenMesh::Decimater::ModHausdorffT;
    using OpenMesh::Decimater::ModNormalDeviationT;
    using OpenMesh::Decimater::ModNormalFlippingT;
    using OpenMesh::Decimater::ModQuadricT;
    DecimaterT<EdgeMesh> decimater(edges_);
    ModQuadricT<EdgeMesh>::Handle quadric;
    ModHausdorffT<EdgeMesh>::Handle hausdorff;
    ModNormalDeviationT<EdgeMesh>::Handle normals;
    ModNormalFlippingT<EdgeMesh>::Handle flipping;
    decimater.add(quadric);
    decimater.add(hausdorff);
    decimater.add(normals);
    decimater.add(flipping);
    decimater.module(quadric).unset_max_err();
    decimater.module(hausdorff).set_tolerance(limits.deviation_m);
    // It compares half of this with the half angle of the cone of all normals.
    decimater.module(normals).set_normal_deviation(limits.normal_deg);
    // A triangle without area has no normal, and ModHausdorffT takes it for near to everything.
    decimater.module(flipping).set_max_normal_deviation(60.0);
    decimater.initialize();
    decimater.decimate();
    edges_.garbage_collection();
  }

  [[nodiscard]] std::vector<Mesh> Parts() const {
    std::vector<MeshGatherer> gatherers(aside_.size());
    for (const auto& face : edges_.faces()) {
      std::array<Eigen::Vector3f, 3> corners;
      std::size_t i = 0;
      for (const auto& vertex : edges_.fv_range(face)) {
        const OpenMesh::Vec3d& point = edges_.point(vertex);
        corners[i++] = Vector3(point[0], point[1], point[2]).cast<float>();
      }
      gatherers[edges_.property(part_of_, face)].Add(corners);
    }
    for (std::size_t p = 0; p < aside_.size(); ++p) {
      for (const Triangle& triangle : aside_[p]) {
        gatherers[p].Add({places_.points()[triangle[0]], places_.points()[triangle[1]],
                          places_.points()[triangle[2]]});
      }
    }
    std::vector<Mesh> parts;
    for (MeshGatherer& gatherer : gatherers) parts.push_back(gatherer.Take());
    return parts;
  }

 private:
  void AddVertices(const std::vector<Mesh>& parts) {
    for (const Mesh& part : parts) {
      for (const Eigen::Vector3f& vertex : part.vertices) (void)places_.Of(vertex);
    }
    for (const Eigen::Vector3f& point : places_.points()) {
      const Vector3 exact = point.cast<double>();
      edges_.add_vertex({exact.x(), exact.y(), exact.z()});
    }
  }

  void AddTriangles(const Mesh& part, std::size_t index) {
    for (const Triangle& corners : part.triangles) {
      Triangle triangle{};
      for (std::size_t i = 0; i < 3; ++i) triangle[i] = places_.Of(part.vertices[corners[i]]);
      const auto vertex = [&](std::size_t i) { return edges_.vertex_handle(triangle[i]); };
      const auto face = edges_.add_face(vertex(0), vertex(1), vertex(2));
      if (face.is_valid()) {
        edges_.property(part_of_, face) = index;
      } else {
        aside_[index].push_back(triangle);
      }
    }
  }

  /// Holds the points at borders, and where parts or what was put aside meet.
  void LockSeams() {
    for (const auto& vertex : edges_.vertices()) {
      std::set<std::size_t> parts;
      for (const auto& face : edges_.vf_range(vertex))
        parts.insert(edges_.property(part_of_, face));
      // ModHausdorffT does not see that a hole or a notch is filled.
      if (parts.size() > 1 || edges_.is_boundary(vertex)) edges_.status(vertex).set_locked(true);
    }
    for (const std::vector<Triangle>& triangles : aside_) {
      for (const Triangle& triangle : triangles) {
        for (const std::uint32_t corner : triangle) {
          edges_.status(edges_.vertex_handle(corner)).set_locked(true);
        }
      }
    }
  }

  Places places_;
  EdgeMesh edges_;
  OpenMesh::FPropHandleT<std::size_t> part_of_;
  std::vector<std::vector<Triangle>> aside_;  ///< By part: what OpenMesh cannot hold.
};

bool IsWithin(const std::vector<Mesh>& made, const std::vector<Mesh>& parts, double limit_m) {
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (parts[p].triangles.empty()) continue;
    if (made[p].triangles.empty()) return false;
    if (!MeshSurface(made[p]).IsWithin(parts[p], limit_m)) return false;
    if (!MeshSurface(parts[p]).IsWithin(made[p], limit_m)) return false;
  }
  return true;
}

}  // namespace

std::vector<Mesh> Simplified(const std::vector<Mesh>& parts, const SimplifyLimits& limits) {
  SimplifyLimits tried = limits;
  // The module looks at points alone, between which the surfaces may be somewhat further apart.
  tried.deviation_m *= 0.7;
  constexpr int kMostTries = 3;
  for (int i = 0; i < kMostTries; ++i) {
    EdgeMeshOfParts edges(parts);
    edges.Collapse(tried);
    std::vector<Mesh> made = edges.Parts();
    if (IsWithin(made, parts, limits.deviation_m)) return made;
    tried.deviation_m /= 2.0;
  }
  return parts;
}

}  // namespace railcast
