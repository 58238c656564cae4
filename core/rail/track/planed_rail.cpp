#include "core/rail/track/planed_rail.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace railcast {
namespace {

using SectionPoints = std::vector<Eigen::Vector2d>;

/// Lower edge of the head: what lies above it and behind the plane is lowered to the height at
/// which the plane meets the top of the head.
constexpr double kHeadDepth_m = 0.045;

/// Highest z of the outline at distance `y_m` from the track's axis, for the left rail.
double TopAt_m(const SectionPoints& outline_m, double y_m) {
  double top_m = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < outline_m.size(); ++i) {
    const Eigen::Vector2d& a = outline_m[i];
    const Eigen::Vector2d& b = outline_m[i + 1];
    if (std::min(a.x(), b.x()) > y_m || std::max(a.x(), b.x()) < y_m || a.x() == b.x()) continue;
    top_m = std::max(top_m, std::lerp(a.y(), b.y(), (y_m - a.x()) / (b.x() - a.x())));
  }
  return top_m;
}

void AppendRow(const RailStation& station, std::span<const Eigen::Vector2d> outline_m, Mesh& mesh) {
  for (const Eigen::Vector2d& point : outline_m) {
    mesh.vertices.emplace_back(
        (station.mesh_from_track * Vector3(0.0, point.x(), point.y())).cast<float>());
  }
}

/// Joins the last two rows of a strip, which have `width` points each.
void JoinRows(std::uint32_t width, Mesh& mesh) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size()) - 2 * width;
  for (std::uint32_t i = 0; i + 1 < width; ++i) {
    const std::uint32_t near = base + i;
    const std::uint32_t far = near + width;
    mesh.triangles.push_back({near, far, far + 1});
    mesh.triangles.push_back({near, far + 1, near + 1});
  }
}

}  // namespace

RailSection PlanedSection(bool left, double width_m) {
  RailSection section = MakeRailSection(true);
  const double plane_m = 0.5 * kGauge_m + width_m;
  if (std::isfinite(plane_m)) {
    const double top_m = TopAt_m(section.outline_m, plane_m);
    for (Eigen::Vector2d& point : section.outline_m) {
      if (point.x() <= plane_m) continue;
      point.x() = plane_m;
      if (point.y() > -kHeadDepth_m) point.y() = std::min(point.y(), top_m);
    }
  }
  if (!left) {
    for (Eigen::Vector2d& point : section.outline_m) point.x() = -point.x();
    std::reverse(section.outline_m.begin(), section.outline_m.end());
  }
  return section;
}

RailMeshes SweepRail(bool left, std::span<const RailStation> stations) {
  RailMeshes meshes;
  RailSection section;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    if (k == 0 || stations[k].width_m != stations[k - 1].width_m) {
      section = PlanedSection(left, stations[k].width_m);
    }
    const std::span<const Eigen::Vector2d> outline(section.outline_m);
    const std::size_t band_length = section.head_last - section.head_first + 1;
    // The rest of the outline runs from the band down, below the foot and up again.
    SectionPoints rest(outline.begin() + static_cast<std::ptrdiff_t>(section.head_last),
                       outline.end());
    rest.insert(rest.end(), outline.begin(),
                outline.begin() + static_cast<std::ptrdiff_t>(section.head_first) + 1);
    AppendRow(stations[k], outline.subspan(section.head_first, band_length), meshes.band);
    AppendRow(stations[k], rest, meshes.rest);
    if (k == 0) continue;
    JoinRows(static_cast<std::uint32_t>(band_length), meshes.band);
    JoinRows(static_cast<std::uint32_t>(rest.size()), meshes.rest);
  }
  return meshes;
}

void AppendRailEnd(const RailStation& station, bool left, bool faces_ahead, Mesh& mesh) {
  const RailSection section = PlanedSection(left, station.width_m);
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto last = static_cast<std::uint32_t>(section.outline_m.size() - 1);
  AppendRow(station, section.outline_m, mesh);
  // Point i of the section mirrors point size - 1 - i, so strips between mirrored points fill it.
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (faces_ahead) std::swap(b, c);
    mesh.triangles.push_back({base + a, base + b, base + c});
  };
  for (std::uint32_t i = 0; i + 1 < last - i; ++i) {
    add(i, i + 1, last - i);
    if (i + 1 < last - i - 1) add(i + 1, last - i - 1, last - i);
  }
}

}  // namespace railcast
