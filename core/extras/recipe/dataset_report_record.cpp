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
  a.Required("scenarios", s.scenarios, "");
  a.Required("frames", s.frames, "");
  a.Required("points", s.points, "");
}

void Describe(Archive& a, LabelCountsRecord& s) {
  a.Required("points", s.points, "");
  a.Required("share", s.share, "Of all points.");
  a.Required("frames", s.frames, "With such a point.");
}

void Describe(Archive& a, DistanceCounts& s) {
  for (std::size_t i = 0; i < s.size(); ++i) a.Required(DistanceBinName(i), s[i], "");
}

void Describe(Archive& a, OcclusionCounts& s) {
  for (std::size_t i = 0; i < s.size(); ++i) a.Required(kOcclusionBinNames[i], s[i], "");
}

void Describe(Archive& a, TypeCountsRecord& s) {
  a.Required("objects", s.objects, "Distinct ones; the others count an object in each frame.");
  a.Required("in_frames", s.in_frames, "");
  a.Required("with_points", s.with_points, "");
  a.Required("points", s.points, "");
  a.Required("by_distance", s.by_distance, "");
  a.Required("points_by_distance", s.points_by_distance, "");
  a.Required("by_occlusion", s.by_occlusion, "");
  EnsureAtMost(a, "objects", s.objects, s.in_frames);
  EnsureAtMost(a, "with_points", s.with_points, s.in_frames);
  EnsureSum(a, "by_distance", s.by_distance, s.in_frames, kItself);
  EnsureSum(a, "points_by_distance", s.points_by_distance, s.points, kItself);
  EnsureSum(a, "by_occlusion", s.by_occlusion, s.in_frames, kItself);
}

void Describe(Archive& a, DatasetReportRecord& s) {
  a.Required("num_frames", s.num_frames, "");
  a.Required("splits", s.splits, "By part.");
  a.Required("frames_without_points", s.frames_without_points, "");
  a.Required("frames_without_objects", s.frames_without_objects, "With no point on any object.");
  a.Required("duplicate_frames", s.duplicate_frames, "Of frames with the same bytes, all but one.");
  DescribeKnown(a, s.counts);
  a.Required("labels", s.labels, "By label; empty where labels are not counted.");
  a.Required("objects", s.objects, "By type.");
  a.Required("weathers", s.weathers, "Scenarios.");
  a.Required("drawn", s.drawn, "Scenarios by the words of each draw.");
  a.Required("frames_by_base", s.frames_by_base, "");
  a.Required("frames_by_sensor", s.frames_by_sensor, "");
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
