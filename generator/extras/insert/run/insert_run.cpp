#include "generator/extras/insert/run/insert_run.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/certify/certifier.h"
#include "core/extras/insert/insert_record.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/plausibility.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/run_folder.h"
#include "core/io/run/sequence_files.h"
#include "core/io/run/table_records.h"
#include "core/program/command_line.h"
#include "core/program/version.h"
#include "core/simulate/frame_poses.h"
#include "core/trace/trace_program.h"
#include "generator/extras/insert/clouds/inserted_objects.h"
#include "generator/extras/insert/clouds/recording_output.h"
#include "generator/extras/insert/clouds/sidecars.h"
#include "generator/extras/insert/firing_finder.h"
#include "generator/extras/insert/inserter.h"
#include "generator/extras/insert/packets/same_copy.h"
#include "generator/extras/insert/plan/recorded_run.h"
#include "generator/extras/insert/run/frame_folder.h"
#include "generator/run/run_directory.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Whether a recording is, or is in, one of the folders that a file lists.
bool IsListed(const std::string& recording, const fs::path& file) {
  const std::string text = ReadFileWhole(file);
  std::string_view rest = text;
  while (const auto folder = TakeLine(rest)) {
    if (recording == *folder || recording.starts_with(std::string(*folder) + "/")) return true;
  }
  return false;
}

/// Returns the part of its data set that a recording belongs to, "train", "val" or "test"; nothing
/// if it is not a sequence of one.
std::optional<std::string> SplitOfRecording(const fs::path& recording) {
  fs::path whole = fs::weakly_canonical(recording);
  if (!whole.has_filename()) whole = whole.parent_path();
  for (fs::path parent = whole.parent_path(); parent != parent.parent_path();
       parent = parent.parent_path()) {
    if (!fs::exists(parent / kDatasetFile)) continue;
    for (const std::string_view name : kSplitFiles) {
      const fs::path file = parent / name;
      if (!fs::exists(file)) continue;
      if (IsListed(whole.lexically_relative(parent).generic_string(), file)) {
        return file.stem().string();
      }
    }
    return std::nullopt;
  }
  return std::nullopt;
}

std::unique_ptr<RecordingOutput> OutputOf(const InsertChoices& choices,
                                          const RecordingInfo& info,
                                          const InsertPlan& plan,
                                          const InsertRange& range,
                                          const std::optional<CertifySpec>& certify) {
  if (choices.format != "same") {
    return MakeConvertedClouds(info, plan, ParseFrameFormat(choices.format), range.first);
  }
  const fs::path folder = choices.directory / kRecordingFolder;
  if (auto sequence = MakeSameSequence(info, plan, range, {folder, certify})) return sequence;
  if (auto clouds = MakeSameClouds(info, plan, range)) return clouds;
  if (auto copy = MakeSameCopy(info, folder)) return copy;
  throw InputError(
      ShownPath(choices.recording) +
      ": must be a sequence, clouds in files, a capture or a bag for --format same (got a " +
      info.kind + ")");
}

InsertRunRecord RecordOfRun(const InsertChoices& choices,
                            const RecordingInfo& info,
                            const InsertPlan& plan,
                            const InsertRange& range) {
  InsertRunRecord run{.version = ProgramVersion(),
                      .embree = EmbreeVersion(),
                      .recording = choices.recording_name,
                      .recording_hash = choices.recording_hash,
                      .kind = info.kind,
                      .has_kitti_labels = info.has_kitti_labels,
                      .plan_hash = plan.identity.scenario_hash,
                      .seed = plan.scenario.seed,
                      .format = choices.format,
                      .may_use_points_alone = choices.may_use_points_alone,
                      .first_frame = range.first,
                      .num_frames = range.num,
                      .certify = CertifiedShareOf(choices.certify)};
  if (run.recording.empty()) {
    run.recording = choices.recording.lexically_normal().generic_string();
  }
  if (run.recording_hash.empty()) {
    run.recording_hash = ContentHash(RecordingTraits(choices.recording));
  }
  if (info.origin) {
    run.source = {info.origin->version, info.origin->scenario_hash, info.origin->data_hash};
  }
  return run;
}

/// The plan as a scenario, for what looks at the frames: with the line of the recording and the
/// rung that plans mean by `auto`.
ScenarioSpec WorldOf(const InsertPlan& plan) {
  ScenarioSpec world = plan.scenario;
  if (world.fidelity == Fidelity::kAuto) world.fidelity = Fidelity::kFootprint;
  return world;
}

/// The labels by the numbers that the output has, but for SemanticKITTI's.
LabelTable LabelsOf(const RecordingInfo& info, const InsertPlan& plan) {
  const bool are_theirs = !info.has_kitti_labels && !info.labels.labels().empty();
  return are_theirs ? info.labels : LabelTable(plan.scenario.labels);
}

/// Gives a frame the motion of the plan's way where the recording does not say how the sensor moved
/// during the scan.
void UsePlannedMotion(const InsertPlan& plan, std::uint32_t number, RecordedFrame& recorded) {
  Frame& frame = recorded.frame;
  if (recorded.has_pose && frame.duration_ns > 0) return;
  const std::int64_t begin_ns = plan.frame_times_ns.at(number);
  const Transform begin = PlannedPose(plan, begin_ns);
  if (!recorded.has_pose) frame.world_from_sensor = begin;
  if (recorded.Has("time_ns")) frame.duration_ns = *std::ranges::max_element(frame.time_ns);
  const Transform recorded_from_planned = frame.world_from_sensor * begin.inverse();
  const auto pose_at = [&](std::uint32_t time_ns) {
    return recorded_from_planned * PlannedPose(plan, begin_ns + time_ns);
  };
  frame.poses_between = PosesBetween(frame.duration_ns, pose_at);
  frame.world_from_sensor_end = pose_at(frame.duration_ns);
}

/// A frame on its way from the recording to the folder.
struct FrameOnWay {
  std::uint32_t frame{};
  Recording::FrameReader read;
  RecordedFirings firings;
  InsertedFrame inserted;
  WrittenFrame output;
  std::vector<FrameFile> sidecars;
  InsertRecord entry;
};

class InsertRun {
 public:
  InsertRun(const InsertChoices& choices,
            const InsertPlan& plan,
            const RunHooks& hooks,
            Recording& recording)
      : plan_(plan),
        hooks_(hooks),
        recording_(recording),
        range_(RangeOf(choices, plan)),
        num_threads_(choices.num_threads),
        split_(SplitOfRecording(recording.info().source)),
        labels_(LabelTable(plan.scenario.labels), recording.info(), {}),
        finder_(recording.info(), plan.scenario.lidar.scan, choices.may_use_points_alone),
        inserter_(plan, choices.num_threads, CertifiedShareOf(choices.certify)),
        output_(OutputOf(choices, recording.info(), plan, range_, inserter_.certify())),
        run_(RecordOfRun(choices, recording.info(), plan, range_)),
        folder_({.directory = choices.directory,
                 .made = "an insertion",
                 .run = RecordFile(run_),
                 .first_frame = range_.first,
                 .num_frames = range_.num,
                 .line_files = LineFiles(),
                 .ledger = std::string(kInsertFile),
                 .is_known = choices.is_known}) {}

  InsertResult Run() {
    const auto write_fixed = [&] { WriteFixed(); };
    InsertResult result{folder_.Fill(output_, write_fixed, [&] { MakeFrames(); }), range_.num};
    if (!folder_.is_complete() && result.num_done == range_.num) Finish();
    result.is_complete = folder_.is_complete();
    return result;
  }

 private:
  [[nodiscard]] std::vector<LineFileName> LineFiles() const {
    std::vector<LineFileName> files = {{std::string(kPosesFile), std::string(kPosesHeader)},
                                       {std::string(kObjectsFile), ""}};
    for (LineFileName& file : output_->LineFiles()) {
      files.push_back({InRecording(file.name), file.header});
    }
    return files;
  }
  static std::string InRecording(const std::string& name) {
    return std::string(kRecordingFolder) + "/" + name;
  }

  void WriteFixed() {
    const auto write = [&](std::string_view name, std::string text) {
      folder_.WriteFixed(FixedText(std::string(name), std::move(text)));
    };
    write("plan.resolved.json", plan_.identity.scenario_json);
    for (const InputFile& input : plan_.identity.inputs) folder_.WriteFixed(input.Copy());
    write(kInsertWorldFile, IdentityOf(WorldOf(plan_)).scenario_json);
    write(kLabelsFile, LabelsJson(LabelsOf(recording_.info(), plan_)));
    for (FixedFile& file : output_->FixedFiles()) {
      file.name = InRecording(file.name);
      folder_.WriteFixed(file);
    }
  }

  void MakeFrames() {
    if (inserter_.certify()) certificates_ = CertificatesSoFar();
    std::vector<FrameOnWay> slots;
    const auto take = [&](std::size_t i, std::uint32_t number) {
      auto reader = recording_.Next();
      if (!reader) return false;
      slots[i].frame = number;
      slots[i].read = std::move(*reader);
      return true;
    };
    MakeMissing(
        {range_, folder_.num_done(), num_threads_, hooks_},
        [&](std::size_t num_slots) { slots.resize(num_slots); }, take,
        {{false, [&](std::size_t i) { slots[i].firings = finder_.Find(ReadFrame(slots[i])); }},
         {true, [&](std::size_t i) { Insert(slots[i]); }},
         {false, [&](std::size_t i) { Encode(slots[i]); }}},
        [&](std::size_t i) { Write(slots[i]); });
  }

  [[nodiscard]] RecordedFrame ReadFrame(FrameOnWay& way) const {
    RecordedFrame recorded = std::exchange(way.read, {})();
    const auto far = CheckRanges(recorded, recording_.info(), plan_.scenario.lidar.range_max_m);
    if (far) recording_.info().remarks->Add(*far, way.frame + 1U);
    return recorded;
  }

  void Insert(FrameOnWay& way) {
    way.inserted = inserter_.Insert(way.firings, way.frame);
    if (way.inserted.certificate) UseNumbers(*way.inserted.certificate);
    UsePlannedMotion(plan_, way.frame, way.inserted.recorded);
  }

  // Labels as labels.json has them, which are the plan's where clouds have SemanticKITTI's.
  void UseNumbers(FrameCertificate& certificate) const {
    if (recording_.info().has_kitti_labels) return;
    for (StratumCount& stratum : certificate.strata)
      stratum.label = labels_.Of(stratum.label, false);
    for (DrawnFiring& drawn : certificate.drawn) {
      for (CertifiedEcho& echo : drawn.echoes) echo.label = labels_.Of(echo.label, false);
    }
  }

  void Encode(FrameOnWay& way) const {
    way.output = output_->Encode(way.firings, way.inserted, way.frame);
    way.entry = InsertEntry(way.firings, way.inserted, plan_, way.frame);
    way.entry.frame.certificate = way.inserted.certificate;
    if (split_) way.entry.split = *split_;
    way.entry.source_hash = way.output.source_hash;
    if (way.output.has_slots) MakeSidecars(way);
  }

  void MakeSidecars(FrameOnWay& way) const {
    way.sidecars = SidecarFiles(way.firings, way.inserted, way.output.slots, labels_, way.frame);
  }

  void Write(FrameOnWay& way) {
    output_->Write(way.firings, way.inserted, way.output);
    if (!way.output.has_slots) MakeSidecars(way);
    std::vector<FrameFile> files = std::move(way.sidecars);
    for (FrameFile& file : way.output.files) {
      files.push_back({InRecording(file.name), std::move(file.bytes)});
    }
    const std::int64_t stamp_ns = plan_.first_stamp_ns + plan_.frame_times_ns.at(way.frame);
    const PoseRecord pose(stamp_ns, way.inserted.recorded.frame.world_from_sensor);
    std::vector<std::string> lines = {
        PoseLine(pose), InsertedObjectsLine(way.firings, way.inserted, way.frame, stamp_ns)};
    lines.insert(lines.end(), way.output.lines.begin(), way.output.lines.end());
    if (way.entry.frame.certificate) certificates_->Add(*way.entry.frame.certificate);
    folder_.Write(files, lines, std::move(way.entry));
    way = {};
  }

  void Finish() {
    output_->Finish();
    std::vector<std::string> others;
    for (const std::string& name : output_->WholeFiles()) others.push_back(InRecording(name));
    folder_.Finish(
        InsertManifestRecord{
            .run = run_, .remarks = plan_.remarks, .certificate = CertificateOfFrames()},
        others);
  }

  [[nodiscard]] std::optional<RunCertificate> CertificateOfFrames() const {
    if (!certificates_) return std::nullopt;
    return certificates_->Result(LabelsOf(recording_.info(), plan_));
  }

  // The certificates of the frames that an earlier run has made.
  [[nodiscard]] CertificateSums CertificatesSoFar() const {
    CertificateSums sums(*inserter_.certify());
    if (folder_.num_done() == 0) return sums;
    LineReader lines(folder_.directory() / kInsertFile);
    while (const auto line = lines.Next()) {
      const auto certificate = ReadInsertLine(line->text, line->place).frame.certificate;
      if (certificate) sums.Add(*certificate);
    }
    return sums;
  }

  const InsertPlan& plan_;
  const RunHooks& hooks_;
  Recording& recording_;
  InsertRange range_;
  int num_threads_;
  std::optional<std::string> split_;
  LabelNumbers labels_;
  FiringFinder finder_;
  Inserter inserter_;
  std::unique_ptr<RecordingOutput> output_;
  InsertRunRecord run_;
  FrameFolder folder_;
  std::optional<CertificateSums> certificates_;  ///< If the run is certified.
};

/// Sums what insert.jsonl says of the frames.
std::string ReportOf(const fs::path& directory) {
  std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> seen;  // Returns and frames.
  std::uint64_t added = 0;
  std::uint64_t removed = 0;
  std::uint64_t num_frames = 0;
  LineReader lines(directory / kInsertFile);
  while (const auto line = lines.Next()) {
    const InsertRecord record = ReadInsertLine(line->text, line->place);
    ++num_frames;
    added += record.added;
    removed += record.removed;
    for (const InsertedObjectRecord& object : record.objects) {
      auto& [returns, frames] = seen[object.name];
      returns += object.returns;
      frames += object.is_visible ? 1 : 0;
    }
  }
  std::string report = Amount(num_frames, "frames, ") + Amount(added, "points added, ") +
                       NumberText(removed) + " removed\n";
  for (const auto& [name, counts] : seen) {
    report += "  " + ShownText(name) + ": ";
    report += counts.first == 0
                  ? "not visible in any frame\n"
                  : Amount(counts.first, "points in ") + Amount(counts.second, "frames\n");
  }
  const fs::path file = directory / kManifestFile;
  const auto manifest = ReadRecord<InsertManifestRecord>(ReadManifestText(file), ShownPath(file));
  if (manifest.certificate) report += CertificateText(*manifest.certificate);
  return report + "written to " + ShownPath(directory) + "\n";
}

}  // namespace

std::pair<std::uint32_t, std::uint32_t> FramesNamed(const std::string& text) {
  const std::size_t dots = text.find("..");
  const auto first = ParseWholeNumber(text.substr(0, dots));
  const auto last = dots == std::string::npos ? first : ParseWholeNumber(text.substr(dots + 2));
  if (!first || !last || *first > *last || *last > kMaxFrame) {
    throw InputError("--frames: must be numbers of frames, first and last, such as 12..30 (got " +
                     ShownText(text) + ")");
  }
  return {static_cast<std::uint32_t>(*first), static_cast<std::uint32_t>(*last)};
}

InsertRange RangeOf(std::uint32_t first_frame,
                    std::optional<std::uint32_t> last_frame,
                    std::uint32_t num) {
  const std::uint32_t last = last_frame.value_or(num == 0 ? 0 : num - 1);
  if (first_frame < num && last < num && first_frame <= last) {
    return {first_frame, last - first_frame + 1};
  }
  throw InputError("--frames: must be of the recording's " + NumberText(num) + " frames (got " +
                   NumberText(first_frame) + ".." + NumberText(last) + ")");
}

InsertRange RangeOf(const InsertChoices& choices, const InsertPlan& plan) {
  return RangeOf(choices.first_frame, choices.last_frame,
                 static_cast<std::uint32_t>(plan.frame_times_ns.size()));
}

void CheckIsApart(const InsertChoices& choices) {
  if (!IsInFolder(choices.directory, KittiSourceOf(choices.recording).clouds)) return;
  throw InputError("--out: must not be in the recording's directory (got " +
                   ShownPath(choices.directory) + ")");
}

PlanCheck CheckInsert(const InsertChoices& choices, const InsertPlan& plan) {
  const auto recording = OpenRecording(choices.recording);
  const InsertRange range = RangeOf(choices, plan);
  const FiringFinder finder(recording->info(), plan.scenario.lidar.scan,
                            choices.may_use_points_alone);
  const Inserter inserter(plan, choices.num_threads);
  static_cast<void>(OutputOf(choices, recording->info(), plan, range, inserter.certify()));
  return CheckPlan(plan, choices.recording, range, finder);
}

InsertResult RunInsert(const InsertChoices& choices,
                       const InsertPlan& plan,
                       const RunHooks& hooks) {
  CheckIsApart(choices);
  if (choices.may_use_points_alone && CertifiedShareOf(choices.certify)) {
    throw InputError(
        "--certify: must be left out with --points-alone, where firings without a point are not "
        "known");
  }
  const auto recording = OpenRecording(choices.recording);
  InsertResult result = InsertRun(choices, plan, hooks, *recording).Run();
  if (result.is_complete) result.text = ReportOf(choices.directory);
  return result;
}

}  // namespace railcast
