#include "generator/sequence/sequence_progress.h"

#include <filesystem>
#include <utility>

#include "core/io/content_hash.h"
#include "core/io/sequence_files.h"
#include "core/io/write_file.h"
#include "generator/record/pose_record.h"

namespace railcast {
namespace {

// Iterates over the whole lines of a line file.
class LineWalk {
 public:
  LineWalk(const std::filesystem::path& file, std::string_view header) {
    if (std::filesystem::exists(file)) text_ = ReadFileWhole(file);
    has_header_ = std::string_view(text_).starts_with(header);
    if (has_header_) position_ = header.size();
  }

  /// Returns the next line with its end; empty if there is none or it is incomplete.
  [[nodiscard]] std::string_view Next() const {
    if (!has_header_) return {};
    const std::size_t end = text_.find('\n', position_);
    if (end == std::string::npos) return {};
    return std::string_view(text_).substr(position_, end + 1 - position_);
  }
  void Advance() { position_ += Next().size(); }
  [[nodiscard]] std::uint64_t position() const { return position_; }

 private:
  std::string text_;
  bool has_header_ = false;
  std::size_t position_ = 0;
};

bool HasContent(const std::filesystem::path& directory, const WrittenFile& file) {
  const std::filesystem::path path = directory / file.name;
  return std::filesystem::exists(path) && std::filesystem::file_size(path) == file.size &&
         ContentHash(ReadFileWhole(path)) == file.hash;
}

// Returns the next frame's record if the frame is complete.
std::optional<FrameRecord> NextWhole(const SequenceSpec& spec,
                                     std::uint32_t frame,
                                     const std::vector<LineWalk>& walks) {
  auto record = ParseFrameLine(walks.back().Next());
  if (!record || record->frame != frame) return std::nullopt;
  std::string records;
  for (std::size_t i = 0; i + 1 < walks.size(); ++i) records += walks[i].Next();
  if (ContentHash(records) != record->records_hash) return std::nullopt;
  for (const WrittenFile& file : record->files) {
    if (!HasContent(spec.directory, file)) return std::nullopt;
  }
  return record;
}

}  // namespace

std::vector<LineFileName> LineFileNames(const FrameFormat& format) {
  std::vector<LineFileName> names = {{std::string(kPosesFile), kPosesHeader},
                                     {std::string(kObjectsFile), ""}};
  if (format.dataset) {
    for (const std::string_view name : format.dataset->record_files) {
      names.push_back({std::string(name), ""});
    }
  }
  names.push_back({std::string(kFramesFile), ""});
  return names;
}

SequenceProgress FindProgress(const SequenceSpec& spec) {
  std::vector<LineWalk> walks;
  for (const LineFileName& file : LineFileNames(*spec.files.format)) {
    walks.emplace_back(spec.directory / file.name, file.header);
  }
  SequenceProgress progress;
  while (progress.num_done < spec.num_frames) {
    const auto record = NextWhole(spec, spec.FrameAt(progress.num_done), walks);
    if (!record) break;
    if (progress.num_done == 0) progress.first_pose_line = walks.front().Next();
    progress.counts.Add(record->counts);
    ++progress.num_done;
    for (LineWalk& walk : walks) walk.Advance();
  }
  for (const LineWalk& walk : walks) progress.keep_bytes.push_back(walk.position());
  return progress;
}

}  // namespace railcast
