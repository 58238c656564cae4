#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/recipe/describe_recipe.h"
#include "core/recipe/json_place.h"
#include "core/recipe/recipe.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

// Makes a base of each recording of a plan. They are read once, here.
void ReadRecordings(const RecordingReader& read_recording, Recipe& recipe) {
  ErrorList errors;
  std::vector<RecipeBase> bases;
  for (std::size_t i = 0; i < recipe.bases.size(); ++i) {
    RecipeBase& base = recipe.bases[i];
    base.pointer = "/bases/" + std::to_string(i);
    const std::vector<std::string> files = std::exchange(base.recordings.files, {});
    if (files.empty()) bases.push_back(base);
    if (!files.empty() && !read_recording) {
      errors.Add({ShownPath(recipe.file.lexically_normal()) + ": " + base.pointer + "/recordings",
                  "must be left out: only data sets are made of recordings", ""});
      continue;
    }
    for (std::size_t k = 0; k < files.size(); ++k) {
      RecipeBase& one = bases.emplace_back(base);
      one.weight = base.weight / static_cast<double>(files.size());
      one.recording_pointer = base.pointer + "/recordings/" + std::to_string(k);
      const auto run = Attempt("", errors, [&] {
        return read_recording(fs::path(base.file).lexically_proximate(fs::current_path()),
                              files[k]);
      });
      if (run) one.run = *run;
    }
  }
  errors.ThrowIfAny();
  recipe.bases = std::move(bases);
}

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
  for (const char* const key :
       {"name", "s_m", "x_m", "y_m", "longitude_deg", "latitude_deg", "frame"}) {
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

void ReadValue(JsonSource& source, const Node& node, RecordingList& list, Anything) {
  std::vector<std::string> names;
  ReadValue(source, node, names, NonEmptyString());
  if (node.json->is_array() && names.empty()) source.Fault(node, "must have a recording");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const fs::path file = (node.file->absolute.parent_path() / names[i]).lexically_normal();
    std::error_code error;
    if (!names[i].empty() && !fs::exists(file, error)) {
      source.Fault(node.Child(i), "must be an existing file or directory");
    }
    list.files.push_back(file.string());
  }
}

Recipe ReadRecipe(const std::filesystem::path& file, const RecordingReader& read_recording) {
  JsonSource source;
  Recipe recipe;
  if (const auto root = source.Open(file)) {
    if (auto list = source.PlainMembers(*root)) {
      ReadMembers(source, *root, std::move(*list), recipe);
    }
  }
  source.errors().ThrowIfAny();
  recipe.file = file;
  ReadRecordings(read_recording, recipe);
  CheckRecipe(recipe);
  return recipe;
}

}  // namespace railcast
