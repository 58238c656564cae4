#include <array>
#include <charconv>
#include <cmath>
#include <fstream>

#include "core/base/attempt.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/scan/firing.h"

namespace railcast {
namespace {

constexpr std::string_view kHeader = "azimuth_deg,elevation_deg,time_us";
constexpr std::array<std::string_view, 3> kNames = {"azimuth_deg", "elevation_deg", "time_us"};
constexpr double kMaxTime_us = 4294967.0;  // Time in a frame is stored as 32-bit nanoseconds.
// A file that is not a table at all has a fault in every line.
constexpr std::size_t kMaxNumFaults = 20;

using Values = std::array<double, 3>;

std::string_view Trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Parses the three numbers of a line. Returns false, with faults in `errors`, if it fails.
bool ParseLine(std::string_view line, const std::string& place, Values& values, ErrorList& errors) {
  std::array<std::string_view, 3> cells;
  std::string_view rest = line;
  std::size_t num_cells = 0;
  for (bool more = true; more; ++num_cells) {
    const std::size_t comma = rest.find(',');
    more = comma != std::string_view::npos;
    if (num_cells < cells.size()) cells[num_cells] = Trimmed(rest.substr(0, comma));
    if (more) rest.remove_prefix(comma + 1);
  }
  if (num_cells != cells.size()) {
    errors.Add(FaultOf(place, "must have 3 values", static_cast<double>(num_cells)));
    return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const char* const end = cells[i].data() + cells[i].size();
    const auto [stop, error] = std::from_chars(cells[i].data(), end, values[i]);
    if (error == std::errc() && stop == end && std::isfinite(values[i])) continue;
    const char* const rule =
        error == std::errc() && stop == end ? "must be finite" : "not a number";
    errors.Add({place + ": " + std::string(kNames[i]), rule, Quoted(cells[i])});
    good = false;
  }
  return good;
}

/// @param last_us Time of the previous line; negative for the first.
void CheckValues(const Values& values,
                 double last_us,
                 const std::string& place,
                 ErrorList& errors) {
  const auto [azimuth_deg, elevation_deg, time_us] = values;
  if (std::abs(azimuth_deg) > 360.0) {
    errors.Add(FaultOf(place + ": azimuth_deg", "must be >= -360 and <= 360", azimuth_deg));
  }
  if (std::abs(elevation_deg) > 90.0) {
    errors.Add(FaultOf(place + ": elevation_deg", "must be >= -90 and <= 90", elevation_deg));
  }
  if (last_us < 0.0 && time_us != 0.0) {
    errors.Add(FaultOf(place + ": time_us", "the first must be 0", time_us));
  } else if (time_us < last_us) {
    errors.Add(FaultOf(place + ": time_us", "must not decrease", time_us));
  } else if (time_us > kMaxTime_us) {
    errors.Add(FaultOf(place + ": time_us", "must be <= 4294967", time_us));
  }
}

}  // namespace

FiringGrid TableFirings(const FiringTableSpec& spec, ErrorList& errors) {
  auto file = Attempt("/pattern/file: ", errors, [&] { return OpenInput(spec.file); });
  if (!file) return {};
  return ParseFiringTable(*file, ShownPath(spec.file), errors);
}

FiringGrid ParseFiringTable(std::istream& file, const std::string& shown, ErrorList& errors) {
  std::string line;
  std::getline(file, line);
  if (Trimmed(line) != kHeader) {
    errors.Add({shown + ":1", "must be \"" + std::string(kHeader) + '"', Quoted(Trimmed(line))});
    return {};
  }
  FiringGrid grid{.rows = 1, .columns = 0, .firings = {}};
  double last_us = -1.0;
  for (std::size_t number = 2; std::getline(file, line); ++number) {
    const std::string place = shown + ":" + std::to_string(number);
    Values values{};
    if (!ParseLine(line, place, values, errors)) {
      if (errors.size() >= kMaxNumFaults) return {};
      continue;
    }
    CheckValues(values, last_us, place, errors);
    if (errors.size() >= kMaxNumFaults) return {};
    last_us = values[2];
    if (grid.firings.size() == kMaxNumFirings) {
      errors.Add({shown, "must have at most 16777216 firings", ""});
      return {};
    }
    grid.firings.push_back({.azimuth_rad = RadFromDeg(values[0]),
                            .elevation_rad = RadFromDeg(values[1]),
                            .time_ns = std::llround(last_us * kNsPerUs),
                            .row = 0,
                            .column = grid.columns++});
  }
  if (grid.firings.empty() && errors.empty()) {
    errors.Add({shown, "must have at least one firing", "0"});
  }
  return errors.empty() ? grid : FiringGrid{};
}

}  // namespace railcast
