#include <cmath>
#include <iomanip>
#include <iostream>
#include <string>

#include "core/base/error.h"
#include "core/scenario/effects.h"
#include "core/scenario/scenario.h"
#include "generator/chosen_fidelity.h"
#include "generator/commands.h"

namespace railcast {
namespace {

std::string LabelName(const LabelTable& labels, std::uint32_t id) {
  const Label* label = labels.Find(id);
  return label == nullptr ? std::to_string(id) : label->name;
}

// Absence reads better as a dash than as nan.
void PrintValue(float value, int width) {
  std::cout << std::setw(width);
  if (std::isnan(value)) {
    std::cout << "-";
  } else {
    std::cout << static_cast<double>(value);
  }
}

void PrintSteps(const std::vector<FiringStory::Step>& steps) {
  std::cout << std::left << std::setw(18) << "after" << std::setw(17) << "outcome" << std::right
            << std::setw(14) << "true_range_m" << std::setw(15) << "cos_incidence" << std::setw(12)
            << "intensity" << std::setw(13) << "power_ratio" << std::setw(12) << "range_m\n";
  for (const FiringStory::Step& step : steps) {
    std::cout << std::left << std::setw(18) << step.effect << std::setw(17)
              << OutcomeName(step.outcome) << std::right;
    PrintValue(step.true_range_m, 14);
    PrintValue(step.cos_incidence, 15);
    PrintValue(step.intensity, 12);
    PrintValue(step.power_ratio, 13);
    PrintValue(step.range_m, 11);
    std::cout << "\n";
  }
}

void PrintEchoes(const std::vector<FiringStory::Echo>& echoes, const LabelTable& labels) {
  std::cout << std::left << std::setw(18) << "echo" << std::setw(17) << "outcome" << std::right
            << std::setw(14) << "true_range_m" << std::setw(15) << "share" << std::setw(25)
            << "power_ratio" << std::setw(11) << "range_m"
            << "  slot\n";
  for (const FiringStory::Echo& echo : echoes) {
    std::cout << std::left << std::setw(18)
              << (echo.label == 0 ? "nothing" : LabelName(labels, echo.label)) << std::setw(17)
              << OutcomeName(echo.outcome) << std::right;
    PrintValue(echo.true_range_m, 14);
    PrintValue(echo.footprint_share, 15);
    PrintValue(echo.power_ratio, 25);
    PrintValue(echo.range_m, 11);
    std::cout << "  " << (echo.slot ? std::to_string(*echo.slot) : "none") << "\n";
  }
}

}  // namespace

int TraceCommand(const TraceOptions& options) {
  const ScenarioSpec scenario = PickSensor(ReadScenario(options.scenario), options.sensor);
  const auto simulator = MakeSimulator(scenario, 1);
  const std::size_t num_firings = simulator->pattern().num_firings();
  if (options.firing >= num_firings) {
    throw InputError("--firing: must be < " + std::to_string(num_firings) +
                     ", the firings of a frame (got " + std::to_string(options.firing) + ")");
  }
  if (scenario.fidelity == kAutoFidelity) UseChosenFidelity(*simulator, scenario);
  const FiringStory story = simulator->Explain(options.frame, options.firing);
  const MaterialLibrary materials(scenario.materials);
  std::cout << "frame " << options.frame << " firing " << story.firing << " at " << story.time_ns
            << " ns, slot " << story.slot << "\n"
            << "from world " << std::fixed << std::setprecision(3) << story.origin_world.transpose()
            << " along sensor " << std::setprecision(6) << story.direction_sensor.transpose()
            << "\n"
            << std::defaultfloat;
  if (story.label == 0) {
    std::cout << "hits nothing\n";
  } else {
    std::cout << "hits " << LabelName(LabelTable(scenario.labels), story.label) << ", instance "
              << story.instance << ", material " << materials.materials()[story.material].name
              << " (reflectivity " << static_cast<double>(story.reflectivity) << ")\n";
  }
  PrintSteps(story.steps);
  if (story.echoes.size() > 1) PrintEchoes(story.echoes, LabelTable(scenario.labels));
  return kExitSuccess;
}

}  // namespace railcast
