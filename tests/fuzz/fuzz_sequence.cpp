#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/io/recording/sequence_lines.h"
#include "core/io/recording/sequence_summary.h"
#include "core/io/verify/cloud_counts.h"
#include "tests/fuzz/fuzz_target.h"

namespace railcast {
namespace {

constexpr const char* kPlace = "fuzz:3";
constexpr std::int64_t kStamp_ns = 100'000'000;
constexpr std::uint32_t kFrame = 1;

void CheckPose(const Transform& pose) {
  constexpr double kTolerance = 1e-9;
  Check(pose.matrix().allFinite(), "a pose is finite");
  Check((pose.linear() * pose.linear().transpose()).isIdentity(kTolerance), "and does not stretch");
}

void ReadObjects(const std::string& line) {
  for (const RecordedObject& object : ReadObjectsLine(line, kFrame, kPlace)) {
    CheckPose(object.sensor_from_box);
    Check(object.size_m.allFinite() && object.velocity_world_mps.allFinite(), "a box is finite");
  }
}

// Must work at any depth of nesting.
void CompareTotals(const std::string& text) {
  const StrictJson manifest = StrictJson::parse(text, nullptr, false);
  CountTotals totals;
  totals.Add({{"points", 3}, {"outcomes", {{"point", 3}}}, {"points_per_label", {{"rail", 3}}}});
  ErrorList faults;
  totals.Compare(manifest, kPlace, faults);
  for (const std::string& fault : faults.lines()) {
    Check(std::string_view(fault).starts_with("fuzz:3: /"), "a fault names its member");
  }
}

void ReadManifestFile(const std::string& text) {
  CompareTotals(text);
  static_cast<void>(DataHash(ReadManifest(text, kPlace).files));
  CheckManifestHash(text, kPlace);
}

void ReadLine(char kind, const std::string& line) {
  try {
    if (kind == 'f') {
      for (const ScanPose& pose : ReadFrameLine(line, kPlace).scan_poses) {
        CheckPose(pose.world_from_sensor);
      }
    }
    if (kind == 'o') ReadObjects(line);
    if (kind == 'p') CheckPose(ReadPoseLine(line, kStamp_ns, kPlace));
    if (kind == 'm') ReadManifestFile(line);
    if (kind == 'r') static_cast<void>(ReadRunSummary(line, kPlace));
  } catch (const InputError& error) {
    Check(std::string_view(error.what()).starts_with("fuzz:3: "), "a fault names its line");
  }
}

}  // namespace
}  // namespace railcast

/// Entry point for libFuzzer. The first byte selects the file of a sequence: the rest is a line of
/// f frames.jsonl, o objects.jsonl or p poses.csv, or the whole of m manifest.json or r run.json.
RAILCAST_FUZZ_TARGET(sequence) {
  if (size == 0) return 0;
  railcast::ReadLine(static_cast<char>(data[0]),
                     std::string(reinterpret_cast<const char*>(data) + 1, size - 1));
  return 0;
}
