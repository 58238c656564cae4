#include <string>

#include "core/base/error.h"
#include "core/io/record/read_record.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/sensors_record.h"
#include "core/io/verify/findings.h"
#include "core/io/verify/verification.h"

namespace railcast {
namespace {

class MergedVerifier : private Findings {
 public:
  explicit MergedVerifier(const MergedFolder& merged) : merged_(merged) {}

  Verification Run(const std::function<void(double)>& on_progress) {
    for (const KnownFile& file : merged_.files) {
      CheckFile(file, [&] { return ReadHashedFile(merged_.folder, file, kSensorsFile); });
    }
    Try([&] { CheckClouds(on_progress); });
    FindOthers(merged_.folder, "is named neither in sensors.json nor in merged.jsonl");
    return Take();
  }

 private:
  template <typename Read>
  void CheckFile(const KnownFile& file, const Read& read) {
    known_.insert(file.name);
    Try([&] {
      result_.num_bytes += read().size();
      ++result_.num_files;
    });
  }

  void CheckClouds(const std::function<void(double)>& on_progress) {
    const auto num_lines = static_cast<double>(CountLines(merged_.folder / kMergedFile));
    LineReader lines(merged_.folder / kMergedFile);
    for (; const auto line = lines.Next(); ++result_.num_frames) {
      on_progress(static_cast<double>(result_.num_frames) / num_lines);
      const auto file = Attempt(
          "", faults_, [&] { return ReadRecordLine<MergedRecord>(line->text, line->place).file; });
      if (!file) continue;
      CheckFile(*file, [&] { return ReadKnownFile(merged_.folder, *file, kMergedFile); });
    }
  }

  const MergedFolder& merged_;
};

}  // namespace

Verification VerifyMerged(const MergedFolder& merged,
                          const std::function<void(double)>& on_progress) {
  return MergedVerifier(merged).Run(on_progress);
}

}  // namespace railcast
