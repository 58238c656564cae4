#include <cmath>
#include <cstdint>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scan/firing.h"
#include "tests/fuzz/fuzz_target.h"

namespace railcast {
namespace {

constexpr double kRate_hz = 10.0;

std::vector<FiringGrid> Parse(const std::string& text,
                              std::uint32_t num_frames,
                              ErrorList& errors) {
  std::istringstream stream(text);
  return ParseFiringTable({stream, "fuzz", num_frames}, kRate_hz, errors);
}

void CheckGrid(const FiringGrid& grid) {
  Check(std::size_t{grid.rows} * grid.columns == grid.firings.size(), "a table is a full grid");
  std::vector<std::uint32_t> columns(grid.rows);
  std::int64_t last_ns = 0;
  for (const Firing& firing : grid.firings) {
    Check(firing.row < grid.rows && firing.column == columns[firing.row]++,
          "a firing knows its place");
    Check(std::abs(firing.azimuth_rad) <= 2.0 * std::numbers::pi, "an azimuth is within a turn");
    Check(std::abs(firing.elevation_rad) <= 0.5 * std::numbers::pi,
          "an elevation is within the poles");
    Check(firing.time_ns >= last_ns && firing.time_ns < std::int64_t{1} << 32U,
          "times rise and have 32 bits");
    last_ns = firing.time_ns;
  }
}

// Compares the times only, since angles in degrees may change when they are converted to radians
// and back.
std::string TableText(const std::vector<FiringGrid>& frames) {
  std::string text = "azimuth_deg,elevation_deg,time_us,ring\n";
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    for (const Firing& firing : frames[frame].firings) {
      text += "0,0," +
              NumberText(static_cast<double>(firing.time_ns) / 1e3 +
                         1e6 / kRate_hz * static_cast<double>(frame)) +
              ',' + NumberText(firing.row) + '\n';
    }
  }
  return text;
}

void ReadTable(const std::string& text, std::uint32_t num_frames) {
  ErrorList errors;
  const std::vector<FiringGrid> frames = Parse(text, num_frames, errors);
  Check(frames.empty() != errors.empty(), "a table has frames or a fault");
  // The last line may have four faults.
  Check(errors.size() <= 23, "faults are few");
  for (const std::string& line : errors.lines()) {
    Check(line.starts_with("fuzz:") && line.find('\n') == std::string::npos && line.size() < 200,
          "a fault is a short line that names its file");
  }
  if (!errors.empty()) return;
  Check(frames.size() == num_frames, "a table has the frames asked for");
  for (const FiringGrid& frame : frames) CheckGrid(frame);
  // BuildScanPattern() refuses frames that overlap.
  const std::int64_t last_ns = frames.front().firings.back().time_ns;
  if (num_frames > 1 && static_cast<double>(last_ns) >= 1e9 / kRate_hz) return;
  const std::vector<FiringGrid> again = Parse(TableText(frames), num_frames, errors);
  Check(errors.empty() && again.size() == frames.size(), "what is written is read");
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    const std::vector<Firing>& firings = frames[frame].firings;
    Check(!firings.empty() && again[frame].firings.size() == firings.size(),
          "every frame has its firings");
    for (std::size_t i = 0; i < firings.size(); ++i) {
      Check(again[frame].firings[i].time_ns == firings[i].time_ns, "and says the same");
    }
  }
}

}  // namespace
}  // namespace railcast

/// a table of firings as CSV.
RAILCAST_FUZZ_TARGET(firing_table) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const std::uint32_t num_frames : {1U, 2U}) railcast::ReadTable(text, num_frames);
  return 0;
}
