#include "core/io/recording/sequence_check.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/record/record_text.h"
#include "core/io/run/motion_files.h"
#include "core/io/run/sequence_files.h"
#include "core/io/write_file.h"
#include "railcast/io/cloud_files.h"

namespace railcast {

bool IsThere(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::symlink_status(file, error);
  return status.type() != std::filesystem::file_type::not_found;
}

namespace {

void CompareContent(const std::filesystem::path& directory,
                    const KnownFile& file,
                    const FileHash& got,
                    std::string_view said_in) {
  const std::string said = ", as " + std::string(said_in) + " says (got ";
  const std::string place = ShownPath(directory / file.name);
  if (file.bytes && got.num_bytes != *file.bytes) {
    throw InputError(place + ": must have " + NumberText(*file.bytes) + " bytes" + said +
                     NumberText(got.num_bytes) + ")");
  }
  if (got.hash != file.hash) {
    throw InputError(place + ": must have the hash " + ShownText(file.hash) + said + got.hash +
                     ")");
  }
}

void CheckIsOfSequence(const std::filesystem::path& directory,
                       const KnownFile& file,
                       std::string_view said_in) {
  if (IsSequenceFile(file.name)) return;
  throw InputError(ShownPath(directory / said_in) + ": must name files of a sequence (got " +
                   ShownText(file.name) + ")");
}

}  // namespace

std::string ReadHashedFile(const std::filesystem::path& directory,
                           const KnownFile& file,
                           std::string_view said_in) {
  std::string bytes = ReadFileWhole(directory / file.name);
  CompareContent(directory, file, {ContentHash(bytes), bytes.size()}, said_in);
  return bytes;
}

std::string ReadKnownFile(const std::filesystem::path& directory,
                          const KnownFile& file,
                          std::string_view said_in) {
  CheckIsOfSequence(directory, file, said_in);
  return ReadHashedFile(directory, file, said_in);
}

std::uint64_t CheckKnownFile(const std::filesystem::path& directory,
                             const KnownFile& file,
                             std::string_view said_in) {
  CheckIsOfSequence(directory, file, said_in);
  const FileHash got = HashFile(directory / file.name);
  CompareContent(directory, file, got, said_in);
  return got.num_bytes;
}

SequenceSummary ReadSequenceSummary(const std::filesystem::path& directory) {
  const std::filesystem::path run = directory / kRunFile;
  SequenceSummary summary{directory, ReadRun(ReadFileWhole(run), ShownPath(run)), {}};
  const std::filesystem::path manifest = directory / kManifestFile;
  if (!IsThere(manifest)) return summary;
  summary.manifest = ReadRecord<ManifestRecord>(ReadManifestText(manifest), ShownPath(manifest));
  return summary;
}

void CheckKnownFiles(const SequenceSummary& summary) {
  if (!summary.manifest) {
    for (const KnownFile& file : summary.run.Files()) {
      (void)CheckKnownFile(summary.directory, file, kRunFile);
    }
    return;
  }
  const ManifestRecord& manifest = *summary.manifest;
  for (const KnownFile& file : manifest.Files()) {
    // Nothing is read of a trace, whose size may be that of all frames.
    if (file.name == summary.run.trace) continue;
    (void)CheckKnownFile(summary.directory, file, kManifestFile);
  }
  const std::string data_hash = DataHash(manifest.files);
  if (manifest.data_hash == data_hash) return;
  throw InputError(ShownPath(summary.directory / kManifestFile) + ": data_xxh3: must be " +
                   data_hash + ", that of the files (got " + ShownText(manifest.data_hash) + ")");
}

SequenceOrigin OriginOf(const SequenceSummary& summary) {
  const RunRecord& run = summary.run;
  return {.version = run.version,
          .embree = run.embree,
          .isa = run.isa,
          .scenario_hash = run.scenario_hash,
          .data_hash = summary.manifest ? summary.manifest->data_hash : "",
          .is_finished = summary.manifest.has_value(),
          .has_commands = !run.commands_hash.empty(),
          .chosen_effects =
              summary.manifest ? summary.manifest->ChosenEffects() : std::vector<std::string>()};
}

std::vector<std::string> RecordFiles(std::string_view format) {
  std::vector<std::string> files = {std::string(kPosesFile), std::string(kObjectsFile)};
  const FrameFormat* const known = FindFrameFormat(format);
  if (known != nullptr && known->dataset) {
    for (const std::string_view name : known->dataset->record_files) files.emplace_back(name);
  }
  return files;
}

std::size_t NumHeaders(std::string_view name) {
  return name == kPosesFile ? 1 : 0;
}

void CheckNumLines(const std::filesystem::path& file, std::size_t num_frames, bool may_have_more) {
  const std::size_t num_lines = CountLines(file);
  const std::size_t got = num_lines - std::min(num_lines, NumHeaders(file.filename().string()));
  if (may_have_more ? got >= num_frames : got == num_frames) return;
  throw InputError(ShownPath(file) + ": must have a line for each of " + NumberText(num_frames) +
                   " frames (got " + NumberText(got) + ")");
}

std::vector<LineReader> OpenMotionFiles(const SequenceSummary& summary) {
  std::vector<LineReader> readers;
  for (const std::string& sensor : summary.run.motion_sensors) {
    readers.emplace_back(summary.directory / MotionFileName(sensor));
    (void)readers.back().Need();
  }
  return readers;
}

std::vector<PlacedLine> ReadMotionLines(const PlacedLine& frame, std::vector<LineReader>& readers) {
  if (readers.empty()) return {};
  const FrameRecord line = ReadFrameLine(frame.text, frame.place);
  if (line.motion_lines.size() != readers.size()) {
    throw InputError(frame.place + ": motion_lines: must be " + NumberText(readers.size()) +
                     ", as many as run.json has motion sensors" + Got(line.motion_lines.size()));
  }
  std::vector<PlacedLine> motion(readers.size());
  for (std::size_t i = 0; i < readers.size(); ++i) {
    for (std::uint32_t k = 0; k < line.motion_lines[i]; ++k) {
      const PlacedLine sample = readers[i].Need();
      if (k == 0) motion[i].place = sample.place;
      motion[i].text += sample.text + "\n";
    }
  }
  return motion;
}

FrameLineReader::FrameLineReader(const SequenceSummary& summary)
    : num_frames_(CountLines(summary.directory / kFramesFile)),
      next_frame_(summary.run.start_frame),
      stride_(summary.run.stride()),
      frames_(summary.directory / kFramesFile) {
  // Lines are counted before files are hashed, since a missing line is a more specific fault than a
  // hash that differs.
  const auto check = [&](std::string_view name) {
    if (!summary.manifest) return;
    CheckNumLines(summary.directory / name, summary.manifest->num_frames, false);
  };
  check(kFramesFile);
  for (const std::string& name : RecordFiles(summary.run.format)) {
    check(name);
    records_.emplace_back(summary.directory / name);
    for (std::size_t i = 0; i < NumHeaders(name); ++i) (void)records_.back().Need();
  }
  motion_ = OpenMotionFiles(summary);
}

std::optional<FrameLines> FrameLineReader::Next() {
  auto frame = frames_.Next();
  if (!frame) return std::nullopt;
  FrameLines lines{next_frame_, std::move(*frame), {}, {}};
  next_frame_ += stride_;
  for (LineReader& records : records_) lines.records.push_back(records.Need());
  lines.motion = ReadMotionLines(lines.frame, motion_);
  return lines;
}

FrameRecord ReadNextFrameLine(const FrameLines& lines) {
  FrameRecord line = ReadFrameLine(lines.frame.text, lines.frame.place);
  if (line.frame == lines.expected_frame) return line;
  throw InputError(lines.frame.place + ": frame: must be " + NumberText(lines.expected_frame) +
                   ", one after another (got " + NumberText(line.frame) + ")");
}

void TakeScanPoses(const FrameRecord& line, Frame& frame) {
  std::vector<ScanPose> poses = ScanPosesOf(line.scan_poses);
  frame.duration_ns = poses.back().time_ns;
  frame.world_from_sensor_end = poses.back().world_from_sensor;
  poses.pop_back();
  frame.poses_between = std::move(poses);
}

void TakeRecords(const FrameRecord& line, const FrameLines& lines, RecordedFrame& recorded) {
  const PlacedLine& pose = lines.records.at(0);
  const PlacedLine& objects = lines.records.at(1);
  Frame& frame = recorded.frame;
  frame.stamp_ns = line.stamp_ns;
  frame.world_from_sensor = ReadPoseLine(pose.text, line.stamp_ns, pose.place);
  TakeScanPoses(line, frame);
  recorded.has_pose = true;
  recorded.objects = ReadObjectsLine(objects.text, line.frame, objects.place);
  if (line.certificate) recorded.certificate_json = RecordText(*line.certificate);
  CheckRecords(line, lines);
}

void CheckRecords(const FrameRecord& line, const FrameLines& lines) {
  const std::string fault = LineHashFault(lines.frame.text);
  if (!fault.empty()) throw InputError(lines.frame.place + ": " + fault);
  std::string records;
  std::string files;
  for (const PlacedLine& record : lines.records) {
    records += record.text + "\n";
    if (!files.empty()) files += ", ";
    files += std::filesystem::path(record.place).filename().string();
  }
  for (const PlacedLine& samples : lines.motion) {
    records += samples.text;
    if (!samples.text.empty()) {
      files += ", " + std::filesystem::path(samples.place).filename().string();
    }
  }
  const std::string hash = ContentHash(records);
  if (hash == line.records_hash) return;
  throw InputError(lines.frame.place + ": records_xxh3: must be that of the frame's lines in " +
                   files + ", " + hash + " (got " + ShownText(line.records_hash) + ")");
}

}  // namespace railcast
