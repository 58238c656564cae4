#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "core/base/out_of_memory.h"
#include "core/rail/network/network_draft.h"
#include "core/rail/survey/surveyed_scene.h"
#include "core/scenario/build_faults.h"
#include "core/scenario/descriptions.h"
#include "core/scenario/json_reader.h"
#include "core/scenario/json_writer.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

/// The names of the elements of a list.
struct KnownNames {
  std::vector<std::string> names;
  bool are_known = true;  ///< Whether all of them could be read.
};

template <class T>
KnownNames KnownNamesOf(const std::string& list,
                        const std::vector<T>& values,
                        const UnknownPlaces& unknown) {
  KnownNames result;
  result.are_known = !values.empty();
  for (std::size_t i = 0; i < values.size(); ++i) {
    result.names.push_back(values[i].name);
    if (!unknown.IsKnown(list + "/" + std::to_string(i) + "/name")) result.are_known = false;
  }
  return result;
}

// Checks that each part of a mesh has one entry.
void CheckPartsDiffer(const std::string& list,
                      const std::vector<MeshPartSpec>& parts,
                      JsonSource& source) {
  for (std::size_t j = 1; j < parts.size(); ++j) {
    const std::string pointer = list + std::to_string(j) + "/of";
    const auto same =
        std::find_if(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(j),
                     [&](const MeshPartSpec& other) { return other.of == parts[j].of; });
    const auto index = same - parts.begin();
    if (index == static_cast<std::ptrdiff_t>(j) || !source.unknown().IsKnown(pointer)) continue;
    if (!source.unknown().IsKnown(list + std::to_string(index) + "/of")) continue;
    source.errors().Add({source.sources().Place(pointer),
                         "must differ from that of parts/" + std::to_string(index),
                         ValueText(parts[j].of)});
    source.unknown().Add(pointer);
  }
}

// Checks names in one section that must exist in another section.
void CheckReferences(const ScenarioSpec& spec, JsonSource& source) {
  UnknownPlaces& unknown = source.unknown();
  const auto check = [&](const std::string& object, const std::string& kind,
                         const std::string& name, const KnownNames& known) {
    const std::string pointer = object + "/" + kind;
    if (!unknown.IsKnown(pointer) || !known.are_known) return;
    if (std::find(known.names.begin(), known.names.end(), name) != known.names.end()) return;
    source.errors().Add({source.sources().Place(pointer),
                         Unknown(kind.starts_with("route/") ? "track" : kind, name, known.names),
                         ValueText(name)});
    unknown.Add(pointer);
  };
  KnownNames tracks = KnownNamesOf("/world/tracks", spec.world.tracks, unknown);
  for (const TrackSpec& track : TracksOfYards(spec.world)) tracks.names.push_back(track.name);
  if (!unknown.IsKnown("/world/yards")) tracks.are_known = false;
  const KnownNames labels = KnownNamesOf("/labels", spec.labels, unknown);
  const KnownNames materials = KnownNamesOf("/materials", spec.materials, unknown);
  const auto check_tracks = [&](const std::string& object, const std::string& track,
                                const std::vector<std::string>& route) {
    if (route.empty()) check(object, "track", track, tracks);
    for (std::size_t i = 0; i < route.size(); ++i) {
      check(object, "route/" + std::to_string(i), route[i], tracks);
    }
  };
  check_tracks("/vehicle", spec.vehicle.track, spec.vehicle.route);
  for (std::size_t i = 0; i < spec.world.trains.size(); ++i) {
    const TrainSpec& train = spec.world.trains[i];
    check_tracks("/world/trains/" + std::to_string(i), train.track, train.route);
  }
  const auto check_parts = [&](const std::string& place, const std::vector<MeshPartSpec>& parts) {
    for (std::size_t j = 0; j < parts.size(); ++j) {
      const std::string part_place = place + "/parts/" + std::to_string(j);
      if (parts[j].label) check(part_place, "label", *parts[j].label, labels);
      if (parts[j].material) check(part_place, "material", *parts[j].material, materials);
    }
    CheckPartsDiffer(place + "/parts/", parts, source);
  };
  for (std::size_t i = 0; i < spec.models.size(); ++i) {
    const ModelSpec& model = spec.models[i];
    const std::string place = "/models/" + std::to_string(i);
    check(place, "label", model.label, labels);
    if (model.material) check(place, "material", *model.material, materials);
    check_parts(place, model.parts);
  }
  for (std::size_t i = 0; i < spec.world.objects.size(); ++i) {
    const ObjectSpec& object = spec.world.objects[i];
    const std::string place = "/world/objects/" + std::to_string(i);
    check_tracks(place, object.track, object.route);
    if (object.label) check(place, "label", *object.label, labels);
    if (object.material) check(place, "material", *object.material, materials);
    check_parts(place, object.parts);
  }
}

void CheckNumberOfMaterials(const ScenarioSpec& spec, JsonSource& source) {
  constexpr std::size_t kMost = MaterialLibrary::kMostMaterials;
  const std::string pointer = "/materials";
  if (spec.materials.size() <= kMost) return;
  source.errors().Add({source.sources().Place(pointer),
                       "must have at most " + std::to_string(kMost) + " elements",
                       std::to_string(spec.materials.size())});
  source.unknown().Add(pointer);
}

// Adds the materials of a survey's surfaces, unless the scenario has them already.
void AddSurveyMaterials(ScenarioSpec& spec) {
  const auto materials = WorldExtras::Get().survey_materials;
  if (!spec.world.survey || materials == nullptr) return;
  for (Material& material : materials()) {
    if (std::ranges::find(spec.materials, material.name, &Material::name) == spec.materials.end()) {
      spec.materials.push_back(std::move(material));
    }
  }
}

// `open` opens the scenario's root.
template <class Open>
ScenarioSpec ReadRoot(const Open& open) {
  JsonSource source;
  ScenarioSpec spec;
  if (const std::optional<Node> root = open(source)) {
    ReadAs(source, *root, spec);
    AddSurveyMaterials(spec);
    CheckNumberOfMaterials(spec, source);
    CheckReferences(spec, source);
    spec.sources = source.sources();
    // The line of a recording is not known yet.
    if (spec.world.recording) source.unknown().Add("/world/alignment");
    if (!source.errors().empty()) AddBuildFaults(spec, source.unknown(), source.errors());
  }
  source.errors().ThrowIfAny();
  return spec;
}

}  // namespace

std::string ResolvedScenarioJson(const ScenarioSpec& spec) {
  ScenarioSpec copy = spec;  // Descriptions take mutable values because the reader fills them.
  Json json = {{"version", 1}};
  json.update(JsonWriter::Write(copy));
  return json.dump(2) + '\n';
}

ScenarioSpec ReadScenario(const std::filesystem::path& file) {
  return WithinMemory(
      [&] { return ReadingText(file); },
      [&] { return ReadRoot([&](JsonSource& source) { return source.Open(file); }); });
}

ScenarioSpec ReadScenarioText(const std::string& text, const std::filesystem::path& file) {
  const auto doing = [&] { return "reading a text of " + std::to_string(text.size()) + " bytes"; };
  return WithinMemory(doing, [&] {
    return ReadRoot([&](JsonSource& source) { return source.OpenAs(file, text); });
  });
}

LabelTable ReadLabelTable(const std::filesystem::path& file) {
  JsonSource source;
  LabelFile table;
  if (const auto root = source.Open(file)) ReadAs(source, *root, table);
  source.errors().ThrowIfAny();
  return LabelTable(std::move(table.labels));
}

}  // namespace railcast
