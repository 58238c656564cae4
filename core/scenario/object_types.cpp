#include "core/scenario/object_types.h"

#include <memory>
#include <utility>

#include "core/base/error.h"
#include "core/base/shipped_files.h"
#include "core/scenario/descriptions.h"
#include "core/scenario/json_reader.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

const std::vector<ObjectType>& TypesOfShapes() {
  static const std::vector<ObjectType> types = {ObjectType::kBox, ObjectType::kPole,
                                                ObjectType::kPerson, ObjectType::kMesh};
  return types;
}

std::vector<ObjectType> ReadShippedTypes() {
  const std::string name = std::string(kShippedPrefix) + "models.json";
  const auto text = ShippedFile(name);
  Check(text.has_value(), "the library holds a table of models");
  JsonSource source;
  ModelFile table;
  if (const auto root = source.OpenShipped(std::string(*text), name)) {
    ReadAs(source, *root, table);
  }
  source.errors().ThrowIfAny();
  std::vector<ObjectType> types;
  for (ModelSpec& model : table.models) {
    types.push_back({.model = std::make_shared<const ModelSpec>(std::move(model))});
  }
  return types;
}

}  // namespace

const std::vector<ObjectType>& ShippedTypes() {
  static const std::vector<ObjectType> types = ReadShippedTypes();
  return types;
}

void ObjectTypes::Add(const ModelSpec& model, std::size_t entry) {
  own_.push_back({.model = std::make_shared<const ModelSpec>(model), .entry = entry});
}

void ObjectTypes::Add(const std::vector<ModelSpec>& models) {
  for (std::size_t i = 0; i < models.size(); ++i) Add(models[i], i);
}

std::optional<ObjectType> ObjectTypes::Find(std::string_view name) const {
  for (const auto* const types : {&TypesOfShapes(), &ShippedTypes(), &own_}) {
    for (const ObjectType& type : *types) {
      if (NameOf(type) == name) return type;
    }
  }
  return std::nullopt;
}

std::vector<std::string> ObjectTypes::Names() const {
  std::vector<std::string> names;
  for (const auto* const types : {&TypesOfShapes(), &ShippedTypes(), &own_}) {
    for (const ObjectType& type : *types) names.emplace_back(NameOf(type));
  }
  return names;
}

ObjectType TypeNamed(std::string_view name) {
  const ObjectTypes types;
  if (auto type = types.Find(name)) return std::move(*type);
  throw InputError({{"type", Unknown("type", name, types.Names()), ""}});
}

}  // namespace railcast
