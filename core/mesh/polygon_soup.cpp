#include "core/mesh/polygon_soup.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

#include "core/scene/polygon.h"
#include "core/scene/rotation_between.h"

namespace railcast {
namespace {

constexpr std::size_t kMostColors = 32;

std::string NameOfColor(const Rgb8& color) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string name = "#";
  for (const std::uint8_t part : color) {
    name += kDigits[part / 16];
    name += kDigits[part % 16];
  }
  return name;
}

using FaceCorners = std::vector<std::uint32_t>;

/// Newell's normal of a polygon: its mean normal times twice its area.
Vector3 NewellNormal(const std::vector<Vector3>& points, const FaceCorners& face) {
  Vector3 normal = Vector3::Zero();
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    const Vector3& origin = points[face[0]];
    normal += (points[face[i]] - origin).cross(points[face[i + 1]] - origin);
  }
  return normal;
}

/// The outline of a face as seen along a normal.
std::vector<Eigen::Vector2d> Projected(const std::vector<Vector3>& points,
                                       const FaceCorners& face,
                                       const Vector3& normal) {
  const Eigen::Quaterniond plan_from_file = RotationBetween(normal, Vector3::UnitZ());
  std::vector<Eigen::Vector2d> outline;
  for (const std::uint32_t corner : face) {
    const Vector3 offset = plan_from_file * (points[corner] - points[face[0]]);
    outline.emplace_back(offset.head<2>());
  }
  return outline;
}

std::vector<std::array<std::uint32_t, 3>> Fan(std::size_t num_corners) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 1; i + 1 < num_corners; ++i) triangles.push_back({0, i, i + 1});
  return triangles;
}

/// The face's triangles, as indices into `points`. Degenerate triangles are recognised in space
/// rather than in the plane of triangulation: in a face that is not planar, a triangle
/// perpendicular to the mean plane has no area there.
std::vector<std::array<std::uint32_t, 3>> Triangulate(const std::vector<Vector3>& points,
                                                      const FaceCorners& face) {
  if (face.size() == 3) return {{face[0], face[1], face[2]}};
  double extent = 0.0;
  for (const std::uint32_t corner : face) {
    extent = std::max(extent, (points[corner] - points[face[0]]).norm());
  }
  // Project the face along its mean normal. One that goes there and back has none, but is seen.
  const Vector3 normal = NewellNormal(points, face);
  std::vector<std::array<std::uint32_t, 3>> triangles =
      normal.norm() > TwiceFlatArea(extent) ? ClipEars(Projected(points, face, normal))
                                            : Fan(face.size());
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

/// The middle of the bounding box of all corners.
Vector3 MiddleOf(const PolygonSoup& soup) {
  Eigen::AlignedBox3d box;
  for (const PolygonSoup::Face& face : soup.faces) {
    for (const std::uint32_t corner : face.corners) box.extend(soup.points[corner]);
  }
  return box.isEmpty() ? Vector3(Vector3::Zero()) : Vector3(box.center());
}

/// A part of the result with the vertices that its triangles use.
class PartBuilder {
 public:
  explicit PartBuilder(NamedMesh part) : part_(std::move(part)) {}

  void Add(const std::array<std::uint32_t, 3>& triangle) {
    part_.mesh.triangles.push_back(triangle);
  }

  /// @param positions Of the points of the soup.
  [[nodiscard]] NamedMesh Take(const std::vector<Eigen::Vector3f>& positions) {
    std::vector<std::uint32_t> used;
    used.reserve(3 * part_.mesh.triangles.size());
    for (const auto& triangle : part_.mesh.triangles) {
      used.insert(used.end(), triangle.begin(), triangle.end());
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    part_.mesh.vertices.reserve(used.size());
    for (const std::uint32_t point : used) part_.mesh.vertices.push_back(positions[point]);
    for (auto& triangle : part_.mesh.triangles) {
      for (std::uint32_t& corner : triangle) {
        corner = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), corner) -
                                            used.begin());
      }
    }
    return std::move(part_);
  }

 private:
  NamedMesh part_;  // Its corners are points of the soup.
};

/// The parts of a soup, begun in the order of its faces.
class PartBuilders {
 public:
  explicit PartBuilders(const PolygonSoup& soup) : soup_(soup) {}

  PartBuilder& Of(const PolygonSoup::Face& face) {
    const auto [it, is_new] = index_of_.try_emplace({face.material, face.group}, builders_.size());
    if (is_new) {
      const bool has_color = face.material < soup_.luminances.size();
      builders_.emplace_back(
          NamedMesh{.material = Name(soup_.materials, face.material),
                    .group = Name(soup_.groups, face.group),
                    .luminance = has_color ? soup_.luminances[face.material] : std::nullopt,
                    .mesh = {}});
    }
    return builders_[it->second];
  }

  [[nodiscard]] std::vector<NamedMesh> Take(const std::vector<Eigen::Vector3f>& positions) {
    std::vector<NamedMesh> parts;
    for (PartBuilder& builder : builders_) parts.push_back(builder.Take(positions));
    return parts;
  }

 private:
  static std::string Name(const std::vector<std::string>& names, std::uint32_t index) {
    return index == PolygonSoup::kUnnamed ? std::string() : names[index];
  }

  const PolygonSoup& soup_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> index_of_;
  std::vector<PartBuilder> builders_;
};

}  // namespace

void NameMaterialsByColor(const std::vector<Rgb8>& of_points, PolygonSoup& soup) {
  if (of_points.empty()) return;
  const auto is_unnamed = [](const PolygonSoup::Face& face) {
    return face.material == PolygonSoup::kUnnamed;
  };
  std::set<Rgb8> colors;
  for (const PolygonSoup::Face& face : soup.faces) {
    if (is_unnamed(face)) colors.insert(of_points[face.corners.front()]);
    if (colors.size() > kMostColors) return;
  }
  NameIndices materials(soup.materials);
  for (PolygonSoup::Face& face : soup.faces) {
    if (!is_unnamed(face)) continue;
    face.material = materials.Of(NameOfColor(of_points[face.corners.front()]));
  }
}

void PolygonSoup::AddFace(std::vector<std::uint32_t> corners,
                          std::uint32_t material,
                          std::uint32_t group) {
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  while (corners.size() > 1 && corners.back() == corners.front()) corners.pop_back();
  if (corners.size() < 3) {
    ++num_cornerless;
    return;
  }
  faces.push_back({.corners = std::move(corners), .material = material, .group = group});
}

std::uint32_t NameIndices::Of(const std::string& name) {
  if (name.empty()) return PolygonSoup::kUnnamed;
  const auto [it, is_new] = indices_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
  if (is_new) names_.push_back(name);
  return it->second;
}

std::size_t ImportedMesh::num_triangles() const {
  return std::accumulate(
      parts.begin(), parts.end(), std::size_t{0},
      [](std::size_t sum, const NamedMesh& part) { return sum + part.mesh.triangles.size(); });
}

ImportedMesh MakeTriangles(const PolygonSoup& soup, double unit_m, bool y_up) {
  const Vector3 middle = MiddleOf(soup);
  const auto z_up_m = [&](const Vector3& p) {
    return Vector3(unit_m * (y_up ? Vector3(p.x(), -p.z(), p.y()) : p));
  };
  // Far from the origin, float32 would move vertices: at the northings of Europe by up to 0.25 m.
  std::vector<Eigen::Vector3f> positions;
  positions.reserve(soup.points.size());
  for (const Vector3& p : soup.points) positions.emplace_back(z_up_m(p - middle).cast<float>());

  ImportedMesh result{.parts = {},
                      .origin_m = z_up_m(middle),
                      .num_faces = soup.faces.size(),
                      .num_cornerless = soup.num_cornerless,
                      .remarks = soup.remarks};
  PartBuilders builders(soup);
  for (const PolygonSoup::Face& face : soup.faces) {
    const auto triangles = Triangulate(soup.points, face.corners);
    result.num_flat += face.corners.size() - 2 - triangles.size();
    for (const auto& triangle : triangles) {
      const Vector3 a = positions[triangle[0]].cast<double>();
      const Vector3 b = positions[triangle[1]].cast<double>();
      const Vector3 c = positions[triangle[2]].cast<double>();
      const Vector3 twice_area_m2 = (b - a).cross(c - a);
      if (twice_area_m2.isZero(0.0)) {
        ++result.num_flat;
        continue;
      }
      result.area_m2 += 0.5 * twice_area_m2.norm();
      builders.Of(face).Add(triangle);
    }
  }
  result.parts = builders.Take(positions);
  return result;
}

}  // namespace railcast
