#include <algorithm>
#include <string>

#include "analysis/inspect/inspection.h"

namespace railcast {
namespace {

using enum Fitness;

/// What it takes to know where each firing went.
JobFitness FiringsOf(const RecordingLook& seen, const RecordingInfo& info) {
  if (!seen.why_no_ranges.empty()) return {"", kNo, seen.why_no_ranges};
  if (info.origin || seen.num_with_beams == seen.num_frames) return {"", kYes, ""};
  if (seen.num_grids == seen.num_frames && seen.sensor.found) {
    const auto guesses = GuessSensor(seen.rings);
    const bool is_known = !guesses.empty() && guesses.front().error_deg < kLikelyGuess_deg;
    return {"", kWithOption,
            "the plan should name its sensor as lidar" +
                (is_known ? ", by its rings a " + guesses.front().name : std::string()) +
                "; without it, that of its points is taken, with default range and power"};
  }
  return {
      "", kNo,
      "its firings are not known: " + (seen.sensor.found ? seen.why_no_grid : seen.sensor.why_not)};
}

std::string WithPoses(const RecordingLook& seen, const RecordingInfo& info, std::string needs) {
  if (seen.num_with_pose == seen.num_frames) return needs;
  if (!needs.empty()) needs += "; ";
  return needs + "since " + (info.has_kitti_labels ? "its clouds have" : "it has") +
         " no poses, the plan needs " +
         (info.has_kitti_labels ? "poses.txt and calib.txt beside them, " : "") +
         "world.recording.poses_file, or poses of standing or registered";
}

JobFitness Insertion(const RecordingLook& seen, const RecordingInfo& info, bool is_weather) {
  JobFitness firings = FiringsOf(seen, info);
  firings.job = is_weather ? "weather" : "insert";
  if (firings.fitness == kNo && (is_weather || !seen.why_no_ranges.empty())) return firings;
  if (firings.fitness == kNo) {
    firings.fitness = kWithOption;
    firings.why = "--points-alone, since " + firings.why;
  }
  firings.why = WithPoses(seen, info, firings.why);
  if (!firings.why.empty()) firings.fitness = kWithOption;
  return firings;
}

JobFitness Statistics(const RecordingLook& seen) {
  if (!seen.why_no_ranges.empty()) {
    return {"stats", kYes, "without dropout and figures by range and ring: " + seen.why_no_ranges};
  }
  if (seen.num_grids == seen.num_frames) return {"stats", kYes, ""};
  return {"stats", kYes, "without dropout and figures by ring: " + seen.why_no_grid};
}

JobFitness Survey(const RecordingLook& seen) {
  if (seen.num_with_pose == seen.num_frames) return {"survey", kYes, ""};
  return {"survey", kWithOption, "--poses FILE, --standing or --world-axes, since it has no poses"};
}

JobFitness Evaluation(const RecordingLook& seen, const RecordingInfo& info) {
  if (info.origin && seen.num_with_objects > 0) return {"evaluate", kYes, ""};
  return {"evaluate", kNo, "it has no boxes of objects that railcast knows"};
}

JobFitness Fit(const RecordingLook& seen, const RecordingInfo& info) {
  if (!seen.why_no_ranges.empty()) return {"fit", kNo, seen.why_no_ranges};
  if (seen.num_grids < seen.num_frames) return {"fit", kNo, seen.why_no_grid};
  if (info.origin) return {"fit", kYes, ""};
  return {"fit", kWithOption, "--scenario SCENARIO with its sensor"};
}

}  // namespace

std::vector<JobFitness> JobsOf(const RecordingLook& inspection, const RecordingInfo& info) {
  if (inspection.num_points == 0) {
    std::vector<JobFitness> none;
    for (const char* const job : kJobs) none.push_back({job, kNo, "it has no point"});
    return none;
  }
  return {{"view", kYes, ""},
          Statistics(inspection),
          Insertion(inspection, info, false),
          Insertion(inspection, info, true),
          Survey(inspection),
          Evaluation(inspection, info),
          Fit(inspection, info)};
}

}  // namespace railcast
