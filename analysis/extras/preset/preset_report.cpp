#include "analysis/extras/preset/preset_comparison.h"

#include <array>
#include <utility>

#include "analysis/report/chart_columns.h"
#include "analysis/stats/bins.h"
#include "core/base/text.h"

namespace railcast {
namespace {

constexpr double kPresetMm = 1e3;

Cell HoleCell(const PlaneFigures& figures, std::size_t bin) {
  const Holes::Count& count = figures.firings[bin];
  return PercentProportion(count.num_missing, count.num_expected);
}

Cell PlaneSigmaCell(const Noise& noise, std::size_t bin) {
  if (bin >= noise.planes().size()) return NotEnough(0);
  return Scaled(noise.planes()[bin].RobustRangeSigma_m(), kPresetMm);
}

Cell TemporalSigmaCell(const TemporalNoise& noise, std::size_t bin) {
  if (bin >= noise.bins().size()) return NotEnough(0);
  return Scaled(noise.bins()[bin].RobustSigma_m(), kPresetMm);
}

Table RangeTable(const PresetComparison& comparison) {
  Table table = {
      "preset_by_range",
      "By range",
      "On the planes, a turn's points each; sigmas are robust. Of few turns: what changes more "
      "slowly is in no interval.",
      ColumnsOf("range_m: Range; recorded: Points recorded; simulated: Points simulated; "
                "recorded_holes_percent: Holes recorded; simulated_holes_percent: Holes simulated; "
                "recorded_planes_mm: About planes, recorded; simulated_planes_mm: About planes, "
                "simulated; recorded_turns_mm: From turn to turn, recorded; simulated_turns_mm: "
                "From turn to turn, simulated"),
      {},
      true};
  const PlaneFigures& recorded = comparison.recorded;
  const PlaneFigures& simulated = comparison.simulated;
  for (std::size_t i = 0; i < recorded.firings.size(); ++i) {
    if (recorded.num_points(i) == 0) continue;
    table.rows.push_back({RangeBins().span(i), recorded.num_points(i), simulated.num_points(i),
                          HoleCell(recorded, i), HoleCell(simulated, i),
                          PlaneSigmaCell(recorded.noise, i), PlaneSigmaCell(simulated.noise, i),
                          TemporalSigmaCell(recorded.temporal, i),
                          TemporalSigmaCell(simulated.temporal, i)});
  }
  return table;
}

Table CellTable(const PresetComparison& comparison) {
  Table table = {
      "preset_intensity", "Intensity by piece, range and incidence",
      "Means of the middle three fifths of at least 15 points. A piece is made of neighbouring "
      "cells whose recorded intensities differ by less than a factor of 1.3; the simulated ones "
      "are multiplied by one factor for each piece.",
      ColumnsOf("turn: Turn; piece: Piece; plane: Plane; strip: Strip; kind: Kind; range_m: Range; "
                "incidence_deg: Incidence; recorded: Recorded; simulated: Simulated")};
  for (const IntensityCell& cell : LikePieces(comparison.intensity)) {
    table.rows.push_back({std::uint64_t{cell.turn}, std::uint64_t{cell.piece},
                          std::uint64_t{cell.place.plane}, std::uint64_t{cell.place.strip},
                          std::string(cell.is_ground ? "ground" : "other"), cell.range_m,
                          cell.incidence_deg, cell.recorded, cell.simulated});
  }
  return table;
}

Section MakePlanesSection(const PresetComparison& comparison) {
  Section section{
      "preset",
      "The preset before the recording's planes",
      {"The planes are found in the recording by themselves; the scenario's sensor looks at them "
       "from the same place with its own pattern, rung and weather. A beam meets a plane where the "
       "recorded firings of its direction did. Level planes below the sensor are asphalt, others "
       "concrete, with the reflectivities that give the recorded intensities; for the comparison "
       "of intensities, one reflectivity everywhere."}};
  Table table = RangeTable(comparison);
  for (const auto& [key, title, what, unit] :
       {std::array{"holes_percent", "Holes in planes", "Holes", "%"},
        std::array{"turns_mm", "Noise from turn to turn", "Standard deviation", "mm"}}) {
    const std::string name = key;
    section.charts.push_back({"preset_" + name,
                              title,
                              "The preset is right where its line lies on the recording's.",
                              {"Range", "m"},
                              {what, unit},
                              {SeriesOf(table, {"range_m", "recorded_" + name}, "recorded"),
                               SeriesOf(table, {"range_m", "simulated_" + name}, "simulated")}});
  }
  section.tables.push_back(std::move(table));
  section.tables.push_back(CellTable(comparison));
  return section;
}

}  // namespace

Report MakePresetReport(const PresetComparison& comparison,
                        const RecordingInfo& recording,
                        const ScenarioSpec& scenario,
                        const std::string& command) {
  Report report{
      .title = "Preset " + scenario.lidar.name + " against " + ShownPath(recording.source),
      .command = command,
      .facts = {{"Recording", recording.kind},
                {"Rung", std::string(NameOf(scenario.fidelity))},
                {"Turns", NumberText(comparison.num_turns)},
                {"Planes", NumberText(comparison.num_planes)},
                {"Cells of intensity", NumberText(LikePieces(comparison.intensity).size())}}};
  if (comparison.gaps.num_pairs > 0) {
    report.facts.emplace_back("Pairs of returns", NumberText(comparison.gaps.num_pairs));
    report.facts.emplace_back("Nearest pair", ShortText(comparison.gaps.least_m) + " m");
    report.facts.emplace_back("Pairs within the preset's dead time",
                              NumberText(comparison.gaps.num_in_dead));
  }
  report.headlines = {
      {"Error of points", "", comparison.PointsError()},
      {"Error of intensity", "", comparison.IntensityError()},
      {"Error of the mean intensity at each range", "", comparison.MeanIntensityError()},
      {"Error of intensity, pieces cut at a factor of 1.2", "", comparison.IntensityError(1.2)},
      {"Error of intensity, pieces cut at a factor of 1.5", "", comparison.IntensityError(1.5)},
      {"Power of range left in the ground's intensity", "",
       RangeExponentLeft(comparison.intensity)},
      {"Noise about planes, simulated / recorded", "", comparison.PlaneSigmaRatio()},
      {"Noise from turn to turn, simulated / recorded", "", comparison.TemporalSigmaRatio()},
      {"Holes, simulated / recorded", "", comparison.HoleRatio()}};
  report.sections.push_back(MakePlanesSection(comparison));
  return report;
}

}  // namespace railcast
