#include <algorithm>
#include <cstring>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/base/units.h"
#include "core/extras/ros/messages/point_layout.h"
#include "core/io/cloud/pcd_encoder.h"
#include "core/io/recording/cloud_fields.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/run/sequence_files.h"
#include "core/io/run/table_records.h"
#include "generator/extras/convert/convert_output.h"
#include "generator/extras/convert/encode_cloud.h"
#include "generator/extras/insert/clouds/label_numbers.h"

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
    return {FixedText(std::string(kLabelsFile), LabelsJson(labels_))};
  }

  void Encode(const SourceFrame& source,
              std::uint32_t number,
              ConvertedFrame& converted) const override {
    const Frame& frame = source.recorded.frame;
    Losses& lost = converted.record.lost;
    Cloud cloud = CloudFor(format_, source, names_, lost);
    if (!format_.has_all_slots) {
      AddLoss("rows of organised clouds", NumRowsAlone(cloud), lost);
      AddLoss("places without a point", DropAbsentPoints(cloud), lost);
    }
    AddLoss("poses within scans", source.recorded.has_pose ? frame.poses_between.size() : 0, lost);
    const std::string name = FrameFileNames(format_, number).front();
    converted.lines = {name + ",0," + NumberText(frame.index) + "," + NumberText(frame.stamp_ns) +
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
  ConvertedKitti(const FrameFormat& format, const RecordingInfo& info, const SourceSurvey& survey)
      : format_(format),
        info_(info),
        are_kitti_numbers_(info.has_kitti_labels || info.labels.labels().empty()),
        survey_(survey),
        first_from_world_(survey.first.recorded.frame.world_from_sensor.inverse()) {}

  [[nodiscard]] std::vector<LineFileName> LineFiles() const override {
    std::vector<LineFileName> names;
    if (survey_.has_poses) names.push_back({std::string(kKittiPosesFile), ""});
    if (survey_.has_stamps) names.push_back({std::string(kKittiTimesFile), ""});
    return names;
  }
  [[nodiscard]] std::vector<FixedFile> FixedFiles() const override {
    std::vector<FixedFile> files;
    for (FrameFile& file : format_.dataset->fixed_files(info_.labels)) {
      // Numbers that nothing is known of have no classes.
      if (file.name == kKittiLabelsFile && are_kitti_numbers_) continue;
      files.push_back(FixedText(std::move(file.name), std::move(file.bytes)));
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
    const Frame frame = WithOutcomes(recorded);
    CountLosses(source, frame, converted);
    const FrameFileSpec spec = {.format = &format_, .fields = {}, .labels = LabelsFor(frame)};
    EncodeFrameFiles(frame, spec, number - survey_.range.first, converted.files,
                     MovingInstances(recorded.objects));
    const std::int64_t first_ns = survey_.first.recorded.frame.stamp_ns;
    converted.lines = format_.dataset->record_lines(first_from_world_ * frame.world_from_sensor,
                                                    SecondsFromNs(frame.stamp_ns - first_ns));
    if (!survey_.has_stamps) converted.lines.pop_back();
    if (!survey_.has_poses) converted.lines.erase(converted.lines.begin());
  }

  [[nodiscard]] Losses LostOfAll() const override {
    Losses lost;
    AddLoss("poses of the first frame, from which the others count", survey_.has_poses ? 1 : 0,
            lost);
    AddLoss("stamps of the first frame, from which the others count", survey_.has_stamps ? 1 : 0,
            lost);
    return lost;
  }

 private:
  /// SemanticKITTI's number of a label; 0: it has none.
  [[nodiscard]] std::uint32_t KittiNumberOf(std::uint32_t id) const {
    if (are_kitti_numbers_) return id;
    const Label* const label = info_.labels.Find(id);
    return label == nullptr ? 0 : label->semantic_kitti;
  }
  /// The table by which labels become these.
  [[nodiscard]] LabelTable LabelsFor(const Frame& frame) const {
    std::vector<Label> labels = KittiNumbersIn(frame).labels();
    for (Label& label : labels) {
      label.semantic_kitti = static_cast<std::uint16_t>(KittiNumberOf(label.id));
    }
    return LabelTable(std::move(labels));
  }

  void CountLosses(const SourceFrame& source, const Frame& frame, ConvertedFrame& converted) const {
    const RecordedFrame& recorded = source.recorded;
    Losses& lost = converted.record.lost;
    std::uint64_t num_points = 0;
    std::uint64_t num_unknown = 0;
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      if (!HasPoint(frame.outcome[slot])) continue;
      ++num_points;
      const std::uint32_t number = KittiNumberOf(frame.label[slot]);
      num_unknown += frame.label[slot] != 0 && number == 0 ? 1 : 0;
      constexpr std::uint32_t kMax = 0xFFFF;
      if (number <= kMax) continue;
      throw InputError(recorded.name + ": label: must be at most 65535 for --format kitti" +
                       Got(number));
    }
    converted.record.frame.counts.points = num_points;

    // These follow from positions and rows where the cloud has them not.
    const std::set<std::string, std::less<>> filled_in = {"range_m", "ring", "column",
                                                          "return_index", "return_count"};
    for (const std::string& name : recorded.fields) {
      const bool is_stored =
          !filled_in.contains(name) || FindFieldOf(source.cloud, name) != nullptr;
      if (is_stored && !IsKittiField(name)) AddLoss("values of " + name, num_points, lost);
    }
    for (const ForeignField& field : recorded.foreign) {
      AddLoss("values of " + field.name, num_points, lost);
    }
    const CloudField* const x = FindFieldOf(source.cloud, "x");
    const bool is_double = x != nullptr && x->type == NumberType::kDouble;
    AddLoss("positions in double precision, rounded", is_double ? num_points : 0, lost);
    const std::uint64_t num_places = std::max<std::uint64_t>(source.cloud.num_points(), num_points);
    AddLoss("places without a point", num_places - num_points, lost);
    AddLoss("rows of organised clouds", NumRowsAlone(source.cloud), lost);
    const bool loses_pose = recorded.has_pose && !survey_.has_poses;
    AddLoss("poses, which not all frames have", loses_pose ? 1 : 0, lost);
    AddLoss("labels without a number in SemanticKITTI, now 0", num_unknown, lost);
    AddLoss("intensities not known, now 0", recorded.Has("intensity") ? 0 : num_points, lost);
  }

  const FrameFormat& format_;
  const RecordingInfo& info_;
  bool are_kitti_numbers_;  ///< Whether labels are SemanticKITTI's numbers, or of no table.
  const SourceSurvey& survey_;
  Transform first_from_world_;
};

/// The cloud with some of its fields, and without what stands between them.
Cloud WithFields(const Cloud& cloud, const std::vector<CloudField>& fields) {
  Cloud kept{.height = cloud.height,
             .width = cloud.width,
             .fields = {},
             .point_step = 0,
             .is_dense = cloud.is_dense,
             .data = {}};
  for (const CloudField& field : fields) {
    kept.AddField(std::string(field.plain_name()), field.type, field.count);
  }
  kept.data.resize(cloud.num_points() * kept.point_step);
  for (std::size_t point = 0; point < cloud.num_points(); ++point) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      std::memcpy(&kept.data[point * kept.point_step + kept.fields[i].offset],
                  &cloud.data[point * cloud.point_step + fields[i].offset], fields[i].num_bytes());
    }
  }
  return kept;
}

}  // namespace

std::vector<std::string> ChosenFields(const std::string& fields,
                                      const std::vector<std::string>& there) {
  if (fields == "all") return {};
  std::vector<std::string> wanted;
  for (std::size_t begin = 0; begin <= fields.size();) {
    const std::size_t end = std::min(fields.find(',', begin), fields.size());
    wanted.push_back(fields.substr(begin, end - begin));
    begin = end + 1;
    if (std::ranges::find(there, wanted.back()) != there.end()) continue;
    throw InputError("--fields: must be among those of the recording, " +
                     Join(there, ", ", ShownText) + " (got " + ShownText(wanted.back()) + ")");
  }
  for (const char* axis : {"x", "y", "z"}) {
    // Other software may write capitals.
    if (std::ranges::find(wanted, axis, LowerCase) != wanted.end()) continue;
    throw InputError("--fields: must contain x, y and z (got " + ShownText(fields) + ")");
  }
  return wanted;
}

Cloud CloudFor(const FrameFormat& format,
               const SourceFrame& source,
               const std::vector<std::string>& names,
               Losses& lost) {
  for (const std::string& name : names) {
    if (source.cloud.Find(name) != nullptr) continue;
    throw InputError(source.recorded.name + ": must have the field " + ShownText(name) +
                     ", as the first frame has");
  }
  for (const char* axis : {"x", "y", "z"}) {
    const CloudField& field = NeedFieldOf(source.cloud, axis, source.recorded.name);
    if (Holds(format, field)) continue;
    throw InputError(source.recorded.name + ": " + axis + ": must be a number of a type that " +
                     std::string(format.name) + " has (got " + NumberText(field.count) + " of " +
                     PcdLetter(field.type) + NumberText(SizeOf(field.type)) + ")");
  }
  std::vector<CloudField> held;
  for (const CloudField& field : source.cloud.fields) {
    const std::string name(field.plain_name());
    if (!names.empty() && std::ranges::find(names, name) == names.end()) continue;
    // If several fields have one name, the first counts.
    if (Holds(format, field) && source.cloud.Find(name) == &field) {
      held.push_back(field);
    } else {
      AddLoss("values of " + name, source.cloud.num_points(), lost);
    }
  }
  return WithFields(source.cloud, held);
}

std::unique_ptr<ConvertOutput> MakeConvertOutput(const ConvertChoices& choices,
                                                 const RecordingInfo& info,
                                                 const SourceSurvey& survey) {
  const FrameFormat& format = ParseFrameFormat(choices.format);
  const SourceFrame& first = survey.first;
  if (!first.recorded.Has("x")) {
    throw InputError(ShownPath(info.source) + ": must have points (got a sequence without)");
  }
  if (format.dataset) return std::make_unique<ConvertedKitti>(format, info, survey);
  const bool is_layout = ValueNamed<ros::PointLayout>(choices.fields).has_value();
  std::vector<std::string> there;
  for (const CloudField& field : first.cloud.fields) there.emplace_back(field.plain_name());
  const auto names = [&] { return ChosenFields(is_layout ? "all" : choices.fields, there); };
  if (!format.bag.empty()) return MakeConvertedBag(choices, info, names(), survey);
  if (is_layout) {
    throw InputError("--fields " + choices.fields +
                     ": must be with --format mcap or rosbag2 (got " + choices.format + ")");
  }
  return std::make_unique<ConvertedFiles>(format, info.labels, names());
}

}  // namespace railcast
