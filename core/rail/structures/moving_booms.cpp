#include "core/rail/structures/moving_booms.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/rail/structures/lineside_models.h"

namespace railcast {

double MovingBoom::Angle_rad(std::int64_t time_ns) const {
  Check(!angles_deg.empty(), "a moving boom has angles");
  const double time_s = 1e-9 * static_cast<double>(time_ns);
  const auto after = std::ranges::upper_bound(angles_deg, time_s, {}, &TimedValue::time_s);
  if (after == angles_deg.begin()) return RadFromDeg(after->value);
  const auto before = after - 1;
  if (after == angles_deg.end()) return RadFromDeg(before->value);
  const double share = (time_s - before->time_s) / (after->time_s - before->time_s);
  return RadFromDeg(std::lerp(before->value, after->value, share));
}

Transform MovingBoom::WorldFromBoom(std::int64_t time_ns) const {
  return world_from_barrier * BarrierFromBoom(Angle_rad(time_ns));
}

std::string BoomName(const std::string& crossing, double side) {
  return crossing + (side > 0.0 ? "/left" : "/right");
}

}  // namespace railcast
