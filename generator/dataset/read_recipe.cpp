#include <algorithm>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "generator/dataset/describe_recipe.h"
#include "generator/dataset/json_place.h"
#include "generator/dataset/recipe.h"

namespace railcast {
namespace {

// Calls `read` with each pointer of an object whose keys are JSON pointers, and with its value.
template <class Read>
void ReadPointed(JsonSource& source, const Node& node, const Read& read) {
  if (!node.json->is_object()) {
    return source.Fault(node, "must be an object with JSON pointers as its keys");
  }
  for (const auto& [key, value] : node.json->items()) {
    const Node child = node.Child(key, value);
    if (const auto fault = PointerFault(key)) source.FaultWithoutValue(child, *fault);
    read(key, child);
  }
}

}  // namespace

void ReadValue(JsonSource& source, const Node& node, JsonList& list, Anything) {
  if (!CheckListOfAtLeast(source, node, NonEmptyList())) return;
  for (const Json& value : *node.json) list.values.push_back(value);
}

void ReadValue(JsonSource& source, const Node& node, ChoiceWeights& weights, Anything) {
  if (!CheckListOfAtLeast(source, node, NonEmptyList())) return;
  const std::size_t num_faults = source.errors().size();
  double sum = 0.0;
  for (std::size_t i = 0; i < node.json->size(); ++i) {
    double weight = 0.0;
    ReadValue(source, node.Child(i), weight, Within(0, 1e9));
    sum += weight;
    weights.values.push_back(weight);
  }
  if (source.errors().size() > num_faults) return;
  if (sum <= 0.0) source.Fault(node, "must have a weight > 0");
}

void ReadValue(JsonSource& source, const Node& node, ObjectTemplate& object, Anything) {
  if (!node.json->is_object()) return source.Fault(node, "must be an object");
  object.json = *node.json;
  for (const char* const key : {"name", "s_m", "x_m", "y_m", "longitude_deg", "latitude_deg"}) {
    if (!node.json->contains(key)) continue;
    source.FaultWithoutValue(node.Child(key), "must not be given: it is drawn");
  }
}

void ReadValue(JsonSource& source, const Node& node, SetList& list, Anything) {
  ReadPointed(source, node, [&](const std::string& pointer, const Node& value) {
    list.values.push_back({pointer, *value.json});
  });
}

void ReadValue(JsonSource& source, const Node& node, DrawList& list, Anything) {
  ReadPointed(source, node, [&](const std::string& pointer, const Node& value) {
    Distribution distribution;
    ReadValue(source, value, distribution, Anything{});
    list.draws.push_back({pointer, std::move(distribution)});
  });
}

Recipe ReadRecipe(const std::filesystem::path& file) {
  JsonSource source;
  Recipe recipe;
  if (const auto root = source.Open(file)) {
    if (auto list = source.PlainMembers(*root)) {
      ReadMembers(source, *root, std::move(*list), recipe);
    }
  }
  source.errors().ThrowIfAny();
  recipe.file = file;
  CheckRecipe(recipe);
  return recipe;
}

}  // namespace railcast
