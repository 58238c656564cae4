#include "core/fidelity/deviation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace railcast {

Deviation DeviationOf(const FrameDifference& difference) {
  const bool lacks_intensity =
      difference.echoes.num_matched > 0 && std::isnan(difference.intensity.median);
  const auto or_zero = [](double value) { return std::isnan(value) ? 0.0 : value; };
  return {or_zero(difference.range_m.median), 1.0 - difference.reference_echoes.share(),
          1.0 - difference.echoes.share(), 1.0 - difference.thin.share(),
          lacks_intensity ? std::numeric_limits<double>::infinity()
                          : or_zero(difference.intensity.median)};
}

bool IsWithin(const Deviation& deviation, const ToleranceSpec& tolerance) {
  return std::all_of(std::begin(kDeviationQuantities), std::end(kDeviationQuantities),
                     [&](const DeviationQuantity& quantity) {
                       return deviation.*quantity.value <= tolerance.*quantity.limit;
                     });
}

}  // namespace railcast
