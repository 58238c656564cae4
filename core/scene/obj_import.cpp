#include "core/scene/obj_import.h"

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/IO/reader/OBJReader.hh>
#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/scene/obj_sieve.h"
#include "core/scene/polygon.h"

namespace railcast {
namespace {

/// Collects the vertices and faces that OpenMesh reads, without requiring a manifold, and ignores
/// everything else.
class SoupImporter final : public OpenMesh::IO::BaseImporter {
 public:
  using VertexHandle = OpenMesh::VertexHandle;
  using FaceHandle = OpenMesh::FaceHandle;
  using HalfedgeHandle = OpenMesh::HalfedgeHandle;
  using EdgeHandle = OpenMesh::EdgeHandle;

  VertexHandle add_vertex(const OpenMesh::Vec3f& point) override {
    return add_vertex(OpenMesh::Vec3d(point));
  }
  VertexHandle add_vertex(const OpenMesh::Vec3d& point) override {
    points_.emplace_back(point[0], point[1], point[2]);
    return VertexHandle(static_cast<int>(points_.size()) - 1);
  }
  FaceHandle add_face(const VHandles& corners) override {
    faces_.emplace_back();
    for (const VertexHandle corner : corners) {
      Check(corner.is_valid() && static_cast<std::size_t>(corner.idx()) < points_.size(),
            "a corner is one of the vertices that were read");
      faces_.back().push_back(static_cast<std::uint32_t>(corner.idx()));
    }
    return FaceHandle(static_cast<int>(faces_.size()) - 1);
  }
  size_t n_vertices() const override { return points_.size(); }
  size_t n_faces() const override { return faces_.size(); }
  size_t n_edges() const override { return 0; }

  const std::vector<Vector3>& points() const { return points_; }
  const std::vector<std::vector<std::uint32_t>>& faces() const { return faces_; }

  VertexHandle add_vertex() override { return VertexHandle(); }
  HalfedgeHandle add_edge(VertexHandle, VertexHandle) override { return HalfedgeHandle(); }
  FaceHandle add_face(HalfedgeHandle) override { return FaceHandle(); }
  void add_face_texcoords(FaceHandle, VertexHandle, const std::vector<OpenMesh::Vec2f>&) override {}
  void add_face_texcoords(FaceHandle, VertexHandle, const std::vector<OpenMesh::Vec3f>&) override {}
  void set_face_texindex(FaceHandle, int) override {}
  void set_point(VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_halfedge(VertexHandle, HalfedgeHandle) override {}
  void set_normal(VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_normal(VertexHandle, const OpenMesh::Vec3d&) override {}
  void set_color(VertexHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(VertexHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_color(VertexHandle, const OpenMesh::Vec4f&) override {}
  void set_texcoord(VertexHandle, const OpenMesh::Vec2f&) override {}
  void set_status(VertexHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_next(HalfedgeHandle, HalfedgeHandle) override {}
  void set_face(HalfedgeHandle, FaceHandle) override {}
  void request_face_texcoords2D() override {}
  void set_texcoord(HalfedgeHandle, const OpenMesh::Vec2f&) override {}
  void set_texcoord(VertexHandle, const OpenMesh::Vec3f&) override {}
  void set_texcoord(HalfedgeHandle, const OpenMesh::Vec3f&) override {}
  void set_status(HalfedgeHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_color(EdgeHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(EdgeHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(EdgeHandle, const OpenMesh::Vec3f&) override {}
  void set_color(EdgeHandle, const OpenMesh::Vec4f&) override {}
  void set_status(EdgeHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void set_normal(FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_normal(FaceHandle, const OpenMesh::Vec3d&) override {}
  void set_color(FaceHandle, const OpenMesh::Vec3uc&) override {}
  void set_color(FaceHandle, const OpenMesh::Vec4uc&) override {}
  void set_color(FaceHandle, const OpenMesh::Vec3f&) override {}
  void set_color(FaceHandle, const OpenMesh::Vec4f&) override {}
  void set_status(FaceHandle, const OpenMesh::Attributes::StatusInfo&) override {}
  void add_texture_information(int, std::string) override {}

 private:
  std::vector<Vector3> points_;
  std::vector<std::vector<std::uint32_t>> faces_;
};

/// Newell's normal of a polygon: its mean normal times twice its area.
Vector3 NewellNormal(const std::vector<Vector3>& points, const std::vector<std::uint32_t>& face) {
  Vector3 normal = Vector3::Zero();
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    const Vector3& origin = points[face[0]];
    normal += (points[face[i]] - origin).cross(points[face[i + 1]] - origin);
  }
  return normal;
}

/// The face's triangles, as indices into `points`. Degenerate triangles are recognised in space
/// rather than in the plane of triangulation: in a face that is not planar, a triangle
/// perpendicular to the mean plane has no area there.
std::vector<std::array<std::uint32_t, 3>> Triangulate(const std::vector<Vector3>& points,
                                                      const std::vector<std::uint32_t>& face) {
  if (face.size() == 3) return {{face[0], face[1], face[2]}};
  // Project the face along its mean normal.
  const Vector3 normal = NewellNormal(points, face);
  const Eigen::Quaterniond plan_from_file =
      Eigen::Quaterniond::FromTwoVectors(normal, Vector3::UnitZ());
  std::vector<Eigen::Vector2d> outline;
  double extent = 0.0;
  for (const std::uint32_t corner : face) {
    const Vector3 offset = plan_from_file * (points[corner] - points[face[0]]);
    outline.emplace_back(offset.head<2>());
    extent = std::max(extent, offset.norm());
  }
  std::vector<std::array<std::uint32_t, 3>> triangles = ClipEars(outline);
  for (auto& triangle : triangles) {
    for (std::uint32_t& corner : triangle) corner = face[corner];
  }
  std::erase_if(triangles, [&](const auto& triangle) {
    const Vector3& a = points[triangle[0]];
    const Vector3& b = points[triangle[1]];
    const Vector3& c = points[triangle[2]];
    return (b - a).cross(c - a).norm() <= TwiceFlatArea(extent);
  });
  return triangles;
}

/// Builds the triangle soup, without triangles that have no area in float32.
Mesh MakeSoup(const SoupImporter& soup, double unit_m, bool y_up) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<Eigen::Vector3f> positions;
  positions.reserve(soup.points().size());
  for (const Vector3& p : soup.points()) {
    const Vector3 z_up = y_up ? Vector3(p.x(), -p.z(), p.y()) : p;
    positions.emplace_back((unit_m * z_up).cast<float>());
  }
  Mesh mesh;
  std::vector<std::uint32_t> new_index(positions.size(), kUnused);
  for (const auto& face : soup.faces()) {
    for (auto triangle : Triangulate(soup.points(), face)) {
      const Vector3 a = positions[triangle[0]].cast<double>();
      const Vector3 b = positions[triangle[1]].cast<double>();
      const Vector3 c = positions[triangle[2]].cast<double>();
      if ((b - a).cross(c - a).isZero(0.0)) continue;
      for (std::uint32_t& corner : triangle) {
        std::uint32_t& index = new_index[corner];
        if (index == kUnused) {
          index = static_cast<std::uint32_t>(mesh.vertices.size());
          mesh.vertices.push_back(positions[corner]);
        }
        corner = index;
      }
      mesh.triangles.push_back(triangle);
    }
  }
  return mesh;
}

}  // namespace

Mesh ParseObj(std::istream& in, const std::string& shown, double unit_m, bool y_up) {
  constexpr auto kLargest = static_cast<double>(std::numeric_limits<float>::max());
  ObjSieve sieve(shown, kLargest / std::max(1.0, unit_m));
  std::istringstream sifted(sieve.Sift(in));
  SoupImporter soup;
  OpenMesh::IO::Options options;
  const bool read = OpenMesh::IO::OBJReader().read(sifted, soup, options);
  Check(read, "OpenMesh reads what was sifted");
  Check(soup.n_vertices() == sieve.num_vertices(), "OpenMesh reads every vertex");
  Check(soup.n_faces() == sieve.num_faces(), "OpenMesh reads every face");
  Mesh mesh = MakeSoup(soup, unit_m, y_up);
  if (mesh.triangles.empty()) throw InputError(shown + ": holds no triangle");
  return mesh;
}

Mesh ReadObj(const std::filesystem::path& file, double unit_m, bool y_up) {
  std::ifstream in = OpenInput(file);
  return ParseObj(in, ShownPath(file), unit_m, y_up);
}

}  // namespace railcast
