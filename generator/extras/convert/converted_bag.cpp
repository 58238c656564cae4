#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/point_layout.h"
#include "core/extras/ros/messages/scene_topics.h"
#include "core/extras/ros/recording/cloud_message.h"
#include "core/io/recording/cloud_frame.h"
#include "core/io/unfinished_file.h"
#include "generator/extras/convert/convert_output.h"
#include "generator/extras/convert/encode_cloud.h"
#include "generator/extras/insert/clouds/recording_output.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

template <typename Message>
bag::BagTopic TopicOf(std::string name) {
  const ros::MessageType& type = ros::TypeOf<Message>();
  return {std::move(name), type.name, type.definition, type.hash};
}

/// The stamp of the message with which readers find the frame's.
std::int64_t MessageStamp_ns(const SourceFrame& source, const Cloud& cloud, Losses& lost) {
  const Frame& frame = source.recorded.frame;
  const auto first_ns = FirstTimeIn_ns(cloud);
  if (!first_ns) return frame.stamp_ns;
  const auto read_back_ns = [&](std::int64_t stamp_ns) {
    const FirstPointTime first = FirstPointTimeOf(stamp_ns, *first_ns, frame.duration_ns);
    return first.is_certain ? stamp_ns + std::llround(first.since_stamp_ns) : stamp_ns;
  };
  constexpr double kMost_ns = 9e18;
  const std::int64_t back_ns = std::abs(*first_ns) < kMost_ns ? std::llround(*first_ns) : 0;
  std::int64_t message_ns = frame.stamp_ns;
  if (source.header) {
    message_ns = source.header->stamp.sec * kNsPerS + source.header->stamp.nanosec;
  }
  for (const std::int64_t stamp_ns : {message_ns, frame.stamp_ns, frame.stamp_ns - back_ns}) {
    if (read_back_ns(stamp_ns) == frame.stamp_ns) return stamp_ns;
  }
  AddLoss("stamps that the times of points contradict", 1, lost);
  return frame.stamp_ns;
}

/// A bag with the clouds of a sensor and, where these are known, its poses in `map`. Those of a bag
/// keep their topic and frame of reference.
class ConvertedBag final : public ConvertOutput {
 public:
  ConvertedBag(const ConvertChoices& choices,
               const RecordingInfo& info,
               std::vector<std::string> names,
               const SourceSurvey& survey)
      : format_(ParseFrameFormat(choices.format)),
        path_(choices.directory / format_.bag),
        is_mcap_(path_.extension() == ".mcap"),
        num_frames_(survey.range.num),
        num_label_names_(info.labels.labels().size()),
        names_(std::move(names)) {
    const SourceFrame& first = survey.first;
    const auto& scenario = info.scenario;
    const std::string sensor =
        scenario && !scenario->lidar.name.empty() ? scenario->lidar.name : "lidar";
    frame_id_ = first.header ? first.header->frame_id : ros::RosName(sensor);
    if (const auto layout = ValueNamed<ros::PointLayout>(choices.fields)) {
      layout_ = ros::CloudSpec{*layout, {}};
    }
    topics_.push_back(TopicOf<ros::TfMessage>("/tf"));
    const bool is_vendors = layout_ && layout_->layout != ros::PointLayout::kRailcast;
    const std::uint32_t num =
        is_vendors ? ros::NumClouds(layout_->layout, first.recorded.frame.returns) : 1;
    if (!is_vendors) layout_.reset();
    for (std::uint32_t i = 0; i < num; ++i) {
      const bool keeps_topic = num == 1 && first.header;
      topics_.push_back(
          TopicOf<ros::PointCloud2>(keeps_topic ? first.topic : ros::PointsTopic(sensor, i)));
    }
  }

  [[nodiscard]] std::uint32_t Begin(std::uint32_t num_done) override {
    fs::path unfinished = path_;
    if (is_mcap_) unfinished += kUnfinishedSuffix;
    // With all frames it may have been closed, and cannot be gone on with.
    const bool is_begun = num_done > 0 && num_done < num_frames_ && fs::exists(unfinished) &&
                          !fs::exists(path_ / "metadata.yaml");
    if (is_begun) writer_ = Continued(num_done);
    if (!writer_) {
      fs::remove_all(path_);
      fs::remove(unfinished);
      writer_ = is_mcap_ ? bag::CreateMcap(path_) : bag::CreateRosbag2(path_);
    }
    for (const bag::BagTopic& topic : topics_) (void)writer_->Add(topic);
    return std::min(num_done, static_cast<std::uint32_t>(writer_->num_commits()));
  }

  void Encode(const SourceFrame& source,
              std::uint32_t /*number*/,
              ConvertedFrame& converted) const override {
    const Frame& frame = source.recorded.frame;
    Losses& lost = converted.record.lost;
    converted.messages.clear();
    if (source.recorded.has_pose) {
      converted.messages.push_back({0, frame.stamp_ns, ros::ToCdr(PosesOf(frame))});
    }
    converted.record.frame.counts.points = 0;
    if (layout_) {
      AddVendorClouds(source, converted);
    } else {
      const Cloud cloud = CloudFor(format_, source, names_, lost);
      const std::int64_t stamp_ns = MessageStamp_ns(source, cloud, lost);
      converted.record.frame.counts.points = cloud.num_points();
      const std::string& frame_id = source.header ? source.header->frame_id : frame_id_;
      converted.messages.push_back(
          {1, frame.stamp_ns,
           ros::ToCdr(MessageOf(cloud, ros::Header{ros::TimeOf(stamp_ns), frame_id}))});
    }
  }

  void Write(const ConvertedFrame& frame) override {
    for (const ros::TopicMessage& message : frame.messages) {
      writer_->Write({message.topic, message.time_ns, message.cdr});
    }
    writer_->Commit();
  }
  void Finish() override { writer_->Close(); }

  [[nodiscard]] std::vector<std::string> WholeFiles() const override {
    if (is_mcap_) return {path_.filename().string()};
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(path_)) {
      names.insert(entry.path().lexically_relative(path_.parent_path()).generic_string());
    }
    return {names.begin(), names.end()};
  }

  [[nodiscard]] Losses LostOfAll() const override {
    Losses lost;
    AddLoss("names of labels", num_label_names_, lost);
    return lost;
  }

 private:
  // The bag after its first commits; nothing if what there is of it cannot be read.
  [[nodiscard]] std::unique_ptr<bag::BagWriter> Continued(std::uint32_t num_commits) const {
    try {
      if (is_mcap_) return bag::ContinueMcap(path_, bag::McapCompression::kZstd, num_commits);
      const auto reader = bag::OpenBag(path_);
      while (reader->Next()) {
      }
      return bag::ContinueRosbag2(path_, num_commits);
    } catch (const InputError&) {
      return nullptr;
    }
  }

  [[nodiscard]] ros::TfMessage PosesOf(const Frame& frame) const {
    ros::TfMessage message;
    const auto add = [&](std::uint32_t time_ns, const Transform& pose) {
      message.transforms.push_back({{ros::TimeOf(frame.stamp_ns + time_ns), "map"},
                                    frame_id_,
                                    {ros::VectorOf(pose.translation()), ros::QuaternionOf(pose)}});
    };
    add(0, frame.world_from_sensor);
    for (const ScanPose& pose : frame.poses_between) add(pose.time_ns, pose.world_from_sensor);
    if (frame.duration_ns > 0) add(frame.duration_ns, frame.world_from_sensor_end);
    return message;
  }

  /// Adds the clouds that a vendor's driver would send. What is not read again is lost.
  void AddVendorClouds(const SourceFrame& source, ConvertedFrame& converted) const {
    const RecordedFrame& recorded = source.recorded;
    for (const char* name : {"intensity", "ring", "time_ns"}) {
      if (recorded.Has(name)) continue;
      throw InputError("--fields " + std::string(NameOf(layout_->layout)) + ": needs " + name +
                       " (got none in " + recorded.name + ")");
    }
    if (!recorded.origin_m.isZero()) {
      throw InputError(recorded.name + ": must have positions near 0 for --fields " +
                       std::string(NameOf(layout_->layout)));
    }
    const Frame frame = WithOutcomes(recorded);
    std::set<std::string, std::less<>> read;
    for (std::size_t i = 0; i + 1 < topics_.size(); ++i) {
      const auto message =
          ros::MakeCloud(frame, *layout_, frame_id_, {}, static_cast<std::uint32_t>(i));
      const Cloud cloud = MakeCloud(message);
      read.merge(MakeCloudFrame(cloud, recorded.name).fields);
      converted.record.frame.counts.points += cloud.num_points();
      converted.messages.push_back({i + 1, frame.stamp_ns, ros::ToCdr(message)});
    }
    const auto num_slots = static_cast<std::uint64_t>(frame.num_slots());
    for (const std::string& name : recorded.fields) {
      if (!read.contains(name)) AddLoss("values of " + name, num_slots, converted.record.lost);
    }
    for (const ForeignField& field : recorded.foreign) {
      AddLoss("values of " + field.name, num_slots, converted.record.lost);
    }
  }

  const FrameFormat& format_;
  fs::path path_;
  bool is_mcap_;
  std::uint32_t num_frames_;
  std::size_t num_label_names_;
  std::vector<std::string> names_;
  std::string frame_id_;
  std::optional<ros::CloudSpec> layout_;  ///< A vendor's; absent: the cloud's own fields.
  std::vector<bag::BagTopic> topics_;     ///< Behind /tf those of the clouds.
  std::unique_ptr<bag::BagWriter> writer_;
};

}  // namespace

std::unique_ptr<ConvertOutput> MakeConvertedBag(const ConvertChoices& choices,
                                                const RecordingInfo& info,
                                                const std::vector<std::string>& names,
                                                const SourceSurvey& survey) {
  return std::make_unique<ConvertedBag>(choices, info, names, survey);
}

}  // namespace railcast
