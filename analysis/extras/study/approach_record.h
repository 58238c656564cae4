#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/detectability/object_detection.h"
#include "analysis/extras/detectors/run_evaluation.h"
#include "core/certify/certificate.h"
#include "core/extras/recipe/scenario_draw.h"
#include "core/scenario/json_text.h"
#include "core/scenario/value_type.h"

namespace railcast {

/// What is pooled over approaches: the name without the number of a placed object, "person" of
/// "person/2".
[[nodiscard]] std::string TargetOf(const std::string& name);

/// Whether a study asks about an object.
/// @param objects StudySpec::objects.
[[nodiscard]] bool IsAskedAbout(const std::string& name, const std::vector<std::string>& objects);

/// An object in the way, as a study records it.
struct StudiedObject {
  std::string name{};
  std::string type{};
  bool is_detected{};
  double distance_m{};  ///< Where it was detected; NaN without a detection.
  /// Number of the frame that completes the rule, or that of the closest point without detection.
  std::uint32_t frame{};
  bool is_from_start{};                 ///< Whether the first frames complete the rule already.
  double nearest_m{};                   ///< Distances of the approach, ...
  double farthest_m{};                  ///< ... from the first sighting on.
  double speed_mps{};                   ///< At the detection, or where it was first in range.
  double needed_m{};                    ///< To stop, with the margin.
  std::map<std::string, Json> drawn{};  ///< What was drawn for the object itself, by JSON pointer.

  [[nodiscard]] std::string Target() const { return TargetOf(name); }
  /// 0 without detection.
  [[nodiscard]] double detected_m() const { return is_detected ? distance_m : 0.0; }
  /// If the object was not detected, the whole distance needed is missing.
  [[nodiscard]] double spare_m() const { return detected_m() - needed_m; }
  [[nodiscard]] bool is_in_time() const { return is_detected && spare_m() >= 0.0; }
  /// Whether the approach began too near to tell: detected at once, yet too late.
  [[nodiscard]] bool is_undecided() const { return is_from_start && !is_in_time(); }
};

void Describe(Archive& a, StudiedObject& s);

/// What a detector says of an approach beyond the objects in the way.
struct ApproachAlarms {
  double driven_m{};
  std::vector<std::string> beside{};  ///< Objects that must raise no alarm.
  std::vector<FalseAlarm> alarms{};
};

/// What is known of the numerical error of an approach: the certificates of its frames, as to the
/// echoes of the objects that were followed. A figure weighs drawn firings by their strata,
/// whichever frame they are of, so that the frames' strata are added up, and nothing is lost but
/// the frames.
struct ApproachCertificate {
  std::uint32_t frames{};
  std::map<std::string, std::uint32_t> objects{};  ///< Instances by name.
  FrameCertificate sum{};                          ///< Without what other rungs would give.

  /// Adds a frame, if any beam of it may meet an object.
  void Add(const FrameCertificate& frame);
};
void Describe(Archive& a, ApproachCertificate& s);

/// One approach of a study.
struct ApproachRecord {
  std::uint32_t scenario{};
  std::uint64_t seed{};
  std::string base{};
  std::map<std::string, Json> drawn{};     ///< By name or JSON pointer.
  std::vector<StudiedObject> objects{};    ///< The objects in the way that are approached.
  std::optional<ApproachAlarms> alarms{};  ///< Only in studies with a detector.
  std::optional<ApproachCertificate> certificate{};
  /// If the approach was also made on a cheaper rung, LeastSpareOf() there.
  std::optional<double> cheap_spare_m{};
};

/// The least that any object in the way leaves to spare, in metres; a million without one, NaN
/// where none is too late and an approach began too near to tell.
[[nodiscard]] double LeastSpareOf(const ApproachRecord& approach);

/// A line of approaches.jsonl.
void Describe(Archive& a, ApproachRecord& s);

/// What the courses of a scenario say.
/// @param frames Numbers of the frames that were followed.
/// @throws InputError as DetectObject() does.
[[nodiscard]] ApproachRecord RecordOf(const DrawnScenario& drawn,
                                      const RunCourses& courses,
                                      const std::vector<std::uint32_t>& frames,
                                      const DetectSpec& spec);

[[nodiscard]] ApproachAlarms AlarmsOf(const EvaluatedRun& run);

}  // namespace railcast
