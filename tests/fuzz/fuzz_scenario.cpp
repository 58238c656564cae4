#include <charconv>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/rail/world/world_draft.h"
#include "core/scenario/sensors.h"
#include "railcast/lidar.h"
#include "railcast/scenario.h"
#include "tests/fuzz/fault_lines.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/input_files.h"

namespace railcast {
namespace {

double LengthOf(const AlignmentSectionsSpec& course) {
  return course.length_m;
}

double LengthOf(const AlignmentElementsSpec& course) {
  return std::accumulate(
      course.elements.begin(), course.elements.end(), 0.0,
      [](double sum_m, const AlignmentElement& element) { return sum_m + element.length_m; });
}

double LengthOf(const AlignmentSplineSpec& course) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < course.points_m.size(); ++i) {
    length_m += std::hypot(course.points_m[i][0] - course.points_m[i - 1][0],
                           course.points_m[i][1] - course.points_m[i - 1][1]);
  }
  return length_m;
}

double NumFirings(const RasterSpec& pattern) {
  return pattern.horizontal_fov_deg * pattern.vertical_fov_deg /
         (pattern.angular_resolution_deg * pattern.angular_resolution_deg);
}

double NumFirings(const SpinningSpec& pattern) {
  return static_cast<double>(pattern.channels.size()) * pattern.columns;
}
double NumFirings(const RisleySpec& pattern) {
  return static_cast<double>(pattern.channels.size()) * pattern.columns;
}

double NumFirings(const FiringTableSpec& /*in_the_input*/) {
  return 0.0;
}

bool IsShort(const AlignmentSpec& alignment) {
  constexpr double kLongest_m = 20e3;
  return std::visit([](const auto& course) { return LengthOf(course); }, alignment.course) <=
         kLongest_m;
}

bool IsSparse(const ScanSpec& scan) {
  constexpr double kMostFirings = 3000.0;
  return std::visit([](const auto& pattern) { return NumFirings(pattern); }, scan.pattern) <=
         kMostFirings;
}

void CheckModel(const Model& model) {
  for (const Part& part : model.parts) {
    for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
      Check(vertex.allFinite(), "a vertex is somewhere");
    }
    for (const auto& triangle : part.mesh.triangles) {
      for (const std::uint32_t corner : triangle) {
        Check(corner < part.mesh.vertices.size(), "a corner is a vertex");
      }
    }
  }
}

void CheckPath(const TrackPath& path, const Alignment& alignment) {
  for (const std::int64_t time_ns : {std::int64_t{0}, std::int64_t{1'000'000'000}}) {
    Check(path.WorldFromObject(alignment, time_ns).matrix().allFinite(), "a thing is somewhere");
  }
}

// Checks the line and objects of the world, without its chunks.
void CheckDraft(const ScenarioSpec& spec) {
  WorldFaults faults;
  const LabelTable labels(spec.labels);
  const MaterialLibrary materials(spec.materials);
  const WorldDraft draft = DraftWorld({spec.world, spec.vehicle, labels, materials}, faults);
  for (const std::string& fault : faults.errors.lines()) CheckFaultLines(fault);
  if (!faults.errors.empty()) return;
  Check(draft.alignment && draft.surfaces && draft.vehicle_path && draft.catenary_plan,
        "a world without faults is whole");
  CheckPath(*draft.vehicle_path, *draft.alignment);
  for (const ObjectPath& path : draft.object_paths) {
    if (path.track) CheckPath(*path.track, *draft.alignment);
  }
  for (const SceneObject& object : draft.objects) CheckModel(*object.model);
}

void CheckPattern(const ScanSpec& scan) {
  try {
    const ScanPattern pattern = BuildScanPattern(scan);
    Check(pattern.num_firings() > 0, "a pattern has firings");
    for (std::uint32_t firing = 0; firing < pattern.num_firings(); ++firing) {
      Check(pattern.row[firing] < pattern.rows && pattern.column[firing] < pattern.columns,
            "a firing has a place");
    }
    const ScanPattern later = PatternOfFrame(pattern, 12'345);
    for (std::uint32_t firing = 0; firing < later.num_firings(); ++firing) {
      Check(std::isfinite(later.direction_x[firing] + later.direction_y[firing] +
                          later.direction_z[firing]),
            "a firing goes somewhere in every frame");
    }
  } catch (const InputError& error) {
    CheckFaultLines(error.what());
  }
}

void CheckFrame(const Frame& frame) {
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    Check(HasPoint(frame.outcome[slot]) == std::isfinite(frame.range_m[slot]),
          "a point has a range");
    Check(!HasPoint(frame.outcome[slot]) ||
              std::isfinite(frame.x[slot] + frame.y[slot] + frame.z[slot]),
          "a point is somewhere");
  }
}

// A scenario without faults must run.
void Run(const ScenarioSpec& spec) {
  for (const auto& simulator : MakeSimulators(spec, 1)) {
    Frame frame;
    for (const std::uint32_t index : {0U, 10U}) {
      simulator->Scan(index, frame);
      CheckFrame(frame);
    }
  }
}

// Whether `is_slow` holds for one of the numbers between `key` and the end of its object.
template <typename IsSlow>
bool HasNumber(std::string_view input, std::string_view key, const IsSlow& is_slow) {
  for (std::size_t at = input.find(key); at != std::string_view::npos; at = input.find(key)) {
    input.remove_prefix(at + key.size());
    std::string_view rest = input.substr(0, input.find('}'));
    for (std::size_t begin = rest.find_first_of("0123456789"); begin != std::string_view::npos;
         begin = rest.find_first_of("0123456789")) {
      rest.remove_prefix(begin);
      double number = 0.0;
      const char* const end = std::from_chars(rest.data(), rest.data() + rest.size(), number).ptr;
      if (is_slow(number)) return true;
      rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    }
  }
  return false;
}

// Splines of 10 000 km and 16 million firings are allowed, but take minutes to check, and they are
// also built tentatively if the scenario has a fault.
bool IsSlow(std::string_view input) {
  return HasNumber(input, "spline", [](double number) { return number > 20e3; }) ||
         HasNumber(input, "points_m", [](double number) { return number > 20e3; }) ||
         HasNumber(input, "angular_resolution_deg", [](double number) { return number < 0.1; }) ||
         HasNumber(input, "columns", [](double number) { return number > 3000.0; });
}

// Running takes seconds, so only a few inputs are run, always the same ones.
bool IsRun(std::string_view input) {
  constexpr std::size_t kOneOf = 256;
  return std::hash<std::string_view>()(input) % kOneOf == 0;
}

void CheckEffects(const ScenarioSpec& spec) {
  try {
    static_cast<void>(EffectsOf(spec));
  } catch (const InputError&) {
    Check(false, "effects that do not go together are refused where they are read");
  }
}

void ReadInput(std::string_view input) {
  const InputFiles files(input);
  try {
    const ScenarioSpec spec = ReadScenario(InputFiles::first());
    const std::string resolved = ResolvedScenarioJson(spec);
    const ScenarioSpec again = ReadScenario(InputFiles::Write("resolved.json", resolved));
    Check(again == spec, "what is written reads the same");
    Check(ResolvedScenarioJson(again) == resolved, "and is written the same");
    CheckEffects(spec);
    bool is_small = IsShort(spec.world.alignment);
    if (is_small) CheckDraft(spec);
    for (const SensorPlace& sensor : SensorsOf(spec)) {
      if (!IsSparse(sensor.lidar.scan)) is_small = false;
      if (IsSparse(sensor.lidar.scan)) CheckPattern(sensor.lidar.scan);
    }
    if (!is_small || !IsRun(input)) return;
    const std::vector<std::string> faults = CheckScenario(InputFiles::first());
    for (const std::string& fault : faults) CheckFaultLines(fault);
    if (faults.empty()) Run(spec);
  } catch (const InputError& error) {
    CheckFaultLines(error.what());
  }
}

}  // namespace
}  // namespace railcast

/// a scenario and the files that it names, separated as InputFiles
/// describes.
RAILCAST_FUZZ_TARGET(scenario) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  if (!railcast::IsSlow(input)) railcast::ReadInput(input);
  return 0;
}
