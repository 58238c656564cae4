#include "analysis/estimate/intervals.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace railcast {

double NormalQuantile() {
  return boost::math::quantile(boost::math::normal(), 1.0 - kTail);
}

double StudentQuantile(double degrees) {
  return boost::math::quantile(boost::math::students_t(degrees), 1.0 - kTail);
}

Estimate ScaleEstimate(double scale, double degrees, std::uint64_t num) {
  const boost::math::chi_squared distribution(degrees);
  return {scale, scale * std::sqrt(degrees / boost::math::quantile(distribution, 1.0 - kTail)),
          scale * std::sqrt(degrees / boost::math::quantile(distribution, kTail)), num};
}

}  // namespace railcast
