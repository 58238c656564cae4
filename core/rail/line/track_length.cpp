#include "core/rail/line/track_length.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace railcast {

TrackLength::TrackLength(const Alignment& alignment, const TrackCourse& course)
    : TrackLength(alignment, course, course.begin_s_m(), course.end_s_m()) {}

TrackLength::TrackLength(const Alignment& alignment,
                         const TrackCourse& course,
                         double begin_s_m,
                         double end_s_m)
    : begin_s_m_(begin_s_m) {
  constexpr double kSampling_m = 1.0;
  const double extent_m = end_s_m - begin_s_m;
  const auto num_steps = static_cast<std::size_t>(std::max(1.0, std::ceil(extent_m / kSampling_m)));
  step_m_ = extent_m / static_cast<double>(num_steps);
  lengths_m_.push_back(0.0);
  const auto axis_at = [&](std::size_t i) -> Vector3 {
    const double s_m = begin_s_m_ + step_m_ * static_cast<double>(i);
    return course.WorldFromTrack(alignment, s_m).translation();
  };
  Vector3 before_m = axis_at(0);
  for (std::size_t i = 1; i <= num_steps; ++i) {
    const Vector3 here_m = axis_at(i);
    lengths_m_.push_back(lengths_m_.back() + (here_m - before_m).norm());
    before_m = here_m;
  }
}

double TrackLength::UpTo(double s_m) const {
  const double from_begin_m = s_m - begin_s_m_;
  const double num_steps = static_cast<double>(lengths_m_.size() - 1);
  const double step = from_begin_m / step_m_;
  if (step <= 0.0) return from_begin_m;
  if (step >= num_steps) return total_m() + from_begin_m - num_steps * step_m_;
  const auto cell = static_cast<std::size_t>(step);
  return std::lerp(lengths_m_[cell], lengths_m_[cell + 1], step - static_cast<double>(cell));
}

double TrackLength::MovedFrom(double s_m, double length_m) const {
  const double to_m = UpTo(s_m) + length_m;
  if (to_m <= 0.0) return begin_s_m_ + to_m;
  const double num_steps = static_cast<double>(lengths_m_.size() - 1);
  if (to_m >= total_m()) return begin_s_m_ + num_steps * step_m_ + to_m - total_m();
  const auto after = std::upper_bound(lengths_m_.begin(), lengths_m_.end(), to_m);
  const double cell = static_cast<double>(std::distance(lengths_m_.begin(), after) - 1);
  const double share = (to_m - *(after - 1)) / (*after - *(after - 1));
  return begin_s_m_ + step_m_ * (cell + share);
}

}  // namespace railcast
