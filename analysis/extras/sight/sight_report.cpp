#include "analysis/extras/sight/sight.h"

#include <limits>

#include "analysis/report/words.h"
#include "core/base/text.h"

namespace railcast {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
constexpr double kPerMille = 1000.0;

double Kmph(double speed_mps) {
  return 3.6 * speed_mps;
}

std::string TargetText(double height_m) {
  return "target of " + NumberText(height_m) + " m";
}

std::string EndText(const Sight& sight) {
  if (sight.end == SightEnd::kBlocked) return sight.blocker;
  return sight.end == SightEnd::kRange ? "range" : "end of the track";
}

Chart SightChart(const std::vector<SightPlace>& places, const SightSpec& spec) {
  Chart chart = ChartOf(kSightWords, "sight");
  ChartSeries needed{.title = "needed", .style = SeriesStyle::kLine};
  for (const SightPlace& place : places)
    needed.points.push_back({place.chainage_m, place.needed_m});
  chart.series.push_back(std::move(needed));
  for (std::size_t i = 0; i < spec.heights_m.size(); ++i) {
    ChartSeries series{.title = TargetText(spec.heights_m[i]), .style = SeriesStyle::kLine};
    for (const SightPlace& place : places) {
      const Sight& sight = place.sights[i];
      series.points.push_back(
          {place.chainage_m, sight.end == SightEnd::kEndOfTrack ? kNotKnown : sight.distance_m});
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

Chart CourseChart(const std::vector<SightPlace>& places,
                  const char* key,
                  double (*value)(const SightPlace&)) {
  Chart chart = ChartOf(kSightWords, key);
  ChartSeries series{.title = chart.y.title, .style = SeriesStyle::kLine};
  for (const SightPlace& place : places) series.points.push_back({place.chainage_m, value(place)});
  chart.series = {std::move(series)};
  return chart;
}

Table ShortTable(const std::vector<ShortSight>& parts) {
  Table table = TableOf(kSightWords, "short_sight");
  for (const ShortSight& part : parts) {
    table.rows.push_back({part.height_m, part.from_s_m, part.to_s_m, part.blocker,
                          part.sight.distance_m, part.worst.needed_m, part.spare_m(),
                          part.worst.chainage_m, Kmph(part.worst.speed_mps),
                          kPerMille * part.worst.gradient});
  }
  return table;
}

Table PlacesTable(const std::vector<SightPlace>& places, const SightSpec& spec) {
  Table table = TableOf(kSightWords, "places");
  for (const SightPlace& place : places) {
    for (std::size_t i = 0; i < spec.heights_m.size(); ++i) {
      table.rows.push_back({std::uint64_t{place.frame}, place.chainage_m, spec.heights_m[i],
                            place.sights[i].distance_m, EndText(place.sights[i]), place.needed_m,
                            place.stop_m, Kmph(place.speed_mps), kPerMille * place.gradient});
    }
  }
  return table;
}

Section RulesSection(const SightSpec& spec, double range_m) {
  const BrakingSpec& braking = spec.braking;
  return SectionOf(
      kSightWords, "rules",
      {{"target_width_m", NumberText(kTargetWidth_m)},
       {"nearest_target_m", NumberText(kNearestTarget_m)},
       {"range_m", NumberText(range_m)},
       {"target_step_m", NumberText(kTargetStep_m)},
       {"most_hidden_m", NumberText(kMostHidden_m)},
       {"reaction_s", NumberText(braking.reaction_s)},
       {"deceleration_mps2", NumberText(braking.deceleration_mps2)},
       {"margin_m", NumberText(braking.margin_m)},
       {"speed", (spec.speed_mps ? "as given" : "the vehicle's own speed at the place")}});
}

void AddSightHeadlines(const std::vector<SightPlace>& places,
                       const SightSpec& spec,
                       Report& report) {
  for (std::size_t i = 0; i < spec.heights_m.size(); ++i) {
    const std::string target = TargetText(spec.heights_m[i]);
    double least_m = kNotKnown;
    std::uint64_t num_short = 0;
    for (const SightPlace& place : places) {
      num_short += place.IsShort(i) ? 1U : 0U;
      if (place.sights[i].end == SightEnd::kEndOfTrack) continue;
      // Negated, so that it also replaces NaN.
      if (!(least_m <= place.sights[i].distance_m)) least_m = place.sights[i].distance_m;
    }
    report.headlines.push_back({"Least sight, " + target, "m", least_m});
    report.headlines.push_back({"Places with too short a sight, " + target, "", num_short});
  }
}

}  // namespace

std::vector<ShortSight> ShortSights(const std::vector<SightPlace>& places, const SightSpec& spec) {
  std::vector<ShortSight> parts;
  for (std::size_t i = 0; i < spec.heights_m.size(); ++i) {
    bool goes_on = false;
    for (const SightPlace& place : places) {
      if (!place.IsShort(i)) {
        goes_on = false;
        continue;
      }
      const Sight& sight = place.sights[i];
      const std::string blocker = EndText(sight);
      if (!goes_on || parts.back().blocker != blocker) {
        parts.push_back(
            {place.chainage_m, place.chainage_m, spec.heights_m[i], blocker, place, sight});
      }
      goes_on = true;
      ShortSight& part = parts.back();
      part.to_s_m = place.chainage_m;
      if (sight.distance_m - place.needed_m >= part.spare_m()) continue;
      part.worst = place;
      part.sight = sight;
    }
  }
  return parts;
}

Report MakeSightReport(const std::vector<SightPlace>& places,
                       const SightSpec& spec,
                       double range_m,
                       const std::string& command) {
  Report report{.title = "Sight along the route", .command = command};
  AddSightHeadlines(places, spec, report);
  const std::vector<ShortSight> parts = ShortSights(places, spec);
  Section sight = SectionOf(kSightWords, "sight", {{"is_short", !parts.empty()}});
  sight.charts = {SightChart(places, spec)};
  sight.tables = {ShortTable(parts)};
  Section course = SectionOf(kSightWords, "course");
  course.charts = {
      CourseChart(places, "speed", [](const SightPlace& place) { return Kmph(place.speed_mps); }),
      CourseChart(places, "gradient",
                  [](const SightPlace& place) { return kPerMille * place.gradient; })};
  Section each = SectionOf(kSightWords, "places");
  each.tables = {PlacesTable(places, spec)};
  report.sections = {std::move(sight), std::move(course), std::move(each),
                     RulesSection(spec, range_m)};
  return report;
}

}  // namespace railcast
