#include <optional>
#include <utility>

#include "analysis/study/study_spec.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "core/scenario/json_reader.h"
#include "core/scenario/json_source.h"

namespace railcast {

template <class Archive>
void Describe(Archive& a, DetectionRule& s) {
  a.Optional("points", s.min_points, "Least number of points on an object that is seen.",
             Within(1, 1e6));
  a.Optional("frames", s.min_frames, "In how many frames it is seen ...", Within(1, 1e4));
  a.Optional("of_frames", s.of_frames, "... of so many consecutive ones.", Within(1, 1e4));
  a.Ensure({"of_frames", "frames"}, s.min_frames <= s.of_frames, "must be >= frames");
}

template <class Archive>
void Describe(Archive& a, BrakingSpec& s) {
  a.Optional("reaction_s", s.reaction_s, "From the detection to full braking.", Within(0, 60));
  a.Optional("deceleration_mps2", s.deceleration_mps2, "On the level.", Within(0.01, 10));
  a.Optional("margin_m", s.margin_m, "To be left before the object.", Within(0, 1000));
}

template <class Archive>
void Describe(Archive& a, StudySpec& s) {
  a.Optional("question", s.question, "What the study is to answer.");
  a.Required("recipe", s.recipe, "What scenarios are drawn from.", ExistingFile());
  a.Optional("detection", s.detect.rule, "When an object counts as detected.");
  a.Optional("braking", s.detect.braking, "How the train stops.");
  std::optional<double> speed_kmph;
  a.Optional("speed_kmph", speed_kmph, "To brake from; absent = the vehicle's own.",
             Within(0, 500));
  if (speed_kmph) s.detect.speed_mps = MpsFromKmph(*speed_kmph);
}

StudySpec ReadStudy(const std::filesystem::path& file) {
  JsonSource source;
  StudySpec study;
  if (const auto root = source.Open(file)) {
    if (auto list = source.PlainMembers(*root)) {
      ReadMembers(source, *root, std::move(*list), study);
    }
  }
  source.errors().ThrowIfAny();
  study.file = file;
  return study;
}

}  // namespace railcast
