#include "core/io/recording/recording_kinds.h"

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/pose_numbers.h"
#include "core/base/text.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/cloud/kitti_names.h"
#include "core/io/cloud/las_reader.h"
#include "core/io/recording/cloud_frame.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/plausibility.h"
#include "core/io/run/frame_record.h"
#include "core/io/run/sequence_files.h"
#include "railcast/io/cloud_files.h"

namespace railcast {
namespace {

RecordedFrame ReadCloudFrame(const std::filesystem::path& file,
                             std::uint32_t index,
                             const std::string& columns = {}) {
  RecordedFrame recorded = MakeCloudFrame(ReadCloud(file, columns), ShownPath(file));
  recorded.frame.index = index;
  return recorded;
}

class CloudRecording : public Recording {
 public:
  CloudRecording(const std::filesystem::path& source,
                 const std::string& kind,
                 std::vector<std::filesystem::path> files)
      : files_(std::move(files)),
        stamps_ns_(StampsOfNames(files_)),
        columns_(KittiSourceOf(source).columns) {
    info_.source = source;
    info_.kind = kind;
    info_.num_frames = files_.size();
    info_.has_kitti_labels = !files_.empty() && IsKittiFile(files_.front());
    if (info_.has_kitti_labels) {
      info_.labels = SemanticKittiNamesOf(files_.front().parent_path());
      RemarkMissingLabels();
    }
    if (!files_.empty() && IsLasFile(files_.front())) info_.labels = AsprsLabels();
  }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }

  [[nodiscard]] std::optional<FrameReader> Next() override {
    if (next_ == files_.size()) return std::nullopt;
    const std::size_t index = next_++;
    const std::int64_t stamp_ns = stamps_ns_.empty() ? 0 : stamps_ns_[index];
    return [file = files_[index], index, stamp_ns, columns = columns_] {
      RecordedFrame recorded = ReadCloudFrame(file, static_cast<std::uint32_t>(index), columns);
      RemarkOtherRanges(recorded);
      recorded.frame.stamp_ns = stamp_ns;
      return recorded;
    };
  }

 private:
  /// Remarks on folders that have labels for some of their frames only.
  void RemarkMissingLabels() {
    std::map<std::filesystem::path, std::vector<std::filesystem::path>> without;
    std::map<std::filesystem::path, bool> has_any;
    for (const std::filesystem::path& file : files_) {
      const bool is_labelled = SecondFileOf(file).has_value();
      if (!is_labelled) without[file.parent_path()].push_back(file);
      has_any[file.parent_path()] |= is_labelled;
    }
    for (const auto& [folder, files] : without) {
      if (!has_any[folder]) continue;
      info_.remarks->Add({.kind = RemarkKind::kLabelsMissing,
                          .place = ShownPath(files.front()),
                          .number = files.size()});
    }
  }

  RecordingInfo info_;
  std::vector<std::filesystem::path> files_;
  std::vector<std::int64_t> stamps_ns_;  ///< Empty: not known.
  std::string columns_;
  std::size_t next_{};
};

/// Reads the frame of a line of frames.csv.
RecordedFrame ReadReceivedFrame(const std::filesystem::path& directory, const PlacedLine& line) {
  constexpr std::size_t kNumWords = 13;    // file,run,frame,stamp_ns,x,y,z,qx,qy,qz,qw,points,lost
  constexpr std::size_t kNumWithEnd = 21;  // end_time_ns,x,y,z,qx,qy,qz,qw
  constexpr std::size_t kNumWithTimes = 24;  // first_arrival_ns,last_arrival_ns,latency_ns
  std::vector<std::string_view> words;
  std::string_view rest = line.text;
  while (words.size() <= kNumWithTimes) {
    const std::size_t end = rest.find(',');
    words.push_back(rest.substr(0, end));
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  const auto fail = [&] {
    throw InputError(line.place + ": must be a line as railcast-analyze receive writes it");
  };
  const bool has_times = words.size() == kNumWithTimes;
  if (words.size() != kNumWords && words.size() != kNumWithEnd && !has_times) fail();
  const bool has_end = words.size() > kNumWords && !(has_times && words[kNumWords].empty());
  const auto pose_from = [&](std::size_t first) {
    std::vector<double> pose;
    for (std::size_t i = first; i < first + 7; ++i) {
      if (const auto number = ParseNumber<double>(words[i])) pose.push_back(*number);
    }
    if (pose.size() != 7) fail();
    return MakePose(pose, line.place);
  };
  const auto index = ParseNumber<std::uint32_t>(words[2]);
  const auto stamp_ns = ParseNumber<std::int64_t>(words[3]);
  const auto duration_ns =
      has_end ? ParseNumber<std::uint32_t>(words[kNumWords]) : std::optional<std::uint32_t>(0);
  if (!index || !stamp_ns || !duration_ns) fail();
  // Conversions of recordings without poses have none.
  const bool has_pose =
      !std::ranges::all_of(std::span(words).subspan(4, 7), &std::string_view::empty);
  const Transform world_from_sensor = has_pose ? pose_from(4) : Transform::Identity();
  // In the lines of older programs, and of points in other axes, as at the stamp.
  const Transform world_from_sensor_end =
      has_pose && has_end ? pose_from(kNumWords + 1) : world_from_sensor;
  RecordedFrame recorded = ReadCloudFrame(directory / words[0], *index);
  recorded.frame.stamp_ns = *stamp_ns;
  recorded.frame.world_from_sensor = world_from_sensor;
  recorded.frame.duration_ns = *duration_ns;
  recorded.frame.world_from_sensor_end = world_from_sensor_end;
  recorded.has_pose = has_pose;
  return recorded;
}

class ReceivedRecording : public Recording {
 public:
  explicit ReceivedRecording(const std::filesystem::path& directory)
      : lines_(directory / kReceivedFile) {
    info_.source = directory;
    info_.kind = "received stream";
    info_.num_frames = std::max<std::size_t>(1, CountLines(directory / kReceivedFile)) - 1;
    (void)lines_.Need();  // Skip the line of column names.
    if (exists(directory / kLabelsFile)) info_.labels = ReadLabelTable(directory / kLabelsFile);
  }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }

  [[nodiscard]] std::optional<FrameReader> Next() override {
    auto line = lines_.Next();
    if (!line) return std::nullopt;
    return [directory = info_.source, line = std::move(*line)] {
      return ReadReceivedFrame(directory, line);
    };
  }

 private:
  RecordingInfo info_;
  LineReader lines_;
};

}  // namespace

std::unique_ptr<Recording> OpenClouds(const std::filesystem::path& source,
                                      const std::string& kind,
                                      std::vector<std::filesystem::path> files) {
  return std::make_unique<CloudRecording>(source, kind, std::move(files));
}

std::unique_ptr<Recording> OpenCloudsIn(const std::filesystem::path& source) {
  const auto [directory, columns] = KittiSourceOf(source);
  const bool is_received = columns.empty() && exists(directory / kReceivedFile);
  if (is_received) return std::make_unique<ReceivedRecording>(directory);
  auto [files, others] = CloudsOfDirectory(directory);
  if (files.empty()) return nullptr;
  const bool is_kitti = IsKittiFile(files.front());
  auto recording = OpenClouds(source, is_kitti ? "KITTI sequence" : "directory of point clouds",
                              std::move(files));
  if (!others.empty()) {
    recording->info().remarks->Add(
        {.kind = RemarkKind::kFilesLeftOut,
         .place = ShownPath(others.front().parent_path()),
         .number = others.size(),
         .detail = ShownPath(others.front().filename()) + " is none of the series"});
  }
  return recording;
}

}  // namespace railcast
