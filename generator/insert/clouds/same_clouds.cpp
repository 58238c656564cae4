#include <utility>

#include "core/base/error.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/write_file.h"
#include "generator/insert/clouds/edit_cloud.h"
#include "generator/insert/clouds/recording_output.h"
#include "generator/insert/clouds/source_files.h"

namespace railcast {
namespace {

/// Clouds in the files that they were read from.
class SameClouds : public RecordingOutput {
 public:
  SameClouds(SourceFiles source, LabelNumbers labels)
      : source_(std::move(source)), labels_(std::move(labels)) {}

  [[nodiscard]] std::vector<LineFileName> LineFiles() const override {
    if (source_.lines.empty()) return {};
    return {{std::string(kReceivedFile), source_.lines.front() + "\n"}};
  }

  [[nodiscard]] std::vector<FrameFile> FixedFiles() const override {
    std::vector<FrameFile> files;
    for (const std::string& name : source_.others) {
      files.push_back({name, ReadFileWhole(source_.directory / name)});
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
    output.slots = EditCloud(firings, inserted, {.labels = &labels_}, files);
    output.files = std::move(files);
    if (!source_.lines.empty()) output.lines = {source_.lines[frame + 1] + "\n"};
    return output;
  }

 private:
  SourceFiles source_;
  LabelNumbers labels_;
};

}  // namespace

std::unique_ptr<RecordingOutput> MakeSameClouds(const RecordingInfo& info, const InsertPlan& plan) {
  auto source = FindSourceFiles(info.source);
  if (!source) return nullptr;
  return std::make_unique<SameClouds>(std::move(*source), LabelNumbersOf(plan, info));
}

}  // namespace railcast
