#include "tests/core/scenario/scenario_schema.h"

#include "core/scenario/descriptions.h"
#include "tests/core/scenario/schema_writer.h"

namespace railcast {
namespace {

template <class T>
std::string SchemaOfFile(const std::string& title) {
  T defaults{};
  SchemaWriter writer;
  Describe(writer, defaults);
  return writer.File(title).dump(2) + '\n';
}

template <class T>
std::string SchemaOfLibrary(const std::string& key, const std::string& title) {
  std::vector<T> values;
  SchemaWriter writer;
  writer.Required(key, values, "In no particular order.", NonEmptyList());
  return writer.File(title).dump(2) + '\n';
}

}  // namespace

std::map<std::string, std::string> ScenarioSchemas() {
  return {
      {"scenario.schema.json", SchemaOfFile<ScenarioSpec>("railcast scenario")},
      {"lidar.schema.json", SchemaOfFile<LidarSpec>("railcast lidar section")},
      {"weather.schema.json", SchemaOfFile<WeatherSpec>("railcast weather section")},
      {"interfaces.schema.json", SchemaOfFile<InterfacesSpec>("railcast interfaces section")},
      {"camera.schema.json", SchemaOfFile<CameraSpec>("railcast camera section")},
      {"motion_sensors.schema.json",
       SchemaOfFile<MotionSensorsSpec>("railcast motion_sensors section")},
      {"world.schema.json", SchemaOfFile<WorldSpec>("railcast world section")},
      {"alignment.schema.json", SchemaOfFile<AlignmentSpec>("railcast alignment section")},
      {"vehicle.schema.json", SchemaOfFile<VehicleSpec>("railcast vehicle section")},
      {"materials.schema.json", SchemaOfLibrary<Material>("materials", "railcast materials")},
      {"models.schema.json", SchemaOfLibrary<ModelSpec>("models", "railcast table of models")},
      {"labels.schema.json", SchemaOfLibrary<Label>("labels", "railcast label table")},
  };
}

}  // namespace railcast
