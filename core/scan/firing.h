#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/scan/scan_spec.h"

namespace railcast {

/// One firing of a pattern under construction.
struct Firing {
  double azimuth_rad{};    ///< Left positive, 0 = forward; unwrapped, so that a turn has two ends.
  double elevation_rad{};  ///< Up positive.
  std::int64_t time_ns{};  ///< Since the stamp.
  std::uint16_t row{};     ///< 0 is the lowest channel.
  std::uint32_t column{};
};

/// The firings of one frame in any order, and the grid they fill: rows x columns of them.
struct FiringGrid {
  std::uint32_t rows{};
  std::uint32_t columns{};
  std::vector<Firing> firings;
};

/// More in one frame (about 1 GB of it) is taken for a slip in the input.
inline constexpr std::size_t kMaxNumFirings = std::size_t{1} << 24U;

/// A fault line: "place: rule (got value)", the value in the fewest digits that give it back.
[[nodiscard]] std::string Fault(std::string_view place, std::string_view rule, double got);

// Each makes one kind of pattern. Faults go to `errors`, with pointers relative to the scan object;
// the result is empty if there is any. A faulty `rate_hz` is in `errors` already.
[[nodiscard]] FiringGrid RasterFirings(const RasterSpec& spec, double rate_hz, ErrorList& errors);
[[nodiscard]] FiringGrid SpinningFirings(const SpinningSpec& spec,
                                         double rate_hz,
                                         ErrorList& errors);
/// Lines of the file are named "file:line: column: rule (got ...)".
[[nodiscard]] FiringGrid TableFirings(const FiringTableSpec& spec, ErrorList& errors);
/// The same of what a file holds, which messages call `shown`.
[[nodiscard]] FiringGrid ParseFiringTable(std::istream& file,
                                          const std::string& shown,
                                          ErrorList& errors);

}  // namespace railcast
