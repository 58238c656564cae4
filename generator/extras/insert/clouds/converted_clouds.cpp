#include <cmath>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/recording/firing_truth.h"
#include "core/io/recording/recording_kinds.h"
#include "generator/extras/insert/clouds/recording_output.h"

namespace railcast {
namespace {

constexpr std::string_view kReceivedHeader =
    "file,run,frame,stamp_ns,x,y,z,qx,qy,qz,qw,points,lost_points\n";

/// The fields that a frame has and those that say what was inserted.
FieldSelection FieldsFor(const RecordedFrame& recorded) {
  std::string list;
  ForEachField(recorded.frame, [&](std::string_view name, std::string_view, const auto&) {
    const bool is_truth = name == "label" || name == "instance" || name == "outcome";
    if (!recorded.Has(name) && !is_truth) return;
    list += (list.empty() ? "" : ",") + std::string(name);
  });
  return FieldSelection(list, recorded.frame.has_velocity);
}

/// With labels of one table.
Frame WholeFrame(const InsertedFrame& inserted, const LabelNumbers& labels) {
  Frame frame = WithOutcomes(inserted.recorded);
  frame.label = WrittenLabels(inserted, labels);
  return frame;
}

/// Clouds of any recording in a format of railcast's.
class ConvertedClouds : public RecordingOutput {
 public:
  ConvertedClouds(const RecordingInfo& info,
                  const InsertPlan& plan,
                  const FrameFormat& format,
                  std::uint32_t first_frame)
      : plan_(plan),
        has_kitti_labels_(info.has_kitti_labels),
        table_(info.labels.labels().empty() ? LabelTable(plan.scenario.labels) : info.labels),
        labels_(LabelNumbersOf(plan, info)),
        format_(format),
        first_frame_(first_frame) {}

  [[nodiscard]] std::vector<LineFileName> LineFiles() const override {
    if (!format_.dataset) return {{std::string(kReceivedFile), std::string(kReceivedHeader)}};
    std::vector<LineFileName> names;
    for (const std::string_view name : format_.dataset->record_files) {
      names.push_back({std::string(name), ""});
    }
    return names;
  }

  [[nodiscard]] std::vector<FixedFile> FixedFiles() const override {
    std::vector<FixedFile> files;
    if (!format_.dataset) return files;
    for (FrameFile& file : format_.dataset->fixed_files(table_)) {
      files.push_back(FixedText(std::move(file.name), std::move(file.bytes)));
    }
    return files;
  }

  [[nodiscard]] WrittenFrame Encode(const RecordedFirings& /*firings*/,
                                    const InsertedFrame& inserted,
                                    std::uint32_t frame) const override {
    const std::set<std::uint32_t> moving = MovingInstances(inserted.objects);
    const Frame whole = WholeFrame(inserted, labels_);
    const FrameFileSpec spec = {.format = &format_,
                                .fields = FieldsFor(inserted.recorded),
                                .labels = has_kitti_labels_ ? KittiNumbersIn(whole) : table_};
    WrittenFrame output;
    const std::uint32_t number = format_.dataset ? frame - first_frame_ : frame;
    EncodeFrameFiles(whole, spec, number, output.files, moving);
    for (std::uint32_t slot = 0; slot < whole.num_slots(); ++slot) {
      if (format_.has_all_slots || HasPoint(whole.outcome[slot])) output.slots.push_back(slot);
    }
    output.lines = LinesOf(whole, frame, output);
    return output;
  }

 private:
  [[nodiscard]] std::vector<std::string> LinesOf(const Frame& written,
                                                 std::uint32_t frame,
                                                 const WrittenFrame& output) const {
    if (format_.dataset) {
      const std::int64_t first_ns = plan_.frame_times_ns.at(first_frame_);
      return format_.dataset->record_lines(PlannedPose(plan_, first_ns).inverse() *
                                               PlannedPose(plan_, plan_.frame_times_ns.at(frame)),
                                           SecondsFromNs(plan_.frame_times_ns[frame] - first_ns));
    }
    std::string line = PoseLine(
        {plan_.first_stamp_ns + plan_.frame_times_ns.at(frame), written.world_from_sensor});
    line.pop_back();
    return {output.files.front().name + ",0," + NumberText(frame) + "," + line + "," +
            NumberText(output.slots.size()) + ",0\n"};
  }

  const InsertPlan& plan_;
  bool has_kitti_labels_;
  LabelTable table_;
  LabelNumbers labels_;
  const FrameFormat& format_;
  std::uint32_t first_frame_;
};

}  // namespace

Frame WithOutcomes(const RecordedFrame& recorded) {
  Frame frame = recorded.frame;
  if (HasAllOutcomes(recorded)) return frame;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    // Files of points alone know the outcomes of these.
    const bool is_known = !std::isnan(frame.x[slot]) && HasPoint(frame.outcome[slot]);
    if (is_known) continue;
    frame.outcome[slot] = std::isnan(frame.x[slot]) ? Outcome::kNoSurface : Outcome::kReturned;
  }
  return frame;
}

LabelTable KittiNumbersIn(const Frame& frame) {
  const std::set<std::uint32_t> ids(frame.label.begin(), frame.label.end());
  std::vector<Label> labels;
  for (const std::uint32_t id : ids) {
    Label& label = labels.emplace_back();
    label.id = id;
    label.semantic_kitti = static_cast<std::uint16_t>(id);
  }
  return LabelTable(std::move(labels));
}

std::unique_ptr<RecordingOutput> MakeConvertedClouds(const RecordingInfo& info,
                                                     const InsertPlan& plan,
                                                     const FrameFormat& format,
                                                     std::uint32_t first_frame) {
  if (format.files.empty()) {
    throw InputError("--format: must be same or a format with a file for each frame (got " +
                     std::string(format.name) + ")");
  }
  return std::make_unique<ConvertedClouds>(info, plan, format, first_frame);
}

}  // namespace railcast
