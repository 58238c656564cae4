#include "core/simulate/frame_motion.h"

#include <iterator>

#include "core/simulate/wind.h"

namespace railcast {

Vector3 SurfaceMotions::VelocityOf_mps(std::uint32_t surface,
                                       double shutter,
                                       const Vector3& place_m) const {
  const auto after = motions_.upper_bound(surface);
  if (after == motions_.begin()) return Vector3::Zero();
  const Motion& motion = std::prev(after)->second;
  if (surface - motion.first_surface >= motion.num_surfaces) return Vector3::Zero();
  const double share = motion.span ? BlowOffShare(*motion.span, place_m) : 1.0;
  return share * VelocityAt_mps(motion.fields, shutter, place_m);
}

}  // namespace railcast
