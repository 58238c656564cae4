#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "analysis/inspect/inspection.h"
#include "analysis/report/cell_text.h"
#include "analysis/stats/bins.h"
#include "core/base/join.h"
#include "core/base/median.h"
#include "core/base/text.h"
#include "core/base/units.h"

namespace railcast {
namespace {

constexpr std::string_view kOfPackets = "capture of ";

/// Rows of a name, a figure and what it means.
class Findings {
 public:
  Findings(std::string key, std::string title) : title_(std::move(title)) {
    table_.title = "Findings";
    table_.key = std::move(key);
    table_.columns = ColumnsOf("what: What; figure: Figure; remark: Remark");
    table_.is_open = true;
  }
  void Add(const std::string& what, const std::string& figure, const std::string& remark = {}) {
    table_.rows.push_back({what, figure, remark});
  }
  void Count(const std::string& what, std::uint64_t number, const std::string& remark = {}) {
    Add(what, CountText(number), remark);
  }
  [[nodiscard]] Section MakeSection(std::vector<std::string> paragraphs = {}) const {
    return {.key = table_.key,
            .title = title_,
            .paragraphs = std::move(paragraphs),
            .tables = {table_}};
  }

 private:
  std::string title_;
  Table table_;
};

std::string ShareText(std::uint64_t part, std::uint64_t whole) {
  return ShortText(100.0 * static_cast<double>(part) /
                   static_cast<double>(std::max<std::uint64_t>(1, whole))) +
         " %";
}

Section JobsSection(const std::vector<JobFitness>& jobs) {
  Table table{.key = "jobs", .title = "Jobs"};
  table.columns = ColumnsOf("job: Job; fit: Fit; why: With what, or why not");
  table.is_open = true;
  for (const JobFitness& job : jobs) {
    const char* const fit = job.fitness == Fitness::kYes  ? "yes"
                            : job.fitness == Fitness::kNo ? "no"
                                                          : "with an option";
    table.rows.push_back({job.job, std::string(fit), job.why});
  }
  return {.key = "jobs", .title = "What it is fit for", .tables = {std::move(table)}};
}

/// Says about which axis the sensor spins, if that is not z, and how scenarios turn it so.
void AddAxis(const SensorSearch& sensor, Findings& findings) {
  const std::string axis = sensor.found ? sensor.found->AxisText() : "";
  if (axis.empty()) return;
  const Vector3 spin = sensor.found->sensor_from_spin->col(2);
  const auto degrees = [](double y, double x) {
    return NumberText(std::round(1e4 * DegFromRad(std::atan2(y, x))) / 1e4 + 0.0);
  };
  findings.Add("axis of rotation", axis,
               "of the recording's axes; the mount of a scenario turns the sensor so by yaw_deg " +
                   degrees(spin.y(), spin.x()) + ", pitch_deg " +
                   degrees(spin.head<2>().norm(), spin.z()));
}

Section SensorSection(const RecordingLook& seen, const RecordingInfo& info) {
  Findings findings("what", "What it is");
  findings.Add("kind", info.kind);
  const auto guesses = GuessSensor(seen.rings);
  if (info.scenario) {
    findings.Add("sensor", info.scenario->lidar.name, "as its scenario says");
  } else if (info.kind.starts_with(kOfPackets)) {
    findings.Add("sensor", info.kind.substr(kOfPackets.size()), "as its packets say");
  } else if (!seen.why_no_ranges.empty()) {
    findings.Add("sensor", "unknown", "its place is not known");
  } else if (guesses.empty() || guesses.front().error_deg > kLikelyGuess_deg) {
    findings.Add("sensor", seen.sensor.found ? "no preset" : "unknown",
                 seen.sensor.found ? seen.sensor.found->Text() : seen.sensor.why_not);
  } else {
    const SensorGuess& best = guesses.front();
    findings.Add("sensor", best.name,
                 std::string(best.error_deg < kSureGuess_deg ? "by its rings: " : "likely: ") +
                     "elevations are off by " + ShortText(best.error_deg) + " deg rms");
  }
  AddAxis(seen.sensor, findings);
  std::vector<std::string> fields;
  for (const auto& [name, num] : seen.fields) fields.push_back(name);
  findings.Add("fields", Join(fields));
  if (!seen.foreign.empty()) findings.Add("fields of others", Join(seen.foreign));
  findings.Count("frames", seen.num_frames,
                 seen.is_cut_short ? "the first of more" : "all of them");
  if (seen.num_empty > 0) findings.Count("frames without a point", seen.num_empty);
  findings.Count("frames as grids of firings", seen.num_grids, seen.why_no_grid);
  if (!seen.origin_m.isZero()) {
    findings.Add("map coordinates",
                 NumberText(std::llround(seen.origin_m.x())) + ", " +
                     NumberText(std::llround(seen.origin_m.y())) + ", " +
                     NumberText(std::llround(seen.origin_m.z())) + " m",
                 "positions far from 0 are kept relative to this place; where the sensor was is "
                 "not known");
  }
  return findings.MakeSection();
}

Section TimesSection(const RecordingLook& seen) {
  Findings findings("times", "Times");
  if (!seen.HasStamps()) {
    findings.Add("stamps", "none", "frames are taken to be 1 / rate_hz apart");
  } else {
    std::vector<double> steps_s;
    std::uint64_t num_equal = 0;
    std::uint64_t num_back = 0;
    for (std::size_t i = 1; i < seen.stamps_ns.size(); ++i) {
      const std::int64_t step_ns = seen.stamps_ns[i] - seen.stamps_ns[i - 1];
      num_equal += step_ns == 0 ? 1 : 0;
      num_back += step_ns < 0 ? 1 : 0;
      steps_s.push_back(SecondsFromNs(step_ns));
    }
    if (!steps_s.empty()) {
      const double median_s = MedianOf(steps_s);
      constexpr double kGap = 1.5;
      const auto num_gaps =
          std::ranges::count_if(steps_s, [&](double step_s) { return step_s > kGap * median_s; });
      findings.Add("step from frame to frame", ShortText(median_s) + " s",
                   "median; at most " + ShortText(*std::ranges::max_element(steps_s)) + " s");
      findings.Count("gaps", static_cast<std::uint64_t>(num_gaps),
                     num_gaps > 0 ? "steps of more than 1.5 times the median" : "");
    }
    findings.Count("doubled stamps", num_equal);
    findings.Count("stamps before the one before them", num_back);
  }
  if (seen.durations_s.empty()) {
    findings.Add("times of points", "none that are certain", "all points of a frame take its pose");
  } else {
    std::vector<double> durations_s = seen.durations_s;
    findings.Add("span of a frame's times", ShortText(MedianOf(durations_s)) + " s",
                 "median of " + CountText(seen.durations_s.size()) + " frames");
  }
  return findings.MakeSection();
}

/// Adds numbers of rings as one row, if there are any.
void AddRings(const std::string& what, const std::vector<std::size_t>& rings, Findings& findings) {
  if (rings.empty()) return;
  constexpr std::size_t kMost = 16;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, rings.size()); ++i) {
    text += (i == 0 ? "" : ", ") + NumberText(rings[i]);
  }
  if (rings.size() > kMost) text += ", ...";
  findings.Count(what, rings.size(), text);
}

Section RingsSection(const RecordingLook& seen) {
  Findings findings("rings", "Rings");
  const std::size_t num = seen.rings.size();
  findings.Count("rings", num);
  std::vector<double> points;
  for (const InspectedRing& ring : seen.rings)
    points.push_back(static_cast<double>(ring.num_points));
  std::vector<double> sorted = points;
  const double median = MedianOf(sorted);
  std::vector<std::size_t> dead;
  std::vector<std::size_t> weak;
  std::vector<std::size_t> misordered;
  std::vector<std::size_t> gaps;
  const auto elevation_deg = [&](std::size_t ring) {
    const Moments& of = seen.rings[ring].elevation_deg;
    return of.num() == 0 ? std::nan("") : of.PlainMean();
  };
  constexpr double kDead = 0.01;
  constexpr double kWeak = 0.5;
  constexpr double kGap = 1.8;
  for (std::size_t i = 0; i < num; ++i) {
    if (points[i] < kDead * median) {
      dead.push_back(i);
    } else if (i > 0 && i + 1 < num && points[i] < kWeak * std::min(points[i - 1], points[i + 1])) {
      weak.push_back(i);
    }
    if (i > 0 && elevation_deg(i) < elevation_deg(i - 1)) misordered.push_back(i);
    if (i < 2 || i + 1 >= num) continue;
    const double step_deg = elevation_deg(i) - elevation_deg(i - 1);
    if (step_deg > kGap * (elevation_deg(i - 1) - elevation_deg(i - 2)) &&
        step_deg > kGap * (elevation_deg(i + 1) - elevation_deg(i))) {
      gaps.push_back(i);
    }
  }
  AddRings("dead, with under 1 % of the median's points", dead, findings);
  AddRings("weak, with under half of either neighbour's points", weak, findings);
  AddRings("lower than the ring before", misordered, findings);
  AddRings("a ring may be missing below", gaps, findings);
  return findings.MakeSection();
}

/// The least of what neighbouring firings say of the noise, by range.
void AddNoise(const NeighbourNoise& noise, Findings& findings) {
  constexpr std::uint64_t kLeast = 1'000;
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < noise.bins().size(); ++i) {
    if (noise.bins()[i].num() < kLeast) continue;
    if (!best || noise.Sigma_m(i).value < noise.Sigma_m(*best).value) best = i;
  }
  if (!best) return;
  const Span span_m = RangeBins().span(*best);
  findings.Add("noise of ranges, at most", ShortText(1e3 * noise.Sigma_m(*best).value) + " mm",
               "at " + ShortText(span_m.low) + " to " + ShortText(span_m.high) +
                   " m, by second differences along rings; more if the sensor averages neighbours");
}

/// What the intensities are, as far as their values tell.
std::string ScaleOf(const InspectedValues& intensity, const RecordingInfo& info) {
  constexpr double kWhite = 1.5;  // Retroreflectors are brighter than white.
  constexpr double kMostByte = 255.0;
  if (info.kind.starts_with(kOfPackets) || info.origin) return "reflectances, 1 = white";
  if (intensity.highest <= kWhite) return "reflectances, 1 = white, or bytes divided by 255";
  if (intensity.highest > kMostByte) return "neither reflectances nor bytes";
  return intensity.is_whole ? "bytes" : "numbers up to 255";
}

Section ValuesSection(const RecordingLook& seen, const RecordingInfo& info) {
  Findings findings("values", "Values");
  findings.Count("points", seen.num_points);
  const bool is_in_map = !seen.why_no_ranges.empty();
  const auto add_range = [&](const std::string& what, double range_m) {
    findings.Add(what, std::isnan(range_m) ? "too few points" : ShortText(range_m) + " m");
  };
  if (is_in_map) {
    findings.Add("ranges", "unknown", seen.why_no_ranges);
  } else {
    add_range("range, median", seen.range_m.Median().value);
    add_range("range, 99.9 % are below", seen.range_m.Quantile(0.999).value);
    findings.Add("nearer than 0.5 m", ShareText(seen.num_near, seen.num_points),
                 seen.num_near > 0 ? "dirt on the window, the vehicle itself, or noise" : "");
    if (seen.range_step_m > 0.0) {
      findings.Add("step of ranges", ShortText(1e3 * seen.range_step_m) + " mm",
                   "found by the differences of neighbouring points");
    }
    AddNoise(seen.neighbours, findings);
  }
  const InspectedValues& intensity = seen.intensity;
  if (intensity.num > 0) {
    findings.Add("intensity", ShortText(intensity.least) + " to " + ShortText(intensity.highest),
                 ScaleOf(intensity, info));
    findings.Add("intensity 0", ShareText(intensity.num_zero, intensity.num));
    constexpr double kLarge = 0.01;
    const bool is_large =
        static_cast<double>(intensity.num_highest) >= kLarge * static_cast<double>(intensity.num);
    findings.Add("intensity as high as any", ShareText(intensity.num_highest, intensity.num),
                 intensity.least == intensity.highest ? "all are alike"
                 : is_large                           ? "a large share: they are saturated"
                                                      : "");
    if (intensity.num_missing > 0) findings.Count("intensity missing", intensity.num_missing);
  } else {
    findings.Add("intensity", "none");
  }
  if (is_in_map) return findings.MakeSection();
  std::string empty;
  for (std::size_t i = 0; i < RecordingLook::kNumSectors;) {
    std::size_t end = i;
    while (end < RecordingLook::kNumSectors && seen.sectors[end] == 0) ++end;
    constexpr int kSector_deg = 5;
    const auto edge = [](std::size_t sector) {
      return NumberText(static_cast<int>(sector) * kSector_deg - 180);
    };
    if (end > i) empty += (empty.empty() ? "" : ", ") + edge(i) + " to " + edge(end) + " deg";
    i = std::max(end, i + 1);
  }
  findings.Add("azimuths without a point in any frame", empty.empty() ? "none" : empty,
               empty.empty() ? "" : "blocked, not scanned, or open; positive to the left");
  return findings.MakeSection();
}

Section PosesSection(const RecordingLook& seen) {
  Findings findings("poses", "Poses");
  findings.Count("frames with a pose", seen.num_with_pose);
  double way_m = 0.0;
  double fastest_mps = 0.0;
  for (std::size_t i = 1; i < seen.world_from_sensor.size(); ++i) {
    const double step_m =
        (seen.world_from_sensor[i].translation() - seen.world_from_sensor[i - 1].translation())
            .norm();
    const double step_s = SecondsFromNs(seen.pose_stamps_ns[i] - seen.pose_stamps_ns[i - 1]);
    way_m += step_m;
    if (step_s > 0.0) fastest_mps = std::max(fastest_mps, step_m / step_s);
  }
  if (seen.world_from_sensor.size() > 1) {
    constexpr double kFast_mps = 100.0;
    findings.Add("way", ShortText(way_m) + " m");
    findings.Add("highest speed from frame to frame", ShortText(fastest_mps) + " m/s",
                 fastest_mps > kFast_mps ? "a jump, or a wrong unit of time" : "");
  }
  if (!seen.motions.empty()) {
    const auto worst = std::ranges::max_element(seen.motions, {}, &MotionBetween::off_m);
    double by_poses_m = 0.0;
    double by_clouds_m = 0.0;
    for (const MotionBetween& motion : seen.motions) {
      by_poses_m += motion.distance_m;
      by_clouds_m += motion.registered_m;
    }
    findings.Add("way by poses and by registration",
                 ShortText(by_poses_m) + " m, " + ShortText(by_clouds_m) + " m",
                 "of " + CountText(seen.motions.size()) + " steps, clouds laid on the one before");
    findings.Add("largest difference of a step", ShortText(worst->off_m) + " m",
                 "frame " + CountText(worst->frame));
  }
  return findings.MakeSection();
}

Section RemarksSection(const std::vector<Remark>& remarks, bool has_odd_frames) {
  Findings findings("remarks", "Remarks of the reader");
  for (const Remark& remark : remarks) {
    findings.Count(std::string(remark.type().name), remark.number, remark.Text());
  }
  return findings.MakeSection(
      remarks.empty()
          ? std::vector<std::string>{std::string(
                                         "The reader left out, bridged, guessed and rounded "
                                         "nothing") +
                                     (has_odd_frames ? "; what is odd of single frames is above."
                                                     : ".")}
          : std::vector<std::string>{});
}

}  // namespace

Report MakeInspectionReport(const RecordingLook& inspection,
                            const RecordingInfo& info,
                            const std::string& command) {
  const bool has_odd_frames = std::ranges::any_of(
      inspection.frames, [](const InspectedFrame& frame) { return !frame.odd.empty(); });
  Report report;
  report.title = "Inspection of " + ShownPath(info.source);
  report.command = command;
  report.facts.emplace_back("Source", ShownPath(info.source) + " (" + info.kind + ")");
  report.sections = {JobsSection(JobsOf(inspection, info)), SensorSection(inspection, info),
                     FramesSection(inspection.HasStamps(), inspection.frames),
                     TimesSection(inspection)};
  if (!inspection.rings.empty() && inspection.why_no_ranges.empty()) {
    report.sections.push_back(RingsSection(inspection));
  }
  report.sections.push_back(ValuesSection(inspection, info));
  report.sections.push_back(PosesSection(inspection));
  report.sections.push_back(RemarksSection(info.remarks->List(), has_odd_frames));
  return report;
}

}  // namespace railcast
