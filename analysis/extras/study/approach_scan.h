#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/detectability/approach.h"
#include "analysis/detectability/object_detection.h"
#include "analysis/extras/detectors/cluster_detector.h"
#include "analysis/extras/detectors/run_evaluation.h"
#include "analysis/extras/study/approach_record.h"
#include "core/certify/certifier.h"
#include "core/io/run/object_survey.h"
#include "railcast/frame.h"
#include "railcast/io/recording.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// Simulates approaches as far as their verdicts depend on it: of all frames, only those up to the
/// detection, and of their firings, only those that may meet an object in the way.
///
/// Scenarios that follow one another and differ in objects, trains, motion, weather and seed alone
/// share their geometry. What is found of a scenario does not depend on those before it.
class ApproachScanner {
 public:
  /// @param num_threads,isa As MakeSimulator() takes them.
  /// @param gauge Of the train; absent = the vehicle's outline.
  /// @param objects Those that are followed: StudySpec::objects.
  /// @param certify Which share of the time certificates may take; absent = none are made.
  explicit ApproachScanner(int num_threads,
                           std::string isa = {},
                           std::optional<TrainGauge> gauge = {},
                           std::vector<std::string> objects = {},
                           std::optional<double> certify = {})
      : num_threads_(num_threads),
        isa_(std::move(isa)),
        gauge_(gauge),
        objects_(std::move(objects)),
        certify_(certify) {}

  /// Whether it has the geometry of a scenario already.
  [[nodiscard]] bool HasSceneOf(const ScenarioSpec& scenario) const;

  /// Follows the objects of a scenario with one sensor through some frames.
  ///
  /// DetectObject() says of those that are in the way and approached the same as of
  /// FollowObjects() on a sequence of these frames. Of others, and in frames after the detection,
  /// the numbers of points are 0.
  /// @param frames By rising number.
  /// @param is_stopped Asked before each frame.
  /// @return Nothing if it was stopped.
  /// @pre The fidelity is not `auto`.
  /// @throws InputError as MakeSimulator() does.
  [[nodiscard]] std::optional<RunCourses> Follow(const ScenarioSpec& scenario,
                                                 const std::vector<std::uint32_t>& frames,
                                                 const DetectionRule& rule,
                                                 const std::function<bool()>& is_stopped);

  /// Simulates whole frames of a scenario, to the last one, and evaluates what the reference
  /// detector finds in them: as `evaluate` does on a sequence of these frames.
  /// @param frames,is_stopped As for Follow(), with the same result, precondition and errors.
  [[nodiscard]] std::optional<EvaluatedRun> Evaluate(const ScenarioSpec& scenario,
                                                     const std::vector<std::uint32_t>& frames,
                                                     const ClusterDetectorSpec& detector,
                                                     const DetectSpec& detect,
                                                     const std::function<bool()>& is_stopped);

  /// The numerical error of the last scenario, as to the objects that were followed; absent where
  /// it is not wanted, and on rung `reference`.
  [[nodiscard]] const std::optional<ApproachCertificate>& certificate() const {
    return certificate_;
  }

  /// How much was traced since the scanner was made.
  struct Effort {
    std::uint64_t num_frames{};  ///< The frames that were asked for.
    std::uint64_t num_traced{};  ///< The frames in which firings were traced.
  };
  [[nodiscard]] const Effort& effort() const { return effort_; }

 private:
  void Use(const ScenarioSpec& scenario);
  /// Certifies what a frame has on some objects, if that is wanted.
  void Certify(BegunFrame& begun, std::span<const std::size_t> objects, const Frame& frame);

  int num_threads_;
  std::string isa_;
  std::optional<TrainGauge> gauge_;
  std::vector<std::string> objects_;
  std::optional<double> certify_;
  std::optional<ScenarioSpec> shared_;  ///< What the simulator's geometry depends on.
  std::unique_ptr<Simulator> simulator_;
  std::shared_ptr<const RailWorld> world_;  ///< The scenario's world.
  Frame frame_;
  RecordedFrame recorded_;              ///< Whole frames, whose memory is used again.
  std::optional<Certifier> certifier_;  ///< For the scenario, as is the certificate.
  std::optional<ApproachCertificate> certificate_;
  Effort effort_;
};

}  // namespace railcast
