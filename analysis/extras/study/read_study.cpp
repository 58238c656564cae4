#include <utility>

#include "analysis/extras/study/study_spec.h"
#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/units.h"
#include "core/scenario/json_reader.h"
#include "core/scenario/json_source.h"

namespace railcast {

void Describe(Archive& a, DetectionRule& s) {
  a.Optional("points", s.min_points, "Least number of points on an object that is seen.",
             Within(1, 1e6));
  a.Optional("frames", s.min_frames, "In how many frames it is seen ...", Within(1, 1e4));
  a.Optional("of_frames", s.of_frames, "... of so many consecutive ones.", Within(1, 1e4));
  a.Ensure({"of_frames", "frames"}, s.min_frames <= s.of_frames, "must be >= frames");
}

void Describe(Archive& a, BrakingSpec& s) {
  a.Optional("reaction_s", s.reaction_s, "From the detection to full braking.", Within(0, 60));
  a.Optional("deceleration_mps2", s.deceleration_mps2, "On the level.", Within(0.01, 10));
  a.Optional("margin_m", s.margin_m, "To be left before the object.", Within(0, 1000));
}

void Describe(Archive& a, ClusterDetectorSpec& s) {
  std::string type;
  a.Required("type", type, "The reference detector, the only one.", OneOf({"clusters"}));
  a.Optional("min_height_m", s.min_height_m, "What is lower over top of rail is track.",
             Within(0, 5));
  a.Optional("min_distance_m", s.min_distance_m, "Ahead of the sensor: what is nearer is rain.",
             Within(0, 100));
  a.Optional("cluster_distance_m", s.cluster_distance_m,
             "Greatest distance of neighbours in a cluster, in plan.", Within(0.01, 10));
  a.Optional("min_points", s.min_points, "Least number of points of a cluster.", Within(1, 1e6));
}

void Describe(Archive& a, TrainGauge& s) {
  a.Required("width_m", s.width_m, "Width of the gauge.", Within(0.1, 10));
  a.Required("height_m", s.height_m, "Over top of rail.", Within(0.1, 10));
}

void Describe(Archive& a, RareSpec& s) {
  a.Optional("cheap", s.cheap, "The rung of most approaches; absent = the recipe's own.",
             OneOf({"geometry", "plausibility", "surface", "footprint"}));
  a.Optional("per_stage", s.per_stage, "Approaches of each stage of the search.", Within(100, 1e5));
  a.Optional("precision", s.precision, "Half the interval, as a share of the probability.",
             Within(0.05, 1));
  a.Optional("most_approaches", s.most_approaches, "After which no more are added.",
             Within(1000, 1e7));
  a.Optional(
      "unseen", s.unseen,
      "How rare a kind of failure may be that is met although no search leads to it; absent = "
      "as is worth it.",
      Within(1e-6, kMostUnseen));
  a.Ensure({"unseen"}, !s.unseen || *s.unseen >= LeastUnseen(s),
           "must be at least 12 / most_approaches");
  a.Ensure({"per_stage"}, s.per_stage <= s.most_approaches / 8,
           "must be at most an eighth of most_approaches");
}

void Describe(Archive& a, StudySpec& s) {
  a.Optional("question", s.question, "What the study is to answer.");
  a.Required("recipe", s.recipe, "What scenarios are drawn from.", ExistingFile());
  std::optional<std::vector<std::string>> objects;
  a.Optional("objects", objects, "Names of the objects to study; absent = all in the way.",
             NonEmptyString());
  a.Ensure({"objects"}, !objects || !objects->empty(), "must not be empty");
  if (objects) s.objects = std::move(*objects);
  a.Optional("detection", s.detect.rule, "When an object counts as detected.");
  a.Optional("detector", s.detector, "Finds the objects, in whole frames.");
  a.Optional("gauge", s.gauge, "Gauge of the train, instead of the vehicle's outline.");
  a.Optional("rare", s.rare, "Seeks the probability of rare failures.");
  a.Optional("braking", s.detect.braking, "How the train stops.");
  std::optional<double> speed_kmph;
  a.Optional("speed_kmph", speed_kmph, "To brake from; absent = the vehicle's own.",
             Within(0, 500));
  if (speed_kmph) s.detect.speed_mps = MpsFromKmph(*speed_kmph);
}

std::string StudySpec::ObjectsText() const {
  return objects.empty() ? "all objects in the way" : Join(objects);
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
