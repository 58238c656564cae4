#include "core/rail/structures/structure_track.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/error.h"

namespace railcast {
namespace {

constexpr double kStructureTolerance_m = 1e-3;

}  // namespace

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
  const ChainageRange range{
      .begin_s_m = std::max(context_->begin_s_m - 0.5 * kChunkOverlap_m, stretch.begin_s_m),
      .end_s_m = std::min(context_->end_s_m + 0.5 * kChunkOverlap_m, stretch.end_s_m)};
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
