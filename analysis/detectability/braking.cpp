#include "analysis/detectability/braking.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {

BrakedStop StopOf(const BrakingSpec& braking, double speed_mps, double gradient) {
  constexpr double kGravity_mps2 = 9.80665;
  const double deceleration_mps2 = braking.deceleration_mps2 + kGravity_mps2 * gradient;
  if (!(deceleration_mps2 > 0.0)) {
    const auto rounded = [](double value) { return std::round(1e3 * value) / 1e3; };
    constexpr double kPermil = 1e3;
    throw InputError("cannot stop: deceleration + g x gradient must be > 0 (got " +
                     NumberText(rounded(deceleration_mps2)) + " m/s2 at " +
                     NumberText(rounded(kPermil * gradient)) + " permil)");
  }
  return {.distance_m =
              speed_mps * braking.reaction_s + speed_mps * speed_mps / (2.0 * deceleration_mps2),
          .time_s = braking.reaction_s + speed_mps / deceleration_mps2};
}

}  // namespace railcast
