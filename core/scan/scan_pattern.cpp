#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/scan/firing.h"
#include "core/scan/spinning_pattern.h"
#include "railcast/lidar.h"

namespace railcast {
namespace {

/// Number of firings, in order of elevation, that form a band as high as the square covered by the
/// firings of one packet.
///
/// If n firings cover a x e (azimuth x elevation), each takes a e / n. A square of p firings has
/// the side sqrt(p a e / n), and a band of that height holds n / e times as many: sqrt(p n a / e).
/// @param has_level_rows Whether the firings of a row have one elevation: then bands are whole
/// rows.
std::size_t BandSize(const FiringGrid& grid, bool has_level_rows) {
  const auto [left, right] = std::ranges::minmax(grid.firings, {}, &Firing::azimuth_rad);
  const auto [low, high] = std::ranges::minmax(grid.firings, {}, &Firing::elevation_rad);
  const double width_rad = right.azimuth_rad - left.azimuth_rad;
  const double height_rad = high.elevation_rad - low.elevation_rad;
  const auto num_firings = static_cast<double>(grid.firings.size());
  const double whole_rows = grid.rows > 1 && has_level_rows ? grid.columns : 1;
  const double size = std::sqrt(kPacketSize * num_firings * width_rad / height_rad);
  if (!(size < num_firings)) return grid.firings.size();  // True also if the height is 0.
  return static_cast<std::size_t>(std::max(1.0, std::round(size / whole_rows)) * whole_rows);
}

// Assigns firings to packets (see ScanPattern::packet_order): every index of `grid.firings` once,
// with the last packet padded with its last firing.
//
// Firings are sorted by elevation and cut into bands about as high as the square that 16 firings
// cover on average. If the pattern is a grid, bands consist of whole rows: 4 rows of a uniform
// raster, 1 to 3 rows of a spinning sensor, whose channels are spaced wider than its columns. Each
// band is sorted by azimuth, alternately leftwards and rightwards, and the sequence of all bands
// is cut into packets. Every packet is therefore full, even where blocks of whole rows and columns
// would not fit, and compact, even if the channels of one column differ by several degrees in
// azimuth.
std::vector<std::uint32_t> PacketOrder(const FiringGrid& grid, bool has_level_rows) {
  const std::vector<Firing>& firings = grid.firings;
  std::vector<std::uint32_t> order(firings.size());
  std::iota(order.begin(), order.end(), 0U);
  if (order.empty()) return order;

  std::ranges::sort(order, {}, [&](std::uint32_t i) {
    return std::tuple(firings[i].elevation_rad, firings[i].row, i);
  });
  const std::size_t band_size = BandSize(grid, has_level_rows);
  bool leftward = false;
  for (std::size_t begin = 0; begin < order.size(); begin += band_size) {
    const std::size_t end = std::min(begin + band_size, order.size());
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(begin),
              order.begin() + static_cast<std::ptrdiff_t>(end),
              [&](std::uint32_t i, std::uint32_t j) {
                const double to_right_rad = firings[j].azimuth_rad - firings[i].azimuth_rad;
                if (to_right_rad != 0.0) return leftward ? to_right_rad > 0.0 : to_right_rad < 0.0;
                return i < j;
              });
    leftward = !leftward;
  }
  const std::uint32_t last = order.back();
  while (order.size() % kPacketSize != 0) order.push_back(last);
  return order;
}

FramesOfFirings MakeFirings(const ScanSpec& spec, ErrorList& errors) {
  if (const auto* raster = std::get_if<RasterSpec>(&spec.pattern)) {
    return {RasterFirings(*raster, spec.rate_hz, errors)};
  }
  if (const auto* spinning = std::get_if<SpinningSpec>(&spec.pattern)) {
    return {SpinningFirings(*spinning, spec.rate_hz, errors)};
  }
  if (const auto* risley = std::get_if<RisleySpec>(&spec.pattern)) {
    return RisleyFirings(*risley, spec.rate_hz, errors);
  }
  return TableFirings(std::get<FiringTableSpec>(spec.pattern), spec.rate_hz, errors);
}

void SortByTime(FiringGrid& grid) {
  std::ranges::sort(grid.firings, {}, [](const Firing& firing) {
    return std::tuple(firing.time_ns, firing.row, firing.column);
  });
}

// Sets what differs between the frames of a pattern that does not repeat.
// @pre The firings are in the pattern's order.
void Aim(const FiringGrid& grid, ScanPattern& pattern) {
  const std::size_t num_firings = grid.firings.size();
  pattern.direction_x.resize(num_firings);
  pattern.direction_y.resize(num_firings);
  pattern.direction_z.resize(num_firings);
  for (std::size_t i = 0; i < num_firings; ++i) {
    const Firing& firing = grid.firings[i];
    const double horizontal = std::cos(firing.elevation_rad);
    pattern.direction_x[i] = static_cast<float>(horizontal * std::cos(firing.azimuth_rad));
    pattern.direction_y[i] = static_cast<float>(horizontal * std::sin(firing.azimuth_rad));
    pattern.direction_z[i] = static_cast<float>(std::sin(firing.elevation_rad));
  }
  pattern.packet_order = PacketOrder(grid, pattern.repeats());
}

/// @param last_ns Time of the last firing.
void CheckLength(double rate_hz, std::int64_t last_ns, ErrorList& errors) {
  if (static_cast<double>(last_ns) >= kNsPerS / rate_hz) {
    errors.Add(FaultOf("/pattern", "the last firing must come before 1 / rate_hz",
                       static_cast<double>(last_ns) / kNsPerS));
  }
  if (last_ns > std::numeric_limits<std::uint32_t>::max()) {
    errors.Add(FaultOf("/pattern", "the last firing must come before 4.29 s",
                       static_cast<double>(last_ns) / kNsPerS));
  }
}

}  // namespace

Fault FaultOf(std::string_view place, std::string_view rule, double got) {
  return {std::string(place), std::string(rule), NumberText(got)};
}

std::int64_t ScanPattern::StampNs(std::uint32_t frame_index) const {
  const std::uint64_t frames_ns = frame_index * std::uint64_t{1'000'000'000};
  if (rate_hz == std::floor(rate_hz)) {
    const auto rate = static_cast<std::uint64_t>(rate_hz);
    return phase_ns + static_cast<std::int64_t>((frames_ns + rate / 2) / rate);
  }
  // A mantissa of 64 bits represents frames_ns exactly, so only the quotient is rounded.
  return phase_ns +
         std::llround(static_cast<long double>(frames_ns) / static_cast<long double>(rate_hz));
}

std::uint32_t ScanPattern::LastFrame() const {
  // A frame's firings are up to 2^32 ns after its stamp.
  const auto last_stamp_ns = static_cast<long double>(std::numeric_limits<std::int64_t>::max() -
                                                      (std::int64_t{1} << 32) - phase_ns);
  constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
  const long double last = std::floor(last_stamp_ns / static_cast<long double>(kNsPerS) *
                                      static_cast<long double>(rate_hz));
  return last < static_cast<long double>(kMost) ? static_cast<std::uint32_t>(last) : kMost;
}

std::uint32_t FiringOfSlot(const ScanPattern& pattern, std::uint32_t returns, std::size_t slot) {
  const std::size_t cell = slot / returns;
  const std::size_t row = cell / pattern.columns;
  const std::size_t column = cell % pattern.columns;
  std::uint32_t firing = 0;
  while (firing < pattern.num_firings() &&
         (pattern.row[firing] != row || pattern.column[firing] != column)) {
    ++firing;
  }
  Check(firing < pattern.num_firings(), "a slot of a frame has a firing");
  return firing;
}

ScanPattern BuildScanPattern(const ScanSpec& spec) {
  ErrorList errors;
  if (!(spec.rate_hz >= 0.01 && spec.rate_hz <= 1e6)) {
    errors.Add(FaultOf("/rate_hz", "must be >= 0.01 and <= 1000000", spec.rate_hz));
  }
  if (!(spec.phase_s >= 0.0 && spec.phase_s * spec.rate_hz < 1.0)) {
    errors.Add(FaultOf("/phase_s", "must be >= 0 and < 1 / rate_hz", spec.phase_s));
  }
  auto [grid, figure] = MakeFirings(spec, errors);
  errors.ThrowIfAny();
  SortByTime(grid);
  CheckLength(spec.rate_hz, grid.firings.back().time_ns, errors);
  errors.ThrowIfAny();

  ScanPattern pattern;
  pattern.rate_hz = spec.rate_hz;
  pattern.phase_ns = std::llround(spec.phase_s * kNsPerS);
  pattern.rows = grid.rows;
  pattern.columns = grid.columns;
  pattern.figure = std::move(figure);
  for (const Firing& firing : grid.firings) {
    pattern.time_ns.push_back(static_cast<std::uint32_t>(firing.time_ns));
    pattern.row.push_back(firing.row);
    pattern.column.push_back(firing.column);
  }
  Aim(grid, pattern);
  const auto* const spinning = std::get_if<SpinningSpec>(&spec.pattern);
  if (spinning != nullptr && spinning->beam_origin_m) AddBeamOrigins(*spinning, pattern);
  return pattern;
}

Vector3 BeamDirection(const ScanPattern& pattern, std::size_t firing) {
  return Eigen::Vector3f(pattern.direction_x[firing], pattern.direction_y[firing],
                         pattern.direction_z[firing])
      .cast<double>();
}

Vector3 BeamOrigin_m(const ScanPattern& pattern, std::size_t firing) {
  if (pattern.origin_x_m.empty()) return Vector3::Zero();
  return Eigen::Vector3f(pattern.origin_x_m[firing], pattern.origin_y_m[firing],
                         pattern.origin_z_m[firing])
      .cast<double>();
}

ScanPattern PatternOfFrame(const ScanPattern& pattern, std::uint32_t frame_index) {
  ScanPattern of_frame = pattern;
  if (pattern.repeats()) return of_frame;
  FiringGrid grid =
      pattern.figure->firings_of(frame_index, pattern.StampNs(frame_index) - pattern.phase_ns);
  SortByTime(grid);
  Aim(grid, of_frame);
  return of_frame;
}

}  // namespace railcast
