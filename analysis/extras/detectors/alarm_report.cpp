#include "analysis/extras/detectors/alarm_report.h"

#include <algorithm>
#include <utility>

#include "analysis/report/words.h"
#include "core/base/text.h"

namespace railcast {
namespace {

constexpr double kMetresPerKm = 1e3;

std::string CauseText(const FalseAlarm& alarm) {
  return alarm.cause.empty() ? "no points" : alarm.cause;
}

// Nothing there first, by cause, then objects.
Table AlarmTable(const std::vector<EvaluatedRun>& runs) {
  Table table = TableOf(kDetectorsWords, "false_alarms");
  std::map<std::pair<std::string, std::string>, std::uint64_t> counts;
  std::uint64_t num_all = 0;
  std::uint64_t num_at_nothing = 0;
  for (const EvaluatedRun& run : runs) {
    for (const FalseAlarm& alarm : run.alarms) {
      ++counts[{alarm.object, CauseText(alarm)}];
      ++num_all;
      num_at_nothing += alarm.object.empty() ? 1U : 0U;
    }
  }
  const double driven_m = SumDriven_m(runs);
  for (const auto& [key, num] : counts) {
    const auto& [object, cause] = key;
    table.rows.push_back(
        {object.empty() ? "no object" : object, cause, num, AlarmsPerKm(num, driven_m)});
  }
  table.rows.push_back({"no object", "all", num_at_nothing, AlarmsPerKm(num_at_nothing, driven_m)});
  table.rows.push_back({"all", "", num_all, AlarmsPerKm(num_all, driven_m)});
  return table;
}

Table BesideAlarmsTable(const std::vector<EvaluatedRun>& runs) {
  Table table = TableOf(kDetectorsWords, "no_alarm");
  for (const auto& [name, object] : ObjectsBesideIn(runs)) {
    table.rows.push_back({name, object.type, object.num_alarms == 0 ? "no alarm" : "false alarm",
                          object.num_runs, object.num_runs_with_alarm, object.num_alarms,
                          object.from_axis_m});
  }
  return table;
}

// Where they happen, by cause.
Chart AlarmChart(const std::vector<EvaluatedRun>& runs) {
  std::map<std::string, ChartSeries> by_cause;
  for (const EvaluatedRun& run : runs) {
    for (const FalseAlarm& alarm : run.alarms) {
      const std::string cause = alarm.object.empty() ? CauseText(alarm) : alarm.object;
      ChartSeries& series = by_cause[cause];
      series.title = cause;
      series.style = SeriesStyle::kPoints;
      series.points.push_back({.x = alarm.s_m, .y = alarm.distance_m});
    }
  }
  Chart chart = ChartOf(kDetectorsWords, "false_alarms");
  for (auto& [cause, series] : by_cause) chart.series.push_back(std::move(series));
  return chart;
}

Table AlarmList(const std::vector<EvaluatedRun>& runs) {
  Table table = TableOf(kDetectorsWords, "each_false_alarm");
  for (const EvaluatedRun& run : runs) {
    for (const FalseAlarm& alarm : run.alarms) {
      table.rows.push_back({ShownPath(run.run.source), std::uint64_t{alarm.frame}, alarm.s_m,
                            alarm.distance_m, alarm.object.empty() ? "no object" : alarm.object,
                            CauseText(alarm)});
    }
  }
  return table;
}

}  // namespace

double SumDriven_m(const std::vector<EvaluatedRun>& runs) {
  double sum_m = 0.0;
  for (const EvaluatedRun& run : runs) sum_m += run.driven_m;
  return sum_m;
}

std::map<std::string, ObjectBeside> ObjectsBesideIn(const std::vector<EvaluatedRun>& runs) {
  std::map<std::string, ObjectBeside> objects;
  for (const EvaluatedRun& run : runs) {
    for (const std::string& name : run.ObjectsBeside()) {
      ObjectBeside& object = objects[name];
      object.type = run.run.courses.objects.at(name).type;
      object.from_axis_m = std::min(object.from_axis_m, run.run.detections.at(name).from_axis_m);
      const auto num =
          static_cast<std::uint64_t>(std::ranges::count(run.alarms, name, &FalseAlarm::object));
      ++object.num_runs;
      object.num_runs_with_alarm += num > 0 ? 1U : 0U;
      object.num_alarms += num;
    }
  }
  return objects;
}

Estimate AlarmsPerKm(std::uint64_t num_alarms, double driven_m) {
  return ExactPoissonRate(num_alarms, driven_m / kMetresPerKm);
}

std::string FalseAlarmText(const DetectionRule& rule) {
  return SentencesOf(kDetectorsWords, "rule",
                     {{"min_frames", NumberText(rule.min_frames)},
                      {"of_frames", NumberText(rule.of_frames)},
                      {"slack_m", NumberText(kBoxSlack_m)}});
}

Section AlarmSection(const std::vector<EvaluatedRun>& runs, const DetectionRule& rule) {
  Section section = SectionOf(kDetectorsWords, "false_alarms");
  section.paragraphs = {FalseAlarmText(rule)};
  section.tables = {AlarmTable(runs)};
  Table beside = BesideAlarmsTable(runs);
  if (!beside.rows.empty()) section.tables.push_back(std::move(beside));
  Table list = AlarmList(runs);
  if (list.rows.empty()) return section;
  section.charts = {AlarmChart(runs)};
  section.tables.push_back(std::move(list));
  return section;
}

}  // namespace railcast
