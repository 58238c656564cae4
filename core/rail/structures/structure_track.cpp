#include "core/rail/structures/structure_track.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "core/scene/polygon.h"

namespace railcast {
namespace {

constexpr double kStructureTolerance_m = 1e-3;

}  // namespace

double TwiceAreaOf(std::span<const Eigen::Vector2d> outline_m) {
  double twice_area_m2 = 0.0;
  for (std::size_t i = 0; i < outline_m.size(); ++i) {
    const Eigen::Vector2d& a = outline_m[i];
    const Eigen::Vector2d& b = outline_m[(i + 1) % outline_m.size()];
    twice_area_m2 += a.x() * b.y() - a.y() * b.x();
  }
  return twice_area_m2;
}

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
  AppendRow(frame, outline_m, mesh);
  for (const auto& [a, b, c] : TriangulatePolygon(outline_m)) {
    mesh.triangles.push_back({base + a, base + b, base + c});
  }
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

StructureTrack::StructureTrack(const ChunkContext& context, const std::string& track)
    : context_(&context),
      track_(FindTrack(context.spec, track)),
      course_(TracksOf(context).CourseOf(track)) {
  Check(course_ != nullptr, "a structure's track exists");
}

Transform StructureTrack::Canted(double s_m) const {
  return context_->chunk_from_world * course_->WorldFromTrack(context_->alignment, s_m);
}

Transform StructureTrack::Upright(double s_m) const {
  return UprightAt(s_m, 0.0, 0.0);
}

Transform StructureTrack::UprightAt(double s_m, double d_m, double h_m) const {
  const Transform canted = Canted(s_m);
  const Vector3 ahead = canted.linear().col(0);
  return MakeTransform(RotationFromYawPitchRoll(std::atan2(ahead.y(), ahead.x()), 0.0, 0.0),
                       canted * Vector3(0.0, d_m, h_m));
}

std::optional<ChainageRange> StructureTrack::InChunk(const ChainageRange& stretch) const {
  const ChainageRange range = SweptRange(*context_, stretch);
  // A shorter range is only the overlap with the chunk in which the structure begins or ends.
  if (range.end_s_m - range.begin_s_m < kChunkOverlap_m) return std::nullopt;
  return range;
}

std::vector<double> StructureTrack::Stations(const ChainageRange& range,
                                             double d_m,
                                             double max_step_m) const {
  if (!course_->is_parallel()) {
    return SweepStations(context_->alignment, range, *course_, kStructureTolerance_m, max_step_m);
  }
  return SweepStations(context_->alignment, range, offset_m(range.begin_s_m) + d_m,
                       kStructureTolerance_m, max_step_m);
}

std::vector<double> StructureTrack::Places(const ChainageRange& stretch, double spacing_m) const {
  const double length_m = stretch.end_s_m - stretch.begin_s_m;
  const auto num_gaps = static_cast<std::int64_t>(std::max(1.0, std::ceil(length_m / spacing_m)));
  const double step_m = length_m / static_cast<double>(num_gaps);
  // One step beyond the chunk on either side, so that rounding loses no place.
  const auto index_of = [&](double s_m) { return (s_m - stretch.begin_s_m) / step_m; };
  const auto first = static_cast<std::int64_t>(std::floor(index_of(context_->begin_s_m))) - 1;
  const auto last = static_cast<std::int64_t>(std::ceil(index_of(context_->end_s_m))) + 1;
  std::vector<double> places_m;
  for (std::int64_t i = std::max<std::int64_t>(0, first); i <= std::min(num_gaps, last); ++i) {
    const double s_m = stretch.begin_s_m + step_m * static_cast<double>(i);
    if (Holds(s_m)) places_m.push_back(s_m);
  }
  return places_m;
}

bool StructureTrack::Holds(double s_m) const {
  const bool is_last = context_->end_s_m >= context_->alignment.length_m();
  return s_m >= context_->begin_s_m && (s_m < context_->end_s_m || is_last);
}

}  // namespace railcast
