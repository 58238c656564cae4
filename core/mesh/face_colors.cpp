#include "core/mesh/face_colors.h"

#include <cstddef>
#include <set>
#include <string>

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

}  // namespace railcast
