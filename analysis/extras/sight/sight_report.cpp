#include "analysis/extras/sight/sight.h"

#include <limits>

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

ChartAxis ChainageAxis() {
  return {.title = "Chainage", .unit = "m"};
}

Chart SightChart(const std::vector<SightPlace>& places, const SightSpec& spec) {
  Chart chart{.key = "sight",
              .title = "Sight along the track and the distance needed to stop",
              .caption =
                  "A line has a gap where the route ends within the range, so that it is not known "
                  "how far one could see on.",
              .x = ChainageAxis(),
              .y = {.title = "Distance along the track", .unit = "m"}};
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
                  Chart chart,
                  double (*value)(const SightPlace&)) {
  chart.x = ChainageAxis();
  ChartSeries series{.title = chart.y.title, .style = SeriesStyle::kLine};
  for (const SightPlace& place : places) series.points.push_back({place.chainage_m, value(place)});
  chart.series = {std::move(series)};
  return chart;
}

Table ShortTable(const std::vector<ShortSight>& parts) {
  Table table{.key = "short_sight",
              .title = "Where the sight is shorter than the distance needed",
              .note =
                  "Each row is a part of the way on which the sight of one target ends at the same "
                  "label; the figures are those of its place with least to spare. Range: nothing "
                  "blocks as far as targets are sought.",
              .columns = ColumnsOf("height_m: Target; from_m: From; to_m: To; blocker: Blocked by; "
                                   "sight_m: Sight; needed_m: Needed; spare_m: To spare; at_m: At; "
                                   "speed_kmph: Speed; gradient_permil: Gradient")};
  table.is_open = true;
  for (const ShortSight& part : parts) {
    table.rows.push_back({part.height_m, part.from_s_m, part.to_s_m, part.blocker,
                          part.sight.distance_m, part.worst.needed_m, part.spare_m(),
                          part.worst.chainage_m, Kmph(part.worst.speed_mps),
                          kPerMille * part.worst.gradient});
  }
  return table;
}

Table PlacesTable(const std::vector<SightPlace>& places, const SightSpec& spec) {
  Table table{
      .key = "places",
      .title = "Every place",
      .columns = ColumnsOf("frame: Frame; chainage_m: Chainage; height_m: Target; sight_m: Sight; "
                           "ended_by: Ended by; needed_m: Needed; braking_distance_m: Braking "
                           "distance; speed_kmph: Speed; gradient_permil: Gradient")};
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
  return {.key = "rules",
          .title = "How it is measured",
          .paragraphs = {
              "Targets " + NumberText(kTargetWidth_m) + " m wide stand on the track's axis, from " +
                  NumberText(kNearestTarget_m) + " m to " + NumberText(range_m) +
                  " m ahead of the sensor, one every " + NumberText(kTargetStep_m) +
                  " m of the route. One is seen if at least half of its face is in line of sight "
                  "of the sensor's place in its vehicle; more and more rays sample it until that "
                  "changes the sight by less than " +
                  NumberText(kTargetStep_m) +
                  " m. The sight is the distance of the last one before targets are hidden for " +
                  NumberText(kMostHidden_m) +
                  " m or to the end; what hides them for a shorter way, as a mast does, is passed "
                  "over.",
              "It is geometry: the sensor's field of view, its resolution, weather and wires do "
              "not count. Moving things stand where they are when the vehicle is at the place.",
              "Needed is s = v t + v^2 / (2 (a + g i)) + margin, with t = " +
                  NumberText(braking.reaction_s) +
                  " s to full braking, a = " + NumberText(braking.deceleration_mps2) +
                  " m/s^2 on the level, a margin of " + NumberText(braking.margin_m) +
                  " m, and the mean gradient i of the track over the braking distance. v is " +
                  (spec.speed_mps ? "as given." : "the vehicle's own speed at the place.")}};
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
  Section sight{.key = "sight", .title = "Sight and braking distance"};
  sight.paragraphs = {
      parts.empty() ? "The sight is nowhere known to be shorter than the distance needed to stop."
                    : "Where the sight is shorter than the distance needed, the train cannot stop "
                      "before what it comes to see."};
  sight.charts = {SightChart(places, spec)};
  sight.tables = {ShortTable(parts)};
  const std::vector<Chart> courses = {
      CourseChart(places,
                  {.key = "speed",
                   .title = "Speed",
                   .caption = "The braking distance grows with the square of the speed.",
                   .y = {"Speed", "km/h"}},
                  [](const SightPlace& place) { return Kmph(place.speed_mps); }),
      CourseChart(places,
                  {.key = "gradient",
                   .title = "Mean gradient over the braking distance",
                   .caption = "Positive uphill in the direction of travel.",
                   .y = {"Gradient", "permil"}},
                  [](const SightPlace& place) { return kPerMille * place.gradient; })};
  report.sections = {
      std::move(sight),
      {.key = "course", .title = "Speed and gradient", .charts = courses},
      {.key = "places", .title = "Place by place", .tables = {PlacesTable(places, spec)}},
      RulesSection(spec, range_m)};
  return report;
}

}  // namespace railcast
