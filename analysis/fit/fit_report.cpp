#include "analysis/fit/fit_report.h"

#include <cmath>

#include "analysis/fit/fit_curves.h"
#include "analysis/fit/fitted_scenario.h"
#include "analysis/report/joined.h"
#include "core/base/number_text.h"

namespace railcast {
namespace {

Table ParameterTable(const FitReportInput& input, const FitResult& result) {
  Table table{
      "parameters",
      "Parameters",
      "With 95 % intervals. What the recording does not identify has no value but a reason.",
      {{"parameter", "Parameter", ""},
       {"key", "Key in a scenario", ""},
       {"unit", "Unit", ""},
       {"value", "Value", ""}},
      {}};
  if (input.scenario) table.columns.push_back({"scenario", "Scenario's own", ""});
  table.columns.push_back({"remark", "Remark", ""});
  for (const FittedParameter& parameter : result.parameters) {
    std::vector<Cell> row = {parameter.title, parameter.place, parameter.unit, parameter.estimate};
    if (input.scenario) row.emplace_back(ScenarioValue(*input.scenario, parameter.place));
    row.emplace_back(parameter.remark);
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table SurfaceTable(const FitReportInput& input, const FitResult& result) {
  Table table{
      "surfaces",
      "Surfaces",
      "Reflectance: diffuse, dry, 1 = white. Facing range: up to where it is detected if it "
      "faces the beam, in clear air; that is its ratio to the threshold.",
      {{"surface", "Surface", ""},
       {"trials", "Trials", ""},
       {"returned", "Returned", ""},
       {"reflectance", "Reflectance", ""}},
      {}};
  if (input.scenario) table.columns.push_back({"scenario", "Scenario's own", ""});
  table.columns.push_back({"facing_range_m", "Facing range", "m"});
  table.columns.push_back({"remark", "Remark", ""});
  for (const SurfaceFit& surface : result.surfaces) {
    std::vector<Cell> row = {surface.name, surface.num_trials, surface.num_returned,
                             surface.reflectance};
    if (input.scenario) row.emplace_back(ScenarioReflectance(*input.scenario, surface.name));
    row.emplace_back(surface.facing_range_m);
    row.emplace_back(surface.remark);
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table PlaneTable(const RecordedTrials& trials) {
  Table table{"planes",
              "Planes",
              "As refined from the points near the given ones.",
              {{"plane", "Plane", ""},
               {"surface", "Surface", ""},
               {"points", "Points in the first frames", ""},
               {"distance_m", "Distance from the sensor", "m"},
               {"normal", "Normal", ""}},
              {}};
  for (std::size_t i = 0; i < trials.planes.size(); ++i) {
    const KnownPlane& plane = trials.planes[i];
    const std::string normal = Joined({NumberText(std::round(1e4 * plane.normal.x()) / 1e4), ", ",
                                       NumberText(std::round(1e4 * plane.normal.y()) / 1e4), ", ",
                                       NumberText(std::round(1e4 * plane.normal.z()) / 1e4)});
    table.rows.push_back({plane.name, plane.surface(), trials.num_plane_points[i],
                          std::abs(plane.normal.dot(plane.point_m)), normal});
  }
  return table;
}

std::vector<std::string> Findings(const RecordedTrials& trials, const FitResult& result) {
  std::vector<std::string> texts = {
      "A trial is a firing of which it is known what it should have met: from the frames' truth "
      "fields, from given planes, or from flat pieces of one label. Only whether a point came back "
      "is used, never why not."};
  if (trials.lateral_ratio > kIsotropicRatio) {
    texts.emplace_back(
        "The points leave their beams sideways as well as along: the noise is isotropic.");
  } else if (!std::isnan(trials.lateral_ratio)) {
    texts.emplace_back("The points stay on their beams: the noise is along the beam.");
  }
  const Estimate& bias_m = result.residuals.bias_m;
  if (bias_m.is_enough() && (bias_m.low > 0.0 || bias_m.high < 0.0)) {
    texts.push_back(Joined({"All ranges together are off by ",
                            NumberText(std::round(1e4 * bias_m.value) / 10.0),
                            " mm: the median of the residuals."}));
  }
  constexpr double kManyHidden = 0.01;
  if (static_cast<double>(trials.num_hidden) > kManyHidden * static_cast<double>(trials.num_seen)) {
    texts.push_back(
        Joined({NumberText(trials.num_hidden),
                " firings were answered by rain, snow or fog: what they should have met "
                "is not known. Weak surfaces are missing among the trials more than "
                "strong ones, so that threshold, extinction and dropout are biased."}));
  }
  return texts;
}

std::vector<Headline> Headlines(const FitResult& result) {
  std::vector<Headline> headlines;
  for (const FittedParameter& parameter : result.parameters) {
    if (parameter.place.empty() || !parameter.estimate.is_enough()) continue;
    headlines.push_back({parameter.title, parameter.unit, parameter.estimate});
  }
  constexpr std::size_t kMost = 6;
  if (headlines.size() > kMost) headlines.resize(kMost);
  return headlines;
}

}  // namespace

Report MakeFitReport(const FitReportInput& input,
                     const RecordedTrials& trials,
                     const FitSettings& settings,
                     const FitResult& result) {
  Report report;
  const std::string rung = settings.is_physical ? "surface" : "plausibility";
  report.title = Joined({"Parameters of rung ", rung, " from ", input.sources.front()});
  report.command = input.command;
  for (const std::string& source : input.sources) report.facts.emplace_back("Input", source);
  report.facts.emplace_back("Kind", input.kind);
  report.facts.emplace_back("Frames", NumberText(trials.num_frames));
  report.facts.emplace_back("Trials", Joined({NumberText(trials.num_seen), ", of which ",
                                              NumberText(result.num_trials), " were fitted"}));
  report.facts.emplace_back("Of those fitted",
                            Joined({NumberText(result.num_lost), " lost, ",
                                    NumberText(result.num_elsewhere), " with a point elsewhere"}));
  report.headlines = Headlines(result);
  Section section{"fit", Joined({"Rung ", rung}), Findings(trials, result), {}, {}};
  section.charts = MakeFitCharts(trials.trials, trials.surfaces, settings, result);
  section.tables = {ParameterTable(input, result), SurfaceTable(input, result)};
  if (!trials.planes.empty()) section.tables.push_back(PlaneTable(trials));
  report.sections.push_back(std::move(section));
  return report;
}

}  // namespace railcast
