#include <array>
#include <cmath>
#include <istream>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/base/text_number.h"
#include "core/base/units.h"
#include "core/scan/at128.h"
#include "core/scan/firing.h"

namespace railcast {
namespace {

constexpr std::string_view kHeader = "azimuth_deg,elevation_deg,time_us";
constexpr std::string_view kRingHeader = "azimuth_deg,elevation_deg,time_us,ring";
constexpr std::array<std::string_view, 4> kNames = {"azimuth_deg", "elevation_deg", "time_us",
                                                    "ring"};
constexpr double kMaxRing = 65535.0;
constexpr double kMaxTime_us = 4294967.0;  // Time in a frame is stored as 32-bit nanoseconds.
constexpr std::uint32_t kMaxNumFrames = 100'000;
// Between frames, times may differ by the rounding of what wrote the table.
constexpr std::int64_t kSameTime_ns = 1000;
// A file that is not a table at all has a fault in every line.
constexpr std::size_t kMaxNumFaults = 20;

/// The numbers of a line; the ring is 0 where the file has none.
using Values = std::array<double, kNames.size()>;

std::string_view Trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Parses the numbers of a line, as many as there are columns. Returns false, with faults in
/// `errors`, if it fails.
bool ParseLine(std::string_view line,
               std::size_t num_columns,
               const std::string& place,
               Values& values,
               ErrorList& errors) {
  std::array<std::string_view, kNames.size()> cells;
  std::string_view rest = line;
  std::size_t num_cells = 0;
  for (bool more = true; more; ++num_cells) {
    const std::size_t comma = rest.find(',');
    more = comma != std::string_view::npos;
    if (num_cells < num_columns) cells[num_cells] = Trimmed(rest.substr(0, comma));
    if (more) rest.remove_prefix(comma + 1);
  }
  if (num_cells != num_columns) {
    const std::string rule = "must have " + NumberText(num_columns) + " values";
    errors.Add(FaultOf(place, rule, static_cast<double>(num_cells)));
    return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < num_columns; ++i) {
    const auto value = ParseTextNumber<double>(cells[i]);
    values[i] = value.value_or(0.0);
    if (value && std::isfinite(*value)) continue;
    const char* const rule = value ? "must be finite" : "not a number";
    errors.Add({place + ": " + std::string(kNames[i]), rule, Quoted(cells[i])});
    good = false;
  }
  return good;
}

/// The times that a line may have.
struct TimeLimits {
  double last_us{};  ///< Time of the previous line; negative for the first.
  double most_us{};
};

void CheckValues(const Values& values,
                 const TimeLimits& limits,
                 const std::string& place,
                 ErrorList& errors) {
  const auto [azimuth_deg, elevation_deg, time_us, ring] = values;
  if (std::abs(azimuth_deg) > 360.0) {
    errors.Add(FaultOf(place + ": azimuth_deg", "must be >= -360 and <= 360", azimuth_deg));
  }
  if (std::abs(elevation_deg) > 90.0) {
    errors.Add(FaultOf(place + ": elevation_deg", "must be >= -90 and <= 90", elevation_deg));
  }
  if (limits.last_us < 0.0 && time_us != 0.0) {
    errors.Add(FaultOf(place + ": time_us", "the first must be 0", time_us));
  } else if (time_us < limits.last_us) {
    errors.Add(FaultOf(place + ": time_us", "must not decrease", time_us));
  } else if (time_us > limits.most_us) {
    errors.Add(FaultOf(place + ": time_us", "must be <= " + NumberText(limits.most_us), time_us));
  }
  if (!(ring >= 0.0 && ring <= kMaxRing && ring == std::floor(ring))) {
    errors.Add(FaultOf(place + ": ring", "must be a whole number from 0 to 65535", ring));
  }
}

/// Checks that the rings are the rows of a grid: each has as many firings, and the elevations do
/// not fall from ring to ring.
/// @param num_firings, elevations_rad Of each ring: the number, and the sum of the elevations.
void CheckRings(const std::vector<std::uint32_t>& num_firings,
                const std::vector<double>& elevations_rad,
                const std::string& place,
                ErrorList& errors) {
  for (std::size_t ring = 1; ring < num_firings.size(); ++ring) {
    const std::string name = "ring " + NumberText(ring);
    if (num_firings[ring] != num_firings[0]) {
      errors.Add({place,
                  name + " must have as many firings as ring 0, " + NumberText(num_firings[0]) +
                      "; one that fires oftener is several",
                  NumberText(num_firings[ring])});
      return;
    }
    // Sums over as many firings. Their rounding is no fall.
    const double rise_deg = DegFromRad(elevations_rad[ring] - elevations_rad[ring - 1]);
    if (rise_deg < -1e-9 * num_firings[0]) {
      errors.Add({place, name + " must lie no lower, on average, than the ring before it",
                  ShortText(rise_deg / num_firings[0]) + " deg"});
      return;
    }
  }
}

/// Gives each firing its row and its column, the number of the ring's firings before it.
FiringGrid GridOf(std::vector<Firing> firings, const std::string& place, ErrorList& errors) {
  std::vector<std::uint32_t> num_firings;
  std::vector<double> elevations_rad;
  for (Firing& firing : firings) {
    if (firing.row >= num_firings.size()) {
      num_firings.resize(firing.row + std::size_t{1});
      elevations_rad.resize(num_firings.size());
    }
    firing.column = num_firings[firing.row]++;
    elevations_rad[firing.row] += firing.elevation_rad;
  }
  if (firings.empty()) return {};
  CheckRings(num_firings, elevations_rad, place, errors);
  return {.rows = static_cast<std::uint32_t>(num_firings.size()),
          .columns = num_firings[0],
          .firings = std::move(firings)};
}

// A firing of a later frame, which must repeat one of the first frame but for its direction.
void CheckRepeats(const Firing& firing,
                  const Firing& first,
                  std::int64_t since_first_ns,
                  const std::string& place,
                  ErrorList& errors) {
  const std::int64_t time_ns = first.time_ns + since_first_ns;
  if (std::abs(firing.time_ns - time_ns) > kSameTime_ns) {
    errors.Add(FaultOf(place + ": time_us",
                       "must be that of the same firing in the first frame, and the periods since, "
                       "to 1 us: " +
                           NumberText(static_cast<double>(time_ns) / kNsPerUs),
                       static_cast<double>(firing.time_ns) / kNsPerUs));
  }
  if (firing.row != first.row) {
    errors.Add(
        FaultOf(place + ": ring",
                "must be that of the same firing in the first frame, " + NumberText(first.row),
                firing.row));
  }
}

/// Cuts a table into frames of as many firings, which get the times and places of the first.
std::vector<FiringGrid> FramesOf(FiringGrid whole,
                                 const FiringTableText& table,
                                 double rate_hz,
                                 ErrorList& errors) {
  const std::size_t num_firings = whole.firings.size() / table.num_frames;
  if (num_firings * table.num_frames != whole.firings.size()) {
    errors.Add(FaultOf(
        table.shown,
        "must have as many firings in each of its " + NumberText(table.num_frames) + " frames",
        static_cast<double>(whole.firings.size())));
    return {};
  }
  std::vector<FiringGrid> frames(table.num_frames,
                                 {whole.rows, whole.columns / table.num_frames, {}});
  for (std::size_t i = 0; i < whole.firings.size(); ++i) {
    Firing& firing = whole.firings[i];
    const Firing& first = whole.firings[i % num_firings];
    const std::size_t frame = i / num_firings;
    CheckRepeats(firing, first, std::llround(kNsPerS * static_cast<double>(frame) / rate_hz),
                 table.shown + ":" + std::to_string(i + 2), errors);
    if (!errors.empty()) return {};
    firing.time_ns = first.time_ns;
    firing.column = first.column;
    frames[frame].firings.push_back(firing);
  }
  return frames;
}

}  // namespace

FramesOfFirings TableFirings(const FiringTableSpec& spec, double rate_hz, ErrorList& errors) {
  if (spec.frames == 0 || spec.frames > kMaxNumFrames) {
    errors.Add(FaultOf("/pattern/frames", "must be >= 1 and <= 100000", spec.frames));
    return {};
  }
  auto text = Attempt("/pattern/file: ", errors, [&] { return ReadTextWhole(spec.file); });
  if (!text) return {};
  if (IsAt128File(spec.file)) return At128Firings(spec, rate_hz, errors);
  std::istringstream lines(*std::move(text));
  auto frames = ParseFiringTable({lines, ShownPath(spec.file), spec.frames}, rate_hz, errors);
  if (!errors.empty()) return {};
  if (frames.size() == 1) return {std::move(frames.front())};
  const auto shared = std::make_shared<const std::vector<FiringGrid>>(std::move(frames));
  const auto of_frame = [shared](std::uint32_t frame_index, std::int64_t) {
    return (*shared)[frame_index % shared->size()];
  };
  return {shared->front(), std::make_shared<const MovingFigure>(MovingFigure{of_frame})};
}

std::vector<FiringGrid> ParseFiringTable(FiringTableText table, double rate_hz, ErrorList& errors) {
  auto& [text, shown, num_frames] = table;
  std::string line;
  std::getline(text, line);
  const bool has_rings = Trimmed(line) == kRingHeader;
  if (!has_rings && Trimmed(line) != kHeader) {
    errors.Add({shown + ":1", "must be " + Quoted(kHeader) + " or " + Quoted(kRingHeader),
                Quoted(Trimmed(line))});
    return {};
  }
  const std::size_t num_columns = has_rings ? kNames.size() : kNames.size() - 1;
  std::vector<Firing> firings;
  TimeLimits limits{-1.0, kMaxTime_us * num_frames};
  for (std::size_t number = 2; std::getline(text, line); ++number) {
    const std::string place = shown + ":" + std::to_string(number);
    Values values{};
    if (!ParseLine(line, num_columns, place, values, errors)) {
      if (errors.size() >= kMaxNumFaults) return {};
      continue;
    }
    CheckValues(values, limits, place, errors);
    if (errors.size() >= kMaxNumFaults) return {};
    limits.last_us = values[2];
    if (firings.size() == kMaxNumFirings) {
      errors.Add({shown, "must have at most 16777216 firings", ""});
      return {};
    }
    if (!errors.empty()) continue;
    firings.push_back({.azimuth_rad = RadFromDeg(values[0]),
                       .elevation_rad = RadFromDeg(values[1]),
                       .time_ns = std::llround(values[2] * kNsPerUs),
                       .row = static_cast<std::uint16_t>(values[3])});
  }
  if (firings.empty() && errors.empty()) {
    errors.Add({shown, "must have at least one firing", "0"});
  }
  if (!errors.empty()) return {};
  FiringGrid whole = GridOf(std::move(firings), shown + ": ring", errors);
  return errors.empty() ? FramesOf(std::move(whole), table, rate_hz, errors)
                        : std::vector<FiringGrid>{};
}

}  // namespace railcast
