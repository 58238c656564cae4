#include "core/io/verify/merged_verification.h"

#include <set>
#include <string>

#include "core/base/attempt.h"
#include "core/base/text.h"
#include "core/io/recorded_json.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/sequence_files.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

class MergedVerifier {
 public:
  explicit MergedVerifier(const MergedFolder& merged) : merged_(merged) {}

  Verification Run(const std::function<void(double)>& on_progress) {
    for (const KnownFile& file : merged_.files) {
      CheckFile(file, [&] { return ReadHashedFile(merged_.folder, file, kSensorsFile); });
    }
    Try([&] { CheckClouds(on_progress); });
    Try([&] { FindOthers(); });
    result_.faults = faults_.lines();
    return std::move(result_);
  }

 private:
  template <typename Work>
  void Try(const Work& work) {
    static_cast<void>(Attempt("", faults_, [&] { return work(), true; }));
  }

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
      const auto file = Attempt("", faults_, [&] {
        return ReadRecordedJson<StrictJson>(line->text, line->place, [](const StrictJson& json) {
          return KnownFile{json.at("file"), json.at("xxh3"), json.at("bytes")};
        });
      });
      if (!file) continue;
      CheckFile(*file, [&] { return ReadKnownFile(merged_.folder, *file, kMergedFile); });
    }
  }

  void FindOthers() {
    for (const auto& entry : fs::recursive_directory_iterator(merged_.folder)) {
      if (entry.is_directory()) continue;
      const std::string name = entry.path().lexically_relative(merged_.folder).generic_string();
      if (known_.contains(name)) continue;
      faults_.Add(
          {ShownPath(entry.path()), "is named neither in sensors.json nor in merged.jsonl", ""});
    }
  }

  const MergedFolder& merged_;
  std::set<std::string, std::less<>> known_;
  ErrorList faults_;
  Verification result_;
};

}  // namespace

Verification VerifyMerged(const MergedFolder& merged,
                          const std::function<void(double)>& on_progress) {
  return MergedVerifier(merged).Run(on_progress);
}

}  // namespace railcast
