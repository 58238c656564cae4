#include <algorithm>
#include <utility>

#include "core/scenario/describe_scenario.h"
#include "core/scenario/json_reader.h"
#include "core/scenario/scenario.h"

namespace railcast {
namespace {

template <class T>
std::vector<std::string> NamesOf(const std::vector<T>& values) {
  std::vector<std::string> names;
  names.reserve(values.size());
  for (const T& value : values) names.push_back(value.name);
  return names;
}

// Names in one section that another section must hold.
void CheckReferences(const ScenarioSpec& spec, const ScenarioSources& sources, ErrorList& errors) {
  const auto check = [&](const std::string& object, const std::string& kind,
                         const std::string& name, const std::vector<std::string>& known) {
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    errors.Add(sources.Place(object + "/" + kind) + ": " + Unknown(kind, name, known) + " (got \"" +
               name + "\")");
  };
  const std::vector<std::string> tracks = NamesOf(spec.world.tracks);
  const std::vector<std::string> labels = NamesOf(spec.labels);
  const std::vector<std::string> materials = NamesOf(spec.materials);
  check("/vehicle", "track", spec.vehicle.track, tracks);
  for (std::size_t i = 0; i < spec.world.objects.size(); ++i) {
    const ObjectSpec& object = spec.world.objects[i];
    const std::string place = "/world/objects/" + std::to_string(i);
    check(place, "track", object.track, tracks);
    if (object.label) check(place, "label", *object.label, labels);
    if (object.material) check(place, "material", *object.material, materials);
  }
}

}  // namespace

ScenarioSpec ReadScenario(const std::filesystem::path& file) {
  JsonSource source;
  ScenarioSpec spec;
  if (const auto root = source.Open(file)) {
    ReadValue(source, *root, spec, Anything{});
    if (source.errors().empty()) CheckReferences(spec, source.sources(), source.errors());
  }
  source.errors().ThrowIfAny();
  spec.sources = std::move(source.sources());
  return spec;
}

LabelTable ReadLabelTable(const std::filesystem::path& file) {
  JsonSource source;
  LabelFile table;
  if (const auto root = source.Open(file)) ReadValue(source, *root, table, Anything{});
  source.errors().ThrowIfAny();
  return LabelTable(std::move(table.labels));
}

}  // namespace railcast
