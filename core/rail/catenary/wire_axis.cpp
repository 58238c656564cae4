#include "core/rail/catenary/wire_axis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/rail/network/network.h"

namespace railcast {
namespace {

/// The track in which a turnout lies.
std::optional<std::size_t> TrackOfTurnout(const WorldSpec& world,
                                          const std::optional<TurnoutSpec>& turnout) {
  return turnout ? TrackIndex(world, turnout->track) : std::nullopt;
}

}  // namespace

WireAxis::WireAxis(const WorldTracks& tracks, std::size_t track) {
  const std::vector<TrackSpec>& specs = tracks.world.tracks;
  for (std::optional<std::size_t> at = track; at;
       at = TrackOfTurnout(tracks.world, specs[*at].begin)) {
    const double end_s_m =
        sections_.empty() ? tracks.courses[*at].end_s_m() : sections_.back().course->begin_s_m();
    sections_.push_back({&tracks.courses[*at], end_s_m});
  }
  std::ranges::reverse(sections_);
  for (auto at = TrackOfTurnout(tracks.world, specs[track].end); at;
       at = TrackOfTurnout(tracks.world, specs[*at].end)) {
    sections_.push_back({&tracks.courses[*at], tracks.courses[*at].end_s_m()});
  }
  sections_.back().end_s_m = std::numeric_limits<double>::infinity();
}

const TrackCourse& WireAxis::CourseAt(double s_m) const {
  return *std::ranges::find_if(sections_, [&](const Section& section) {
            return s_m <= section.end_s_m;
          })->course;
}

double WireAxis::OffsetAt_m(double s_m) const {
  return CourseAt(s_m).OffsetWithin_m(s_m);
}

double WireAxis::LiftAt_m(const Alignment& alignment, double s_m) const {
  const TrackCourse& course = CourseAt(s_m);
  return course.LiftAt(alignment, std::clamp(s_m, course.begin_s_m(), course.end_s_m())).h_m;
}

std::optional<double> StaggerInCurve(const CatenarySpec& spec, double curvature_per_m) {
  const double rise_m = spec.max_span_m * spec.max_span_m * std::abs(curvature_per_m) / 8.0;
  if (rise_m <= 0.5 * spec.stagger_m) return std::nullopt;
  return curvature_per_m > 0.0 ? -spec.stagger_m : spec.stagger_m;
}

double PantographShift_m(const CatenarySpec& spec, const AxisPoint& axis) {
  return -spec.contact_height_m * std::sin(axis.cant_rad);
}

Transform WorldFromSupport(const Alignment& alignment,
                           const WorldSpec& spec,
                           const AxisOffset& axis,
                           double s_m) {
  const double height_m = spec.catenary.contact_height_m;
  const Vector3 contact_m = alignment.WorldFromTrack(s_m, axis.d_m) * Vector3(0.0, 0.0, height_m);
  return MakeTransform(RotationFromYawPitchRoll(alignment.At(s_m).heading_rad, 0.0, 0.0),
                       contact_m + (axis.lift_m - height_m) * Vector3::UnitZ());
}

}  // namespace railcast
