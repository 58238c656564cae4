#include "analysis/extras/track/track_report.h"

#include <cmath>
#include <limits>

#include "analysis/report/words.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/track/track_points.h"

namespace railcast {
namespace {

constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();
const double kDeg = DegFromRad(1.0);

/// A figure of the report, with the unit that it is shown in.
struct ShownFigure {
  std::string name;
  std::string unit;
  double per_unit{};
  FigureOfFrames TrackSurvey::*over{};
};

const std::vector<ShownFigure>& ShownFigures() {
  static const std::vector<ShownFigure> figures = {
      {"Sensor above the rails", "m", 1.0, &TrackSurvey::height_m},
      {"Sensor left of the track's middle", "m", 1.0, &TrackSurvey::sideways_m},
      {"Yaw", "deg", kDeg, &TrackSurvey::yaw_rad},
      {"Pitch", "deg", kDeg, &TrackSurvey::pitch_rad},
      {"Roll", "deg", kDeg, &TrackSurvey::roll_rad},
      {"Gauge", "mm", 1e3, &TrackSurvey::gauge_m},
      {"Curvature", "1/km", 1e3, &TrackSurvey::curvature_per_m},
  };
  return figures;
}

Table FiguresTable(const TrackSurvey& survey) {
  Table table = TableOf(kTrackWords, "figures");
  for (const ShownFigure& figure : ShownFigures()) {
    const FigureOfFrames& over = survey.*figure.over;
    const bool is_one = survey.num_own < 2;
    table.rows.push_back({figure.name, figure.unit, figure.per_unit * over.median.value,
                          figure.per_unit * over.median.margin,
                          is_one ? kNoFigure : figure.per_unit * over.sway,
                          survey.num_own < 4 ? kNoFigure : figure.per_unit * over.drift});
  }
  return table;
}

Table FramesTable(const TrackSurvey& survey) {
  Table table = TableOf(kTrackWords, "frames");
  for (std::size_t i = 0; i < survey.frames.size(); ++i) {
    const TracksOfFrame& of = survey.frames[i];
    std::vector<Cell> row = {std::uint64_t{i}, std::uint64_t{of.found.tracks.size()}};
    const FoundTrack* track = of.track();
    const auto add = [&](auto value) { row.emplace_back(value); };
    if (track == nullptr) {
      row.resize(table.columns.size() - 1, kNoFigure);
      add(of.found.tracks.empty() ? of.found.why_not : std::string("none lies as in other frames"));
      table.rows.push_back(std::move(row));
      continue;
    }
    for (const BoundedFigure* const figure :
         {&track->height_m, &track->sideways_m, &track->yaw_rad, &track->pitch_rad,
          &track->roll_rad, &track->gauge_m, &track->curvature_per_m}) {
      const bool is_angle =
          figure == &track->yaw_rad || figure == &track->pitch_rad || figure == &track->roll_rad;
      const double per_unit = is_angle ? kDeg : 1.0;
      add(per_unit * figure->value);
      add(per_unit * figure->margin);
    }
    add(of.has_pose ? 1e3 * of.gradient : kNoFigure);
    add(of.has_pose ? 1e3 * of.cant_m : kNoFigure);
    add(std::uint64_t{track->points[0]});
    add(std::uint64_t{track->points[1]});
    add(track->first_m);
    add(track->last_m);
    add(std::string());
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table OthersTable(const TrackSurvey& survey) {
  Table table = TableOf(kTrackWords, "others");
  for (const double offset_m : survey.OtherTracks_m()) table.rows.push_back({offset_m});
  return table;
}

Chart FigureChart(const TrackSurvey& survey,
                  const std::string& key,
                  BoundedFigure FoundTrack::*figure) {
  Chart chart = ChartOf(kTrackWords, key);
  ChartSeries series{.title = chart.y.title, .style = SeriesStyle::kPoints};
  for (std::size_t i = 0; i < survey.frames.size(); ++i) {
    const FoundTrack* track = survey.frames[i].track();
    if (track == nullptr) continue;
    const BoundedFigure& each = track->*figure;
    series.points.push_back(
        {static_cast<double>(i), each.value, each.value - each.margin, each.value + each.margin});
  }
  chart.series = {std::move(series)};
  return chart;
}

}  // namespace

Report MakeTrackReport(const TrackSurvey& survey, const std::string& command) {
  Report report{.title = "The track in a recording", .command = command};
  for (const ShownFigure& figure : ShownFigures()) {
    const FigureOfFrames& over = survey.*figure.over;
    report.headlines.push_back({figure.name, figure.unit,
                                ShortText(figure.per_unit * over.median.value) + " ± " +
                                    ShortText(figure.per_unit * over.median.margin)});
  }
  report.headlines.push_back({"Tracks", "", std::uint64_t{1 + survey.OtherTracks_m().size()}});
  const std::size_t num_frames = survey.frames.size();
  Section mount = SectionOf(
      kTrackWords, "mount",
      {{"is_on_track", survey.is_on_track()},
       {"num_own", NumberText(survey.num_own)},
       {"num_frames", NumberText(num_frames)},
       {"num_straight", survey.num_in_straight > 0 ? NumberText(survey.num_in_straight) : ""},
       {"first_m", ShortText(survey.first_m)},
       {"last_m", ShortText(survey.last_m)},
       {"known_m", ShortText(survey.known_m)},
       {"margin_m", ShortText(kMostTrackMargin_m)}});
  mount.tables = {FiguresTable(survey), OthersTable(survey)};
  if (num_frames > 1) {
    mount.charts = {FigureChart(survey, "height", &FoundTrack::height_m),
                    FigureChart(survey, "sideways", &FoundTrack::sideways_m),
                    FigureChart(survey, "curvature", &FoundTrack::curvature_per_m)};
  }
  Section frames = SectionOf(kTrackWords, "frames");
  frames.tables = {FramesTable(survey)};
  report.sections = {std::move(mount), std::move(frames), SectionOf(kTrackWords, "rules")};
  return report;
}

}  // namespace railcast
