#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/recording/bag_recording.h"
#include "core/extras/ros/recording/bag_series.h"
#include "core/extras/ros/recording/cloud_message.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/field_layout.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/recording_kinds.h"
#include "generator/extras/convert/convert_output.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// The files of a recording whose frames are clouds in files; none of others.
std::vector<fs::path> CloudsOf(const fs::path& clouds) {
  if (IsCloudFile(clouds)) return {clouds};
  if (!fs::is_directory(clouds)) return {};
  if (!fs::exists(clouds / kReceivedFile)) return CloudsOfDirectory(clouds).files;
  std::vector<fs::path> files;
  LineReader lines(clouds / kReceivedFile);
  (void)lines.Need();
  while (const auto line = lines.Next()) {
    files.push_back(clouds / line->text.substr(0, line->text.find(',')));
  }
  return files;
}

/// The reader of the clouds in a bag's topic; null if they are none of PointCloud2.
std::unique_ptr<bag::BagReader> CloudMessagesOf(const BagSource& source) {
  auto bag = bag::OpenBag(source.bag);
  const std::size_t topic = PickTopic(bag->topics(), source.bag, source.topic);
  if (bag->topics()[topic].type != ros::PointCloud2::kName) return nullptr;
  bag->Select({topic});
  return bag;
}

/// Copies the numbers of a field of each point to places of another layout.
template <typename Value>
void PutColumn(const std::vector<Value>& values, const CloudField& field, Cloud& cloud) {
  using Stored = typename StoredType<Value>::Type;
  char* place = reinterpret_cast<char*>(cloud.data.data()) + field.offset;
  for (std::size_t i = 0; i < values.size(); ++i, place += cloud.point_step) {
    StoreAt<Stored>(place, values[i]);
  }
}

/// The cloud of a frame that is not in one: its known fields, in the table's order, and others.
/// Positions far from 0 have the numbers that were stored.
Cloud CloudOfFrame(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  Cloud cloud{.height = frame.rows,
              .width = frame.width(),
              .fields = {},
              .point_step = 0,
              .is_dense = false,
              .data = {}};
  const auto for_each = [&](const auto& visit) {
    std::size_t axis = 0;
    ForEachField(frame, [&](std::string_view name, std::string_view, const auto& values) {
      const bool is_position = axis < 3;
      const double origin_m = is_position ? recorded.origin_m[static_cast<Eigen::Index>(axis)] : 0;
      ++axis;
      if (!recorded.Has(name)) return;
      if (!is_position || recorded.origin_m.isZero()) return visit(std::string(name), values);
      std::vector<double> stored;
      for (const auto value : values) stored.push_back(static_cast<double>(value) + origin_m);
      visit(std::string(name), stored);
    });
    for (const ForeignField& field : recorded.foreign) visit(field.name, field.values);
  };
  for_each([&](const std::string& name, const auto& values) {
    using Value = ElementOf<decltype(values)>;
    cloud.AddField(name, NumberTypeOf<typename StoredType<Value>::Type>());
  });
  cloud.data.resize(cloud.num_points() * cloud.point_step);
  std::size_t next = 0;
  for_each([&](const std::string&, const auto& values) {
    PutColumn(values, cloud.fields[next++], cloud);
  });
  return cloud;
}

}  // namespace

SourceFrames::SourceFrames(const fs::path& recording) : recording_(OpenRecording(recording)) {
  const RecordingInfo& info = recording_->info();
  // Sequences and insertions say more of their points than their clouds do.
  if (info.scenario || info.origin) return;
  if (info.kind == "bag of ROS 2") {
    if (const auto source = FindBag(recording)) {
      bag_ = CloudMessagesOf(*source);
      bag_series_ = source->series;
    }
    return;
  }
  const auto [clouds, columns] = KittiSourceOf(recording);
  files_ = CloudsOf(clouds);
  kitti_columns_ = columns;
  if (info.has_kitti_labels) kitti_ = ReadKittiPoses(clouds, files_.size());
}

std::optional<std::function<SourceFrame()>> SourceFrames::Next() {
  auto read = recording_->Next();
  if (!read) return std::nullopt;
  if (!files_.empty()) {
    std::optional<Transform> pose;
    std::optional<std::int64_t> stamp_ns;
    if (!kitti_.world_from_sensor.empty()) pose = kitti_.world_from_sensor.at(next_);
    if (!kitti_.times_ns.empty()) stamp_ns = kitti_.times_ns.at(next_);
    return [=, read = std::move(*read), file = files_.at(next_++), columns = kitti_columns_] {
      SourceFrame source{read(), ReadCloud(file, columns)};
      Frame& frame = source.recorded.frame;
      frame.stamp_ns = stamp_ns.value_or(frame.stamp_ns);
      if (!pose) return source;
      frame.world_from_sensor = *pose;
      frame.world_from_sensor_end = *pose;
      source.recorded.has_pose = true;
      return source;
    };
  }
  if (bag_ != nullptr) {
    const auto message = NextOfSeries(*bag_, bag_series_);
    Check(message.has_value(), "a bag has a message for each frame");
    return [read = std::move(*read), topic = bag_->topics()[message->topic].name,
            data = std::vector<std::byte>(message->data.begin(), message->data.end())] {
      auto cloud = ros::FromCdr<ros::PointCloud2>(data);
      const ros::Header header = cloud.header;
      return SourceFrame{read(), MakeCloud(std::move(cloud)), topic, header};
    };
  }
  return [read = std::move(*read)] {
    SourceFrame frame{read(), {}};
    frame.cloud = CloudOfFrame(frame.recorded);
    return frame;
  };
}

}  // namespace railcast
