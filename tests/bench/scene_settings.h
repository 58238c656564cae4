#pragma once

#include <string>
#include <vector>

#include "railcast/scenario.h"

namespace railcast {

/// One of the settings of a scene that the published evaluation (Vir2Rail, Table 2) compares.
struct SceneSetting {
  std::string name;
  ScenarioSpec scenario;
};

/// The settings, the base first: the scenario with trees, contact line and its own objects, without
/// grass and camera. Each other setting changes one thing of the base.
///
/// "10x objects" and "100x objects" keep the objects and add 9 and 99 copies of each, which stand
/// beside it on the side away from the vehicle's track, every 3.75 m in 20 rows, and further on
/// every 66 m. The camera is that of scenarios/published/Camera.json.
[[nodiscard]] std::vector<SceneSetting> SceneSettings(const ScenarioSpec& scenario);

}  // namespace railcast
