#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/bag/bag_lines.h"
#include "core/extras/ros/messages/frame_topics.h"
#include "core/io/content_hash.h"
#include "core/io/run/run_folder.h"
#include "core/io/run/sequence_files.h"
#include "core/io/run/table_records.h"
#include "core/io/unfinished_file.h"
#include "core/io/write_file.h"
#include "core/simulate/returns.h"
#include "generator/extras/ros/run_topics.h"
#include "generator/run/frame_maker.h"
#include "generator/run/run_directory.h"
#include "generator/run/run_extras.h"
#include "generator/run/run_plan.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// The commit of what is said once, before the frames.
constexpr std::uint64_t kFirstCommits = 1;

void AttachFile(bag::BagWriter& writer, const std::string& name, const std::string& bytes) {
  writer.Attach(name, "application/json", std::as_bytes(std::span(bytes)));
}

// The bag as far as it was written by an interrupted run, after its first `max_commits` commits.
std::unique_ptr<bag::BagWriter> Continue(bool is_mcap,
                                         const fs::path& path,
                                         std::size_t max_commits) {
  return is_mcap ? bag::ContinueMcap(path, bag::McapCompression::kZstd, max_commits)
                 : bag::ContinueRosbag2(path, max_commits);
}

// The name of a bag until it is complete.
fs::path UnfinishedPath(bool is_mcap, const fs::path& path) {
  return is_mcap ? fs::path(path.string() + std::string(kUnfinishedSuffix)) : path;
}

bool IsBegun(bool is_mcap, const fs::path& path) {
  return fs::exists(UnfinishedPath(is_mcap, path));
}

// A rosbag2 directory gets its metadata last.
bool IsFinished(bool is_mcap, const fs::path& path) {
  return fs::exists(is_mcap ? path : path / "metadata.yaml");
}

/// The messages of all frames of a run. A commit of the bag is a frame, but for the first, which
/// holds what is said once. Beside it stands what each commit holds (BagLines).
class RunBag final : public RunOutput {
 public:
  RunBag(const RunPlan& plan, ros::TopicsSpec topics, std::int64_t begin_ns);

  [[nodiscard]] std::uint64_t num_frames() const override { return num_frames_; }
  [[nodiscard]] bool is_complete() const override { return is_complete_; }
  [[nodiscard]] const fs::path& path() const override { return path_; }
  [[nodiscard]] bool IsUnchanged() const override;
  void Discard() override;
  std::uint64_t Open(std::uint64_t num_frames) override;
  void Encode(std::size_t sensor, const MadeFrame& made, EncodedFrame& encoded) const override;
  void Write(const EncodedFrame& encoded) override;
  void Finish(const RunPlan& plan,
              std::int64_t end_ns,
              const Transform& world_from_vehicle) override;

 private:
  void FindFrames(const fs::path& bag);
  [[nodiscard]] bool HasOthers() const;
  void RefuseStrangers() const;
  void Put(const std::vector<ros::TopicMessage>& messages);

  fs::path path_;
  bool is_mcap_;
  /// Names and texts of the files that are attached first.
  std::vector<std::pair<std::string, std::string>> attachments_;
  ros::FrameTopics topics_;
  std::vector<bag::BagTopic> bag_topics_;
  std::vector<std::uint64_t> topic_hashes_;
  std::int64_t begin_ns_;
  bool is_complete_ = false;
  std::uint64_t num_frames_ = 0;
  WholeCommits whole_;  ///< What there is of an interrupted bag.
  std::vector<bag::BagAttachment> attached_;
  std::optional<LineFile> lines_;
  std::unique_ptr<bag::BagWriter> writer_;
};

RunBag::RunBag(const RunPlan& plan, ros::TopicsSpec topics, std::int64_t begin_ns)
    : path_(plan.directory / plan.sensors.front().spec.files.format->bag),
      is_mcap_(path_.extension() == ".mcap"),
      attachments_(
          {{std::string(kScenarioFile), ResolvedScenarioJson(plan.scenario)},
           {std::string(kLabelsFile), LabelsJson(plan.sensors.front().spec.files.labels)}}),
      topics_(std::move(topics)),
      begin_ns_(begin_ns),
      is_complete_(IsFinished(is_mcap_, path_)) {
  for (const auto& [name, type, is_latched] : topics_.topics()) {
    bag_topics_.push_back({name, type.name, type.definition, type.hash, is_latched});
    topic_hashes_.push_back(TopicHash(bag_topics_.back()));
  }
  if (is_complete_) {
    for (const SensorPlan& sensor : plan.sensors) num_frames_ += sensor.spec.num_frames;
  } else if (IsBegun(is_mcap_, path_)) {
    FindFrames(UnfinishedPath(is_mcap_, path_));
  }
}

// Finds what an unfinished bag holds. What cannot be read has no frames.
void RunBag::FindFrames(const fs::path& bag) {
  try {
    const auto reader = bag::OpenBag(bag);
    whole_ = FindWholeCommits(BagLinesFile(path_), *reader);
    attached_ = reader->ReadAttachments();
  } catch (const InputError&) {
    whole_ = {};
  }
  num_frames_ = whole_.num - std::min<std::uint64_t>(whole_.num, kFirstCommits);
}

bool RunBag::IsUnchanged() const {
  try {
    if (ReadBagLines(BagLinesFile(path_)).files.empty()) return false;
    ErrorList faults;
    CompareWithBagLines(path_, true, faults);
    return faults.empty();
  } catch (const InputError&) {
    return false;  // It cannot be read.
  }
}

// What others have put where the bag is would be lost with it.
void RunBag::RefuseStrangers() const {
  for (const fs::path& bag : {path_, UnfinishedPath(is_mcap_, path_)}) {
    if (!fs::is_directory(bag)) continue;
    if (is_mcap_) RefuseStranger(bag.parent_path(), bag.filename().string());
    for (const auto& entry : fs::directory_iterator(bag)) {
      std::string name = entry.path().filename().string();
      name = std::string(FinishedName(name).value_or(name));
      const bool is_own =
          IsOfDatabase(bag / name) || name == "metadata.yaml" || name.ends_with(kManifestFile) ||
          std::ranges::any_of(attachments_,
                              [&](const auto& attachment) { return attachment.first == name; });
      if (is_own && !entry.is_directory()) continue;
      RefuseStranger(bag.parent_path(),
                     entry.path().lexically_relative(bag.parent_path()).string());
    }
  }
}

void RunBag::Discard() {
  RefuseStrangers();
  writer_.reset();
  lines_.reset();
  for (const fs::path& each : {path_, UnfinishedPath(is_mcap_, path_), BagLinesFile(path_)}) {
    fs::remove_all(each);
  }
  is_complete_ = false;
  num_frames_ = 0;
  whole_ = {};
  attached_.clear();
}

// Whether an unfinished bag holds what was not written.
bool RunBag::HasOthers() const {
  if (whole_.num == 0 || whole_.has_others) return true;
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  // A database cannot be cut. All of its commits have lines, so that each must be whole.
  if (!is_mcap_) return bag::ContinueRosbag2(path_, kAll)->num_commits() > whole_.num;
  // What stands in an MCAP file cannot be written anew.
  return std::ranges::any_of(attachments_, [&](const auto& file) {
    const auto found = std::ranges::find(attached_, file.first, &bag::BagAttachment::name);
    return found == attached_.end() ||
           !std::ranges::equal(found->bytes, std::as_bytes(std::span(file.second)));
  });
}

std::uint64_t RunBag::Open(std::uint64_t num_frames) {
  Check(!is_complete_ && num_frames <= num_frames_, "a bag goes on after frames that it holds");
  writer_.reset();
  if (IsBegun(is_mcap_, path_) && HasOthers()) {
    Discard();
    num_frames = 0;
  }
  std::size_t num_commits = 0;
  if (IsBegun(is_mcap_, path_)) {
    writer_ = Continue(is_mcap_, path_, std::min(num_frames + kFirstCommits, whole_.num));
    num_commits = writer_->num_commits();
  }
  lines_.emplace(BagLinesFile(path_), EndOfCommits(BagLinesFile(path_), num_commits));
  if (!writer_) writer_ = is_mcap_ ? bag::CreateMcap(path_) : bag::CreateRosbag2(path_);
  for (const bag::BagTopic& topic : bag_topics_) writer_->Add(topic);
  if (num_commits == 0 || !is_mcap_) {
    for (const auto& [name, text] : attachments_) AttachFile(*writer_, name, text);
  }
  if (num_commits == 0) Put(topics_.First(begin_ns_));
  num_frames_ = writer_->num_commits() - kFirstCommits;
  return num_frames_;
}

void RunBag::Encode(std::size_t sensor, const MadeFrame& made, EncodedFrame& encoded) const {
  auto messages = MessagesOf(topics_, sensor, made);
  std::string clouds;
  for (const ros::TopicMessage& message : messages) {
    if (topics_.topics()[message.topic].type.name != ros::PointCloud2::kName) continue;
    clouds.append(reinterpret_cast<const char*>(message.cdr.data()), message.cdr.size());
  }
  encoded.record.clouds_hash = ContentHash(clouds);
  encoded.output = std::move(messages);
}

void RunBag::Write(const EncodedFrame& encoded) {
  Put(std::any_cast<const std::vector<ros::TopicMessage>&>(encoded.output));
  ++num_frames_;
}

void RunBag::Put(const std::vector<ros::TopicMessage>& messages) {
  std::vector<std::uint64_t> hashes;
  for (const ros::TopicMessage& message : messages) {
    hashes.push_back(MessageHash(topic_hashes_[message.topic], message.time_ns, message.cdr));
  }
  // Before the commit, so that none is without its line.
  lines_->Append(CommitLine(hashes));
  if (!is_mcap_) lines_->Sync();
  for (const ros::TopicMessage& message : messages) {
    writer_->Write({message.topic, message.time_ns, message.cdr});
  }
  writer_->Commit();
}

void RunBag::Finish(const RunPlan& plan, std::int64_t end_ns, const Transform& world_from_vehicle) {
  Put({topics_.PoseAt(end_ns, world_from_vehicle)});
  for (const auto& [name, scenario, spec] : plan.sensors) {
    const std::string prefix = plan.is_in_folders() ? name + "." : "";
    AttachFile(*writer_, prefix + std::string(kManifestFile),
               ReadFileWhole(spec.directory / kManifestFile));
  }
  writer_->Close();
  writer_.reset();
  lines_->Append(BagFilesLine(path_));
  lines_->Sync();
  is_complete_ = true;
}

// How the points of a sensor are stored.
ros::CloudSpec PlannedClouds(const SequenceSpec& spec) {
  if (spec.layout.empty()) return {ros::PointLayout::kRailcast, spec.files.fields};
  return {ValueNamed<ros::PointLayout>(spec.layout).value(), {}};
}

void PlanBag(const std::string& fields, SensorPlan& sensor) {
  const LidarSpec& lidar = sensor.scenario.lidar;
  SequenceSpec& spec = sensor.spec;
  const ros::CloudSpec clouds = ros::ParseCloudSpec(fields, lidar.velocity.has_value(), true);
  spec.files.fields = clouds.fields;
  if (clouds.layout != ros::PointLayout::kRailcast) spec.layout = NameOf(clouds.layout);
  const std::uint32_t num = ros::NumClouds(clouds.layout, NumReturns(lidar.receiver.return_mode));
  for (std::uint32_t i = 0; i < num; ++i) {
    spec.cloud_topics.push_back(ros::PointsTopic(sensor.name, i));
  }
}

std::unique_ptr<RunOutput> FindBag(const FrameMaker& maker, const RunPlan& plan) {
  const std::int64_t begin_ns = maker.pattern(0).StampNs(plan.sensors.front().spec.start_frame);
  // The fields of the sensor with most fields; frames leave out what they lack.
  const auto num_fields = [](const SensorPlan& sensor) {
    return sensor.spec.files.fields.names().size();
  };
  const SensorPlan& richest = *std::ranges::max_element(plan.sensors, {}, num_fields);
  return std::make_unique<RunBag>(
      plan,
      TopicsSpecOf(plan.scenario, *maker.StateAt(begin_ns).world, PlannedClouds(richest.spec),
                   ros::ImageEncoding::kPng),
      begin_ns);
}

}  // namespace

void AddRos(RunExtras& extras) {
  extras.layouts = NamesOf<ros::PointLayout>();
  extras.plan_bag = PlanBag;
  extras.find_bag = FindBag;
}

}  // namespace railcast
