#include "core/io/recording/recording_kinds.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/cloud/kitti_names.h"
#include "core/io/recording/cloud_frame.h"
#include "core/io/recording/line_reader.h"
#include "core/io/run/frame_record.h"
#include "railcast/io/cloud_files.h"

namespace railcast {
namespace {

/// Takes the digits off the front of the text and returns them without leading zeros.
std::string_view TakeDigits(std::string_view& text) {
  const auto end = std::ranges::find_if_not(text, IsDigit);
  std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(digits.size());
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

/// Compares names naturally: numbers by value, all other characters one by one.
bool ComesBefore(std::string_view a, std::string_view b) {
  while (!a.empty() && !b.empty()) {
    if (IsDigit(a.front()) && IsDigit(b.front())) {
      const std::string_view a_digits = TakeDigits(a);
      const std::string_view b_digits = TakeDigits(b);
      if (a_digits.size() != b_digits.size()) return a_digits.size() < b_digits.size();
      if (a_digits != b_digits) return a_digits < b_digits;
    } else {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  return a.size() < b.size();
}

/// Sorts paths of one folder by the natural order of their names, so that 9.pcd comes
/// before 10.pcd.
void SortNaturally(std::vector<std::filesystem::path>& paths) {
  std::ranges::sort(paths, [](const std::filesystem::path& a, const std::filesystem::path& b) {
    const std::string a_name = a.filename().string();
    const std::string b_name = b.filename().string();
    if (ComesBefore(a_name, b_name)) return true;
    return !ComesBefore(b_name, a_name) && a_name < b_name;
  });
}

RecordedFrame ReadCloudFrame(const std::filesystem::path& file, std::uint32_t index) {
  RecordedFrame recorded = MakeCloudFrame(ReadCloud(file), ShownPath(file));
  recorded.frame.index = index;
  return recorded;
}

class CloudRecording : public Recording {
 public:
  CloudRecording(const std::filesystem::path& source,
                 const std::string& kind,
                 std::vector<std::filesystem::path> files)
      : files_(std::move(files)) {
    info_.source = source;
    info_.kind = kind;
    info_.num_frames = files_.size();
    info_.has_kitti_labels = !files_.empty() && files_.front().extension() == ".bin";
    if (info_.has_kitti_labels) {
      info_.labels = SemanticKittiNamesOf(files_.front().parent_path());
    }
  }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }

  [[nodiscard]] std::optional<FrameReader> Next() override {
    if (next_ == files_.size()) return std::nullopt;
    const std::size_t index = next_++;
    return [file = files_[index], index] {
      return ReadCloudFrame(file, static_cast<std::uint32_t>(index));
    };
  }

 private:
  RecordingInfo info_;
  std::vector<std::filesystem::path> files_;
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
  const Transform world_from_sensor = pose_from(4);
  // In the lines of older programs, and of points in other axes, as at the stamp.
  const Transform world_from_sensor_end = has_end ? pose_from(kNumWords + 1) : world_from_sensor;
  RecordedFrame recorded = ReadCloudFrame(directory / words[0], *index);
  recorded.frame.stamp_ns = *stamp_ns;
  recorded.frame.world_from_sensor = world_from_sensor;
  recorded.frame.duration_ns = *duration_ns;
  recorded.frame.world_from_sensor_end = world_from_sensor_end;
  recorded.has_pose = true;
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

bool IsCloudFile(const std::filesystem::path& file) {
  return FindReader(file) != nullptr;
}

std::vector<std::filesystem::path> CloudFilesIn(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    if (IsCloudFile(entry.path())) files.push_back(entry.path());
  }
  SortNaturally(files);
  return files;
}

std::vector<std::filesystem::path> KittiSequencesIn(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> sequences;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory / "sequences", error)) {
    if (!CloudFilesIn(entry.path() / "velodyne").empty()) sequences.push_back(entry.path());
  }
  SortNaturally(sequences);
  return sequences;
}

std::vector<std::filesystem::path> CloudsOfDirectory(const std::filesystem::path& directory) {
  for (const auto& place : {directory, directory / "frames", directory / "velodyne"}) {
    auto files = CloudFilesIn(place);
    if (!files.empty()) return files;
  }
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& sequence : KittiSequencesIn(directory)) {
    const auto more = CloudFilesIn(sequence / "velodyne");
    files.insert(files.end(), more.begin(), more.end());
  }
  return files;
}

std::unique_ptr<Recording> OpenClouds(const std::filesystem::path& source,
                                      const std::string& kind,
                                      std::vector<std::filesystem::path> files) {
  return std::make_unique<CloudRecording>(source, kind, std::move(files));
}

std::unique_ptr<Recording> OpenCloudsIn(const std::filesystem::path& directory) {
  if (exists(directory / kReceivedFile)) return std::make_unique<ReceivedRecording>(directory);
  auto files = CloudsOfDirectory(directory);
  if (files.empty()) return nullptr;
  const bool is_kitti = files.front().extension() == ".bin";
  return OpenClouds(directory, is_kitti ? "KITTI sequence" : "directory of point clouds",
                    std::move(files));
}

}  // namespace railcast
