#include <cmath>
#include <cstdint>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scan/firing.h"

namespace railcast {
namespace {

FiringGrid Parse(const std::string& text, ErrorList& errors) {
  std::istringstream stream(text);
  return ParseFiringTable(stream, "fuzz", errors);
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
std::string TableText(const FiringGrid& grid) {
  std::string text = "azimuth_deg,elevation_deg,time_us,ring\n";
  for (const Firing& firing : grid.firings) {
    text += "0,0," + NumberText(static_cast<double>(firing.time_ns) / 1e3) + ',' +
            NumberText(firing.row) + '\n';
  }
  return text;
}

void ReadTable(const std::string& text) {
  ErrorList errors;
  const FiringGrid grid = Parse(text, errors);
  Check(grid.firings.empty() != errors.empty(), "a table has firings or a fault");
  // The last line may have four faults.
  Check(errors.size() <= 23, "faults are few");
  for (const std::string& line : errors.lines()) {
    Check(line.starts_with("fuzz:") && line.find('\n') == std::string::npos && line.size() < 200,
          "a fault is a short line that names its file");
  }
  if (!errors.empty()) return;
  CheckGrid(grid);
  const FiringGrid again = Parse(TableText(grid), errors);
  Check(errors.empty() && again.firings.size() == grid.firings.size(), "what is written is read");
  for (std::size_t i = 0; i < grid.firings.size(); ++i) {
    Check(again.firings[i].time_ns == grid.firings[i].time_ns, "and says the same");
  }
}

}  // namespace
}  // namespace railcast

/// Entry point for libFuzzer: a table of firings as CSV.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  railcast::ReadTable({reinterpret_cast<const char*>(data), size});
  return 0;
}
