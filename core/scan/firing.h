#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "railcast/lidar.h"
#include "railcast/transform.h"

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

/// Gives the firings of the frames of a pattern that does not repeat. Between frames only azimuths
/// and elevations differ.
struct MovingFigure {
  /// @param since_first_ns From the stamp of frame 0 to that of the frame.
  std::function<FiringGrid(std::uint32_t frame_index, std::int64_t since_first_ns)> firings_of;
};

/// The firings of frame 0, and what gives those of later frames if they differ.
struct FramesOfFirings {
  FiringGrid first;
  std::shared_ptr<const MovingFigure> figure{};
};

/// The direction of a firing's beam, and from where it leaves, in the sensor's axes.
[[nodiscard]] Vector3 BeamDirection(const ScanPattern& pattern, std::size_t firing);
[[nodiscard]] Vector3 BeamOrigin_m(const ScanPattern& pattern, std::size_t firing);

/// Larger frames (this one takes about 1 GB) are assumed to be a mistake in the input.
inline constexpr std::size_t kMaxNumFirings = std::size_t{1} << 24U;

/// The fault of a number that breaks a rule.
[[nodiscard]] Fault FaultOf(std::string_view place, std::string_view rule, double got);

// Each of these functions makes one kind of pattern. Faults are appended to `errors`, with pointers
// relative to the scan object; the result is empty if `errors` is not. The caller has already
// reported an invalid `rate_hz`.
[[nodiscard]] FiringGrid RasterFirings(const RasterSpec& spec, double rate_hz, ErrorList& errors);
[[nodiscard]] FiringGrid SpinningFirings(const SpinningSpec& spec,
                                         double rate_hz,
                                         ErrorList& errors);
[[nodiscard]] FramesOfFirings RisleyFirings(const RisleySpec& spec,
                                            double rate_hz,
                                            ErrorList& errors);
/// Faults in the file read "file:line: column: rule (got ...)".
[[nodiscard]] FramesOfFirings TableFirings(const FiringTableSpec& spec,
                                           double rate_hz,
                                           ErrorList& errors);
/// The firings of a table whose file is an AT128's, each frame the sweep of a mirror.
[[nodiscard]] FramesOfFirings At128Firings(const FiringTableSpec& spec,
                                           double rate_hz,
                                           ErrorList& errors);

/// A stream with a firing table.
struct FiringTableText {
  std::istream& text;
  std::string shown;  ///< What messages call it.
  std::uint32_t num_frames = 1;
};
/// The firings of each frame of a table.
[[nodiscard]] std::vector<FiringGrid> ParseFiringTable(FiringTableText table,
                                                       double rate_hz,
                                                       ErrorList& errors);

}  // namespace railcast
