#include "generator/import/lines/speed_limits.h"

#include <charconv>
#include <cmath>
#include <cstddef>

namespace railcast {

std::optional<double> SpeedOf_kmph(std::string_view maxspeed) {
  constexpr double kMph = 1.609344;
  constexpr double kFastest_kmph = 1000.0;
  double speed = 0.0;
  const auto [end, error] =
      std::from_chars(maxspeed.data(), maxspeed.data() + maxspeed.size(), speed);
  if (error != std::errc{}) return std::nullopt;
  const std::string_view unit(end, static_cast<std::size_t>(maxspeed.end() - end));
  if (unit == " mph" || unit == "mph") {
    speed *= kMph;
  } else if (!unit.empty() && unit != " km/h") {
    return std::nullopt;
  }
  // "inf" and "nan" are numbers, too.
  return speed > 0.0 && speed <= kFastest_kmph ? std::optional(speed) : std::nullopt;
}

std::vector<double> SpeedsAlong_kmph(const RailMap& map,
                                     const TrackLine& line,
                                     double otherwise_kmph) {
  std::vector<std::optional<double>> given;
  std::vector<double> middle_m;  // Along the line.
  double along_m = 0.0;
  for (std::size_t i = 0; i < line.ways.size(); ++i) {
    given.push_back(SpeedOf_kmph(TagOf(map.ways[line.ways[i]].tags, "maxspeed")));
    const double length_m = StepLength_m(map, line, i);
    middle_m.push_back(along_m + 0.5 * length_m);
    along_m += length_m;
  }
  std::vector<double> speeds_kmph;
  for (std::size_t i = 0; i < given.size(); ++i) {
    std::optional<std::size_t> nearest;
    const auto consider = [&](std::size_t other) {
      const auto distance_m = [&](std::size_t way) {
        return std::abs(middle_m[way] - middle_m[i]);
      };
      if (!nearest || distance_m(other) < distance_m(*nearest)) nearest = other;
    };
    for (std::size_t before = i + 1; before-- > 0;) {
      if (!given[before]) continue;
      consider(before);
      break;
    }
    for (std::size_t after = i; after < given.size(); ++after) {
      if (!given[after]) continue;
      consider(after);
      break;
    }
    speeds_kmph.push_back(nearest ? *given[*nearest] : otherwise_kmph);
  }
  return speeds_kmph;
}

}  // namespace railcast
