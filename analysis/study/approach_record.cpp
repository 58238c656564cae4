#include "analysis/study/approach_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

std::map<std::string, Json> ToMap(const Json& object) {
  std::map<std::string, Json> map;
  for (const auto& [key, value] : object.items()) map.emplace(key, value);
  return map;
}

double NumberOrNaN(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

}  // namespace

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
  const Json& said = drawn.record;
  ApproachRecord record{.scenario = said.at("scenario").get<std::uint32_t>(),
                        .seed = said.at("seed").get<std::uint64_t>(),
                        .base = said.at("base").get<std::string>(),
                        .drawn = ToMap(said.at("drawn")),
                        .objects = {}};
  std::map<std::string, Json> placed;
  for (const Json& object : said.at("placed")) {
    placed.emplace(object.at("name").get<std::string>(), object.at("drawn"));
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
         .drawn = found == placed.end() ? std::map<std::string, Json>() : ToMap(found->second)});
  }
  return record;
}

ApproachAlarms AlarmsOf(const EvaluatedRun& run) {
  return {.driven_m = run.driven_m, .beside = run.ObjectsBeside(), .alarms = run.alarms};
}

Json ToJson(const ApproachRecord& record) {
  Json objects = Json::array();
  for (const StudiedObject& object : record.objects) {
    objects.push_back({{"name", object.name},
                       {"type", object.type},
                       {"detected", object.is_detected},
                       {"distance_m", object.distance_m},
                       {"frame", object.frame},
                       {"from_start", object.is_from_start},
                       {"nearest_m", object.nearest_m},
                       {"farthest_m", object.farthest_m},
                       {"speed_mps", object.speed_mps},
                       {"needed_m", object.needed_m},
                       {"drawn", Json(object.drawn)}});
  }
  Json json = {{"scenario", record.scenario},
               {"seed", record.seed},
               {"base", record.base},
               {"drawn", Json(record.drawn)},
               {"objects", std::move(objects)}};
  if (!record.alarms) return json;
  Json alarms = Json::array();
  for (const FalseAlarm& alarm : record.alarms->alarms) {
    alarms.push_back({{"frame", alarm.frame},
                      {"s_m", alarm.s_m},
                      {"distance_m", alarm.distance_m},
                      {"object", alarm.object},
                      {"cause", alarm.cause}});
  }
  json["driven_m"] = record.alarms->driven_m;
  json["beside"] = record.alarms->beside;
  json["false_alarms"] = std::move(alarms);
  return json;
}

ApproachRecord ApproachFromJson(const Json& json) {
  ApproachRecord record{.scenario = json.at("scenario").get<std::uint32_t>(),
                        .seed = json.at("seed").get<std::uint64_t>(),
                        .base = json.at("base").get<std::string>(),
                        .drawn = ToMap(json.at("drawn")),
                        .objects = {}};
  for (const Json& object : json.at("objects")) {
    record.objects.push_back({.name = object.at("name").get<std::string>(),
                              .type = object.at("type").get<std::string>(),
                              .is_detected = object.at("detected").get<bool>(),
                              .distance_m = NumberOrNaN(object.at("distance_m")),
                              .frame = object.at("frame").get<std::uint32_t>(),
                              .is_from_start = object.at("from_start").get<bool>(),
                              .nearest_m = object.at("nearest_m").get<double>(),
                              .farthest_m = object.at("farthest_m").get<double>(),
                              .speed_mps = object.at("speed_mps").get<double>(),
                              .needed_m = object.at("needed_m").get<double>(),
                              .drawn = ToMap(object.at("drawn"))});
  }
  if (!json.contains("false_alarms")) return record;
  record.alarms = {.driven_m = json.at("driven_m").get<double>(),
                   .beside = json.at("beside").get<std::vector<std::string>>(),
                   .alarms = {}};
  for (const Json& alarm : json.at("false_alarms")) {
    record.alarms->alarms.push_back({.frame = alarm.at("frame").get<std::uint32_t>(),
                                     .s_m = alarm.at("s_m").get<double>(),
                                     .distance_m = alarm.at("distance_m").get<double>(),
                                     .object = alarm.at("object").get<std::string>(),
                                     .cause = alarm.at("cause").get<std::string>()});
  }
  return record;
}

}  // namespace railcast
