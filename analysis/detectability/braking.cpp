#include "analysis/detectability/braking.h"

#include "core/base/error.h"
#include "core/base/number_text.h"

namespace railcast {

Stop StopOf(const BrakingSpec& braking, double speed_mps, double gradient) {
  constexpr double kGravity_mps2 = 9.80665;
  const double deceleration_mps2 = braking.deceleration_mps2 + kGravity_mps2 * gradient;
  if (!(deceleration_mps2 > 0.0)) {
    constexpr double kPermil = 1000.0;
    throw InputError("deceleration: must be > " + NumberText(-kGravity_mps2 * gradient) +
                     " m/s2, or the train cannot stop at a gradient of " +
                     NumberText(kPermil * gradient) + " permil (got " +
                     NumberText(braking.deceleration_mps2) + ")");
  }
  return {.distance_m =
              speed_mps * braking.reaction_s + speed_mps * speed_mps / (2.0 * deceleration_mps2),
          .time_s = braking.reaction_s + speed_mps / deceleration_mps2};
}

}  // namespace railcast
