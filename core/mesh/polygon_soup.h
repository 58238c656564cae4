#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "railcast/remark.h"
#include "railcast/scene.h"

namespace railcast {

/// What a mesh file holds, in the file's own units and axes: polygons that need not be manifold,
/// closed, planar or convex. A face with a hole is an outline that goes to the hole and back along
/// the same edge, and names some points twice.
struct PolygonSoup {
  static constexpr std::uint32_t kUnnamed = 0xFFFFFFFF;

  struct Face {
    std::vector<std::uint32_t> corners;  ///< Indices into `points`, at least three.
    std::uint32_t material = kUnnamed;   ///< Index into `materials`.
    std::uint32_t group = kUnnamed;      ///< Index into `groups`.
  };

  std::vector<Vector3> points;
  std::vector<Face> faces;
  /// Their names in the file, each once, unless several of one name have different colours.
  std::vector<std::string> materials;
  /// Luminances of their base colours, 1 = white, if known; may be fewer.
  std::vector<std::optional<double>> luminances;
  std::vector<std::string> groups;  ///< Names of groups or objects, each once.
  std::size_t num_cornerless{};     ///< Faces that AddFace() left out.
  std::vector<Remark> remarks;      ///< Without a place, which is the file.

  /// Adds a face without corners equal to the one before, unless fewer than three are left.
  void AddFace(std::vector<std::uint32_t> corners,
               std::uint32_t material = kUnnamed,
               std::uint32_t group = kUnnamed);
};

/// Finds the places of names in a list of PolygonSoup, which must outlive it.
class NameIndices {
 public:
  explicit NameIndices(std::vector<std::string>& names) : names_(names) {}

  /// The index of a name, which is added if it is new; kUnnamed if it is empty.
  [[nodiscard]] std::uint32_t Of(const std::string& name);

 private:
  std::vector<std::string>& names_;
  std::unordered_map<std::string, std::uint32_t> indices_;
};

/// Red, green and blue.
using Rgb8 = std::array<std::uint8_t, 3>;

/// The luminance of a linear colour as sRGB (IEC 61966-2-1) has it: 1 = white.
[[nodiscard]] constexpr double LuminanceOf(double red, double green, double blue) {
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

/// Gives each face without a material's name that of its first corner's colour, like "#a0522d". If
/// there are more than 32 such colours, the mesh is a photograph rather than painted, and nothing
/// is changed.
/// @param of_points A colour for each of the soup's points; may be empty.
void NameMaterialsByColor(const std::vector<Rgb8>& of_points, PolygonSoup& soup);

/// Triangles whose faces have the same names in their file.
struct NamedMesh {
  std::string material;               ///< Empty = none.
  std::string group;                  ///< Empty = none.
  std::optional<double> luminance{};  ///< Luminance of the material's base colour; 1 = white.
  Mesh mesh;                          ///< m, z up, relative to ImportedMesh::origin_m.
};

/// A mesh file as triangles in metres, z up.
struct ImportedMesh {
  std::vector<NamedMesh> parts;  ///< In the order in which the file names them; none is empty.
  Vector3 origin_m;         ///< The middle of the file's bounding box, in the file's frame; or 0.
  std::size_t num_faces{};  ///< Faces in the file with three different corners or more.
  std::size_t num_cornerless{};  ///< Faces left out because they have fewer.
  std::size_t num_flat{};        ///< Triangles left out because they have no area in float32.
  double area_m2{};              ///< Area of all triangles.
  bool has_own_up{};             ///< Whether the file's format says which axis is up.
  std::vector<Remark> remarks;   ///< Remarks of its reader; their place is the file.

  [[nodiscard]] std::size_t num_triangles() const;
};

/// Cuts all faces into triangles. Every face keeps its area. Lengths are multiplied by `unit_m`; if
/// `y_up`, y becomes z and z becomes -y. Vertices are centred in double precision before they are
/// rounded to float32, so that a mesh in map coordinates is as exact as one about its origin.
/// Triangles without area in float32 and unused points are left out. The vertices of a part are in
/// the order of the file.
[[nodiscard]] ImportedMesh MakeTriangles(const PolygonSoup& soup, double unit_m, bool y_up);

}  // namespace railcast
