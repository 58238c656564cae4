#include "core/extras/recipe/dataset_report_record.h"

#include "core/base/text.h"
#include "core/scenario/archive.h"

namespace railcast {
namespace {

// The sum of what `value_of` gives of each element must be the total.
template <class Values, class ValueOf>
void EnsureSum(Archive& a,
               std::string_view key,
               const Values& values,
               std::uint64_t total,
               const ValueOf& value_of) {
  std::uint64_t sum = 0;
  for (const auto& value : values) sum += value_of(value);
  a.Ensure({key}, sum == total, "must sum up to " + NumberText(total));
}

constexpr auto kItself = [](std::uint64_t count) { return count; };
constexpr auto kOfName = [](const auto& named) { return named.second; };

void EnsureAtMost(Archive& a, std::string_view key, std::uint64_t count, std::uint64_t most) {
  a.Ensure({key}, count <= most, "must be <= " + NumberText(most));
}

}  // namespace

void Describe(Archive& a, SplitCountsRecord& s) {
  a.Required("scenarios", s.scenarios, "Number of scenarios in this part.");
  a.Required("frames", s.frames, "Number of frames in this part.");
  a.Required("points", s.points, "Number of points in these frames.");
}

void Describe(Archive& a, LabelCountsRecord& s) {
  a.Required("points", s.points, "Number of points with this label.");
  a.Required("share", s.share, "Their share of all points.");
  a.Required("frames", s.frames, "Number of frames with at least one such point.");
}

void Describe(Archive& a, DistanceCounts& s) {
  for (std::size_t i = 0; i < s.size(); ++i) {
    a.Required(DistanceBinName(i), s[i], "How many have this distance.");
  }
}

void Describe(Archive& a, OcclusionCounts& s) {
  for (std::size_t i = 0; i < s.size(); ++i) {
    a.Required(kOcclusionBinNames[i], s[i], "How many are hidden by this share.");
  }
}

void Describe(Archive& a, TypeCountsRecord& s) {
  a.Required("objects", s.objects,
             "Number of distinct objects; the other keys count an object in each frame.");
  a.Required("in_frames", s.in_frames, "How often an object of this type is in a frame.");
  a.Required("with_points", s.with_points, "How often it has a point there.");
  a.Required("points", s.points, "Number of points on objects of this type.");
  a.Required("by_distance", s.by_distance, "Objects in frames, by distance from the sensor.");
  a.Required("points_by_distance", s.points_by_distance,
             "Points on objects, by the object's distance.");
  a.Required("by_occlusion", s.by_occlusion,
             "Objects in frames, by the hidden share of their firings.");
  EnsureAtMost(a, "objects", s.objects, s.in_frames);
  EnsureAtMost(a, "with_points", s.with_points, s.in_frames);
  EnsureSum(a, "by_distance", s.by_distance, s.in_frames, kItself);
  EnsureSum(a, "points_by_distance", s.points_by_distance, s.points, kItself);
  EnsureSum(a, "by_occlusion", s.by_occlusion, s.in_frames, kItself);
}

void Describe(Archive& a, DatasetReportRecord& s) {
  a.Required("num_frames", s.num_frames, "Number of frames in the data set.");
  a.Required("splits", s.splits, "Counts for each part: train, val and test.");
  a.Required("frames_without_points", s.frames_without_points, "Number of frames without a point.");
  a.Required("frames_without_objects", s.frames_without_objects,
             "Number of frames without a point on any object.");
  a.Required("duplicate_frames", s.duplicate_frames,
             "Number of frames whose bytes repeat those of another frame.");
  DescribeKnown(a, s.counts);
  a.Required("labels", s.labels, "Counts for each label; empty where labels are not counted.");
  a.Required("objects", s.objects, "Counts for each type of object.");
  a.Required("weathers", s.weathers, "Number of scenarios with each kind of weather.");
  a.Required("drawn", s.drawn, "Number of scenarios with each value of the draws between words.");
  a.Required("frames_by_base", s.frames_by_base, "Number of frames of each base scenario.");
  a.Required("frames_by_sensor", s.frames_by_sensor, "Number of frames of each sensor.");
  EnsureAtMost(a, "frames_without_points", s.frames_without_points, s.num_frames);
  EnsureAtMost(a, "frames_without_objects", s.frames_without_objects, s.num_frames);
  EnsureAtMost(a, "duplicate_frames", s.duplicate_frames, s.num_frames);
  EnsureSum(a, "splits", s.splits, s.num_frames,
            [](const auto& split) { return split.second.frames; });
  EnsureSum(a, "splits", s.splits, s.counts.points,
            [](const auto& split) { return split.second.points; });
  // Recordings may be without labels.
  if (!s.labels.empty()) {
    EnsureSum(a, "labels", s.labels, s.counts.points,
              [](const auto& label) { return label.second.points; });
  }
  std::uint64_t num_scenarios = 0;
  for (const auto& [name, split] : s.splits) num_scenarios += split.scenarios;
  EnsureSum(a, "weathers", s.weathers, num_scenarios, kOfName);
  EnsureSum(a, "frames_by_base", s.frames_by_base, s.num_frames, kOfName);
  EnsureSum(a, "frames_by_sensor", s.frames_by_sensor, s.num_frames, kOfName);
}

}  // namespace railcast
