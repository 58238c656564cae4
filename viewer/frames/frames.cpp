#include "viewer/frames/frames.h"

namespace railcast {

void Frames::UseScenario(const ScenarioSpec& scenario) {
  info_.scenario = scenario;
  info_.labels = LabelTable(scenario.labels);
  info_.materials.clear();
  const MaterialLibrary library(scenario.materials);
  for (const Material& material : library.materials()) {
    info_.materials.push_back(material.name);
  }
}

}  // namespace railcast
