#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/extras/insert/insert_record.h"
#include "core/extras/recipe/dataset_record.h"
#include "core/io/record/read_record.h"
#include "core/io/recording/sequence_lines.h"
#include "core/io/run/run_record.h"
#include "core/io/verify/findings.h"
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

void CompareTotals(const FrameCounts& counts) {
  FrameCounts totals;
  totals.points = 3;
  totals.points_per_label = {{"rail", 3}};
  ErrorList faults;
  CompareCounts(totals, counts, {kPlace, "", ""}, faults);
  for (const std::string& fault : faults.lines()) {
    Check(std::string_view(fault).starts_with("fuzz:3: /"), "a fault names its member");
  }
}

void ReadManifestFile(const std::string& text) {
  const ManifestRecord manifest = ReadManifest(text, kPlace);
  CompareTotals(manifest.counts);
  static_cast<void>(DataHash(manifest.files));
  CheckManifestHash(text, kPlace);
}

void ReadLine(char kind, const std::string& line) {
  try {
    if (kind == 'f') {
      for (const ScanPose& pose : ScanPosesOf(ReadFrameLine(line, kPlace).scan_poses)) {
        CheckPose(pose.world_from_sensor);
      }
    }
    if (kind == 'o') ReadObjects(line);
    if (kind == 'p') CheckPose(ReadPoseLine(line, kStamp_ns, kPlace));
    if (kind == 'm') ReadManifestFile(line);
    if (kind == 'r') static_cast<void>(ReadRun(line, kPlace));
    if (kind == 'i') static_cast<void>(ReadInsertLine(line, kPlace));
    if (kind == 's') static_cast<void>(ReadRecordLine<ScenarioRecord>(line, kPlace));
  } catch (const InputError& error) {
    Check(std::string_view(error.what()).starts_with("fuzz:3: "), "a fault names its line");
  }
}

}  // namespace
}  // namespace railcast

/// Entry point for libFuzzer. The first byte selects the file of a sequence: the rest is a line of
/// f frames.jsonl, i insert.jsonl, o objects.jsonl, p poses.csv or s scenarios.jsonl, or the whole
/// of m manifest.json or r run.json.
RAILCAST_FUZZ_TARGET(sequence) {
  if (size == 0) return 0;
  railcast::ReadLine(static_cast<char>(data[0]),
                     std::string(reinterpret_cast<const char*>(data) + 1, size - 1));
  return 0;
}
