#include "core/rail/objects/car_body.h"

#include <algorithm>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/wagon_parts.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

using SectionPoint = Eigen::Vector2d;

constexpr double kWallThickness_m = 0.07;

/// The outer face of the side wall between two heights, moved inwards.
std::vector<SectionPoint> FaceBetweenHeights(const CarSection& section,
                                             double bottom_m,
                                             double top_m,
                                             double inwards_m) {
  std::vector<SectionPoint> face;
  face.emplace_back(HalfWidthAt_m(section, bottom_m) - inwards_m, bottom_m);
  for (const SectionPoint& point : section.side) {
    if (point.y() > bottom_m && point.y() < top_m) {
      face.emplace_back(point.x() - inwards_m, point.y());
    }
  }
  face.emplace_back(HalfWidthAt_m(section, top_m) - inwards_m, top_m);
  return face;
}

struct WallPart {
  double begin_x_m{};
  double end_x_m{};
  double bottom_m{};
  double top_m{};
};

/// A part of the side wall whose outer and inner faces lie that far behind the wall's outer face.
Mesh MakeWallPart(const CarSection& section,
                  const WallPart& part,
                  double side,
                  const Eigen::Vector2d& outer_inner_m) {
  std::vector<SectionPoint> outline =
      FaceBetweenHeights(section, part.bottom_m, part.top_m, outer_inner_m.x());
  const std::vector<SectionPoint> inner =
      FaceBetweenHeights(section, part.bottom_m, part.top_m, outer_inner_m.y());
  outline.insert(outline.end(), inner.rbegin(), inner.rend());
  for (SectionPoint& point : outline) point.x() *= side;
  return MakeExtrusion(outline, part.begin_x_m, part.end_x_m);
}

/// Heights at which the openings begin and end, between the wall's lower and upper edge.
std::vector<double> Heights_m(const CarSection& section, std::span<const CarOpening> openings) {
  std::vector<double> heights_m = {section.side.front().y(), section.side.back().y()};
  for (const CarOpening& opening : openings) {
    heights_m.push_back(opening.bottom_m);
    heights_m.push_back(opening.top_m);
  }
  std::sort(heights_m.begin(), heights_m.end());
  heights_m.erase(std::unique(heights_m.begin(), heights_m.end()), heights_m.end());
  return heights_m;
}

/// The parts of the wall between and beside the openings, in strips from one height to the next.
std::vector<WallPart> SolidParts(const CarSection& section,
                                 const Eigen::Vector2d& begin_end_x_m,
                                 std::span<const CarOpening> openings) {
  std::vector<WallPart> parts;
  const std::vector<double> heights_m = Heights_m(section, openings);
  for (std::size_t i = 0; i + 1 < heights_m.size(); ++i) {
    const double middle_m = 0.5 * (heights_m[i] + heights_m[i + 1]);
    std::vector<CarOpening> holes;
    for (const CarOpening& opening : openings) {
      if (opening.bottom_m < middle_m && middle_m < opening.top_m) holes.push_back(opening);
    }
    std::sort(holes.begin(), holes.end(),
              [](const CarOpening& a, const CarOpening& b) { return a.begin_x_m < b.begin_x_m; });
    double x_m = begin_end_x_m.x();
    for (const CarOpening& hole : holes) {
      parts.push_back({x_m, hole.begin_x_m, heights_m[i], heights_m[i + 1]});
      x_m = hole.end_x_m;
    }
    parts.push_back({x_m, begin_end_x_m.y(), heights_m[i], heights_m[i + 1]});
  }
  return parts;
}

void AddOpening(const CarSection& section,
                const CarOpening& opening,
                double side,
                const CarSurfaces& surfaces,
                Model& car) {
  // Edges reach 1 cm into the wall.
  constexpr double kLap_m = 0.01;
  WallPart part{opening.begin_x_m - kLap_m, opening.end_x_m + kLap_m, opening.bottom_m - kLap_m,
                opening.top_m + kLap_m};
  if (opening.kind == CarOpeningKind::kWindow) {
    MeshOf(surfaces.glass, car).Append(MakeWallPart(section, part, side, {0.02, 0.03}));
    return;
  }
  part.bottom_m = opening.bottom_m;
  MeshOf(surfaces.door, car).Append(MakeWallPart(section, part, side, {0.04, 0.06}));
  const double inset_m = 0.22 * (opening.end_x_m - opening.begin_x_m);
  const double height_m = opening.top_m - opening.bottom_m;
  const WallPart pane{opening.begin_x_m + inset_m, opening.end_x_m - inset_m,
                      opening.bottom_m + 0.45 * height_m, opening.top_m - 0.12 * height_m};
  MeshOf(surfaces.glass, car).Append(MakeWallPart(section, pane, side, {0.035, 0.045}));
}

}  // namespace

double HalfWidthAt_m(const CarSection& section, double z_m) {
  for (std::size_t i = 0; i + 1 < section.side.size(); ++i) {
    const SectionPoint& a = section.side[i];
    const SectionPoint& b = section.side[i + 1];
    if (z_m <= b.y()) return a.x() + (b.x() - a.x()) * (z_m - a.y()) / (b.y() - a.y());
  }
  return section.side.back().x();
}

void AddCarBody(const CarSection& section,
                const Eigen::Vector2d& begin_end_x_m,
                std::span<const CarOpening> openings,
                const CarSurfaces& surfaces,
                Model& car) {
  for (const double side : kBothSides) {
    for (const WallPart& part : SolidParts(section, begin_end_x_m, openings)) {
      MeshOf(surfaces.wall, car).Append(MakeWallPart(section, part, side, {0.0, kWallThickness_m}));
    }
    for (const CarOpening& opening : openings) AddOpening(section, opening, side, surfaces, car);
  }
  std::vector<SectionPoint> roof = section.roof;
  for (auto point = section.roof.rbegin(); point != section.roof.rend(); ++point) {
    if (point->x() > 0.0) roof.emplace_back(-point->x(), point->y());
  }
  MeshOf(surfaces.roof, car).Append(MakeExtrusion(roof, begin_end_x_m.x(), begin_end_x_m.y()));
}

Mesh MakeCarEnd(const CarSection& section, double begin_x_m, double end_x_m) {
  std::vector<SectionPoint> outline = section.side;
  outline.insert(outline.end(), section.roof.begin() + 1, section.roof.end());
  for (std::size_t i = outline.size(); i-- > 0;) {
    const SectionPoint left = outline[i];
    if (left.x() > 0.0) outline.emplace_back(-left.x(), left.y());
  }
  return MakeExtrusion(outline, begin_x_m, end_x_m);
}

}  // namespace railcast
