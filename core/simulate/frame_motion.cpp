#include "core/simulate/frame_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "core/base/units.h"
#include "core/simulate/wind.h"

namespace railcast {
namespace {

constexpr std::int64_t kApart_ns = 500'000;

/// The derivative at each of three places that are kApart_ns apart is the sum of the places with
/// these weights, over kApart_ns.
constexpr std::array<std::array<double, 3>, 3> kDerivative = {
    {{-1.5, 2.0, -0.5}, {-0.5, 0.0, 0.5}, {0.5, -2.0, 1.5}}};

/// Which of the three places about `time_ns` it is itself, so that none is outside the frame or, in
/// one too short for that, before it.
std::size_t OwnPlace(std::int64_t time_ns, std::int64_t duration_ns) {
  if (time_ns < kApart_ns) return 0;
  if (time_ns + kApart_ns <= duration_ns) return 1;
  return time_ns < 2 * kApart_ns ? 0 : 2;
}

}  // namespace

std::vector<VelocityFields> VelocityFieldsOf(const PlacesAt& places_at,
                                             std::int64_t duration_ns,
                                             std::int64_t num_intervals) {
  std::vector<VelocityFields> fields;
  for (std::int64_t step = 0; step <= num_intervals; ++step) {
    const std::int64_t time_ns = duration_ns * step / std::max<std::int64_t>(num_intervals, 1);
    const std::size_t own = OwnPlace(time_ns, duration_ns);
    std::array<std::vector<Eigen::Affine3d>, 3> places;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::int64_t away = static_cast<std::int64_t>(i) - static_cast<std::int64_t>(own);
      places[i] = places_at(time_ns + away * kApart_ns);
    }
    fields.resize(places[0].size());
    for (std::size_t thing = 0; thing < fields.size(); ++thing) {
      VelocityField change = VelocityField::Zero();
      for (std::size_t i = 0; i < places.size(); ++i) {
        change += kDerivative[own][i] * places[i][thing].matrix().topRows<3>();
      }
      fields[thing].emplace_back(change / SecondsFromNs(kApart_ns) *
                                 places[own][thing].inverse().matrix());
    }
  }
  return fields;
}

Vector3 VelocityAt_mps(const VelocityFields& fields, double shutter, const Vector3& place_m) {
  const double step = shutter * static_cast<double>(fields.size() - 1);
  const auto before = std::min(static_cast<std::size_t>(step), fields.size() - 1);
  const auto after = std::min(before + 1, fields.size() - 1);
  const double share = step - static_cast<double>(before);
  const VelocityField field = (1.0 - share) * fields[before] + share * fields[after];
  return field.leftCols<3>() * place_m + field.col(3);
}

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
