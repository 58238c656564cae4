#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "railcast/lidar.h"

namespace railcast {

/// One firing of a pattern under construction.
struct Firing {
  /// Left positive, 0 = forward; not wrapped, so that the start and end of a full turn differ.
  double azimuth_rad{};
  double elevation_rad{};  ///< Up positive.
  std::int64_t time_ns{};  ///< Since the stamp.
  std::uint16_t row{};     ///< 0 is the lowest channel.
  std::uint32_t column{};
};

/// The firings of one frame, in any order, and the size of the grid they fill.
struct FiringGrid {
  std::uint32_t rows{};
  std::uint32_t columns{};
  std::vector<Firing> firings;
};

/// Larger frames (this one takes about 1 GB) are assumed to be a mistake in the input.
inline constexpr std::size_t kMaxNumFirings = std::size_t{1} << 24U;

inline constexpr double kNsPerUs = 1e3;

/// The fault of a number that breaks a rule.
[[nodiscard]] Fault FaultOf(std::string_view place, std::string_view rule, double got);

// Each of these functions makes one kind of pattern. Faults are appended to `errors`, with pointers
// relative to the scan object; the result is empty if `errors` is not. The caller has already
// reported an invalid `rate_hz`.
[[nodiscard]] FiringGrid RasterFirings(const RasterSpec& spec, double rate_hz, ErrorList& errors);
[[nodiscard]] FiringGrid SpinningFirings(const SpinningSpec& spec,
                                         double rate_hz,
                                         ErrorList& errors);
/// Faults in the file read "file:line: column: rule (got ...)".
[[nodiscard]] FiringGrid TableFirings(const FiringTableSpec& spec, ErrorList& errors);
/// As TableFirings(), for a stream that messages call `shown`.
[[nodiscard]] FiringGrid ParseFiringTable(std::istream& file,
                                          const std::string& shown,
                                          ErrorList& errors);

}  // namespace railcast
