#include <algorithm>
#include <iomanip>
#include <iostream>
#include <string>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/rail/rail_world.h"
#include "core/scan/scan_pattern.h"
#include "core/scenario/scenario.h"
#include "generator/commands.h"
#include "generator/scene_audit.h"

namespace railcast {
namespace {

void PrintRates(const ScanPattern& pattern) {
  const auto num_firings = static_cast<double>(pattern.num_firings());
  const std::uint32_t duration_ns =
      *std::max_element(pattern.time_ns.begin(), pattern.time_ns.end());
  std::cout << "rates\n  firings per frame    " << pattern.num_firings() << " (" << pattern.rows
            << " rows x " << pattern.columns << " columns)\n  frame period         "
            << 1.0 / pattern.rate_hz << " s\n  first to last firing " << SecondsFromNs(duration_ns)
            << " s\n  points per second    at most " << num_firings * pattern.rate_hz << "\n";
}

void PrintAudit(const SceneAudit& audit) {
  std::cout << "scene of frame 0\n  chunks               " << audit.num_chunks << " around chunk "
            << audit.home_chunk << "\n  surfaces             " << audit.ground_triangles
            << " triangles\n  things               " << audit.num_placements << " places for "
            << audit.num_models << " models: " << audit.placed_triangles << " triangles, "
            << audit.model_triangles << " of them stored\n  objects              "
            << audit.object_triangles << " triangles\n  materials           ";
  for (const std::string& material : audit.materials) std::cout << " " << material;
  std::cout << "\n";
}

void PrintObjects(const World& world, const LabelTable& labels) {
  std::cout << "objects\n";
  for (const SceneObject& object : world.objects()) {
    const Label* label = labels.Find(object.label);
    std::cout << "  " << object.instance << " " << object.name << ": " << object.type << ", label "
              << (label == nullptr ? std::to_string(object.label) : label->name) << ", "
              << object.model->num_triangles() << " triangles, "
              << (object.is_ego  ? "own vehicle"
                  : object.moves ? "moves"
                                 : "stands")
              << "\n";
  }
}

void PrintJumps(const Alignment& alignment) {
  std::cout << "line: " << alignment.length_m() << " m, tightest radius "
            << alignment.tightest_radius_m() << " m, " << alignment.smoothed_jumps().size()
            << " jumps smoothed\n";
  for (const SmoothedJump& jump : alignment.smoothed_jumps()) {
    const char* unit = jump.quantity == "gradient" ? " permil" : " 1/m";
    std::cout << "  " << jump.quantity << " at s " << jump.s_m << " m: from " << jump.before
              << " to " << jump.after << unit << " over " << jump.length_m << " m\n";
  }
}

}  // namespace

int CheckCommand(const std::filesystem::path& file) {
  ErrorList faults;
  for (const std::string& fault : CheckScenario(file)) faults.Add(fault);
  faults.ThrowIfAny();
  const ScenarioSpec scenario = ReadScenario(file);
  const ScanPattern pattern = BuildScanPattern(scenario.lidar.scan);
  const auto world = MakeWorld(scenario);
  const SceneAudit audit = AuditScene(*world, MaterialLibrary(scenario.materials),
                                      pattern.StampNs(0), scenario.lidar.range_max_m);
  std::cout << std::setprecision(10) << ResolvedScenarioJson(scenario) << "\n";
  PrintJumps(world->alignment());
  PrintRates(pattern);
  PrintAudit(audit);
  PrintObjects(*world, LabelTable(scenario.labels));
  if (scenario.camera) std::cout << "camera: read and kept for later; nothing uses it yet\n";
  return kExitSuccess;
}

}  // namespace railcast
