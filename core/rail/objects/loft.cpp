#include "core/rail/objects/loft.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <tuple>

#include "core/base/error.h"
#include "core/rail/base/rail_surfaces.h"

namespace railcast {
namespace {

bool IsPoint(const LoftSection& section) {
  return section.half_width_m == 0.0;
}

LoftSection Interpolated(const LoftSection& a, const LoftSection& b, double z_m) {
  const double t = (z_m - a.z_m) / (b.z_m - a.z_m);
  const auto mix = [&](double of_a, double of_b) { return (1.0 - t) * of_a + t * of_b; };
  return {.z_m = z_m,
          .front_m = mix(a.front_m, b.front_m),
          .back_m = mix(a.back_m, b.back_m),
          .half_width_m = mix(a.half_width_m, b.half_width_m),
          .x_m = mix(a.x_m, b.x_m),
          .exponent = mix(a.exponent, b.exponent)};
}

/// The point of a section at one of its `num_sides` corners, counted to the left from the front.
Vector3 CornerOf(const LoftSection& section, int corner, int num_sides) {
  const double angle_rad = 2.0 * std::numbers::pi * corner / num_sides;
  const double power = 2.0 / section.exponent;
  const auto shaped = [&](double value) {
    // Rounding must not move the corners on the axes, as a power near 1 of 1e-17 would.
    return std::abs(value) < 1e-9 ? 0.0 : std::copysign(std::pow(std::abs(value), power), value);
  };
  const double x = shaped(std::cos(angle_rad));
  const double depth_m = x > 0.0 ? section.front_m : section.back_m;
  return {section.x_m + depth_m * x, section.half_width_m * shaped(std::sin(angle_rad)),
          section.z_m};
}

/// Collects triangles by surface and gives each surface its own vertices.
class SurfaceCollector {
 public:
  explicit SurfaceCollector(Model& model) : model_(model) {}

  void Add(const SurfaceClass& surface, const std::array<Vector3, 3>& corners_m) {
    Mesh& mesh = MeshOf(surface, model_);
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3f vertex = corners_m[i].cast<float>();
      const auto [found, is_new] = indices_.try_emplace(
          {surface.material, surface.label, vertex.x(), vertex.y(), vertex.z()},
          static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(vertex);
      triangle[i] = found->second;
    }
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
      return;
    }
    mesh.triangles.push_back(triangle);
  }

 private:
  Model& model_;
  std::map<std::tuple<std::uint16_t, std::uint32_t, float, float, float>, std::uint32_t> indices_;
};

}  // namespace

std::vector<LoftSection> Stretched(std::span<const LoftSection> sections, const Vector3& scale) {
  std::vector<LoftSection> stretched(sections.begin(), sections.end());
  for (LoftSection& section : stretched) {
    section.z_m *= scale.z();
    section.x_m *= scale.x();
    section.front_m *= scale.x();
    section.back_m *= scale.x();
    section.half_width_m *= scale.y();
  }
  return stretched;
}

std::vector<LoftSection> WithSectionAt(double z_m, std::vector<LoftSection> sections) {
  const auto above = std::find_if(sections.begin(), sections.end(),
                                  [&](const LoftSection& section) { return section.z_m >= z_m; });
  Check(above != sections.end() && above != sections.begin(), "the section lies inside the body");
  if (above->z_m == z_m) return sections;
  sections.insert(above, Interpolated(*(above - 1), *above, z_m));
  return sections;
}

std::vector<LoftSection> WithDomes(double below_m,
                                   double above_m,
                                   std::vector<LoftSection> sections) {
  const auto dome = [](const LoftSection& rim, double height_m, double angle_rad) {
    const double share = angle_rad < 1.57 ? std::cos(angle_rad) : 0.0;
    LoftSection section = rim;
    section.z_m += height_m * std::sin(angle_rad);
    section.front_m *= share;
    section.back_m *= share;
    section.half_width_m *= share;
    return section;
  };
  const std::array<double, 2> angles_rad = {0.75, 0.5 * std::numbers::pi};
  const LoftSection bottom = sections.front();
  const LoftSection top = sections.back();
  for (const double angle_rad : angles_rad) {
    if (below_m > 0.0) sections.insert(sections.begin(), dome(bottom, -below_m, angle_rad));
    if (above_m > 0.0) sections.push_back(dome(top, above_m, angle_rad));
  }
  return sections;
}

void AddLoft(std::span<const LoftSection> sections,
             int num_sides,
             const LoftSurface& surface,
             Model& model,
             const Transform& model_from_loft) {
  Check(sections.size() >= 2 && num_sides >= 4 && num_sides % 2 == 0, "a body has sections");
  const auto corner = [&](std::size_t section, int side) -> Vector3 {
    return model_from_loft * CornerOf(sections[section], side % num_sides, num_sides);
  };
  SurfaceCollector collector(model);
  const std::size_t last = sections.size() - 1;
  for (int side = 0; side < num_sides; ++side) {
    for (std::size_t gap = 0; gap < last; ++gap) {
      const SurfaceClass face = surface(static_cast<int>(gap), side);
      const Vector3 a = corner(gap, side);
      const Vector3 b = corner(gap, side + 1);
      const Vector3 c = corner(gap + 1, side + 1);
      const Vector3 d = corner(gap + 1, side);
      if (!IsPoint(sections[gap])) collector.Add(face, {a, b, c});
      if (!IsPoint(sections[gap + 1])) collector.Add(face, {a, c, d});
    }
    const Vector3 bottom = model_from_loft * Vector3(sections[0].x_m, 0.0, sections[0].z_m);
    const Vector3 top = model_from_loft * Vector3(sections[last].x_m, 0.0, sections[last].z_m);
    const int top_gap = static_cast<int>(last) - 1;
    if (!IsPoint(sections[0])) {
      collector.Add(surface(0, side), {bottom, corner(0, side + 1), corner(0, side)});
    }
    if (!IsPoint(sections[last])) {
      collector.Add(surface(top_gap, side), {top, corner(last, side), corner(last, side + 1)});
    }
  }
}

void AddLoft(std::span<const LoftSection> sections,
             int num_sides,
             const SurfaceClass& surface,
             Model& model,
             const Transform& model_from_loft) {
  AddLoft(
      sections, num_sides, [&](int, int) { return surface; }, model, model_from_loft);
}

}  // namespace railcast
