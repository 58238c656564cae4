#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "analysis/estimate/streams.h"
#include "analysis/extras/detectors/alarm_report.h"
#include "analysis/extras/study/study_report.h"
#include "analysis/report/words.h"

namespace railcast {
namespace {

constexpr double kNoDistance = std::numeric_limits<double>::quiet_NaN();
/// The object of approaches that lead to nothing.
constexpr const char* kNoObject = "no object";

/// Approaches that have something in common.
struct ApproachGroup {
  std::uint64_t num{};
  double driven_m{};
  std::uint64_t num_alarms_at_nothing{};
  std::uint64_t num_alarms_at_objects{};

  void Add(const ApproachAlarms& approach) {
    ++num;
    driven_m += approach.driven_m;
    for (const FalseAlarm& alarm : approach.alarms) {
      ++(alarm.object.empty() ? num_alarms_at_nothing : num_alarms_at_objects);
    }
  }
};

/// One target in approaches that have something in common.
struct TargetGroup {
  ApproachGroup approaches;
  bool is_in_way{};
  std::uint64_t num_detected{};
  std::uint64_t num_in_time{};
  Moments distance_m;
  double least_distance_m = kNoDistance;
};

// "weather: fog" for each choice between names.
std::vector<std::string> ConditionsOf(const ApproachRecord& approach) {
  std::vector<std::string> conditions = {"all"};
  for (const auto& [name, value] : approach.drawn) {
    if (value.is_string()) conditions.push_back(name + ": " + value.get<std::string>());
  }
  return conditions;
}

void AddObject(const StudiedObject& object, TargetGroup& group) {
  group.is_in_way = true;
  group.num_in_time += object.is_in_time() ? 1U : 0U;
  if (!object.is_detected) return;
  ++group.num_detected;
  group.distance_m.Add(object.distance_m);
  group.least_distance_m = std::fmin(group.least_distance_m, object.distance_m);
}

/// By target and condition.
using TargetGroups = std::map<std::string, std::map<std::string, TargetGroup>>;

TargetGroups GroupTargets(const std::vector<ApproachRecord>& approaches) {
  TargetGroups groups;
  for (const ApproachRecord& approach : approaches) {
    std::set<std::string> targets;
    for (const StudiedObject& object : approach.objects) targets.insert(object.Target());
    for (const std::string& name : approach.alarms->beside) targets.insert(TargetOf(name));
    if (targets.empty()) targets = {kNoObject};
    for (const std::string& condition : ConditionsOf(approach)) {
      for (const std::string& target : targets) {
        groups[target][condition].approaches.Add(*approach.alarms);
      }
      for (const StudiedObject& object : approach.objects) {
        AddObject(object, groups[object.Target()][condition]);
      }
    }
  }
  return groups;
}

// Conditions that every target has only one of say nothing beyond the target.
std::set<std::string> TellingConditions(const TargetGroups& groups) {
  std::map<std::string, std::size_t> num_targets;
  for (const auto& [target, by_condition] : groups) {
    for (const auto& [condition, group] : by_condition) ++num_targets[condition];
  }
  std::set<std::string> telling;
  for (const auto& [condition, num] : num_targets) {
    if (num > 1 || groups.size() == 1) telling.insert(condition);
  }
  return telling;
}

Table TargetTable(const std::vector<ApproachRecord>& approaches) {
  Table table = TableOf(kStudyWords, "targets_by_condition");
  const TargetGroups groups = GroupTargets(approaches);
  const std::set<std::string> telling = TellingConditions(groups);
  for (const auto& [target, by_condition] : groups) {
    for (const auto& [condition, group] : by_condition) {
      if (!telling.contains(condition)) continue;
      const bool is_in_way = group.is_in_way;  // A lambda cannot capture a structured binding.
      const auto known = [&](std::uint64_t num) {
        return is_in_way ? Cell(num) : Cell(std::string());
      };
      table.rows.push_back(
          {target, condition, group.approaches.num, known(group.num_detected),
           known(group.num_in_time), group.least_distance_m, group.distance_m.PlainMean(),
           group.approaches.num_alarms_at_objects,
           AlarmsPerKm(group.approaches.num_alarms_at_nothing, group.approaches.driven_m)});
    }
  }
  return table;
}

Table ConditionAlarmTable(const std::vector<ApproachRecord>& approaches) {
  Table table = TableOf(kStudyWords, "false_alarms");
  std::map<std::string, ApproachGroup> groups;
  for (const ApproachRecord& approach : approaches) {
    for (const std::string& condition : ConditionsOf(approach)) {
      groups[condition].Add(*approach.alarms);
    }
  }
  constexpr double kKilometresPerMetre = 1e-3;
  for (const auto& [condition, group] : groups) {
    table.rows.push_back({condition, group.num, kKilometresPerMetre * group.driven_m,
                          group.num_alarms_at_objects, group.num_alarms_at_nothing,
                          AlarmsPerKm(group.num_alarms_at_nothing, group.driven_m)});
  }
  return table;
}

Table StudyAlarmList(const std::vector<ApproachRecord>& approaches) {
  Table table = TableOf(kStudyWords, "each_false_alarm");
  for (const ApproachRecord& approach : approaches) {
    for (const FalseAlarm& alarm : approach.alarms->alarms) {
      table.rows.push_back({std::uint64_t{approach.scenario}, std::uint64_t{alarm.frame}, alarm.s_m,
                            alarm.distance_m, alarm.object.empty() ? kNoObject : alarm.object,
                            alarm.cause});
    }
  }
  return table;
}

}  // namespace

Section StudyAlarmsSection(const StudySpec& study, const std::vector<ApproachRecord>& approaches) {
  Section section = SectionOf(kStudyWords, "false_alarms");
  section.paragraphs = {FalseAlarmText(study.detect.rule)};
  section.tables = {TargetTable(approaches), ConditionAlarmTable(approaches)};
  Table list = StudyAlarmList(approaches);
  if (!list.rows.empty()) section.tables.push_back(std::move(list));
  return section;
}

}  // namespace railcast
