#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/write_file.h"
#include "generator/extras/insert/clouds/edit_cloud.h"
#include "generator/extras/insert/clouds/recording_output.h"
#include "generator/extras/insert/clouds/source_files.h"

namespace railcast {
namespace {

/// Whether each line of a file is of a frame, as beside KITTI's clouds.
bool HasLinesOfFrames(const std::filesystem::path& file) {
  return file.filename() == "poses.txt" || file.filename() == "times.txt";
}

/// The lines of some frames; the whole text if it has not one line for each frame.
std::string LinesOfRange(const std::string& text,
                         const InsertRange& range,
                         std::size_t num_frames) {
  std::string kept;
  std::size_t number = 0;
  std::string_view rest = text;
  for (; const auto line = TakeLine(rest); ++number) {
    if (number >= range.first && number - range.first < range.num)
      kept += std::string(*line) + "\n";
  }
  return number == num_frames ? kept : text;
}

/// Clouds in the files that they were read from.
class SameClouds : public RecordingOutput {
 public:
  SameClouds(SourceFiles source, LabelNumbers labels, const InsertRange& range)
      : source_(std::move(source)), labels_(std::move(labels)), range_(range) {}

  [[nodiscard]] std::vector<LineFileName> LineFiles() const override {
    if (source_.lines.empty()) return {};
    return {{std::string(kReceivedFile), source_.lines.front() + "\n"}};
  }

  [[nodiscard]] std::vector<FixedFile> FixedFiles() const override {
    const bool is_whole = range_.num == source_.frames.size();
    std::vector<FixedFile> files;
    for (const std::string& name : source_.others) {
      const std::filesystem::path file = source_.directory / name;
      if (is_whole || !HasLinesOfFrames(file)) {
        files.push_back({name, nullptr, file});
      } else {
        files.push_back(
            FixedText(name, LinesOfRange(ReadFileWhole(file), range_, source_.frames.size())));
      }
    }
    return files;
  }

  [[nodiscard]] WrittenFrame Encode(const RecordedFirings& firings,
                                    const InsertedFrame& inserted,
                                    std::uint32_t frame) const override {
    Check(frame < source_.frames.size(), "each frame of the recording has a file");
    std::vector<FrameFile> files;
    for (const std::string& name : source_.frames[frame]) {
      files.push_back({name, ReadFileWhole(source_.directory / name)});
    }
    WrittenFrame output;
    output.source_hash = SourceHash(files);
    output.slots = EditCloud(firings, inserted,
                             {.labels = &labels_, .kitti_columns = source_.kitti_columns}, files);
    output.files = std::move(files);
    if (!source_.lines.empty()) output.lines = {source_.lines[frame + 1] + "\n"};
    return output;
  }

 private:
  SourceFiles source_;
  LabelNumbers labels_;
  InsertRange range_;
};

}  // namespace

std::unique_ptr<RecordingOutput> MakeSameClouds(const RecordingInfo& info,
                                                const InsertPlan& plan,
                                                const InsertRange& range) {
  auto source = FindSourceFiles(info.source);
  if (!source) return nullptr;
  return std::make_unique<SameClouds>(std::move(*source), LabelNumbersOf(plan, info), range);
}

}  // namespace railcast
