#include "core/mesh/simplify.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalDeviationT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/mesh/mesh_deviation.h"
#include "railcast/frame.h"

namespace railcast {
namespace {

struct ExactTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using EdgeMesh = OpenMesh::TriMesh_ArrayKernelT<ExactTraits>;

/// Lets a point at a border go only if it lies on the straight line between its neighbours there:
/// the other rules do not see that a hole or a notch is filled.
template <class MeshT>
class StraightBordersT : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  // NOLINTNEXTLINE(modernize-use-using): OpenMesh's macro names the types that it asks for
  DECIMATING_MODULE(StraightBordersT, MeshT, StraightBorders);

  explicit StraightBordersT(MeshT& mesh) : Base(mesh, true) {}
  void set_tolerance(double tolerance_m) { tolerance_m_ = tolerance_m; }

  float collapse_priority(const CollapseInfo& collapse) override {
    const MeshT& mesh = Base::mesh();
    if (!mesh.is_boundary(collapse.v0)) return Base::LEGAL_COLLAPSE;
    if (!mesh.is_manifold(collapse.v0)) return Base::ILLEGAL_COLLAPSE;
    const auto outgoing = mesh.halfedge_handle(collapse.v0);  // Along the border.
    const auto next = mesh.to_vertex_handle(outgoing);
    const auto other =
        next == collapse.v1 ? mesh.from_vertex_handle(mesh.prev_halfedge_handle(outgoing)) : next;
    const OpenMesh::Vec3d line = mesh.point(other) - collapse.p1;
    const OpenMesh::Vec3d offset = collapse.p0 - collapse.p1;
    const double along = (line | offset) / line.sqrnorm();
    const bool is_straight =
        along > 0.0 && along < 1.0 && (offset - along * line).norm() <= tolerance_m_;
    return is_straight ? Base::LEGAL_COLLAPSE : Base::ILLEGAL_COLLAPSE;
  }

 private:
  double tolerance_m_ = 0.0;
};

/// Adds up how far the surface moves wherever a point goes, and lets none go where the sum would be
/// more than the tolerance. A look at all points that are gone, as
/// ModHausdorffT takes, would make the time grow with the square of how many there are.
template <class MeshT>
class NearbyT : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  // NOLINTNEXTLINE(modernize-use-using): OpenMesh's macro names the types that it asks for
  DECIMATING_MODULE(NearbyT, MeshT, Nearby);

  explicit NearbyT(MeshT& mesh) : Base(mesh, true) { Base::mesh().add_property(sum_m_); }
  ~NearbyT() override { Base::mesh().remove_property(sum_m_); }
  NearbyT(const NearbyT&) = delete;
  NearbyT& operator=(const NearbyT&) = delete;
  void set_tolerance(double tolerance_m) { tolerance_m_ = tolerance_m; }

  void initialize() override {
    for (const auto& vertex : Base::mesh().vertices()) Base::mesh().property(sum_m_, vertex) = 0.0;
  }

  float collapse_priority(const CollapseInfo& collapse) override {
    // A point with many edges is slow to look at.
    constexpr unsigned kMostEdges = 48;
    const MeshT& mesh = Base::mesh();
    if (mesh.valence(collapse.v0) + mesh.valence(collapse.v1) > kMostEdges) {
      return Base::ILLEGAL_COLLAPSE;
    }
    return SumAfter_m(collapse) <= tolerance_m_ ? Base::LEGAL_COLLAPSE : Base::ILLEGAL_COLLAPSE;
  }

  void preprocess_collapse(const CollapseInfo& collapse) override {
    double& sum_m = Base::mesh().property(sum_m_, collapse.v1);
    sum_m = std::max(sum_m, SumAfter_m(collapse));
  }

 private:
  using Fan = std::vector<TriangleInSpace>;

  /// The squared distance of a point to the nearest triangle of a fan.
  static double SquaredToFan_m2(const Vector3& point, const Fan& fan) {
    double least_m2 = std::numeric_limits<double>::infinity();
    for (const TriangleInSpace& triangle : fan) {
      least_m2 = std::min(least_m2, SquaredDistance_m2(point, triangle));
    }
    return least_m2;
  }

  /// Compares the faces about the point that goes with those that stand for them, at the point and
  /// at the middles of the edges that end or begin to exist.
  [[nodiscard]] double SumAfter_m(const CollapseInfo& collapse) {
    const MeshT& mesh = Base::mesh();
    const auto in_space = [](const OpenMesh::Vec3d& p) { return Vector3(p[0], p[1], p[2]); };
    const Vector3 gone = in_space(collapse.p0);
    const Vector3 left = in_space(collapse.p1);
    old_.clear();
    new_.clear();
    for (const auto& face : mesh.vf_range(collapse.v0)) {
      TriangleInSpace before;
      TriangleInSpace after;
      std::size_t i = 0;
      for (const auto& vertex : mesh.fv_range(face)) {
        before[i] = in_space(mesh.point(vertex));
        after[i] = vertex == collapse.v0 ? left : before[i];
        ++i;
      }
      old_.push_back(before);
      if (face != collapse.fl && face != collapse.fr) new_.push_back(after);
    }
    double most_m2 = SquaredToFan_m2(gone, new_);
    for (const auto& vertex : mesh.vv_range(collapse.v0)) {
      if (vertex == collapse.v1) continue;
      const Vector3 around = in_space(mesh.point(vertex));
      most_m2 = std::max({most_m2, SquaredToFan_m2(0.5 * (gone + around), new_),
                          SquaredToFan_m2(0.5 * (left + around), old_)});
    }
    return mesh.property(sum_m_, collapse.v0) + std::sqrt(most_m2);
  }

  Fan old_;  // Kept for their memory.
  Fan new_;
  OpenMesh::VPropHandleT<double> sum_m_;
  double tolerance_m_ = 0.0;
};

/// A mesh of OpenMesh, and the triangles that it cannot hold.
class CollapsingMesh {
 public:
  CollapsingMesh(const Mesh& mesh, const std::vector<bool>& is_held) {
    // What OpenMesh cannot hold it would print. No two threads may make the first call at once.
    [[maybe_unused]] static const bool is_silent = (omerr().disable(), true);
    edges_.request_vertex_status();
    edges_.request_edge_status();
    edges_.request_halfedge_status();
    edges_.request_face_status();
    edges_.request_face_normals();
    for (const Eigen::Vector3f& point : mesh.vertices) {
      const Vector3 exact = point.cast<double>();
      edges_.add_vertex({exact.x(), exact.y(), exact.z()});
    }
    for (std::size_t v = 0; v < is_held.size(); ++v) {
      if (is_held[v]) Hold(static_cast<std::uint32_t>(v));
    }
    for (const auto& triangle : mesh.triangles) {
      const auto corner = [&](std::size_t i) { return edges_.vertex_handle(triangle[i]); };
      if (edges_.add_face(corner(0), corner(1), corner(2)).is_valid()) continue;
      for (const std::uint32_t vertex : triangle) Hold(vertex);
      aside_.push_back(
          {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]});
    }
    edges_.update_face_normals();
  }

  void Collapse(const SimplifyLimits& limits) {
    using OpenMesh::Decimater::ModNormalDeviationT;
    using OpenMesh::Decimater::ModNormalFlippingT;
    using OpenMesh::Decimater::ModQuadricT;
    OpenMesh::Decimater::DecimaterT<EdgeMesh> decimater(edges_);
    ModQuadricT<EdgeMesh>::Handle quadric;
    StraightBordersT<EdgeMesh>::Handle borders;
    ModNormalFlippingT<EdgeMesh>::Handle flipping;
    ModNormalDeviationT<EdgeMesh>::Handle normals;
    NearbyT<EdgeMesh>::Handle nearby;
    decimater.add(quadric);
    // The cheapest is asked first.
    decimater.add(borders);
    decimater.add(flipping);
    decimater.add(normals);
    decimater.add(nearby);
    decimater.module(quadric).unset_max_err();
    decimater.module(borders).set_tolerance(1e-3 * limits.deviation_m);
    // A triangle without area has no normal.
    decimater.module(flipping).set_max_normal_deviation(60.0);
    // It compares half of this with the half angle of the cone of all normals.
    decimater.module(normals).set_normal_deviation(limits.normal_deg);
    decimater.module(nearby).set_tolerance(limits.deviation_m);
    decimater.initialize();
    decimater.decimate();
    edges_.garbage_collection();
  }

  [[nodiscard]] Mesh Take() const {
    constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
    Mesh mesh;
    std::vector<std::uint32_t> number_of(edges_.n_vertices(), kUnused);
    for (const auto& face : edges_.faces()) {
      std::array<std::uint32_t, 3> triangle{};
      std::size_t i = 0;
      for (const auto& vertex : edges_.fv_range(face)) {
        std::uint32_t& number = number_of[static_cast<std::size_t>(vertex.idx())];
        if (number == kUnused) {
          number = static_cast<std::uint32_t>(mesh.vertices.size());
          const OpenMesh::Vec3d& point = edges_.point(vertex);
          mesh.vertices.emplace_back(Vector3(point[0], point[1], point[2]).cast<float>());
        }
        triangle[i++] = number;
      }
      mesh.triangles.push_back(triangle);
    }
    for (const std::array<Eigen::Vector3f, 3>& corners : aside_) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
  }

 private:
  void Hold(std::uint32_t vertex) { edges_.status(edges_.vertex_handle(vertex)).set_locked(true); }

  EdgeMesh edges_;
  std::vector<std::array<Eigen::Vector3f, 3>> aside_;
};

}  // namespace

Mesh CollapseEdges(const Mesh& mesh,
                   const std::vector<bool>& is_held,
                   const SimplifyLimits& limits) {
  CollapsingMesh edges(mesh, is_held);
  edges.Collapse(limits);
  return edges.Take();
}

}  // namespace railcast
