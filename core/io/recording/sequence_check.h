#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/recording/line_reader.h"
#include "core/io/recording/sequence_lines.h"
#include "core/io/run/run_record.h"
#include "railcast/io/recording.h"

namespace railcast {

// Checks whether a sequence directory holds what it claims to hold.

/// Whether an entry of this name exists, even if it is a link to nowhere.
[[nodiscard]] bool IsThere(const std::filesystem::path& file);

/// Returns the bytes of a file with a known content.
/// @param said_in The file that states the expected content, for error messages: "manifest.json".
/// @throws InputError with one line if the file cannot be read or holds anything else.
[[nodiscard]] std::string ReadHashedFile(const std::filesystem::path& directory,
                                         const KnownFile& file,
                                         std::string_view said_in);

/// As ReadHashedFile(), for a file of a sequence directory.
/// @param said_in The file that states the expected content, for error messages: "frames.jsonl".
/// @throws InputError with one line if the file cannot be read or holds anything else, or if a
///   sequence directory never has a file of this name.
[[nodiscard]] std::string ReadKnownFile(const std::filesystem::path& directory,
                                        const KnownFile& file,
                                        std::string_view said_in);

/// As ReadKnownFile(), but reads the file piece by piece and returns its size: it may be larger
/// than the memory.
[[nodiscard]] std::uint64_t CheckKnownFile(const std::filesystem::path& directory,
                                           const KnownFile& file,
                                           std::string_view said_in);

/// The summary that a sequence directory gives of itself.
struct SequenceSummary {
  std::filesystem::path directory;
  RunRecord run;
  std::optional<ManifestRecord> manifest;  ///< Absent while the run is unfinished.
};

/// Reads the summary.
/// @throws InputError with one line if run.json or manifest.json cannot be read.
[[nodiscard]] SequenceSummary ReadSequenceSummary(const std::filesystem::path& directory);

/// Checks all files that the directory names with their hashes, except those of the frames.
/// @throws InputError with one line for the first that has changed since it was written.
void CheckKnownFiles(const SequenceSummary& summary);

/// Returns what a recording reports of the directory's origin.
[[nodiscard]] SequenceOrigin OriginOf(const SequenceSummary& summary);

/// Returns the files other than frames.jsonl that have a line for each frame, in the order in which
/// a frame's records_hash covers them.
[[nodiscard]] std::vector<std::string> RecordFiles(std::string_view format);

/// Returns the number of header lines of such a file: poses.csv begins with the names of its
/// columns.
[[nodiscard]] std::size_t NumHeaders(std::string_view name);

/// Checks that such a file, or frames.jsonl, has a line for each frame.
/// @param may_have_more Whether further lines are allowed, as in an unfinished run whose next frame
///   is being written.
/// @throws InputError with one line if the count is wrong or the file cannot be read.
void CheckNumLines(const std::filesystem::path& file, std::size_t num_frames, bool may_have_more);

/// The lines of one frame in all line files, not yet parsed.
struct FrameLines {
  std::uint32_t expected_frame{};
  PlacedLine frame;
  std::vector<PlacedLine> records;  ///< One from each file of RecordFiles().
  /// The frame's lines in each motion sensor's file, with their ends, and the place of the first.
  std::vector<PlacedLine> motion{};
};

/// Reads the lines of a frame in the files of the motion sensors.
/// @param readers Of these files, at the frame's lines.
/// @throws InputError with one line if the frame has lines in another number of files, or if a file
///   has fewer lines.
[[nodiscard]] std::vector<PlacedLine> ReadMotionLines(const PlacedLine& frame,
                                                      std::vector<LineReader>& readers);

/// Opens the files of the motion sensors behind their headers.
/// @throws InputError if one cannot be read.
[[nodiscard]] std::vector<LineReader> OpenMotionFiles(const SequenceSummary& summary);

/// Reads the line files of a directory frame by frame.
class FrameLineReader {
 public:
  /// @throws InputError if a file cannot be read, or if a finished directory does not have a line
  ///   for every frame.
  explicit FrameLineReader(const SequenceSummary& summary);

  /// Returns the number of frames.
  [[nodiscard]] std::size_t num_frames() const { return num_frames_; }

  /// Returns the next frame's lines, or nothing at the end.
  /// @throws InputError if another file has fewer lines than frames.jsonl.
  [[nodiscard]] std::optional<FrameLines> Next();

 private:
  std::size_t num_frames_{};
  std::uint32_t next_frame_{};
  std::uint32_t stride_{};
  LineReader frames_;
  std::vector<LineReader> records_;
  std::vector<LineReader> motion_;
};

/// Parses the frame's line of frames.jsonl.
/// @throws InputError with one line if it is damaged, or if it belongs to a frame other than the
///   expected one.
[[nodiscard]] FrameRecord ReadNextFrameLine(const FrameLines& lines);

/// Takes the sensor's poses during the scan.
void TakeScanPoses(const FrameRecord& line, Frame& frame);

/// Takes what the frame's lines say: stamp, poses and objects.
/// @throws InputError as CheckRecords() does.
void TakeRecords(const FrameRecord& line, const FrameLines& lines, RecordedFrame& recorded);

/// Checks the frame's line against its own hash, and its lines in the other files against
/// records_hash.
/// @throws InputError with one line if they have changed since the frame was written.
void CheckRecords(const FrameRecord& line, const FrameLines& lines);

}  // namespace railcast
