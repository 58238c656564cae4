#include <algorithm>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/cloud/kitti.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/ros/point_layout.h"
#include "core/io/run/sequence_files.h"
#include "core/io/run/table_records.h"
#include "generator/convert/convert_output.h"
#include "generator/convert/encode_cloud.h"

namespace railcast {
namespace {

constexpr std::string_view kConvertedHeader =
    "file,run,frame,stamp_ns,x,y,z,qx,qy,qz,qw,points,lost_points,end_time_ns,end_x,end_y,end_z,"
    "end_qx,end_qy,end_qz,end_qw\n";

/// The numbers of a pose as a line of poses.csv has them, without the stamp; empty words where it
/// is not known.
std::string PoseWords(bool is_known, const Transform& pose) {
  if (!is_known) return ",,,,,,,";
  std::string line = PoseLine({0, pose});
  line.pop_back();
  return line.substr(line.find(','));
}

/// Clouds in files, with frames.csv.
class ConvertedFiles final : public ConvertOutput {
 public:
  ConvertedFiles(const FrameFormat& format, LabelTable labels, std::vector<std::string> names)
      : format_(format), labels_(std::move(labels)), names_(std::move(names)) {}

  [[nodiscard]] std::vector<LineFileName> LineFiles() const override {
    return {{std::string(kReceivedFile), std::string(kConvertedHeader)}};
  }
  [[nodiscard]] std::vector<FixedFile> FixedFiles() const override {
    if (labels_.labels().empty()) return {};
    return {{std::string(kLabelsFile), LabelsJson(labels_), {}}};
  }

  void Encode(const SourceFrame& source,
              std::uint32_t number,
              ConvertedFrame& converted) const override {
    const Frame& frame = source.recorded.frame;
    Losses& lost = converted.record.lost;
    Cloud cloud = CloudFor(format_, source, names_, lost);
    if (!format_.has_all_slots) AddLoss("places without a point", DropAbsentPoints(cloud), lost);
    AddLoss("poses within scans", source.recorded.has_pose ? frame.poses_between.size() : 0, lost);
    AddLoss("boxes of objects", source.recorded.objects.size(), lost);
    const std::string name = FrameFileNames(format_, number).front();
    converted.lines = {name + ",0," + NumberText(number) + "," + NumberText(frame.stamp_ns) +
                       PoseWords(source.recorded.has_pose, frame.world_from_sensor) + "," +
                       NumberText(cloud.num_points()) + ",0," + NumberText(frame.duration_ns) +
                       PoseWords(source.recorded.has_pose, frame.world_from_sensor_end) + "\n"};
    converted.record.frame.counts.points = cloud.num_points();
    converted.files = {{name, EncodeCloud(cloud, format_)}};
  }

 private:
  const FrameFormat& format_;
  LabelTable labels_;
  std::vector<std::string> names_;
};

/// KITTI's layout, in which points have a fixed set of fields.
class ConvertedKitti final : public ConvertOutput {
 public:
  ConvertedKitti(const FrameFormat& format,
                 const RecordingInfo& info,
                 std::uint32_t first_number,
                 const RecordedFrame& first)
      : format_(format),
        info_(info),
        first_number_(first_number),
        has_poses_(first.has_pose),
        first_stamp_ns_(first.frame.stamp_ns),
        first_from_world_(first.frame.world_from_sensor.inverse()) {}

  [[nodiscard]] std::vector<LineFileName> LineFiles() const override {
    std::vector<LineFileName> names = {{std::string(kKittiTimesFile), ""}};
    if (has_poses_) names.insert(names.begin(), {std::string(kKittiPosesFile), ""});
    return names;
  }
  [[nodiscard]] std::vector<FixedFile> FixedFiles() const override {
    std::vector<FixedFile> files;
    for (FrameFile& file : format_.dataset->fixed_files(info_.labels)) {
      // Numbers that nothing is known of have no classes.
      const bool is_of_labels = file.name == kKittiLabelsFile;
      if (is_of_labels && (info_.has_kitti_labels || info_.labels.labels().empty())) continue;
      files.push_back({std::move(file.name), std::move(file.bytes), {}});
    }
    return files;
  }

  void Encode(const SourceFrame& source,
              std::uint32_t number,
              ConvertedFrame& converted) const override {
    const RecordedFrame& recorded = source.recorded;
    if (!recorded.origin_m.isZero()) {
      throw InputError(recorded.name +
                       ": must have positions near 0 for --format kitti, which are float32 (got "
                       "those of a national grid); pcd, ply, mcap and rosbag2 keep them");
    }
    if (recorded.has_pose != has_poses_) {
      throw InputError(recorded.name + ": must have a pose as the first frame " +
                       (has_poses_ ? "has" : "has none") + " for --format kitti");
    }
    const Frame frame = WithOutcomes(recorded);
    CountLosses(source, frame, converted);
    const FrameFileSpec spec = {
        .format = &format_, .fields = {}, .labels = LabelsFor(frame, recorded.name)};
    EncodeFrameFiles(frame, spec, number - first_number_, converted.files,
                     MovingIn(recorded.objects));
    std::vector<std::string> lines =
        format_.dataset->record_lines(first_from_world_ * frame.world_from_sensor,
                                      SecondsFromNs(frame.stamp_ns - first_stamp_ns_));
    if (!has_poses_) lines.erase(lines.begin());
    converted.lines = std::move(lines);
  }

  [[nodiscard]] Losses LostOfAll() const override {
    Losses lost;
    if (has_poses_) lost["poses of the first frame, from which the others count"] = 1;
    lost["stamps of the first frame, from which the others count"] = 1;
    return lost;
  }

 private:
  static std::set<std::uint32_t> MovingIn(const std::vector<RecordedObject>& objects) {
    std::set<std::uint32_t> moving;
    for (const RecordedObject& object : objects) {
      if (IsMoving(object.velocity_world_mps)) moving.insert(object.instance);
    }
    return moving;
  }

  /// The table by which labels become SemanticKITTI's numbers.
  [[nodiscard]] LabelTable LabelsFor(const Frame& frame, const std::string& name) const {
    if (info_.has_kitti_labels || info_.labels.labels().empty()) {
      for (const std::uint32_t label : frame.label) CheckFits(label, name);
      return KittiNumbersIn(frame);
    }
    for (const std::uint32_t label : frame.label) {
      if (info_.labels.Find(label) == nullptr) {
        throw InputError(name + ": label: must be in the recording's table for --format kitti" +
                         Got(label));
      }
    }
    return info_.labels;
  }
  static void CheckFits(std::uint32_t label, const std::string& name) {
    constexpr std::uint32_t kMax = 0xFFFF;
    if (label <= kMax) return;
    throw InputError(name + ": label: must be at most 65535 for --format kitti" + Got(label));
  }

  void CountLosses(const SourceFrame& source, const Frame& frame, ConvertedFrame& converted) const {
    const RecordedFrame& recorded = source.recorded;
    Losses& lost = converted.record.lost;
    std::uint64_t num_points = 0;
    std::uint64_t num_unknown = 0;
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      if (!HasPoint(frame.outcome[slot])) continue;
      ++num_points;
      const Label* const label = info_.labels.Find(frame.label[slot]);
      const bool is_known = info_.has_kitti_labels || label == nullptr || frame.label[slot] == 0;
      num_unknown += is_known || label->semantic_kitti != 0 ? 0 : 1;
    }
    converted.record.frame.counts.points = num_points;

    // These follow from positions and rows where the cloud has them not.
    const std::set<std::string, std::less<>> filled_in = {"range_m", "column", "return_index",
                                                          "return_count"};
    for (const std::string& name : recorded.fields) {
      const bool is_stored = !filled_in.contains(name) || source.cloud.Find(name) != nullptr;
      if (is_stored && !IsKittiField(name)) AddLoss("values of " + name, num_points, lost);
    }
    for (const ForeignField& field : recorded.foreign) {
      AddLoss("values of " + field.name, num_points, lost);
    }
    const CloudField* const x = source.cloud.Find("x");
    const bool is_double = x != nullptr && x->type == NumberType::kDouble;
    AddLoss("positions in double precision, rounded", is_double ? num_points : 0, lost);
    const std::uint64_t num_places = std::max<std::uint64_t>(source.cloud.num_points(), num_points);
    AddLoss("places without a point", num_places - num_points, lost);
    AddLoss("labels without a number in SemanticKITTI, now 0", num_unknown, lost);
    AddLoss("intensities that are not known, now 0", recorded.Has("intensity") ? 0 : num_points,
            lost);
    AddLoss("boxes of objects", recorded.objects.size(), lost);
  }

  const FrameFormat& format_;
  const RecordingInfo& info_;
  std::uint32_t first_number_;
  bool has_poses_;
  std::int64_t first_stamp_ns_;
  Transform first_from_world_;
};

/// The chosen fields of a cloud; empty: all.
/// @throws InputError "--fields: ..." if it lacks one.
std::vector<std::string> NamesIn(const Cloud& cloud, const std::string& fields) {
  if (fields == "all") return {};
  std::string valid;
  for (const CloudField& field : cloud.fields) {
    valid.append(valid.empty() ? "" : ", ").append(ShownText(field.plain_name()));
  }
  std::vector<std::string> wanted;
  for (std::size_t begin = 0; begin <= fields.size();) {
    const std::size_t end = std::min(fields.find(',', begin), fields.size());
    wanted.push_back(fields.substr(begin, end - begin));
    begin = end + 1;
    if (cloud.Find(wanted.back()) != nullptr) continue;
    throw InputError("--fields: must be among those of the recording, " + valid + " (got " +
                     ShownText(wanted.back()) + ")");
  }
  for (const char* axis : {"x", "y", "z"}) {
    if (std::ranges::find(wanted, axis) != wanted.end()) continue;
    throw InputError("--fields: must contain x, y and z (got " + ShownText(fields) + ")");
  }
  return wanted;
}

}  // namespace

Cloud CloudFor(const FrameFormat& format,
               const SourceFrame& source,
               const std::vector<std::string>& names,
               Losses& lost) {
  for (const std::string& name : names) {
    if (source.cloud.Find(name) != nullptr) continue;
    throw InputError(source.recorded.name + ": must have the field " + ShownText(name) +
                     ", as the first frame has");
  }
  std::vector<std::string> held;
  for (const CloudField& field : source.cloud.fields) {
    const std::string name(field.plain_name());
    if (!names.empty() && std::ranges::find(names, name) == names.end()) continue;
    if (Holds(format, field)) {
      held.push_back(name);
    } else {
      AddLoss("values of " + name, source.cloud.num_points(), lost);
    }
  }
  return WithFields(source.cloud, held);
}

std::unique_ptr<ConvertOutput> MakeConvertOutput(const ConvertChoices& choices,
                                                 const RecordingInfo& info,
                                                 const SourceFrame& first) {
  const FrameFormat& format = ParseFrameFormat(choices.format);
  if (!first.recorded.Has("x")) {
    throw InputError(ShownPath(info.source) + ": must have points (got a sequence without)");
  }
  if (format.dataset) {
    return std::make_unique<ConvertedKitti>(format, info, choices.first_frame, first.recorded);
  }
  const bool is_layout = ValueNamed<ros::PointLayout>(choices.fields).has_value();
  if (!format.bag.empty()) {
    return MakeConvertedBag(choices, info, NamesIn(first.cloud, is_layout ? "all" : choices.fields),
                            first);
  }
  if (is_layout) {
    throw InputError("--fields " + choices.fields +
                     ": must be with --format mcap or rosbag2 (got " + choices.format + ")");
  }
  return std::make_unique<ConvertedFiles>(format, info.labels,
                                          NamesIn(first.cloud, choices.fields));
}

}  // namespace railcast
