#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "railcast/enum_names.h"

namespace railcast {

/// Whether a raster is scanned column by column from the left, or row by row from the lowest.
enum class RasterOrder { kColumns, kRows };
template <>
inline constexpr auto kEnumNames<RasterOrder> = std::to_array<EnumName<RasterOrder>>(
    {{RasterOrder::kColumns, "columns"}, {RasterOrder::kRows, "rows"}});

/// A rectangular grid of directions, as the published system (Vir2Rail, README.md) scans it.
///
/// Beams pass through the centres of the cells: 60 x 30 deg at 0.25 deg give 240 x 120 cells, the
/// published 28,800 beams. The columns fire one after another, spread evenly over 1 / rate_hz; all
/// rows of a column fire simultaneously. With RasterOrder::kRows, rows and columns change places.
struct RasterSpec {
  double horizontal_fov_deg{};  ///< > 0, <= 360, symmetric about +x.
  double vertical_fov_deg{};    ///< > 0, <= 180, symmetric about the horizon.
  /// > 0; must divide both fields of view to within 1e-6 of a cell.
  double angular_resolution_deg{};
  RasterOrder order = RasterOrder::kColumns;

  bool operator==(const RasterSpec&) const = default;
};

/// The sense of rotation of a sensor's rotor, seen from above.
enum class Rotation { kClockwise, kCounterclockwise };
template <>
inline constexpr auto kEnumNames<Rotation> = std::to_array<EnumName<Rotation>>(
    {{Rotation::kClockwise, "clockwise"}, {Rotation::kCounterclockwise, "counterclockwise"}});

/// One laser of a spinning sensor, or of one with prisms.
struct ChannelSpec {
  double elevation_deg{};  ///< Up positive.
  /// In a SpinningSpec: offset from the rotor's azimuth, positive in the sense of rotation. In a
  /// RisleySpec: azimuth of the beam before the prisms, left positive.
  double azimuth_deg{};
  double time_us{};  ///< Time since the start of the firing cycle; the earliest is 0.

  bool operator==(const ChannelSpec&) const = default;
};

/// A spinning sensor: channels that each fire once per firing cycle while the rotor turns.
///
/// All azimuths are positive in the sense of rotation, as in vendors' manuals: the azimuths of a
/// clockwise sensor grow to the right. A firing at time t has the azimuth
/// start_azimuth_deg + 360 rate_hz t + the channel's azimuth_deg. The rows of a frame are the
/// channels by rising elevation, its columns are the firing cycles. A frame consists of a fixed
/// number of cycles, and stamps are exactly 1 / rate_hz apart, so columns x cycle_us must not
/// exceed 1 / rate_hz.
struct SpinningSpec {
  std::vector<ChannelSpec> channels;  ///< In the vendor's laser order.
  double cycle_us{};                  ///< Duration of a firing cycle.
  std::uint32_t columns{};            ///< Firing cycles per frame, also outside the azimuth window.
  Rotation rotation = Rotation::kClockwise;
  double start_azimuth_deg{};  ///< Azimuth of the rotor at the stamp; 0 = forward (+x).
  /// The point from which beams leave and ranges count: its distance from the rotor's axis, at the
  /// rotor's azimuth, and its height above the sensor's origin. Absent: the sensor's origin.
  std::optional<std::array<double, 2>> beam_origin_m{};
  /// The rotor's first and last azimuth at which the sensor fires, 0 to 360 in the sense of
  /// rotation; the window passes 0 if the last is smaller than the first. A cycle that begins
  /// outside is not fired and has no column in the frame. Absent: all cycles fire.
  std::optional<std::array<double, 2>> azimuth_window_deg{};

  bool operator==(const SpinningSpec&) const = default;
};

/// A glass wedge that turns about the sensor's x axis and bends the beams towards its thick side.
struct PrismSpec {
  double wedge_deg{};         ///< Angle between its two faces, >= 0 and <= 60.
  double refractive_index{};  ///< Refractive index of the glass against air, >= 1 and <= 4.
  double turns_hz{};          ///< Turns per second, at most 10,000; positive turns left to up.
  double start_deg{};         ///< Where its thick side is at frame 0's stamp: 0 = left, 90 = up.

  bool operator==(const PrismSpec&) const = default;
};

/// A Risley scanner, as in sensors whose figure does not repeat: all beams pass the same prisms,
/// each of which turns at its own speed. The prisms keep turning from frame to frame, so that each
/// frame continues the figure where the one before it ended.
///
/// Light is refracted exactly, by Snell's law at every face, as Brazeal et al. 2021 (doi
/// 10.3390/s21144722) model a Livox Mid-40; thin prisms would simply add deflections of (index - 1)
/// x wedge. The face of the first prism towards the lasers is perpendicular to the axis, as is the
/// outer face of every other prism; the opposite faces are inclined by the wedge. The sideways
/// shift of the beams inside the prisms, some millimetres, is neglected. Rows and columns are as in
/// SpinningSpec.
struct RisleySpec {
  std::vector<ChannelSpec> channels;  ///< The beams before the prisms.
  double cycle_us{};                  ///< Duration of a firing cycle.
  std::uint32_t columns{};        ///< Firing cycles per frame; columns x cycle_us <= 1 / rate_hz.
  std::vector<PrismSpec> prisms;  ///< 1 to 4, in the order in which the light passes them.

  bool operator==(const RisleySpec&) const = default;
};

/// An arbitrary sequence of firings, read from a CSV file with the header
/// `azimuth_deg,elevation_deg,time_us`: azimuth positive to the left (counterclockwise), time from
/// 0 and non-decreasing. The frame has one row and a column for each firing. With a fourth column,
/// `ring`, it has a row for each ring, 0 the lowest, and a column for each of the ring's firings;
/// all rings must have the same number of firings.
///
/// A table of several frames is played frame by frame and then starts over. Its frames must have
/// the same number of firings, and the same rings at the same times since the stamp, within 1 us.
///
/// The file may also be the correction file of a Hesai AT128 (.dat). Its three frames are the
/// sweeps of the sensor's three mirrors.
struct FiringTableSpec {
  std::string file;          ///< Relative to the file that refers to it.
  std::uint32_t frames = 1;  ///< Number of frames in the table, > 0.

  bool operator==(const FiringTableSpec&) const = default;
};

/// How a sensor scans: the frame rate and one of four kinds of pattern.
struct ScanSpec {
  double rate_hz{};  ///< Frames per second, > 0.
  std::variant<RasterSpec, SpinningSpec, RisleySpec, FiringTableSpec> pattern;
  double phase_s = 0.0;  ///< Stamp of frame 0; >= 0 and < 1 / rate_hz.

  bool operator==(const ScanSpec&) const = default;
};

/// Position and orientation of a sensor or a camera on the vehicle.
struct MountSpec {
  std::array<double, 3> position_m{0.0, 0.0, 2.5};  ///< In the vehicle frame.
  double yaw_deg = 0.0;                             ///< Positive to the left.
  double pitch_deg = 0.0;                           ///< Positive nose down.
  double roll_deg = 0.0;                            ///< Positive right side down.

  bool operator==(const MountSpec&) const = default;
};

/// Rays per packet: Embree traces 16 rays at once.
inline constexpr std::size_t kPacketSize = 16;

/// Computes the directions of each frame where frames differ; see ScanPattern::repeats().
struct MovingFigure;

/// The firings of one frame: a table of directions and times.
///
/// BuildScanPattern() makes it. It is not changed afterwards, so that threads may share one
/// pattern. All per-firing arrays have num_firings() elements in order of time (ties: by row, then
/// by column).
struct ScanPattern {
  double rate_hz{};
  std::int64_t phase_ns{};  ///< Stamp of frame 0.
  std::uint32_t rows{};
  std::uint32_t columns{};

  std::vector<float> direction_x, direction_y, direction_z;  ///< Unit vectors in the sensor frame.
  /// Where the beams leave, in the sensor frame; empty if all of them leave at its origin.
  std::vector<float> origin_x_m, origin_y_m, origin_z_m;
  std::vector<std::uint32_t> time_ns;  ///< Time since the stamp.
  std::vector<std::uint16_t> row;      ///< Ring; 0 is the lowest channel.
  std::vector<std::uint32_t> column;

  /// Firing indices by packet: each run of kPacketSize firings is traced as one packet. The size is
  /// num_firings() rounded up to a multiple of kPacketSize; the last packet is padded with its last
  /// firing. The firings of a packet are neighbours in angle, so that packets are coherent. The
  /// order is fixed, because what a ray on a vertex or edge hits depends on its packet.
  std::vector<std::uint32_t> packet_order;

  /// Null if all frames have the same directions.
  std::shared_ptr<const MovingFigure> figure;

  /// Whether all frames have the same firings. Otherwise directions and packet_order are those of
  /// one frame, and PatternOfFrame() gives those of any other; all else is the same in all frames.
  [[nodiscard]] bool repeats() const { return figure == nullptr; }
  [[nodiscard]] std::size_t num_firings() const { return time_ns.size(); }
  /// Stamp of a frame, the simulation time from which its time_ns count: phase_ns for frame 0.
  /// Stamps are exactly 1 / rate_hz apart.
  /// @pre frame_index <= LastFrame().
  [[nodiscard]] std::int64_t StampNs(std::uint32_t frame_index) const;
  /// From one stamp to the next: 1 / rate_hz, rounded.
  [[nodiscard]] std::int64_t PeriodNs() const { return StampNs(1) - StampNs(0); }
  /// Index of the last frame whose times in nanoseconds fit into 64 bits (292 years).
  [[nodiscard]] std::uint32_t LastFrame() const;
};

/// Index of the firing that fills a slot of a frame of this pattern.
/// @param returns Number of slots per firing.
/// @pre returns > 0 and slot < rows * columns * returns.
[[nodiscard]] std::uint32_t FiringOfSlot(const ScanPattern& pattern,
                                         std::uint32_t returns,
                                         std::size_t slot);

/// Returns a sensor's pattern in a frame, which depends on nothing but the frame's index. If the
/// pattern repeats, it is a copy of `pattern`.
/// @param pattern The sensor's pattern in any frame.
/// @pre frame_index <= pattern.LastFrame().
[[nodiscard]] ScanPattern PatternOfFrame(const ScanPattern& pattern, std::uint32_t frame_index);

/// Builds the table of firings of a scan, in frame 0:
///
///   const ScanPattern pattern = BuildScanPattern({.rate_hz = 10.0, .pattern = RasterSpec{...}});
///
/// @throws InputError if the spec has no firing or more than 2^24, a number of cells is not whole,
///   a frame lasts longer than 1 / rate_hz or 4.29 s (time_ns has 32 bits), frame 0 does not begin
///   within the first 1 / rate_hz, a beam may be reflected totally in a prism, or the firing table
///   cannot be read. The message has a line for every fault, with pointers relative to the scan
///   object: "/pattern/cycle_us: must be > 0 (got -1)"; lines about a table name its file and line.
[[nodiscard]] ScanPattern BuildScanPattern(const ScanSpec& spec);

}  // namespace railcast
