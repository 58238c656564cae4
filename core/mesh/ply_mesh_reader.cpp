#include "core/mesh/mesh_readers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/base/error.h"
#include "core/base/ply.h"
#include "core/base/text.h"
#include "core/mesh/polygon_soup.h"

namespace railcast {
namespace {

/// What a PLY file holds, and the colours of its points; these are empty if it has none.
struct PlySoup {
  PolygonSoup soup;
  std::vector<Rgb8> colors;
};

void RefuseSplats(const PlyWalk& ply) {
  for (const PlyElement& element : ply.elements()) {
    if (std::ranges::count(element.properties, "f_dc_0", &PlyProperty::name) == 0) continue;
    ply.Fail(
        "holds Gaussian splats, which are no surface: make a mesh of them first (got the "
        "property f_dc_0)");
  }
}

/// Which of three names each property has, 0 to 2; 3 if it is a list or has another.
std::vector<std::size_t> PlacesAmong(const std::array<std::string_view, 3>& names,
                                     const PlyElement& element) {
  std::vector<std::size_t> places;
  for (const PlyProperty& property : element.properties) {
    const auto* const it = std::ranges::find(names, property.name);
    places.push_back(property.length ? names.size() : static_cast<std::size_t>(it - names.begin()));
  }
  return places;
}

/// A part of a colour that is given in bytes or, as a fraction, from 0 to 1.
std::uint8_t ColorByteOf(double value, NumberType type) {
  const bool is_fraction = type == NumberType::kFloat || type == NumberType::kDouble;
  const double byte = is_fraction ? std::round(255.0 * value) : value;
  return byte >= 0.0 && byte <= 255.0 ? static_cast<std::uint8_t>(byte) : std::uint8_t{0};
}

void ReadPlyVertices(const PlyElement& element, double largest, PlyWalk& ply, PlySoup& read) {
  const auto axes = PlacesAmong({"x", "y", "z"}, element);
  const auto parts = PlacesAmong({"red", "green", "blue"}, element);
  const auto has = [](const std::vector<std::size_t>& places, std::size_t place) {
    return std::ranges::find(places, place) != places.end();
  };
  std::vector<Rgb8>& colors = read.colors;
  if (std::ranges::count_if(parts, [](std::size_t part) { return part < 3; }) == 3) {
    colors.resize(element.count);
  }
  read.soup.points.reserve(element.count);
  std::uint32_t vertex = 0;
  Vector3 point = Vector3::Zero();
  const auto take = [&](std::size_t property, double value, std::size_t /*length*/) {
    if (parts[property] < 3 && !colors.empty()) {
      colors[vertex][parts[property]] = ColorByteOf(value, element.properties[property].type);
    }
    if (axes[property] == 3) return;
    if (!(std::abs(value) <= largest)) {
      ply.Fail("vertex " + NumberText(vertex) + " must have three finite coordinates" + Got(value));
    }
    point[static_cast<Eigen::Index>(axes[property])] = value;
  };
  ply.Read(element, take, [&] {
    read.soup.points.push_back(std::exchange(point, Vector3::Zero()));
    ++vertex;
  });
  if (element.count > 0 && !(has(axes, 0) && has(axes, 1) && has(axes, 2))) {
    ply.Fail("element vertex: must have the properties x, y and z");
  }
}

[[noreturn]] void FailPlyCorner(const PlyWalk& ply,
                                const PolygonSoup& soup,
                                std::size_t face,
                                double corner) {
  ply.Fail("face " + NumberText(face) + " must name one of the " + NumberText(soup.points.size()) +
           " vertices, counted from 0" + Got(corner));
}

enum class FaceUse { kNone, kCorners, kMaterial };

FaceUse UseOfProperty(const PlyProperty& property, const PolygonSoup& soup) {
  if (property.name == "vertex_indices" || property.name == "vertex_index") {
    return FaceUse::kCorners;
  }
  const bool is_material = property.name == "material_index" && !property.length;
  return is_material && !soup.materials.empty() ? FaceUse::kMaterial : FaceUse::kNone;
}

void ReadPlyFaces(const PlyElement& element, PlyWalk& ply, PolygonSoup& soup) {
  std::vector<FaceUse> uses;
  for (const PlyProperty& property : element.properties) {
    uses.push_back(UseOfProperty(property, soup));
  }
  const bool has_corners = std::ranges::find(uses, FaceUse::kCorners) != uses.end();
  const auto is_below = [](double value, double end) {
    return value >= 0.0 && value < end && value == std::floor(value);
  };
  std::uint32_t face = 0;
  std::vector<std::uint32_t> corners;
  std::uint32_t material = PolygonSoup::kUnnamed;
  const auto take = [&](std::size_t property, double value, std::size_t length) {
    if (uses[property] == FaceUse::kCorners) {
      constexpr double kMaxIndex = 4294967295.0;
      if (!is_below(value, kMaxIndex)) FailPlyCorner(ply, soup, face, value);
      if (corners.empty()) corners.reserve(length);
      corners.push_back(static_cast<std::uint32_t>(value));
    } else if (uses[property] == FaceUse::kMaterial) {
      if (!is_below(value, static_cast<double>(soup.materials.size()))) {
        ply.Fail("face " + NumberText(face) + " must name one of the " +
                 NumberText(soup.materials.size()) + " materials, counted from 0" + Got(value));
      }
      material = static_cast<std::uint32_t>(value);
    }
  };
  ply.Read(element, take, [&] {
    if (has_corners) soup.AddFace(std::exchange(corners, {}), material);
    material = PolygonSoup::kUnnamed;
    ++face;
  });
}

void ReadMeshElement(const PlyElement& element, double largest, PlyWalk& ply, PlySoup& read) {
  const bool is_vertex = element.name == "vertex";
  const bool is_face = element.name == "face";
  if (element.properties.empty()) {
    // Others have no bytes, and need not have lines.
    if ((!is_vertex && !is_face) || element.count == 0) return;
    ply.Fail("element " + ShownText(element.name) + ": has no property");
  }
  // Each one has at least a byte: a count beyond that would only fill the memory.
  if (element.count > ply.rest().size()) ply.FailShort(element);
  if (is_vertex) return ReadPlyVertices(element, largest, ply, read);
  if (is_face) return ReadPlyFaces(element, ply, read.soup);
  ply.Read(
      element, [](std::size_t, double, std::size_t) {}, [] {});
}

}  // namespace

PolygonSoup ReadPlyMesh(const std::string& shown, std::string_view bytes, double largest) {
  PlySoup read;
  PolygonSoup& soup = read.soup;
  PlyWalk ply(shown, bytes, [&](std::string_view line) {
    const auto words = Words(line);
    if (words.size() == 3 && words[0] == "comment" && words[1] == "material") {
      soup.materials.emplace_back(words[2]);
    }
  });
  RefuseSplats(ply);
  if (std::ranges::count(ply.elements(), "vertex", &PlyElement::name) > 1) {
    ply.Fail("element vertex: must come once");
  }
  for (const PlyElement& element : ply.elements()) ReadMeshElement(element, largest, ply, read);
  for (std::size_t i = 0; i < soup.faces.size(); ++i) {
    for (const std::uint32_t corner : soup.faces[i].corners) {
      if (corner >= soup.points.size()) FailPlyCorner(ply, soup, i, corner);
    }
  }
  const bool is_blank = ply.rest().find_first_not_of(" \t\r\n") == std::string_view::npos;
  if (ply.encoding() != PlyEncoding::kAscii || !is_blank) {
    AddRemark({RemarkKind::kSurplusBytes, {}, ply.rest().size()}, soup.remarks);
  }
  NameMaterialsByColor(read.colors, soup);
  return std::move(soup);
}

ImportedMesh ReadShippedPly(std::string_view bytes) {
  constexpr std::string_view kMaterial = "comment material ";
  constexpr std::size_t kVertexBytes = 3 * sizeof(float);
  constexpr std::size_t kFaceBytes = 8;
  std::string_view rest = bytes;
  const auto take = [&](std::string_view beginning) {
    const auto line = TakeLine(rest);
    Check(line && line->starts_with(beginning), "a shipped mesh has the header of all of them");
    return line->substr(beginning.size());
  };
  take("ply");
  take("format binary_little_endian 1.0");
  ImportedMesh mesh;
  while (rest.starts_with(kMaterial)) {
    mesh.parts.push_back(
        {.material = std::string(take(kMaterial)), .group = {}, .luminance = {}, .mesh = {}});
  }
  const auto num_vertices = ParseNumber<std::uint32_t>(take("element vertex ")).value_or(0);
  for (const char* axis : {"x", "y", "z"}) take("property float " + std::string(axis));
  const auto num_faces = ParseNumber<std::uint32_t>(take("element face ")).value_or(0);
  take("property list uchar ushort vertex_indices");
  take("property uchar material_index");
  take("end_header");
  Check(rest.size() == num_vertices * kVertexBytes + num_faces * kFaceBytes,
        "a shipped mesh has as many bytes as its header says");
  std::vector<Eigen::Vector3f> vertices(num_vertices);
  std::memcpy(static_cast<void*>(vertices.data()), rest.data(), num_vertices * kVertexBytes);
  const char* face = rest.data() + num_vertices * kVertexBytes;
  std::vector<std::uint32_t> ends(mesh.parts.size(), 0);  // Ends of the parts' vertices.
  mesh.num_faces = num_faces;
  for (std::uint32_t i = 0; i < num_faces; ++i, face += kFaceBytes) {
    std::array<std::uint16_t, 3> corners{};
    std::memcpy(corners.data(), face + 1, sizeof corners);
    const auto part = static_cast<std::uint8_t>(face[7]);
    mesh.parts.at(part).mesh.triangles.push_back({corners[0], corners[1], corners[2]});
    ends[part] = std::max({ends[part], corners[0] + 1U, corners[1] + 1U, corners[2] + 1U});
    const Eigen::Vector3f& first = vertices.at(corners[0]);
    mesh.area_m2 +=
        0.5 * static_cast<double>(
                  (vertices.at(corners[1]) - first).cross(vertices.at(corners[2]) - first).norm());
  }
  std::uint32_t begin = 0;
  for (std::size_t part = 0; part < ends.size(); ++part) {
    Mesh& own = mesh.parts[part].mesh;
    own.vertices.assign(vertices.begin() + begin, vertices.begin() + ends[part]);
    for (auto& triangle : own.triangles) {
      for (std::uint32_t& corner : triangle) corner -= begin;
    }
    begin = ends[part];
  }
  mesh.origin_m = Vector3::Zero();
  return mesh;
}

}  // namespace railcast
