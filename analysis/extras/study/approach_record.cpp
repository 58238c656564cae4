#include "analysis/extras/study/approach_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scenario/archive.h"

namespace railcast {

std::string TargetOf(const std::string& name) {
  const std::size_t slash = name.rfind('/');
  if (slash == std::string::npos || slash + 1 == name.size()) return name;
  const auto is_digit = [](char letter) { return letter >= '0' && letter <= '9'; };
  const auto begin = name.begin() + static_cast<std::ptrdiff_t>(slash) + 1;
  return std::all_of(begin, name.end(), is_digit) ? name.substr(0, slash) : name;
}

bool IsAskedAbout(const std::string& name, const std::vector<std::string>& objects) {
  return objects.empty() || std::ranges::any_of(objects, [&](const std::string& asked) {
           return asked == name || asked == TargetOf(name);
         });
}

ApproachRecord RecordOf(const DrawnScenario& drawn,
                        const RunCourses& courses,
                        const std::vector<std::uint32_t>& frames,
                        const DetectSpec& spec) {
  const ScenarioRecord& said = drawn.record;
  ApproachRecord record{.scenario = said.scenario,
                        .seed = said.seed,
                        .base = said.base,
                        .drawn = {said.drawn.begin(), said.drawn.end()}};
  std::map<std::string, std::map<std::string, Json>> placed;
  for (const Json& object : said.placed) {
    auto& of_object = placed[object.value("name", "")];
    const Json drawn_of_object = object.value("drawn", Json::object());
    for (const auto& [key, value] : drawn_of_object.items()) {
      of_object.emplace(key, value);
    }
  }
  for (const auto& [name, course] : courses.objects) {
    const ObjectCourse& of_object = course;
    const ObjectDetection detection = AtPlace("object " + ShownText(name) + ": ", [&] {
      return DetectObject(of_object, spec.rule, spec.braking, spec.speed_mps);
    });
    if (detection.fate == Fate::kNeverApproached || !detection.is_in_way) continue;
    const std::span<const Sighting> approach = ApproachIn(course.sightings);
    const std::uint32_t frame = detection.frame.value_or(approach.back().frame);
    const auto found = placed.find(name);
    record.objects.push_back(
        {.name = name,
         .type = course.type,
         .is_detected = detection.fate == Fate::kDetected,
         .distance_m = detection.distance_m,
         .frame = frames.at(frame),
         .is_from_start = detection.is_from_start,
         .nearest_m = approach.back().distance_m,
         .farthest_m = std::ranges::max(approach, {}, &Sighting::distance_m).distance_m,
         .speed_mps = detection.speed_mps,
         .needed_m = detection.needed_m,
         .drawn = found == placed.end() ? std::map<std::string, Json>() : found->second});
  }
  return record;
}

double LeastSpareOf(const ApproachRecord& approach) {
  constexpr double kWithoutObject_m = 1e6;
  double least_m = kWithoutObject_m;
  bool is_known = true;
  for (const StudiedObject& object : approach.objects) {
    if (object.is_undecided()) {
      is_known = false;
    } else {
      least_m = std::min(least_m, object.spare_m());
    }
  }
  return is_known || least_m < 0.0 ? least_m : std::numeric_limits<double>::quiet_NaN();
}

ApproachAlarms AlarmsOf(const EvaluatedRun& run) {
  return {.driven_m = run.driven_m, .beside = run.ObjectsBeside(), .alarms = run.alarms};
}

void ApproachCertificate::Add(const FrameCertificate& frame) {
  if (frame.strata.empty()) return;
  ++frames;
  std::vector<std::uint32_t> places;
  for (const StratumCount& stratum : frame.strata) {
    const auto same = std::ranges::find(sum.strata, static_cast<const Stratum&>(stratum),
                                        [](const Stratum& each) { return each; });
    places.push_back(static_cast<std::uint32_t>(same - sum.strata.begin()));
    if (same == sum.strata.end()) {
      sum.strata.push_back(stratum);
    } else {
      same->firings += stratum.firings;
    }
  }
  for (DrawnFiring drawn : frame.drawn) {
    drawn.stratum = places[drawn.stratum];
    drawn.rungs.clear();
    sum.drawn.push_back(std::move(drawn));
  }
}

void Describe(Archive& a, ApproachCertificate& s) {
  a.Required("frames", s.frames, "Frames in which a beam may meet an object.");
  a.Required("objects", s.objects, "Instances of the objects whose echoes count, by name.");
  Describe(a, s.sum);
}

void Describe(Archive& a, StudiedObject& s) {
  a.Required("name", s.name, "Name of the object.");
  a.Required("type", s.type, "Type of the object.");
  a.Required("detected", s.is_detected, "Whether it was detected.");
  std::optional<double> distance_m;
  if (!std::isnan(s.distance_m)) distance_m = s.distance_m;
  a.Nullable("distance_m", distance_m, "Distance at which it was detected.");
  s.distance_m = distance_m.value_or(std::numeric_limits<double>::quiet_NaN());
  a.Required(
      "frame", s.frame,
      "Number of the frame that completes the rule, or else of the one with the closest point.");
  a.Required("from_start", s.is_from_start, "Whether the first frames complete the rule.");
  a.Required("nearest_m", s.nearest_m, "Least distance of the approach.");
  a.Required("farthest_m", s.farthest_m,
             "Greatest distance of the approach, from the first sighting on.");
  a.Required("speed_mps", s.speed_mps,
             "Speed at the detection, or else where it was first in range.");
  a.Required("needed_m", s.needed_m, "Distance that the vehicle needs to stop, with the margin.");
  a.Required("drawn", s.drawn, "The values drawn for the object itself, by JSON pointer.");
}

void Describe(Archive& a, FalseAlarm& s) {
  a.Required("frame", s.frame, "Number of the frame that completes the rule.");
  a.Required("s_m", s.s_m, "Chainage of the nearest box.");
  a.Required("distance_m", s.distance_m, "Distance of that box.");
  a.Required("object", s.object, "The object that is not in the way; empty where there is none.");
  a.Required("cause", s.cause, "Label of most of the box's points, or the detector's word.");
}

void Describe(Archive& a, ApproachRecord& s) {
  a.Required("scenario", s.scenario, "Number of the scenario.");
  a.Required("seed", s.seed, "Seed of the scenario.");
  a.Required("base", s.base, "Name of the base scenario's file.");
  a.Required("drawn", s.drawn, "The drawn values, by their names or JSON pointers.");
  a.Required("objects", s.objects, "The objects in the way that are approached.");
  a.Optional("cheap_spare_m", s.cheap_spare_m,
             "Least distance to spare on the cheaper rung, if both were made.");
  std::optional<double> driven_m;
  std::optional<std::vector<std::string>> beside;
  std::optional<std::vector<FalseAlarm>> alarms;
  if (s.alarms) {
    driven_m = s.alarms->driven_m;
    beside = s.alarms->beside;
    alarms = s.alarms->alarms;
  }
  a.Optional("driven_m", driven_m,
             "Distance driven; like the next two, only in studies with a detector.");
  a.Optional("beside", beside, "Objects that must raise no alarm.");
  a.Optional("false_alarms", alarms, "The false alarms.");
  a.Ensure({"driven_m"}, driven_m.has_value() == (beside && alarms),
           "must stand with beside and false_alarms");
  a.Optional("certificate", s.certificate, "The numerical error of the objects' echoes.");
  if (driven_m && beside && alarms) s.alarms = {*driven_m, *beside, *alarms};
}

}  // namespace railcast
