#include "core/rail/structures/swept_solid.h"

#include <algorithm>

#include "core/scene/polygon.h"

namespace railcast {
namespace {

double TwiceAreaOf(std::span<const Eigen::Vector2d> outline_m) {
  double twice_area_m2 = 0.0;
  for (std::size_t i = 0; i < outline_m.size(); ++i) {
    const Eigen::Vector2d& a = outline_m[i];
    const Eigen::Vector2d& b = outline_m[(i + 1) % outline_m.size()];
    twice_area_m2 += a.x() * b.y() - a.y() * b.x();
  }
  return twice_area_m2;
}

}  // namespace

Outline RectangleOutline(double y0_m, double z0_m, double y1_m, double z1_m) {
  return {{y0_m, z0_m}, {y1_m, z0_m}, {y1_m, z1_m}, {y0_m, z1_m}};
}

Outline OnSide(Outline outline_m, double side) {
  for (Eigen::Vector2d& point : outline_m) point.x() *= side;
  return outline_m;
}

std::optional<Stretch> StretchInChunk(const StructureTrack& track,
                                      const ChainageRange& range,
                                      double d_m,
                                      const std::function<Transform(double s_m)>& frame_at) {
  const std::optional<ChainageRange> inside = track.InChunk(range);
  if (!inside) return std::nullopt;
  Stretch stretch{.frames = {},
                  .has_begin = inside->begin_s_m == range.begin_s_m,
                  .has_end = inside->end_s_m == range.end_s_m};
  for (const double s_m : track.Stations(*inside, d_m)) stretch.frames.push_back(frame_at(s_m));
  return stretch;
}

void AppendSection(const Transform& frame, std::span<const Eigen::Vector2d> outline_m, Mesh& mesh) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector2d& point : outline_m) {
    mesh.vertices.emplace_back((frame * Vector3(0.0, point.x(), point.y())).cast<float>());
  }
  for (const auto& [a, b, c] : TriangulatePolygon(outline_m)) {
    mesh.triangles.push_back({base + a, base + b, base + c});
  }
}

void AppendSweptSheet(const Stretch& stretch,
                      std::span<const Eigen::Vector2d> outline_m,
                      Mesh& mesh) {
  AppendSweep(stretch.frames, outline_m, mesh);
}

void AppendSweptSolid(const Stretch& stretch,
                      std::span<const Eigen::Vector2d> outline_m,
                      Mesh& mesh) {
  // AppendSweep() wants outlines that turn right, seen with y to the right.
  Outline closed(outline_m.begin(), outline_m.end());
  if (TwiceAreaOf(closed) > 0.0) std::reverse(closed.begin(), closed.end());
  if (stretch.has_begin) AppendSection(stretch.frames.front(), closed, mesh);
  if (stretch.has_end) {
    const Outline facing_ahead(closed.rbegin(), closed.rend());
    AppendSection(stretch.frames.back(), facing_ahead, mesh);
  }
  closed.push_back(closed.front());
  AppendSweep(stretch.frames, closed, mesh);
}

}  // namespace railcast
