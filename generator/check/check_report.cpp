#include "generator/check/check_report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numbers>
#include <numeric>
#include <sstream>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/rail/clearance/clear_space.h"
#include "core/rail/motion/speed_profile.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

// A point that is not reached within a year counts as never reached.
constexpr double kForever_s = 365.0 * 24.0 * 3600.0;
// Needed because a stop is approached ever more slowly; at 1 m/s^2 this is 45 us before it.
constexpr double kArrival_m = 1e-9;
constexpr int kNumBisections = 80;

WayPoint PointAt(const SpeedProfile& profile, double time_s) {
  const SpeedProfile::State state = profile.At(time_s);
  return {time_s, state.s_m, state.speed_mps};
}

// Found by bisection, since the chainage is a monotonic function of time.
std::optional<WayPoint> ArrivalAt(const SpeedProfile& profile, double s_m) {
  const auto is_there = [&](double time_s) {
    const double ahead_m = s_m - profile.At(time_s).s_m;
    return (profile.reverse() ? -ahead_m : ahead_m) <= kArrival_m;
  };
  double after_s = 1.0;
  while (!is_there(after_s)) {
    after_s *= 2.0;
    if (after_s > kForever_s) return std::nullopt;
  }
  double before_s = 0.0;
  if (is_there(before_s)) return PointAt(profile, before_s);
  for (int i = 0; i < kNumBisections; ++i) {
    const double middle_s = std::midpoint(before_s, after_s);
    (is_there(middle_s) ? after_s : before_s) = middle_s;
  }
  return PointAt(profile, after_s);
}

// In frames: a moment found by bisection may lie just before the frame at which it occurs.
constexpr double kRoundOff = 1e-6;

// Rounds to this number of decimal places.
std::string Rounded(double value, int num_digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(num_digits) << value;
  return text.str();
}

std::string LabelName(const LabelTable& labels, std::uint32_t id) {
  const Label* label = labels.Find(id);
  return label == nullptr ? std::to_string(id) : label->name;
}

const char* UnitOf(const SmoothedJump& jump) {
  return jump.quantity == "gradient" ? " permil" : " 1/m";
}

double HeightOf(const SmoothedJump& jump) {
  return std::abs(jump.after - jump.before);
}

// For example "7 curvature jumps smoothed, the largest of 0.001 1/m at s 123 m".
std::string JumpsText(const std::vector<SmoothedJump>& all,
                      const std::string& quantity,
                      const std::string& kind) {
  std::vector<SmoothedJump> jumps;
  for (const SmoothedJump& jump : all) {
    if (jump.quantity == quantity) jumps.push_back(jump);
  }
  if (jumps.empty()) return ReportLine("", "no " + kind + "s");
  const auto largest =
      std::max_element(jumps.begin(), jumps.end(),
                       [](const auto& a, const auto& b) { return HeightOf(a) < HeightOf(b); });
  return ReportLine("", std::to_string(jumps.size()) + " " + kind + (jumps.size() == 1 ? "" : "s") +
                            " smoothed, the largest of " + ShortText(HeightOf(*largest)) +
                            UnitOf(*largest) + " at s " + Rounded(largest->s_m, 1) + " m");
}

// The frame under way, or the first if it begins later.
std::string WayPointText(const WayPoint& point, const ScanSpec& scan) {
  const double frame = std::floor((point.time_s - scan.phase_s) * scan.rate_hz + kRoundOff);
  return "after " + Rounded(point.time_s, 2) + " s (frame " + Rounded(std::max(0.0, frame), 0) +
         "), at s " + Rounded(point.s_m, 2) + " m";
}

std::string FramesText(std::uint32_t first, std::uint32_t last) {
  if (first == last) return "frame " + std::to_string(first);
  return "frames " + std::to_string(first) + " to " + std::to_string(last);
}

std::string SightingText(const SightedSurface& sighting,
                         const World& world,
                         const LabelTable& labels) {
  std::string text = LabelName(labels, sighting.label);
  for (const SceneObject& object : world.objects()) {
    if (object.instance == sighting.instance) text += " of \"" + ShownText(object.name) + '"';
  }
  return text + ", " + Rounded(sighting.range_m, 2) + " m";
}

}  // namespace

VehicleWay FindVehicleWay(const VehicleSpec& vehicle, const TrackCourse& track) {
  const SpeedProfile profile(vehicle.motion, vehicle.start_s_m);
  VehicleWay way;
  way.start = PointAt(profile, 0.0);
  if (!vehicle.motion.profile.empty()) {
    const SpeedPoint& last = vehicle.motion.profile.back();
    way.profile_end = last.time_s ? PointAt(profile, *last.time_s) : ArrivalAt(profile, *last.s_m);
    if (way.profile_end) way.profile_end->speed_mps = last.speed_mps;
  }
  way.track_end = ArrivalAt(profile, profile.reverse() ? track.begin_s_m() : track.end_s_m());
  return way;
}

/// The scan of a table, whose columns may be in other units than it says: how fast it fires, and
/// how wide it looks.
/// @return Lines with remarks if that is beyond what any sensor does.
std::string TableText(const ScanPattern& pattern, std::uint32_t duration_ns) {
  constexpr double kFastest_hz = 100e6;
  constexpr double kNarrowest_deg = 2.0 * std::numbers::pi;  // A whole turn in rad.
  const auto num_firings = static_cast<double>(pattern.num_firings());
  // The turn but for the widest gap between azimuths.
  std::vector<double> azimuths_deg;
  double lowest_deg = 90.0;
  double highest_deg = -90.0;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const double x = pattern.direction_x[i];
    const double y = pattern.direction_y[i];
    azimuths_deg.push_back(DegFromRad(std::atan2(y, x)));
    const double elevation_deg =
        DegFromRad(std::atan2(double{pattern.direction_z[i]}, std::hypot(x, y)));
    lowest_deg = std::min(lowest_deg, elevation_deg);
    highest_deg = std::max(highest_deg, elevation_deg);
  }
  std::ranges::sort(azimuths_deg);
  double gap_deg = azimuths_deg.front() + 360.0 - azimuths_deg.back();
  for (std::size_t i = 1; i < azimuths_deg.size(); ++i) {
    gap_deg = std::max(gap_deg, azimuths_deg[i] - azimuths_deg[i - 1]);
  }
  const double width_deg = 360.0 - gap_deg;
  const double height_deg = highest_deg - lowest_deg;
  const double rate_hz = duration_ns == 0 ? 0.0 : (num_firings - 1.0) / SecondsFromNs(duration_ns);
  std::string text = ReportLine(
      "", "a table: " + (rate_hz == 0.0 ? "all at once" : ShortText(rate_hz) + " firings/s") +
              ", a field of view of " + ShortText(width_deg) + " x " + ShortText(height_deg) +
              " degrees");
  if (rate_hz > kFastest_hz) {
    text += ReportLine("", "remark: no sensor fires so fast: is time_us in microseconds?");
  }
  if (num_firings > 1.0 && std::max(width_deg, height_deg) <= kNarrowest_deg) {
    text += ReportLine("", "remark: no sensor looks so narrowly: are the angles in degrees?");
  }
  return text;
}

std::string SensorText(const LidarSpec& lidar, const ScanPattern& pattern) {
  const std::uint32_t duration_ns =
      *std::max_element(pattern.time_ns.begin(), pattern.time_ns.end());
  const auto num_firings = static_cast<double>(pattern.num_firings());
  const std::string name = lidar.name.empty() ? "" : lidar.name + ": ";
  const std::string begin =
      pattern.phase_ns == 0 ? ""
                            : ", the first at " + ShortText(SecondsFromNs(pattern.phase_ns)) + " s";
  return ReportLine("sensor", name + std::to_string(pattern.num_firings()) + " firings a frame (" +
                                  std::to_string(pattern.rows) + " rows x " +
                                  std::to_string(pattern.columns) + " columns), range " +
                                  NumberText(lidar.range_min_m) + " to " +
                                  NumberText(lidar.range_max_m) + " m") +
         ReportLine("", NumberText(pattern.rate_hz) + " frames/s" + begin + ", each fired within " +
                            ShortText(SecondsFromNs(duration_ns)) + " s; at most " +
                            Rounded(num_firings * pattern.rate_hz, 0) + " points/s") +
         (std::holds_alternative<FiringTableSpec>(lidar.scan.pattern)
              ? TableText(pattern, duration_ns)
              : "") +
         (pattern.repeats() ? "" : ReportLine("", "a figure that goes on from frame to frame"));
}

std::string CameraText(const CameraSpec& camera) {
  return ReportLine("camera", camera.name + ": " + NumberText(camera.width_px) + " x " +
                                  NumberText(camera.height_px) + " pixels, " +
                                  NumberText(camera.horizontal_fov_deg) + " degrees wide, " +
                                  (camera.rate_hz ? NumberText(*camera.rate_hz) + " images/s"
                                                  : "an image with each frame"));
}

std::string MotionSensorsText(const MotionSensorsSpec& motion_sensors) {
  std::string text;
  const auto add = [&](const char* kind, const auto& sensors) {
    for (const auto& sensor : sensors) {
      text +=
          ReportLine(text.empty() ? "motion" : "",
                     sensor.name + ": " + kind + ", " + NumberText(sensor.rate_hz) + " samples/s");
    }
  };
  add("IMU", motion_sensors.imus);
  add("GNSS receiver", motion_sensors.gnss);
  add("odometer", motion_sensors.odometers);
  return text;
}

std::string LineText(const Alignment& alignment, double gauge_mm, bool is_verbose) {
  const double radius_m = alignment.tightest_radius_m();
  const std::vector<SmoothedJump>& jumps = alignment.smoothed_jumps();
  std::string text = ReportLine(
      "line",
      Rounded(alignment.length_m(), 1) + " m, " +
          (std::isinf(radius_m) ? "straight" : "tightest radius " + Rounded(radius_m, 1) + " m") +
          (gauge_mm == kStandardGauge_mm ? "" : ", gauge " + NumberText(gauge_mm) + " mm"));
  if (radius_m < kLeastWidenedRadius_m) {
    text +=
        ReportLine("", "remark: norms have no clear space of curves of less than " +
                           NumberText(kLeastWidenedRadius_m) + " m; what stands in it is a guess");
  }
  if (jumps.empty()) return text;
  text += JumpsText(jumps, "curvature", "curvature jump");
  text += JumpsText(jumps, "gradient", "gradient step");
  if (!is_verbose) return text + ReportLine("", "(-v lists them)");
  for (const SmoothedJump& jump : jumps) {
    text += ReportLine("", "  " + jump.quantity + " at s " + NumberText(jump.s_m) + " m: from " +
                               ShortText(jump.before) + " to " + ShortText(jump.after) +
                               UnitOf(jump) + " over " + ShortText(jump.length_m) + " m");
  }
  return text;
}

std::string VehicleText(const std::string& track, const VehicleWay& way, const ScanSpec& scan) {
  const auto speed = [](const WayPoint& point) { return ShortText(point.speed_mps) + " m/s"; };
  std::string text =
      ReportLine("vehicle", "starts on track \"" + track + "\" at s " + Rounded(way.start.s_m, 2) +
                                " m with " + speed(way.start));
  // A profile that ends at the start adds nothing to the line about the start.
  if (way.profile_end && way.profile_end->time_s > 0.0) {
    const bool stops = way.profile_end->speed_mps == 0.0;
    text += ReportLine(
        "", "reaches the end of its speed profile " + WayPointText(*way.profile_end, scan) +
                (stops ? ", and stands" : ", and goes on with " + speed(*way.profile_end)));
  }
  return text + ReportLine("", way.track_end ? "reaches the end of its track " +
                                                   WayPointText(*way.track_end, scan)
                                             : "never reaches the end of its track");
}

std::string RideText(const VehicleSpec& vehicle) {
  const bool moves = std::ranges::any_of(
      vehicle.motion.profile, [](const SpeedPoint& point) { return point.speed_mps > 0.0; });
  const bool has_springs = !vehicle.consist.empty() || vehicle.pivot_distance_m > 0.0;
  if (!moves || !has_springs || vehicle.ride) return "";
  return ReportLine("", "remark: it has no ride (vehicle.ride): neither track nor brakes shake it");
}

std::string GaugeText(const std::vector<GaugeEntry>& entries) {
  std::string text;
  for (const GaugeEntry& entry : entries) {
    text += ReportLine(
        text.empty() ? "clearance" : "",
        Quoted(entry.name) +
            (entry.is_in_way ? " is in the way on track " : " is in the clear space of track ") +
            Quoted(entry.track) + " at s " + Rounded(entry.begin_s_m, 1) + " to " +
            Rounded(entry.end_s_m, 1) + " m, deepest at " + Rounded(entry.deepest_s_m, 1) +
            " m by " + Rounded(entry.depth_m, 2) + " m, from " + Rounded(entry.bottom_m, 2) +
            " to " + Rounded(entry.top_m, 2) + " m above top of rail");
  }
  return text;
}

std::string DetailText(const DetailAudit& audit, const LabelTable& labels) {
  if (audit.num_coarser_chunks == 0 && audit.levels.empty()) return "";
  const auto count = [](std::size_t value) { return std::to_string(value); };
  std::string text = ReportLine(
      "detail", "of surfaces, as traced: " + count(audit.traced_surfaces) + " of " +
                    count(audit.full_surfaces) + " triangles; " + count(audit.num_coarser_chunks) +
                    " of " + count(audit.num_chunks) + " chunks in coarser forms");
  if (audit.levels.empty()) return text;
  text += ReportLine("", "of plants, as traced: " + count(audit.traced_triangles) + " of " +
                             count(audit.full_triangles) + " triangles");
  for (const auto& [label, levels] : audit.levels) {
    std::string line;
    for (const auto& [level, of_level] : levels) {
      line += (line.empty() ? LabelName(labels, label) + ": " : ", ") +
              std::to_string(of_level.num_placements) +
              (level == 0 ? " in full detail" : " at level " + std::to_string(level)) + " from " +
              Rounded(of_level.nearest_m, 0) + " m";
    }
    text += ReportLine("", line);
  }
  return text;
}

std::string SceneText(const SceneAudit& audit) {
  std::string materials;
  for (const std::string& material : audit.materials) materials += " " + material;
  const auto count = [](std::size_t value) { return std::to_string(value); };
  return ReportLine("scene", "at frame 0: " + count(audit.num_chunks) + " chunks around chunk " +
                                 std::to_string(audit.home_chunk)) +
         ReportLine("", "surfaces: " + count(audit.ground_triangles) + " triangles") +
         ReportLine("", "things: " + count(audit.num_placements) + " placements of " +
                            count(audit.num_models) + " models: " + count(audit.placed_triangles) +
                            " triangles, " + count(audit.model_triangles) + " of them stored") +
         ReportLine("", "objects: " + count(audit.object_triangles) + " triangles") +
         ReportLine("", "materials:" + materials);
}

std::string ObjectsText(const World& world, const LabelTable& labels) {
  std::string text;
  for (const SceneObject& object : world.objects()) {
    const char* const motion = object.is_ego ? "own vehicle" : object.moves ? "moves" : "stands";
    text += ReportLine(text.empty() ? "objects" : "",
                       std::to_string(object.instance) + " " + ShownText(object.name) + ": " +
                           object.type + ", label " + LabelName(labels, object.label) + ", " +
                           std::to_string(object.model->num_triangles()) + " triangles, " + motion);
  }
  return text.empty() ? ReportLine("objects", "none") : text;
}

std::string ContactsText(const std::vector<ContactRun>& runs,
                         const World& world,
                         std::uint32_t last_frame) {
  constexpr double kShownStep_m = 1e-3;
  const auto name = [&](std::size_t object) { return Quoted(world.objects()[object].name); };
  const std::string frames = FramesText(0, last_frame);
  std::string text =
      ReportLine("contacts", runs.empty() ? "none in " + frames : "in " + frames + ":");
  for (const ContactRun& run : runs) {
    const ObjectContact& nearest = run.nearest;
    const std::string amount = Rounded(std::abs(nearest.gap_m), 3) + " m";
    text += ReportLine(
        "", name(nearest.one) + (nearest.is_overlap() ? " overlaps " : " touches ") +
                name(nearest.other) + " in " + FramesText(run.first_frame, run.last_frame) + ": " +
                (nearest.gap_m > -kShownStep_m / 2 ? amount + " apart" : amount + " deep") +
                " at frame " + std::to_string(run.nearest_frame));
  }
  return text;
}

std::string SurroundingsText(const SensorSurroundings& around,
                             const World& world,
                             const LabelTable& labels) {
  const Vector3& position_m = around.position_world;
  const auto sight = [&](const std::optional<SightedSurface>& sighting, const char* otherwise) {
    return sighting ? SightingText(*sighting, world, labels) : std::string(otherwise);
  };
  std::string text = ReportLine(
      "around", "at frame 0 the sensor is at world " + Rounded(position_m.x(), 2) + " " +
                    Rounded(position_m.y(), 2) + " " + Rounded(position_m.z(), 2) + " m");
  text += ReportLine("", "below it: " + sight(around.below, "nothing; is it under the ground?"));
  text += ReportLine("", "above it: " + sight(around.above, "nothing"));
  text += ReportLine("", "nearest: " + sight(around.nearest, "nothing"));
  if (around.inside != 0) {
    text += ReportLine("", "it is INSIDE the nearest object: every beam ends there");
  }
  return text;
}

std::string OwnHitsText(const OwnHits& hits) {
  if (hits.num_firings == 0) return "";
  const double percent =
      100.0 * static_cast<double>(hits.num_on_vehicle) / static_cast<double>(hits.num_firings);
  return ReportLine("", std::to_string(hits.num_on_vehicle) + " of its " +
                            std::to_string(hits.num_firings) + " firings, " + Rounded(percent, 1) +
                            " %, meet the vehicle itself");
}

std::string OutputText(const OutputSpec& output, const Vector3& sensor_world) {
  if (output.frame != OutputFrame::kWorld) return "";
  const Vector3 from_origin_m =
      sensor_world - Vector3(output.origin_m[0], output.origin_m[1], output.origin_m[2]);
  const auto largest_m = static_cast<float>(from_origin_m.cwiseAbs().maxCoeff());
  const float step_m =
      std::nextafter(largest_m, std::numeric_limits<float>::infinity()) - largest_m;
  constexpr float kFine_m = 1e-3F;
  return ReportLine("output", "world coordinates: float32 has steps of " +
                                  ShortText(1e3 * static_cast<double>(step_m)) +
                                  " mm where the sensor starts" +
                                  (step_m > kFine_m ? "; put output.origin_m near there" : ""));
}

}  // namespace railcast
