#include "analysis/extras/preset/preset_comparison.h"

#include <utility>

#include "analysis/report/chart_columns.h"
#include "analysis/report/words.h"
#include "analysis/stats/bins.h"
#include "core/base/text.h"

namespace railcast {

extern const char* const kPresetWords;
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

Cell NeighbourSigmaCell(const NeighbourNoise& noise, std::size_t bin) {
  if (bin >= noise.bins().size()) return NotEnough(0);
  return Scaled(noise.Sigma_m(bin), kPresetMm);
}

Cell TemporalSigmaCell(const TemporalNoise& noise, std::size_t bin) {
  if (bin >= noise.bins().size()) return NotEnough(0);
  return Scaled(noise.bins()[bin].RobustSigma_m(), kPresetMm);
}

Table RangeTable(const PresetComparison& comparison) {
  Table table = TableOf(kPresetWords, "preset_by_range");
  const PlaneFigures& recorded = comparison.recorded;
  const PlaneFigures& simulated = comparison.simulated;
  for (std::size_t i = 0; i < recorded.firings.size(); ++i) {
    if (recorded.num_points(i) == 0) continue;
    table.rows.push_back(
        {RangeBins().span(i), recorded.num_points(i), simulated.num_points(i),
         HoleCell(recorded, i), HoleCell(simulated, i), PlaneSigmaCell(recorded.noise, i),
         PlaneSigmaCell(simulated.noise, i), NeighbourSigmaCell(recorded.neighbours, i),
         NeighbourSigmaCell(simulated.neighbours, i), TemporalSigmaCell(recorded.temporal, i),
         TemporalSigmaCell(simulated.temporal, i)});
  }
  return table;
}

Table CellTable(const PresetComparison& comparison) {
  Table table = TableOf(kPresetWords, "preset_intensity");
  for (const IntensityCell& cell : LikePieces(comparison.intensity)) {
    table.rows.push_back({std::uint64_t{cell.turn}, std::uint64_t{cell.piece},
                          std::uint64_t{cell.place.plane}, std::uint64_t{cell.place.strip},
                          std::string(cell.is_ground ? "ground" : "other"), cell.range_m,
                          cell.incidence_deg, cell.recorded, cell.simulated});
  }
  return table;
}

Section MakePlanesSection(const PresetComparison& comparison) {
  Section section = SectionOf(kPresetWords, "preset");
  Table table = RangeTable(comparison);
  section.charts = {ChartOfTable(kPresetWords, "preset_holes_percent", table),
                    ChartOfTable(kPresetWords, "preset_turns_mm", table)};
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
