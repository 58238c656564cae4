#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "analysis/estimate/streams.h"
#include "analysis/extras/dossier/dossier_report.h"
#include "analysis/extras/study/approach_scan.h"
#include "analysis/report/words.h"
#include "core/base/text.h"
#include "core/io/run/dataset_files.h"

namespace railcast {
namespace {

// The frames of an approach are alike, so that each of them is not needed.
std::vector<std::uint32_t> Thinned(const std::vector<std::uint32_t>& frames) {
  constexpr std::size_t kMostFrames = 40;
  const std::size_t step = (frames.size() + kMostFrames - 1) / kMostFrames;
  std::vector<std::uint32_t> thinned;
  for (std::size_t i = 0; i < frames.size(); i += step) thinned.push_back(frames[i]);
  return thinned;
}

RunCourses CoursesOn(Fidelity fidelity,
                     ScenarioSpec scenario,
                     const std::vector<std::uint32_t>& frames,
                     ApproachScanner& scanner) {
  // Is never complete, so that all frames up to the closest are traced.
  constexpr DetectionRule kNever = {
      .min_points = std::numeric_limits<std::uint32_t>::max(), .min_frames = 1, .of_frames = 1};
  if (scenario.fidelity != fidelity) {
    scenario.fidelity = fidelity;
    scenario.effects = {};
  }
  return scanner.Follow(scenario, frames, kNever, [] { return false; }).value();
}

void AddCompared(const RunCourses& courses, const RunCourses& reference, ModelError& error) {
  for (const auto& [name, course] : courses.objects) {
    if (course.sightings.empty()) continue;
    const std::span<const Sighting> approach = ApproachIn(course.sightings);
    if (!std::ranges::any_of(approach, &Sighting::is_in_way) || !IsApproached(approach)) continue;
    const std::vector<Sighting>& expected = reference.objects.at(name).sightings;
    ComparedApproach compared{.target = TargetOf(name),
                              .approach = {.object = name, .instance = 0, .points = {}}};
    for (std::size_t i = 0; i < approach.size(); ++i) {
      compared.approach.points.push_back({.distance_m = approach[i].distance_m,
                                          .points_in_reference = expected[i].points,
                                          .points = approach[i].points});
    }
    error.approaches.push_back(std::move(compared));
  }
}

/// Points on a target in one bin of distance.
struct ComparedBin {
  std::uint64_t num_frames{};
  std::uint64_t points{};
  std::uint64_t points_in_reference{};
  Moments ratios;  ///< One of each approach: the frames of one are not independent.
};

using ComparedBins = std::array<ComparedBin, kNumDistanceBins>;

std::map<std::string, ComparedBins> ComparedBinsOf(const ModelError& error) {
  std::map<std::string, ComparedBins> by_target;
  for (const ComparedApproach& compared : error.approaches) {
    ComparedBins& bins = by_target[compared.target];
    std::array<std::pair<std::uint64_t, std::uint64_t>, kNumDistanceBins> sums{};
    for (const ApproachPoints& frame : compared.approach.points) {
      const std::size_t bin = BinOf(kBinDistances_m, frame.distance_m);
      ++bins.at(bin).num_frames;
      sums.at(bin).first += frame.points;
      sums.at(bin).second += frame.points_in_reference;
    }
    for (std::size_t i = 0; i < bins.size(); ++i) {
      const auto [points, in_reference] = sums.at(i);
      bins.at(i).points += points;
      bins.at(i).points_in_reference += in_reference;
      if (in_reference == 0) continue;
      bins.at(i).ratios.Add(static_cast<double>(points) / static_cast<double>(in_reference));
    }
  }
  return by_target;
}

Span DistancesOf(std::size_t bin) {
  return {.low = bin == 0 ? 0.0 : kBinDistances_m.at(bin - 1),
          .high = bin < kBinDistances_m.size() ? kBinDistances_m.at(bin)
                                               : std::numeric_limits<double>::infinity()};
}

double PerFrame(std::uint64_t points, std::uint64_t num_frames) {
  return static_cast<double>(points) / static_cast<double>(num_frames);
}

Table PointsTable(const std::map<std::string, ComparedBins>& by_target) {
  Table table = TableOf(kDossierWords, "model_points");
  for (const auto& [target, bins] : by_target) {
    for (std::size_t i = 0; i < bins.size(); ++i) {
      const ComparedBin& bin = bins.at(i);
      if (bin.num_frames == 0) continue;
      table.rows.push_back({target, DistancesOf(i), bin.num_frames,
                            PerFrame(bin.points, bin.num_frames),
                            PerFrame(bin.points_in_reference, bin.num_frames), bin.ratios.Mean()});
    }
  }
  return table;
}

Table DistancesTable(const ModelError& error) {
  struct Shifts {
    std::uint64_t num{};
    std::uint64_t num_at_start{};
    std::uint64_t num_missed{};
    Moments shift_m;
    double least_m = std::numeric_limits<double>::quiet_NaN();
    double most_m = std::numeric_limits<double>::quiet_NaN();
  };
  std::map<std::string, Shifts> by_target;
  for (const ComparedApproach& compared : error.approaches) {
    Shifts& shifts = by_target[compared.target];
    ++shifts.num;
    const double found_m =
        DetectionDistance_m(compared.approach, &ApproachPoints::points, error.min_points);
    const double expected_m = DetectionDistance_m(
        compared.approach, &ApproachPoints::points_in_reference, error.min_points);
    if (std::isnan(found_m) || std::isnan(expected_m)) {
      ++shifts.num_at_start;
    } else if (found_m == 0.0 || expected_m == 0.0) {
      ++shifts.num_missed;
    } else {
      const double shift_m = found_m - expected_m;
      shifts.shift_m.Add(shift_m);
      shifts.least_m = std::fmin(shifts.least_m, shift_m);
      shifts.most_m = std::fmax(shifts.most_m, shift_m);
    }
  }
  Table table = TableOf(kDossierWords, "model_distances");
  for (const auto& [target, shifts] : by_target) {
    table.rows.push_back({target, shifts.num, shifts.num_at_start, shifts.num_missed,
                          shifts.shift_m.Mean(), shifts.least_m, shifts.most_m});
  }
  return table;
}

Chart RatioChart(const std::map<std::string, ComparedBins>& by_target) {
  Chart chart = ChartOf(kDossierWords, "model_ratio");
  for (const auto& [target, bins] : by_target) {
    ChartSeries series{target, SeriesStyle::kLinePoints};
    for (std::size_t i = 0; i + 1 < bins.size(); ++i) {
      const Span span = DistancesOf(i);
      series.points.push_back(PointAt((span.low + span.high) / 2.0, bins.at(i).ratios.Mean()));
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace

ModelError MeasureModelError(const FinishedStudy& study,
                             const std::vector<ScenarioSpec>& sample,
                             int num_threads,
                             const std::function<void(double done)>& on_progress) {
  const std::vector<std::uint32_t> frames = Thinned(study.frames);
  ModelError error;
  const StudySpec& spec = study.spec;
  error.min_points = spec.detector ? spec.detector->min_points : spec.detect.rule.min_points;
  std::set<Fidelity> rungs;
  std::vector<RunCourses> courses;
  // A scanner keeps the scene of one rung, so that all approaches are on one, and then on the
  // other.
  for (const bool is_reference : {false, true}) {
    ApproachScanner scanner(num_threads, {}, spec.gauge, spec.objects);
    for (std::size_t i = 0; i < sample.size(); ++i) {
      const std::size_t num_done = i + (is_reference ? sample.size() : 0);
      on_progress(0.5 * static_cast<double>(num_done) / static_cast<double>(sample.size()));
      const ScenarioSpec& scenario = sample[i];
      rungs.insert(scenario.fidelity);
      RunCourses found = CoursesOn(is_reference ? Fidelity::kReference : scenario.fidelity,
                                   scenario, frames, scanner);
      if (is_reference) {
        AddCompared(courses[i], found, error);
      } else {
        courses.push_back(std::move(found));
      }
    }
  }
  if (rungs.size() == 1) error.rung = NameOf(*rungs.begin());
  return error;
}

Section ModelErrorSection(const ModelError& error) {
  Section section = SectionOf(kDossierWords, "model",
                              {{"rung", error.rung}, {"num", NumberText(error.approaches.size())}});
  const auto by_target = ComparedBinsOf(error);
  section.charts = {RatioChart(by_target)};
  section.tables = {DistancesTable(error), PointsTable(by_target)};
  return section;
}

}  // namespace railcast
