#include "core/rail/line/map_place.h"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>

#include "core/base/units.h"

namespace railcast {
namespace {

constexpr double kEquatorialRadius_m = 6378137.0;
constexpr double kFlattening = 1.0 / 298.257223563;
constexpr double kThird = kFlattening / (2.0 - kFlattening);  ///< The third flattening.

/// Karney's equation 35: alpha_1 to alpha_4.
constexpr std::array<double, 4> kAlpha = {
    kThird * (1.0 / 2.0 + kThird * (-2.0 / 3.0 + kThird * (5.0 / 16.0 + kThird * 41.0 / 180.0))),
    kThird* kThird*(13.0 / 48.0 + kThird * (-3.0 / 5.0 + kThird * 557.0 / 1440.0)),
    kThird* kThird* kThird*(61.0 / 240.0 - kThird * 103.0 / 140.0),
    kThird* kThird* kThird* kThird * 49561.0 / 161280.0};

/// Radius of the sphere whose meridians are as long as the ellipsoid's.
constexpr double kRectifyingRadius_m =
    kEquatorialRadius_m / (1.0 + kThird) *
    (1.0 + kThird * kThird * (1.0 / 4.0 + kThird * kThird / 64.0));

/// Northing (real) and easting (imaginary) from the equator and a meridian.
std::complex<double> TransverseMercator_m(double east_of_meridian_rad, double latitude_rad) {
  const double eccentricity = std::sqrt(kFlattening * (2.0 - kFlattening));
  // Tangent of the conformal latitude.
  const double tangent =
      std::sinh(std::asinh(std::tan(latitude_rad)) -
                eccentricity * std::atanh(eccentricity * std::sin(latitude_rad)));
  const double cosine = std::cos(east_of_meridian_rad);
  const std::complex<double> sphere(
      std::atan2(tangent, cosine),
      std::asinh(std::sin(east_of_meridian_rad) / std::hypot(tangent, cosine)));
  std::complex<double> sum = sphere;
  for (std::size_t j = 0; j < kAlpha.size(); ++j) {
    sum += kAlpha[j] * std::sin(2.0 * static_cast<double>(j + 1) * sphere);
  }
  return kRectifyingRadius_m * sum;
}

/// The polynomial whose terms are x^i y^j, those of the least i + j and the greatest i first.
Eigen::Vector2d Polynomial_m(const std::vector<std::array<double, 2>>& coefficients_m,
                             const Eigen::Vector2d& place) {
  Eigen::Vector2d sum_m = Eigen::Vector2d::Zero();
  int order = 0;
  int of_y = 0;
  for (const std::array<double, 2>& coefficient_m : coefficients_m) {
    const double term = std::pow(place.x(), order - of_y) * std::pow(place.y(), of_y);
    sum_m += term * Eigen::Vector2d(coefficient_m[0], coefficient_m[1]);
    if (++of_y <= order) continue;
    ++order;
    of_y = 0;
  }
  return sum_m;
}

}  // namespace

Eigen::Vector2d WorldFromProjection(const MapSpec& map, const Eigen::Vector2d& place_m) {
  return place_m - Eigen::Vector2d(map.origin_m[0], map.origin_m[1]);
}

Eigen::Vector2d WorldFromGeographic(const MapSpec& map, double longitude_deg, double latitude_deg) {
  const double east_deg = std::remainder(longitude_deg - map.longitude_deg, 360.0);
  if (!(std::abs(east_deg) < 90.0)) {
    return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  const std::complex<double> there_m =
      TransverseMercator_m(RadFromDeg(east_deg), RadFromDeg(latitude_deg)) -
      TransverseMercator_m(0.0, RadFromDeg(map.latitude_deg));
  const Eigen::Vector2d place_m(there_m.imag(), there_m.real());
  if (map.coefficients_m.empty()) return WorldFromProjection(map, place_m);
  return Polynomial_m(map.coefficients_m, place_m / MapSpec::kUnit_m);
}

Eigen::Vector2d GeographicFromWorld(const MapSpec& map, const Eigen::Vector2d& place_m) {
  constexpr int kMostSteps = 20;
  constexpr double kEnough_m = 1e-6;
  // Sizes of the differences by which the derivatives are taken. They need not be exact.
  constexpr double kDifference_deg = 1e-4;
  Eigen::Vector2d there_deg(map.longitude_deg, map.latitude_deg);
  const auto world_at = [&](const Eigen::Vector2d& at_deg) {
    return WorldFromGeographic(map, at_deg.x(), at_deg.y());
  };
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::Vector2d here_m = world_at(there_deg);
    const Eigen::Vector2d off_m = place_m - here_m;
    if (off_m.norm() <= kEnough_m) return there_deg;
    Eigen::Matrix2d m_per_deg;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d beside_deg = there_deg + kDifference_deg * Eigen::Vector2d::Unit(axis);
      m_per_deg.col(axis) = (world_at(beside_deg) - here_m) / kDifference_deg;
    }
    there_deg += m_per_deg.inverse() * off_m;
  }
  return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace railcast
