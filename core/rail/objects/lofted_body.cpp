#include "core/rail/objects/lofted_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "core/base/error.h"
#include "core/rail/base/model_parts.h"

namespace railcast {
namespace {

using Point2 = Eigen::Vector2d;
using Triangle = std::array<std::uint32_t, 3>;

/// The part of a lofted body's surface to which a triangle belongs.
struct BodyPanel {
  std::size_t piece{};
  std::size_t side{};
};
constexpr std::size_t kFirstEnd = static_cast<std::size_t>(-1);
constexpr std::size_t kLastEnd = static_cast<std::size_t>(-2);

struct LoftedBody {
  Mesh mesh;
  std::vector<BodyPanel> panels;  ///< Of each triangle.
};

void AddPanelFace(const Triangle& triangle, const BodyPanel& panel, LoftedBody& body) {
  const auto& vertices = body.mesh.vertices;
  const Eigen::Vector3f ab = vertices[triangle[1]] - vertices[triangle[0]];
  const Eigen::Vector3f ac = vertices[triangle[2]] - vertices[triangle[0]];
  const Eigen::Vector3f bc = vertices[triangle[2]] - vertices[triangle[1]];
  if (ab.isZero(0.0F) || ac.isZero(0.0F) || bc.isZero(0.0F)) return;
  body.mesh.triangles.push_back(triangle);
  body.panels.push_back(panel);
}

void AddEnd(const Rib& rib, std::uint32_t first, std::size_t end, LoftedBody& body) {
  Vector3 middle_m = Vector3::Zero();
  for (const Vector3& point : rib) middle_m += point / static_cast<double>(rib.size());
  const auto middle = static_cast<std::uint32_t>(body.mesh.vertices.size());
  body.mesh.vertices.emplace_back(middle_m.cast<float>());
  const auto count = static_cast<std::uint32_t>(rib.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t next = (i + 1) % count;
    const bool is_last = end == kLastEnd;
    AddPanelFace({middle, first + (is_last ? i : next), first + (is_last ? next : i)}, {end, 0},
                 body);
  }
}

double SixfoldVolume_m3(const Mesh& mesh) {
  double volume_m3 = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3 pa = mesh.vertices[a].cast<double>();
    volume_m3 += pa.dot(mesh.vertices[b].cast<double>().cross(mesh.vertices[c].cast<double>()));
  }
  return volume_m3;
}

LoftedBody LoftThrough(std::span<const Rib> ribs, bool is_endless) {
  Check(ribs.size() >= 2 && ribs.front().size() >= 3, "a lofted body has ribs");
  LoftedBody body;
  const auto count = static_cast<std::uint32_t>(ribs.front().size());
  for (const Rib& rib : ribs) {
    Check(rib.size() == count, "all ribs of a body have as many points");
    for (const Vector3& point : rib) body.mesh.vertices.emplace_back(point.cast<float>());
  }
  const auto num_ribs = static_cast<std::uint32_t>(ribs.size());
  for (std::uint32_t piece = 0; piece + (is_endless ? 0 : 1) < num_ribs; ++piece) {
    const std::uint32_t a = piece * count;
    const std::uint32_t b = (piece + 1) % num_ribs * count;
    for (std::uint32_t side = 0; side < count; ++side) {
      const std::uint32_t next = (side + 1) % count;
      AddPanelFace({a + side, a + next, b + next}, {piece, side}, body);
      AddPanelFace({a + side, b + next, b + side}, {piece, side}, body);
    }
  }
  if (!is_endless) {
    AddEnd(ribs.front(), 0, kFirstEnd, body);
    AddEnd(ribs.back(), (num_ribs - 1) * count, kLastEnd, body);
  }
  if (SixfoldVolume_m3(body.mesh) < 0.0) {
    for (Triangle& triangle : body.mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return body;
}

SurfaceClass SurfaceOf(const BodyPanel& panel, const BodySurfaces& surfaces) {
  if (panel.piece == kFirstEnd) return surfaces.first_end;
  if (panel.piece == kLastEnd) return surfaces.last_end;
  return surfaces.wall(panel.piece, panel.side);
}

/// The slope of the smooth curve at one of its points.
double SlopeAt(std::span<const Point2> points, std::size_t i) {
  if (i == 0 || i + 1 == points.size()) return 0.0;
  const Point2 before = points[i] - points[i - 1];
  const Point2 after = points[i + 1] - points[i];
  const double first = before.y() / before.x();
  const double second = after.y() / after.x();
  if (first * second <= 0.0) return 0.0;
  const double w1 = 2.0 * after.x() + before.x();
  const double w2 = after.x() + 2.0 * before.x();
  return (w1 + w2) / (w1 / first + w2 / second);
}

using OvalVector = Eigen::Vector4d;

OvalVector VectorOf(const OvalSection& section) {
  return {section.x_m, section.z_m, section.half_height_m, section.half_width_m};
}

/// Sections along the spline, kSteps for each of the given ones.
std::vector<OvalVector> SmoothSections(std::span<const OvalSection> sections) {
  constexpr int kSteps = 2;
  std::vector<OvalVector> smooth;
  const auto at = [&](std::size_t i) { return VectorOf(sections[i]); };
  const std::size_t last = sections.size() - 1;
  for (std::size_t i = 0; i < last; ++i) {
    const OvalVector p1 = at(i);
    const OvalVector p2 = at(i + 1);
    const OvalVector m1 = i == 0 ? OvalVector(p2 - p1) : OvalVector(0.5 * (p2 - at(i - 1)));
    const OvalVector m2 = i + 1 == last ? OvalVector(p2 - p1) : OvalVector(0.5 * (at(i + 2) - p1));
    for (int step = 0; step < kSteps; ++step) {
      const double t = 1.0 * step / kSteps;
      const double u = 1.0 - t;
      smooth.emplace_back((1.0 + 2.0 * t) * u * u * p1 + t * u * u * m1 +
                          t * t * (3.0 - 2.0 * t) * p2 - t * t * u * m2);
    }
  }
  smooth.push_back(at(last));
  return smooth;
}

/// An oval rib at `middle_m`, across the direction (along.x, along.y) = (x, z).
Rib OvalRib(const Vector3& middle_m, const Point2& along, const Point2& half_m, int num_sides) {
  Rib rib;
  for (int side = 0; side < num_sides; ++side) {
    const double angle_rad = 2.0 * std::numbers::pi * side / num_sides;
    const double across_m = half_m.x() * std::sin(angle_rad);
    rib.emplace_back(middle_m + Vector3(-along.y() * across_m, half_m.y() * std::cos(angle_rad),
                                        along.x() * across_m));
  }
  return rib;
}

}  // namespace

Mesh MakeLoftedBody(std::span<const Rib> ribs, bool is_endless) {
  return LoftThrough(ribs, is_endless).mesh;
}

void AddLoftedBody(std::span<const Rib> ribs, const BodySurfaces& surfaces, Model& model) {
  const LoftedBody body = LoftThrough(ribs, false);
  const std::size_t num_vertices = body.mesh.vertices.size();
  Model sorted;
  for (std::size_t i = 0; i < body.panels.size(); ++i) {
    Mesh& mesh = MeshOf(SurfaceOf(body.panels[i], surfaces), sorted);
    mesh.triangles.push_back(body.mesh.triangles[i]);
  }
  for (const Part& part : sorted.parts) {
    Mesh& mesh = MeshOf({part.material, part.label}, model);
    std::vector<std::uint32_t> places(num_vertices, UINT32_MAX);
    for (Triangle triangle : part.mesh.triangles) {
      for (std::uint32_t& vertex : triangle) {
        std::uint32_t& place = places[vertex];
        if (place == UINT32_MAX) {
          place = static_cast<std::uint32_t>(mesh.vertices.size());
          mesh.vertices.push_back(body.mesh.vertices[vertex]);
        }
        vertex = place;
      }
      mesh.triangles.push_back(triangle);
    }
  }
}

double SmoothValueAt(std::span<const Point2> points, double x) {
  if (x <= points.front().x()) return points.front().y();
  if (x >= points.back().x()) return points.back().y();
  std::size_t i = 0;
  while (points[i + 1].x() < x) ++i;
  const double width = points[i + 1].x() - points[i].x();
  const double t = (x - points[i].x()) / width;
  const double u = 1.0 - t;
  return (1.0 + 2.0 * t) * u * u * points[i].y() + t * u * u * width * SlopeAt(points, i) +
         t * t * (3.0 - 2.0 * t) * points[i + 1].y() - t * t * u * width * SlopeAt(points, i + 1);
}

Rib MirroredRib(double x_m, std::span<const Point2> half) {
  Rib rib;
  for (const Point2& point : half) rib.emplace_back(x_m, point.x(), point.y());
  for (std::size_t i = half.size() - 2; i > 0; --i) {
    rib.emplace_back(x_m, -half[i].x(), half[i].y());
  }
  return rib;
}

std::size_t HalfPanel(std::size_t side, std::size_t num_half_points) {
  const std::size_t num_panels = num_half_points - 1;
  return side < num_panels ? side : 2 * num_panels - 1 - side;
}

Mesh MakeOvalBody(std::span<const OvalSection> sections, const Point2& y_m, int num_sides) {
  const std::vector<OvalVector> smooth = SmoothSections(sections);
  std::vector<Rib> ribs;
  const std::size_t last = smooth.size() - 1;
  // How far beyond its ends a body is how wide, for a half width of 1.
  const std::vector<Point2> rounding = {{0.65, 0.4}, {0.4, 0.8}};
  for (std::size_t i = 0; i <= last; ++i) {
    const OvalVector from_to = smooth[std::min(i + 1, last)] - smooth[i == 0 ? 0 : i - 1];
    const Point2 along = from_to.head<2>().normalized();
    const double share = static_cast<double>(i) / static_cast<double>(last);
    const Vector3 middle_m(smooth[i].x(), std::lerp(y_m.x(), y_m.y(), share), smooth[i].y());
    const Point2 half_m(smooth[i].z(), smooth[i].w());
    const auto add_beyond = [&](const Point2& beyond, double direction) {
      const double beyond_m = direction * beyond.x() * half_m.minCoeff();
      ribs.push_back(OvalRib(middle_m + beyond_m * Vector3(along.x(), 0.0, along.y()), along,
                             beyond.y() * half_m, num_sides));
    };
    if (i == 0) {
      for (const Point2& beyond : rounding) add_beyond(beyond, -1.0);
    }
    ribs.push_back(OvalRib(middle_m, along, half_m, num_sides));
    if (i == last) {
      for (auto beyond = rounding.rbegin(); beyond != rounding.rend(); ++beyond) {
        add_beyond(*beyond, 1.0);
      }
    }
  }
  return MakeLoftedBody(ribs);
}

Mesh MakeRevolvedBody(std::span<const Point2> outline, int num_sides) {
  std::vector<Rib> ribs;
  for (int i = 0; i < num_sides; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / num_sides;
    Rib rib;
    for (const Point2& point : outline) {
      rib.emplace_back(point.y() * std::sin(angle_rad), point.x(),
                       -point.y() * std::cos(angle_rad));
    }
    ribs.push_back(std::move(rib));
  }
  return MakeLoftedBody(ribs, true);
}

void ScaleTo(const Vector3& size_m, Model& model) {
  const Eigen::AlignedBox3d bounds_m = model.Bounds();
  const Vector3 scale = size_m.cwiseQuotient(bounds_m.sizes());
  for (Part& part : model.parts) {
    for (Eigen::Vector3f& vertex : part.mesh.vertices) {
      vertex = scale.cwiseProduct(vertex.cast<double>()).cast<float>();
    }
  }
  StandOnOrigin(model);
}

void StandOnOrigin(Model& model) {
  const Eigen::AlignedBox3d bounds_m = model.Bounds();
  const Vector3 foot_m(bounds_m.center().x(), bounds_m.center().y(), bounds_m.min().z());
  for (Part& part : model.parts) {
    for (Eigen::Vector3f& vertex : part.mesh.vertices) {
      vertex = (vertex.cast<double>() - foot_m).cast<float>();
    }
  }
}

}  // namespace railcast
