#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "analysis/frontier/differences.h"
#include "analysis/report/report.h"
#include "analysis/study/finished_study.h"

namespace railcast {

/// An object in the way, as the study's rung and the rung `reference` see it on one approach, with
/// the same draws.
struct ComparedApproach {
  std::string target;
  Approach approach;
};

/// How far the rung of a study is from the reference on the study's own scenes.
struct ModelError {
  std::string rung;            ///< Of the study; empty if its scenarios differ in their rungs.
  std::uint32_t min_points{};  ///< That the study's rule or detector asks for.
  std::vector<ComparedApproach> approaches;
};

/// Makes at most 40 frames of each approach of the sample on both rungs.
/// @param on_progress Called with the share that is done.
/// @throws InputError as MakeSimulator() does.
[[nodiscard]] ModelError MeasureModelError(const FinishedStudy& study,
                                           const std::vector<ScenarioSpec>& sample,
                                           int num_threads,
                                           const std::function<void(double done)>& on_progress);

/// Points against distance on both rungs, by target, and the distances from which on the points
/// suffice.
[[nodiscard]] Section ModelErrorSection(const ModelError& error);

}  // namespace railcast
