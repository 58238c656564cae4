#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/scan/firing.h"
#include "core/scan/spinning_pattern.h"
#include "railcast/transform.h"

namespace railcast {
namespace {

constexpr double kQuarterTurn_rad = 0.5 * std::numbers::pi;
constexpr std::size_t kMaxNumPrisms = 4;
// Sine of the angle from the normal up to which light leaves a prism: next to 1, where rounding
// would decide.
constexpr double kMostSine = 0.9999;

// Snell's law in vector form: a ray that passes a face along its normal. All vectors have length 1.
// @param ratio Refractive index before the face over that behind it.
Vector3 Refracted(const Vector3& ray, const Vector3& normal, double ratio) {
  const double cosine = ray.dot(normal);
  const double cosine_behind = std::sqrt(1.0 - ratio * ratio * (1.0 - cosine * cosine));
  return ratio * ray + (cosine_behind - ratio * cosine) * normal;
}

/// A prism at an instant: the normals of its faces, along the light.
struct TurnedPrism {
  Vector3 entry = Vector3::UnitX();
  Vector3 exit = Vector3::UnitX();
  double refractive_index = 1.0;

  [[nodiscard]] Vector3 Behind(const Vector3& ray) const {
    return Refracted(Refracted(ray, entry, 1.0 / refractive_index), exit, refractive_index);
  }
};

// The first prism is the only one whose inclined face is the exit.
TurnedPrism PrismAt(const PrismSpec& spec, bool is_first, double turns) {
  const double wedge_rad = RadFromDeg(spec.wedge_deg);
  const double angle_rad = RadFromDeg(spec.start_deg) + 2.0 * std::numbers::pi * turns;
  // Light bends to the normal of a face that it enters, and away from that of one that it leaves.
  const double lean = is_first ? -std::sin(wedge_rad) : std::sin(wedge_rad);
  const Vector3 inclined(std::cos(wedge_rad), lean * std::cos(angle_rad),
                         lean * std::sin(angle_rad));
  const Vector3 axis = Vector3::UnitX();
  return is_first ? TurnedPrism{axis, inclined, spec.refractive_index}
                  : TurnedPrism{inclined, axis, spec.refractive_index};
}

Vector3 BeamOf(const ChannelSpec& channel) {
  const double azimuth_rad = RadFromDeg(channel.azimuth_deg);
  const double elevation_rad = RadFromDeg(channel.elevation_deg);
  return {std::cos(elevation_rad) * std::cos(azimuth_rad),
          std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

// An upper bound of the angle from the axis behind a prism, however it is turned; nothing if a beam
// may be reflected totally.
//
// Where a face is inclined by the wedge, a ray meets it at most so much steeper. Leaving glass
// bends a ray the more, the steeper it meets the face. Entering glass brings it nearer to the
// normal, between where it came from and the normal.
// @param angle_rad The same bound before the prism.
std::optional<double> MostBehind(const PrismSpec& prism, bool is_first, double angle_rad) {
  const double wedge_rad = RadFromDeg(prism.wedge_deg);
  const double index = prism.refractive_index;
  if (!(angle_rad < kQuarterTurn_rad)) return std::nullopt;
  const double steepest_rad =
      wedge_rad + (is_first ? std::asin(std::sin(angle_rad) / index) : angle_rad);
  if (!(steepest_rad < kQuarterTurn_rad)) return std::nullopt;
  const double inside_rad = is_first
                                ? steepest_rad
                                : std::min(std::max(angle_rad, wedge_rad),
                                           wedge_rad + std::asin(std::sin(steepest_rad) / index));
  if (!(inside_rad < kQuarterTurn_rad && index * std::sin(inside_rad) < kMostSine)) {
    return std::nullopt;
  }
  return std::asin(index * std::sin(inside_rad)) - (is_first ? wedge_rad : 0.0);
}

void CheckPrism(const PrismSpec& prism, const std::string& place, ErrorList& errors) {
  if (!(prism.wedge_deg >= 0.0 && prism.wedge_deg <= 60.0)) {
    errors.Add(FaultOf(place + "/wedge_deg", "must be >= 0 and <= 60", prism.wedge_deg));
  }
  if (!(prism.refractive_index >= 1.0 && prism.refractive_index <= 4.0)) {
    errors.Add(
        FaultOf(place + "/refractive_index", "must be >= 1 and <= 4", prism.refractive_index));
  }
  if (!(std::abs(prism.turns_hz) <= 10'000.0)) {
    errors.Add(FaultOf(place + "/turns_hz", "must be >= -10000 and <= 10000", prism.turns_hz));
  }
  if (!(std::abs(prism.start_deg) <= 360.0)) {
    errors.Add(FaultOf(place + "/start_deg", "must be >= -360 and <= 360", prism.start_deg));
  }
}

std::string PlaceOfPrism(std::size_t index) {
  return "/pattern/prisms/" + std::to_string(index);
}

void CheckPrisms(const std::vector<PrismSpec>& prisms, ErrorList& errors) {
  if (prisms.empty() || prisms.size() > kMaxNumPrisms) {
    errors.Add(
        FaultOf("/pattern/prisms", "must have 1 to 4 prisms", static_cast<double>(prisms.size())));
    return;
  }
  for (std::size_t i = 0; i < prisms.size(); ++i) CheckPrism(prisms[i], PlaceOfPrism(i), errors);
}

void CheckAllBeamsPass(const RisleySpec& spec, ErrorList& errors) {
  double angle_rad = 0.0;
  for (const ChannelSpec& channel : spec.channels) {
    angle_rad = std::max(angle_rad, std::acos(std::clamp(BeamOf(channel).x(), -1.0, 1.0)));
  }
  for (std::size_t i = 0; i < spec.prisms.size(); ++i) {
    const auto behind_rad = MostBehind(spec.prisms[i], i == 0, angle_rad);
    if (!behind_rad) {
      errors.Add(FaultOf(PlaceOfPrism(i) + "/wedge_deg",
                         "must be smaller, since beams may be reflected totally",
                         spec.prisms[i].wedge_deg));
      return;
    }
    angle_rad = *behind_rad;
  }
}

/// The prisms of a scanner in one frame.
class TurningPrisms {
 public:
  /// @param since_first_ns From the stamp of frame 0 to that of the frame.
  TurningPrisms(const std::vector<PrismSpec>& prisms, std::int64_t since_first_ns)
      : prisms_(prisms), turned_(prisms.size()) {
    for (const PrismSpec& prism : prisms) {
      // Whole turns would cost digits.
      turns_at_stamp_.push_back(
          std::remainder(prism.turns_hz * SecondsFromNs(since_first_ns), 1.0));
    }
  }

  void TurnTo(double time_us) {
    if (time_us == time_us_) return;
    time_us_ = time_us;
    for (std::size_t i = 0; i < prisms_.size(); ++i) {
      turned_[i] =
          PrismAt(prisms_[i], i == 0, turns_at_stamp_[i] + prisms_[i].turns_hz * time_us * 1e-6);
    }
  }
  [[nodiscard]] Vector3 Behind(Vector3 beam) const {
    for (const TurnedPrism& prism : turned_) beam = prism.Behind(beam);
    return beam;
  }

 private:
  const std::vector<PrismSpec>& prisms_;
  std::vector<double> turns_at_stamp_;
  double time_us_ = -1.0;  // Since the stamp.
  std::vector<TurnedPrism> turned_;
};

/// @param since_first_ns As TurningPrisms().
FiringGrid FiringsSince(const RisleySpec& spec, std::int64_t since_first_ns) {
  const std::vector<std::uint16_t> rows = RowsByElevation(spec.channels);
  std::vector<Vector3> beams;
  for (const ChannelSpec& channel : spec.channels) beams.push_back(BeamOf(channel));
  FiringGrid grid{
      .rows = static_cast<std::uint32_t>(rows.size()), .columns = spec.columns, .firings = {}};
  grid.firings.reserve(rows.size() * spec.columns);
  TurningPrisms prisms(spec.prisms, since_first_ns);
  for (std::uint32_t column = 0; column < spec.columns; ++column) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double time_us = column * spec.cycle_us + spec.channels[i].time_us;
      prisms.TurnTo(time_us);
      const Vector3 beam = prisms.Behind(beams[i]);
      grid.firings.push_back({.azimuth_rad = std::atan2(beam.y(), beam.x()),
                              .elevation_rad = std::atan2(beam.z(), beam.head<2>().norm()),
                              .time_ns = std::llround(time_us * kNsPerUs),
                              .row = rows[i],
                              .column = column});
    }
  }
  return grid;
}

}  // namespace

FramesOfFirings RisleyFirings(const RisleySpec& spec, double rate_hz, ErrorList& errors) {
  CheckCycles({spec.channels, spec.cycle_us, spec.columns}, rate_hz, errors);
  CheckPrisms(spec.prisms, errors);
  if (!errors.empty()) return {};
  CheckAllBeamsPass(spec, errors);
  if (!errors.empty()) return {};
  const auto of_frame = [spec](std::uint32_t, std::int64_t since_first_ns) {
    return FiringsSince(spec, since_first_ns);
  };
  return {FiringsSince(spec, 0), std::make_shared<const MovingFigure>(MovingFigure{of_frame})};
}

}  // namespace railcast
