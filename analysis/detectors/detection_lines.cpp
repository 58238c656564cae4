#include <string>
#include <string_view>
#include <utility>

#include "analysis/detectors/reported_detections.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scenario/json_reader.h"
#include "core/scenario/json_source.h"

namespace railcast {

void Describe(Archive& a, ReportedDetection& s) {
  a.Optional("center_m", s.center_m, "Of a box.", Within(-kFarthestBox_m, kFarthestBox_m));
  a.Optional("size_m", s.size_m, "Of a box: length, width, height.", PositiveUpTo(kLargestBox_m));
  a.Optional("quaternion_xyzw", s.quaternion_xyzw, "Turns the box.", Within(-1, 1));
  a.Optional("points", s.points, "Of a cluster: their places in the frame's file.", NonEmptyList());
  a.Optional("score", s.score, "How sure the detector is.", Within(0, 1));
  a.Optional("class", s.class_name, "What it is taken for.", OneLine());
  const Eigen::Map<const Eigen::Vector4d> turn(s.quaternion_xyzw.data());
  constexpr double kRounding = 1e-3;
  a.Ensure({"quaternion_xyzw"}, std::abs(turn.norm() - 1.0) <= kRounding, "must have length 1");
  a.Ensure({"", "center_m", "size_m", "points"},
           s.points ? !s.center_m && !s.size_m : s.center_m && s.size_m,
           "must have either center_m and size_m, or points");
}

void Describe(Archive& a, ReportedFrame& s) {
  a.Required("frame", s.frame, "Number of the frame, as its file has it.");
  a.Optional("latency_ms", s.latency_ms, "From the stamp until this is known.", Within(0, 1e5));
  a.Optional("compensate", s.compensation, "Which motion had been undone.");
  a.Optional("axes", s.axes, "Whose axes the boxes are in.");
  a.Optional("handedness", s.handedness, "Of these axes.");
  a.Required("detections", s.detections, "Of this frame; may be empty.");
}

namespace {

// A line without its end. The place, "FILE:3", is for messages.
ReportedFrame ReadDetectionLine(std::string_view line, const std::string& place) {
  JsonSource source;
  ReportedFrame frame;
  frame.place = place;
  if (const auto root = source.OpenText(std::string(line), place)) {
    if (auto list = source.PlainMembers(*root)) {
      ReadMembers(source, *root, std::move(*list), frame);
    }
  }
  source.errors().ThrowIfAny();
  return frame;
}

}  // namespace

ReportedRun ReadDetectionLines(const std::string& text, const std::string& shown) {
  ReportedRun run;
  std::string_view rest = text;
  std::size_t number = 0;
  while (const auto line = TakeLine(rest)) {
    ReportedFrame frame = ReadDetectionLine(*line, shown + ":" + NumberText(++number));
    if (!run.empty() && frame.frame <= run.back().frame) {
      throw InputError({{frame.place + ": /frame",
                         "must be > that of the line before, " + NumberText(run.back().frame),
                         NumberText(frame.frame)}});
    }
    run.push_back(std::move(frame));
  }
  return run;
}

}  // namespace railcast
