#include "core/extras/insert/insertion_verification.h"

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/extras/insert/convert_record.h"
#include "core/extras/insert/insert_record.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/run_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/verify/findings.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// What a line of the ledger says of the files of its frame.
std::vector<KnownFile> FilesOfLine(std::string_view ledger,
                                   const PlacedLine& line,
                                   std::uint32_t frame) {
  const std::string fault = LineHashFault(line.text);
  if (!fault.empty()) throw InputError(line.place + ": " + fault);
  const FrameRecord record = ReadLedgerLine(ledger, line.text, line.place);
  if (record.frame == frame) return record.files;
  throw InputError(line.place + ": /frame: must be " + NumberText(frame) + Got(record.frame));
}

class InsertionVerifier : private Findings {
 public:
  InsertionVerifier(const fs::path& directory, const std::function<void(double)>& on_progress)
      : directory_(directory),
        on_progress_(on_progress),
        ledger_(IsThere(directory / kConvertFile) ? kConvertFile : kInsertFile) {}

  Verification Run() {
    const bool has_manifest = Try([&] { CheckManifest(); });
    Try([&] { CheckFrames(); });
    const fs::path recording = directory_ / kRecordingFolder;
    // A sequence names its files itself.
    const bool is_sequence = ledger_ == kInsertFile &&
                             (IsThere(recording / kRunFile) || (has_manifest && !names_recording_));
    if (is_sequence) {
      Try([&] {
        Verification found = VerifySequence(recording, [](double) {});
        found.num_frames = 0;  // They have been counted.
        Add(found);
      });
    }
    if (!has_manifest) return Findings::Take();
    FindOthers(directory_, "is named neither in manifest.json nor in " + std::string(ledger_),
               is_sequence ? NameSet{std::string(kRecordingFolder)} : NameSet());
    return Findings::Take();
  }

 private:
  void CheckManifest() {
    const fs::path file = directory_ / kManifestFile;
    known_.insert({std::string(kManifestFile), std::string(kRunFile), std::string(ledger_)});
    if (!IsThere(file)) {
      throw InputError({Fault{ShownPath(file), "missing: the run is unfinished", ""}});
    }
    const std::string text = ReadManifestText(file);
    if (ledger_ == kConvertFile) {
      Take(ReadRecord<ConvertManifestRecord>(text, ShownPath(file)));
    } else {
      Take(ReadRecord<InsertManifestRecord>(text, ShownPath(file)));
    }
  }

  template <typename Manifest>
  void Take(const Manifest& manifest) {
    num_frames_ = manifest.run.num_frames;
    first_frame_ = manifest.run.first_frame;
    CheckHashes(directory_, manifest.files, kManifestFile);
    for (const auto& [name, hash] : manifest.files) NoteRecording(name);
  }

  void NoteRecording(const std::string& name) {
    names_recording_ = names_recording_ || name.starts_with(std::string(kRecordingFolder) + "/");
  }

  void CheckFrames() {
    LineReader lines(directory_ / ledger_);
    std::uint32_t num = 0;
    for (; const auto line = lines.Next(); ++num) {
      if (num_frames_ > 0) {
        on_progress_(static_cast<double>(num) / static_cast<double>(num_frames_));
      }
      Try([&] {
        for (const KnownFile& file : FilesOfLine(ledger_, *line, first_frame_ + num)) {
          known_.insert(file.name);
          NoteRecording(file.name);
          CheckHash(directory_ / file.name, file.hash, std::string(ledger_));
        }
      });
    }
    result_.num_frames += num;
    if (num == num_frames_ || num_frames_ == 0) return;
    faults_.Add({ShownPath(directory_ / ledger_),
                 "must have a line for each of " + NumberText(num_frames_) + " frames",
                 NumberText(num)});
  }

  const fs::path& directory_;
  const std::function<void(double)>& on_progress_;
  std::string_view ledger_;       ///< The file with a line for each frame.
  bool names_recording_ = false;  ///< Whether files of the recording are named.
  std::uint32_t first_frame_ = 0;
  std::uint32_t num_frames_ = 0;  ///< 0 = not known.
};

}  // namespace

Verification VerifyInsertion(const fs::path& directory,
                             const std::function<void(double)>& on_progress) {
  return InsertionVerifier(directory, on_progress).Run();
}

}  // namespace railcast
