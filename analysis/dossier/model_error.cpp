#include "analysis/dossier/dossier_report.h"

#include <algorithm>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include "analysis/study/approach_scan.h"

namespace railcast {
namespace {

// The frames of an approach are alike, so that each of them is not needed.
std::vector<std::uint32_t> Thinned(const std::vector<std::uint32_t>& frames) {
  constexpr std::size_t kMostFrames = 40;
  const std::size_t step = (frames.size() + kMostFrames - 1) / kMostFrames;
  std::vector<std::uint32_t> thinned;
  for (std::size_t i = 0; i < frames.size(); i += step) thinned.push_back(frames[i]);
  return thinned;
}

RunCourses CoursesOn(Fidelity fidelity,
                     const StudySpec& study,
                     ScenarioSpec scenario,
                     const std::vector<std::uint32_t>& frames,
                     int num_threads) {
  // Is never complete, so that all frames up to the closest are traced.
  constexpr DetectionRule kNever = {
      .min_points = std::numeric_limits<std::uint32_t>::max(), .min_frames = 1, .of_frames = 1};
  if (scenario.fidelity != fidelity) {
    scenario.fidelity = fidelity;
    scenario.effects = {};
  }
  return ApproachScanner(num_threads, {}, study.gauge, study.objects)
      .Follow(scenario, frames, kNever, [] { return false; })
      .value();
}

void AddCompared(const RunCourses& courses, const RunCourses& reference, ModelError& error) {
  for (const auto& [name, course] : courses.objects) {
    if (course.sightings.empty()) continue;
    const std::span<const Sighting> approach = ApproachIn(course.sightings);
    if (!std::ranges::any_of(approach, &Sighting::is_in_way) || !IsApproached(approach)) continue;
    const std::vector<Sighting>& expected = reference.objects.at(name).sightings;
    ComparedApproach compared{.target = TargetOf(name),
                              .approach = {.object = name, .instance = 0, .points = {}}};
    for (std::size_t i = 0; i < approach.size(); ++i) {
      compared.approach.points.push_back({.distance_m = approach[i].distance_m,
                                          .points_in_reference = expected[i].points,
                                          .points = approach[i].points});
    }
    error.approaches.push_back(std::move(compared));
  }
}

}  // namespace

ModelError MeasureModelError(const FinishedStudy& study,
                             const std::vector<ScenarioSpec>& sample,
                             int num_threads,
                             const std::function<void(double done)>& on_progress) {
  const std::vector<std::uint32_t> frames = Thinned(study.frames);
  ModelError error;
  const StudySpec& spec = study.spec;
  error.min_points = spec.detector ? spec.detector->min_points : spec.detect.rule.min_points;
  std::set<Fidelity> rungs;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    on_progress(static_cast<double>(i) / static_cast<double>(sample.size()));
    const ScenarioSpec& scenario = sample[i];
    rungs.insert(scenario.fidelity);
    AddCompared(CoursesOn(scenario.fidelity, study.spec, scenario, frames, num_threads),
                CoursesOn(Fidelity::kReference, study.spec, scenario, frames, num_threads), error);
  }
  if (rungs.size() == 1) error.rung = NameOf(*rungs.begin());
  return error;
}

}  // namespace railcast
