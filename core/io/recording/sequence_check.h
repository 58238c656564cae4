#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/recording/line_reader.h"
#include "core/io/recording/recording.h"
#include "core/io/recording/sequence_lines.h"
#include "core/io/recording/sequence_summary.h"

namespace railcast {

// Whether a sequence directory holds what it says it does.

/// Whether there is anything of this name, be it a link that leads nowhere.
[[nodiscard]] bool IsThere(const std::filesystem::path& file);

/// The bytes of a file of the directory.
/// @param said_in The file that knows what it must hold: "frames.jsonl".
/// @throws InputError with one line if it cannot be read or holds anything else, or if its name is
///   none of a sequence's.
[[nodiscard]] std::string ReadKnownFile(const std::filesystem::path& directory,
                                        const KnownFile& file,
                                        std::string_view said_in);

/// What a sequence directory says of itself as a whole.
struct SequenceSummary {
  std::filesystem::path directory;
  RunSummary run;
  std::optional<Manifest> manifest;  ///< Absent while the run is unfinished.
};

/// @throws InputError with one line if run.json or manifest.json cannot be read.
[[nodiscard]] SequenceSummary ReadSequenceSummary(const std::filesystem::path& directory);

/// Checks all files but the frames' that the directory names with their hashes.
/// @throws InputError with one line for the first that is not as it was written.
void CheckKnownFiles(const SequenceSummary& summary);

/// What a recording tells of it.
[[nodiscard]] SequenceOrigin OriginOf(const SequenceSummary& summary);

/// The files that have a line for each frame besides frames.jsonl, in the order in which a frame's
/// records_hash is over them.
[[nodiscard]] std::vector<std::string> RecordFiles(std::string_view format);

/// How many lines of such a file come before the frames': poses.csv begins with its columns' names.
[[nodiscard]] std::size_t NumHeaders(std::string_view name);

/// Checks that such a file, or frames.jsonl, has a line for each frame.
/// @param may_have_more Of an unfinished run the line that is being written may be there.
/// @throws InputError with one line if it has not, or cannot be read.
void CheckNumLines(const std::filesystem::path& file, std::size_t num_frames, bool may_have_more);

/// A frame's line of each line file, not yet looked into.
struct FrameLines {
  std::uint32_t expected_frame{};
  PlacedLine frame;
  std::vector<PlacedLine> records;  ///< Of RecordFiles().
};

/// Goes through the line files of a directory frame by frame.
class FrameLineReader {
 public:
  /// @throws InputError if a file cannot be read, or if a finished directory does not have a line
  ///   for every frame.
  explicit FrameLineReader(const SequenceSummary& summary);

  /// How many frames there are.
  [[nodiscard]] std::size_t num_frames() const { return num_frames_; }

  /// Nothing at the end. @throws InputError if another file has fewer lines than frames.jsonl.
  [[nodiscard]] std::optional<FrameLines> Next();

 private:
  std::size_t num_frames_{};
  std::uint32_t next_frame_{};
  LineReader frames_;
  std::vector<LineReader> records_;
};

/// What the line of frames.jsonl says.
/// @throws InputError with one line if it is none, or of another frame than the next.
[[nodiscard]] FrameLine ReadNextFrameLine(const FrameLines& lines);

/// @throws InputError with one line if the frame's lines in the other files are not those that its
///   line in frames.jsonl was written with.
void CheckRecords(const FrameLine& line, const FrameLines& lines);

}  // namespace railcast
