#include "generator/run/run_bag.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/run/sequence_files.h"
#include "core/io/write_file.h"
#include "generator/run/run_topics.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kJsonType = "application/json";
/// The commit of what is said once, before the frames.
constexpr std::uint64_t kFirstCommits = 1;

void AttachFile(bag::BagWriter& writer, const std::string& name, const std::string& bytes) {
  writer.Attach(name, std::string(kJsonType), std::as_bytes(std::span(bytes)));
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

// How many frames an unfinished bag holds. It is only read, since another process may be writing
// it; what cannot be read has no frames, and is refused when it is gone on with.
std::uint64_t CountFrames(const fs::path& path, const RunPlan& plan) {
  std::uint64_t num_frames = 0;
  try {
    const auto reader = bag::OpenBag(path);
    std::vector<std::size_t> first_clouds;
    for (std::size_t i = 0; i < reader->topics().size(); ++i) {
      if (std::ranges::any_of(plan.sensors, [&](const SensorPlan& sensor) {
            return sensor.spec.cloud_topics.front() == reader->topics()[i].name;
          })) {
        first_clouds.push_back(i);
      }
    }
    reader->Select(first_clouds);
    while (reader->Next()) ++num_frames;
  } catch (const InputError&) {
    return num_frames;
  }
  return num_frames;
}

// A rosbag2 directory gets its metadata last.
bool IsFinished(bool is_mcap, const fs::path& path) {
  return fs::exists(is_mcap ? path : path / "metadata.yaml");
}

}  // namespace

RunBag::RunBag(const RunPlan& plan, ros::TopicsSpec topics, std::int64_t begin_ns)
    : path_(plan.directory / plan.sensors.front().spec.files.format->bag),
      is_mcap_(path_.extension() == ".mcap"),
      scenario_json_(ResolvedScenarioJson(plan.scenario)),
      labels_file_(plan.sensors.front().spec.directory / kLabelsFile),
      topics_(std::move(topics)),
      begin_ns_(begin_ns),
      is_complete_(IsFinished(is_mcap_, path_)) {
  if (is_complete_) {
    for (const SensorPlan& sensor : plan.sensors) num_frames_ += sensor.spec.num_frames;
  } else if (IsBegun(is_mcap_, path_)) {
    num_frames_ = CountFrames(UnfinishedPath(is_mcap_, path_), plan);
  }
}

std::uint64_t RunBag::Open(std::uint64_t num_frames) {
  Check(!is_complete_ && num_frames <= num_frames_, "a bag goes on after frames that it holds");
  writer_.reset();
  if (IsBegun(is_mcap_, path_)) {
    writer_ = Continue(is_mcap_, path_, num_frames + kFirstCommits);
  } else {
    writer_ = is_mcap_ ? bag::CreateMcap(path_) : bag::CreateRosbag2(path_);
  }
  for (const ros::Topic& topic : topics_.topics()) {
    const auto& [name, type, is_latched] = topic;
    writer_->Add({name, type.name, type.definition, type.hash, is_latched});
  }
  if (writer_->num_commits() == 0) Begin();
  num_frames_ = writer_->num_commits() - kFirstCommits;
  return num_frames_;
}

void RunBag::Begin() {
  AttachFile(*writer_, std::string(kScenarioFile), scenario_json_);
  AttachFile(*writer_, std::string(kLabelsFile), ReadFileWhole(labels_file_));
  Put(topics_.First(begin_ns_));
}

void RunBag::Encode(std::size_t sensor, const MadeFrame& made, EncodedFrame& encoded) const {
  encoded.messages = MessagesOf(topics_, sensor, made);
  std::string clouds;
  for (const ros::TopicMessage& message : encoded.messages) {
    if (topics_.topics()[message.topic].type.name != ros::PointCloud2::kName) continue;
    clouds.append(reinterpret_cast<const char*>(message.cdr.data()), message.cdr.size());
  }
  encoded.record.clouds_hash = ContentHash(clouds);
}

void RunBag::Write(const EncodedFrame& encoded) {
  Put(encoded.messages);
  ++num_frames_;
}

void RunBag::Put(const std::vector<ros::TopicMessage>& messages) {
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
  is_complete_ = true;
}

}  // namespace railcast
