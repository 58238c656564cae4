#include <cmath>
#include <string>

#include "analysis/extras/detectors/reported_detections.h"
#include "core/base/error.h"
#include "tests/fuzz/fault_lines.h"
#include "tests/fuzz/fuzz_target.h"

namespace railcast {
namespace {

void CheckReported(const ReportedRun& run) {
  for (std::size_t i = 0; i < run.size(); ++i) {
    Check(i == 0 || run[i].frame > run[i - 1].frame, "frames rise");
    for (const ReportedDetection& detection : run[i].detections) {
      Check(detection.points.has_value() != detection.center_m.has_value(), "a box or points");
      if (!detection.size_m) continue;
      for (const double side_m : *detection.size_m) Check(side_m > 0.0, "boxes have sides");
      for (const double place_m : *detection.center_m) Check(std::isfinite(place_m), "and places");
    }
  }
}

template <typename Read>
void TryReading(const Read& read) {
  try {
    CheckReported(read());
  } catch (const InputError& error) {
    CheckFaultLines(error.what());
  }
}

}  // namespace
}  // namespace railcast

/// a file of detections, read as either kind.
RAILCAST_FUZZ_TARGET(detections) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  railcast::TryReading([&] { return railcast::ReadDetectionLines(text, "fuzz"); });
  railcast::TryReading(
      [&] { return railcast::ReadOpenLabelRun(text, "fuzz", railcast::Transform::Identity()); });
  return 0;
}
