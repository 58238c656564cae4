#include "core/rail/motion/speed_profile.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rail/motion/ride.h"

namespace railcast {
namespace {

std::string PlaceOfPoint(std::size_t point) {
  return "/profile/" + std::to_string(point);
}

// Measures the progress of a point: its time, or its distance from the start in the direction of
// travel.
struct ProgressRule {
  bool in_time{};
  double start_s_m{};
  bool reverse{};

  [[nodiscard]] double Value(const SpeedPoint& point) const {
    return in_time ? *point.time_s : *point.s_m;
  }
  [[nodiscard]] double Of(const SpeedPoint& point) const {
    if (in_time) return *point.time_s;
    return reverse ? start_s_m - *point.s_m : *point.s_m - start_s_m;
  }
};

void CheckKinds(const MotionSpec& motion, ErrorList& errors) {
  const bool in_time = motion.profile.front().time_s.has_value();
  for (std::size_t i = 0; i < motion.profile.size(); ++i) {
    const SpeedPoint& point = motion.profile[i];
    if (point.time_s.has_value() == point.s_m.has_value()) {
      errors.Add({PlaceOfPoint(i), "must have exactly one of time_s and s_m",
                  point.time_s ? "both" : "none"});
    } else if (point.time_s.has_value() != in_time) {
      errors.Add({PlaceOfPoint(i),
                  in_time ? "must be at a time_s like the first point"
                          : "must be at an s_m like the first point",
                  in_time ? "s_m" : "time_s"});
    }
  }
}

void CheckProgress(const MotionSpec& motion, const ProgressRule& rule, ErrorList& errors) {
  for (std::size_t i = 0; i < motion.profile.size(); ++i) {
    const SpeedPoint& point = motion.profile[i];
    const std::string place = PlaceOfPoint(i) + (rule.in_time ? "/time_s" : "/s_m");
    const double value = rule.Value(point);
    const double progress = rule.Of(point);
    const char* beyond = rule.reverse && !rule.in_time ? "less than " : "greater than ";
    if (i == 0) {
      if (!(progress >= 0.0)) {
        errors.Add({place,
                    rule.in_time
                        ? "must be >= 0"
                        : "must not be behind the start at " + NumberText(rule.start_s_m) + " m",
                    NumberText(value)});
      }
    } else if (!(progress > rule.Of(motion.profile[i - 1]))) {
      errors.Add({place,
                  std::string("must be ") + beyond + NumberText(rule.Value(motion.profile[i - 1])) +
                      " of the point before it",
                  NumberText(value)});
    }
    const double speed_before_mps = i == 0 ? point.speed_mps : motion.profile[i - 1].speed_mps;
    if (!rule.in_time && progress > 0.0 && speed_before_mps == 0.0 && point.speed_mps == 0.0) {
      errors.Add(
          {place, "is never reached, the speed being 0 up to it and at it", NumberText(value)});
    }
  }
}

}  // namespace

SpeedProfile::SpeedProfile(const MotionSpec& motion, double start_s_m)
    : corners_{Corner{}}, start_s_m_(start_s_m), direction_(motion.reverse ? -1.0 : 1.0) {
  if (motion.profile.empty()) return;
  ErrorList errors;
  for (std::size_t i = 0; i < motion.profile.size(); ++i) {
    const double speed_mps = motion.profile[i].speed_mps;
    if (!(speed_mps >= 0.0)) {
      errors.Add({PlaceOfPoint(i) + "/speed_mps", "must be >= 0", NumberText(speed_mps)});
    }
  }
  CheckKinds(motion, errors);
  errors.ThrowIfAny();
  const ProgressRule rule{motion.profile.front().time_s.has_value(), start_s_m, motion.reverse};
  CheckProgress(motion, rule, errors);
  errors.ThrowIfAny();

  corners_.front().speed_mps = motion.profile.front().speed_mps;
  for (const SpeedPoint& point : motion.profile) {
    Corner& last = corners_.back();
    const double speed_sum_mps = last.speed_mps + point.speed_mps;
    Corner next{.speed_mps = point.speed_mps};
    if (rule.in_time) {
      next.time_s = *point.time_s;
      next.travelled_m = last.travelled_m + 0.5 * speed_sum_mps * (next.time_s - last.time_s);
    } else {
      next.travelled_m = rule.Of(point);
      const double distance_m = next.travelled_m - last.travelled_m;
      next.time_s = distance_m > 0.0 ? last.time_s + 2.0 * distance_m / speed_sum_mps : 0.0;
    }
    const double duration_s = next.time_s - last.time_s;
    // A first point at the start itself replaces the start.
    if (duration_s == 0.0) {
      last = next;
      continue;
    }
    last.acceleration_mps2 = (next.speed_mps - last.speed_mps) / duration_s;
    next.CountDistancesSince(last);
    corners_.push_back(next);
  }
}

SpeedProfile SpeedProfile::WithSpeedFrom(double time_s,
                                         double speed_mps,
                                         double acceleration_mps2) const {
  const State now = At(time_s);
  const Corner change{.time_s = time_s,
                      .travelled_m = direction_ * (now.s_m - start_s_m_),
                      .speed_mps = now.speed_mps,
                      .speeding_up_m = now.speeding_up_m,
                      .slowing_down_m = now.slowing_down_m};
  const double difference_mps = speed_mps - now.speed_mps;
  SpeedProfile changed = *this;
  changed.corners_ = {change};
  if (difference_mps != 0.0) {
    changed.corners_.front().acceleration_mps2 = std::copysign(acceleration_mps2, difference_mps);
  }
  changed.dropped_ = RecentJolts(time_s);
  changed.dropped_.push_back(
      {time_s, changed.corners_.front().acceleration_mps2 - now.acceleration_mps2});
  if (difference_mps == 0.0) return changed;
  const double duration_s = std::abs(difference_mps) / acceleration_mps2;
  Corner end{.time_s = time_s + duration_s,
             .travelled_m = change.travelled_m + 0.5 * (now.speed_mps + speed_mps) * duration_s,
             .speed_mps = speed_mps};
  end.CountDistancesSince(changed.corners_.front());
  changed.corners_.push_back(end);
  return changed;
}

void SpeedProfile::Corner::CountDistancesSince(const Corner& before) {
  speeding_up_m = before.speeding_up_m;
  slowing_down_m = before.slowing_down_m;
  const double distance_m = travelled_m - before.travelled_m;
  if (before.acceleration_mps2 > 0.0) speeding_up_m += distance_m;
  if (before.acceleration_mps2 < 0.0) slowing_down_m += distance_m;
}

SpeedProfile::State SpeedProfile::At(double time_s) const {
  const auto after =
      std::upper_bound(corners_.begin() + 1, corners_.end(), time_s,
                       [](double time, const Corner& corner) { return time < corner.time_s; });
  const Corner& corner = *(after - 1);
  const double inside_s = time_s - corner.time_s;
  Corner here = corner;
  here.travelled_m += (corner.speed_mps + 0.5 * corner.acceleration_mps2 * inside_s) * inside_s;
  here.CountDistancesSince(corner);
  return {.s_m = start_s_m_ + direction_ * here.travelled_m,
          .speed_mps = corner.speed_mps + corner.acceleration_mps2 * inside_s,
          .acceleration_mps2 = corner.acceleration_mps2,
          .speeding_up_m = here.speeding_up_m,
          .slowing_down_m = here.slowing_down_m};
}

std::vector<SpeedProfile::Jolt> SpeedProfile::RecentJolts(double time_s) const {
  constexpr double kMemory_s = 10.0;  // Leaves 3e-7 of a jolt at 1.2 Hz and a fifth of damping.
  std::vector<Jolt> recent;
  const auto add = [&](const Jolt& jolt) {
    if (jolt.time_s <= time_s && jolt.time_s > time_s - kMemory_s) recent.push_back(jolt);
  };
  std::ranges::for_each(dropped_, add);
  const auto first = std::ranges::upper_bound(corners_, time_s - kMemory_s, {}, &Corner::time_s);
  for (auto corner = std::max(first, corners_.begin() + 1); corner < corners_.end(); ++corner) {
    if (corner->time_s > time_s) break;
    add({corner->time_s, corner->acceleration_mps2 - (corner - 1)->acceleration_mps2});
  }
  return recent;
}

double SpeedProfile::SprungAcceleration_mps2(const Suspension& suspension,
                                             double time_s,
                                             double after_s) const {
  double sprung_mps2 = At(time_s).acceleration_mps2;
  for (const Jolt& jolt : RecentJolts(time_s)) {
    sprung_mps2 -= jolt.change_mps2 * suspension.LeftOfStep(time_s + after_s - jolt.time_s);
  }
  return sprung_mps2;
}

std::optional<double> SpeedProfile::TimeAt_s(double s_m) const {
  const double wanted_m = direction_ * (s_m - start_s_m_);
  if (wanted_m < corners_.front().travelled_m) return std::nullopt;
  const auto after = std::ranges::upper_bound(corners_, wanted_m, {}, &Corner::travelled_m);
  // Where the object stands for a while, the corner before `after` is that at which it goes on.
  auto corner = after - 1;
  while (corner != corners_.begin() && corner->travelled_m == wanted_m &&
         (corner - 1)->travelled_m == wanted_m) {
    --corner;
  }
  const double left_m = wanted_m - corner->travelled_m;
  if (left_m == 0.0) return corner->time_s;
  // The lesser root of v t + a t^2 / 2 = left, in the form that also holds for a = 0.
  const double discriminant =
      corner->speed_mps * corner->speed_mps + 2.0 * corner->acceleration_mps2 * left_m;
  const double divisor = corner->speed_mps + std::sqrt(std::max(0.0, discriminant));
  if (discriminant < 0.0 || divisor <= 0.0) return std::nullopt;
  return corner->time_s + 2.0 * left_m / divisor;
}

bool SpeedProfile::moves() const {
  return std::any_of(corners_.begin(), corners_.end(),
                     [](const Corner& corner) { return corner.speed_mps > 0.0; });
}

}  // namespace railcast
