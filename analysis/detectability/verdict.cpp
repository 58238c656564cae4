#include "analysis/detectability/verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace railcast {
namespace {

constexpr double kNoDistance_m = std::numeric_limits<double>::quiet_NaN();

void Add(const ObjectDetection& detection, Verdict& verdict) {
  verdict.is_in_way = verdict.is_in_way || detection.is_in_way;
  verdict.from_axis_m = std::min(verdict.from_axis_m, detection.from_axis_m);
  if (detection.fate == Fate::kNeverApproached) return;
  ++verdict.num_approached;
  // Both comparisons are negated so that they also replace an initial NaN.
  if (!(verdict.most_needed_m >= detection.needed_m)) verdict.most_needed_m = detection.needed_m;
  if (detection.fate == Fate::kNeverDetected) return;
  ++verdict.num_detected;
  verdict.num_in_time += detection.is_in_time() ? 1U : 0U;
  if (detection.is_from_start && !detection.is_in_time()) {
    ++verdict.num_undecided;
    return;
  }
  // If detected at once, the distance is only a lower bound.
  if (!detection.is_from_start) {
    verdict.distance_m.Add(detection.distance_m);
    verdict.spare_m.Add(detection.spare_m());
    if (!(verdict.least_distance_m <= detection.distance_m)) {
      verdict.least_distance_m = detection.distance_m;
    }
  }
  if (!(verdict.least_spare_m <= detection.spare_m())) verdict.least_spare_m = detection.spare_m();
}

std::string Runs(std::uint64_t num, std::uint64_t all) {
  if (all == 1) return "in the one run";
  if (num == all) return "in all " + std::to_string(all) + " runs";
  return "in " + std::to_string(num) + " of " + std::to_string(all) + " runs";
}

}  // namespace

std::string Verdict::InWords() const {
  if (num_approached == 0) return "never approached";
  if (num_detected == 0) return "not detected " + Runs(num_approached, num_approached);
  if (num_in_time == num_approached) return "in time " + Runs(num_in_time, num_approached);
  std::string words;
  const auto add = [&](const char* what, std::uint64_t num) {
    if (num == 0) return;
    if (!words.empty()) words += ", ";
    words += what + Runs(num, num_approached);
  };
  add("too late ", num_detected - num_in_time - num_undecided);
  add("not detected ", num_approached - num_detected);
  add("not known, begun too near ", num_undecided);
  return words;
}

std::vector<Verdict> MakeVerdicts(const std::vector<DetectRun>& runs) {
  std::map<std::string, Verdict> by_name;
  for (const DetectRun& run : runs) {
    for (const auto& [name, detection] : run.detections) {
      const ObjectCourse& course = run.courses.objects.at(name);
      const auto [entry, is_new] = by_name.try_emplace(name);
      Verdict& verdict = entry->second;
      if (is_new) {
        verdict.name = name;
        verdict.type = course.type;
        verdict.label = course.label;
        verdict.from_axis_m = std::numeric_limits<double>::infinity();
        verdict.least_distance_m = verdict.least_spare_m = verdict.most_needed_m = kNoDistance_m;
      }
      Add(detection, verdict);
    }
  }
  std::vector<Verdict> verdicts;
  for (auto& [name, verdict] : by_name) verdicts.push_back(std::move(verdict));
  return verdicts;
}

}  // namespace railcast
