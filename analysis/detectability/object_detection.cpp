#include "analysis/detectability/object_detection.h"

#include <algorithm>
#include <cmath>
#include <ranges>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

/// An object is approached if its distance falls by this much.
constexpr double kMinApproach_m = 1.0;
constexpr double kNoDistance_m = std::numeric_limits<double>::quiet_NaN();

void Add(const ObjectDetection& detection, Verdict& verdict) {
  verdict.is_in_way = verdict.is_in_way || detection.is_in_way;
  verdict.from_axis_m = std::min(verdict.from_axis_m, detection.from_axis_m);
  if (detection.fate == Fate::kNeverApproached) return;
  ++verdict.num_approached;
  // Both comparisons are negated so that they also replace an initial NaN.
  if (!(verdict.most_needed_m >= detection.needed_m)) verdict.most_needed_m = detection.needed_m;
  if (detection.fate == Fate::kNeverDetected) return;
  ++verdict.num_detected;
  verdict.num_in_time += detection.is_in_time() ? 1U : 0U;
  if (detection.is_from_start && !detection.is_in_time()) {
    ++verdict.num_undecided;
    return;
  }
  // If detected at once, the distance is only a lower bound.
  if (!detection.is_from_start) {
    verdict.distance_m.Add(detection.distance_m);
    verdict.spare_m.Add(detection.spare_m());
    if (!(verdict.least_distance_m <= detection.distance_m)) {
      verdict.least_distance_m = detection.distance_m;
    }
  }
  if (!(verdict.least_spare_m <= detection.spare_m())) verdict.least_spare_m = detection.spare_m();
}

std::string Runs(std::uint64_t num, std::uint64_t all) {
  if (all == 1) return "in the one run";
  if (num == all) return "in all " + std::to_string(all) + " runs";
  return "in " + std::to_string(num) + " of " + std::to_string(all) + " runs";
}

/// Index of the sighting that completes the rule.
std::optional<std::size_t> FirstDetected(std::span<const Sighting> sightings,
                                         const DetectionRule& rule) {
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (CompletesRule(sightings.first(i + 1), rule)) return i;
  }
  return std::nullopt;
}

/// The last frame with fewer points than the rule asks for.
std::optional<std::uint32_t> LastMissed(std::span<const Sighting> sightings,
                                        const DetectionRule& rule) {
  for (std::size_t i = sightings.size(); i-- > 0;) {
    if (sightings[i].points < rule.min_points) return sightings[i].frame;
  }
  return std::nullopt;
}

}  // namespace

std::span<const Sighting> ApproachIn(const std::vector<Sighting>& sightings) {
  const auto closest = std::ranges::min_element(sightings, {}, &Sighting::distance_m);
  const auto num = static_cast<std::size_t>(closest - sightings.begin()) + 1;
  return std::span(sightings).first(num);
}

bool IsApproached(std::span<const Sighting> approach) {
  const auto farthest = std::ranges::max(approach, {}, &Sighting::distance_m).distance_m;
  return farthest - approach.back().distance_m >= kMinApproach_m;
}

bool CompletesRule(std::span<const Sighting> sightings, const DetectionRule& rule) {
  std::uint32_t num = 0;
  for (const Sighting& each : std::views::reverse(sightings)) {
    if (sightings.back().frame - each.frame >= rule.of_frames) break;
    num += each.points >= rule.min_points ? 1U : 0U;
  }
  return num >= rule.min_frames;
}

BrakedStop StopOf(const BrakingSpec& braking, double speed_mps, double gradient) {
  constexpr double kGravity_mps2 = 9.80665;
  const double deceleration_mps2 = braking.deceleration_mps2 + kGravity_mps2 * gradient;
  if (!(deceleration_mps2 > 0.0)) {
    const auto rounded = [](double value) { return std::round(1e3 * value) / 1e3; };
    constexpr double kPermil = 1e3;
    throw InputError("cannot stop: deceleration + g x gradient must be > 0 (got " +
                     NumberText(rounded(deceleration_mps2)) + " m/s2 at " +
                     NumberText(rounded(kPermil * gradient)) + " permil)");
  }
  return {.distance_m =
              speed_mps * braking.reaction_s + speed_mps * speed_mps / (2.0 * deceleration_mps2),
          .time_s = braking.reaction_s + speed_mps / deceleration_mps2};
}

ObjectDetection DetectObject(const ObjectCourse& course,
                             const DetectionRule& rule,
                             const BrakingSpec& braking,
                             std::optional<double> speed_mps) {
  ObjectDetection result;
  result.fate = Fate::kNeverApproached;
  if (course.sightings.empty()) return result;
  const std::span<const Sighting> approach = ApproachIn(course.sightings);
  result.is_in_way = std::ranges::any_of(approach, &Sighting::is_in_way);
  result.from_axis_m = std::ranges::min(approach, {}, &Sighting::from_axis_m).from_axis_m;
  // If vehicle and object both stand still, the distance between them does not change.
  if (!IsApproached(approach)) return result;
  const auto detected = FirstDetected(approach, rule);
  const Sighting& sighting = approach[detected.value_or(0)];
  result.fate = detected ? Fate::kDetected : Fate::kNeverDetected;
  result.missed_frame = LastMissed(approach.first(detected.value_or(approach.size())), rule);
  if (detected) {
    result.distance_m = sighting.distance_m;
    result.frame = sighting.frame;
    result.is_from_start = approach.front().frame == 0 && *detected + 1 == rule.min_frames;
  }
  result.speed_mps = speed_mps.value_or(sighting.speed_mps);
  result.gradient = sighting.gradient;
  const BrakedStop stop = StopOf(braking, result.speed_mps, result.gradient);
  result.stop_m = stop.distance_m;
  result.needed_m =
      stop.distance_m + std::max(0.0, sighting.approach_mps) * stop.time_s + braking.margin_m;
  return result;
}

DetectRun DetectInRun(std::filesystem::path source,
                      std::uint64_t seed,
                      RunCourses courses,
                      const DetectSpec& spec) {
  DetectRun run{
      .source = std::move(source), .seed = seed, .courses = std::move(courses), .detections = {}};
  for (const auto& [name, course] : run.courses.objects) {
    const ObjectCourse& of_object = course;  // A lambda cannot capture a structured binding.
    run.detections[name] =
        AtPlace(ShownPath(run.source) + ": object " + ShownText(name) + ": ",
                [&] { return DetectObject(of_object, spec.rule, spec.braking, spec.speed_mps); });
  }
  return run;
}

std::string Verdict::InWords() const {
  if (num_approached == 0) return "never approached";
  if (num_detected == 0) return "not detected " + Runs(num_approached, num_approached);
  if (num_in_time == num_approached) return "in time " + Runs(num_in_time, num_approached);
  std::string words;
  const auto add = [&](const char* what, std::uint64_t num) {
    if (num == 0) return;
    if (!words.empty()) words += ", ";
    words += what + Runs(num, num_approached);
  };
  add("too late ", num_detected - num_in_time - num_undecided);
  add("not detected ", num_approached - num_detected);
  add("not known, begun too near ", num_undecided);
  return words;
}

std::vector<Verdict> MakeVerdicts(const std::vector<DetectRun>& runs) {
  std::map<std::string, Verdict> by_name;
  for (const DetectRun& run : runs) {
    for (const auto& [name, detection] : run.detections) {
      const ObjectCourse& course = run.courses.objects.at(name);
      const auto [entry, is_new] = by_name.try_emplace(name);
      Verdict& verdict = entry->second;
      if (is_new) {
        verdict.name = name;
        verdict.type = course.type;
        verdict.label = course.label;
        verdict.from_axis_m = std::numeric_limits<double>::infinity();
        verdict.least_distance_m = verdict.least_spare_m = verdict.most_needed_m = kNoDistance_m;
      }
      Add(detection, verdict);
    }
  }
  std::vector<Verdict> verdicts;
  for (auto& [name, verdict] : by_name) verdicts.push_back(std::move(verdict));
  return verdicts;
}

}  // namespace railcast
