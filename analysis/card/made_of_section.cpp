#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "analysis/card/dataset_card.h"
#include "analysis/stats/dataset_overview.h"
#include "core/base/text.h"
#include "core/io/recording/sequence_summary.h"
#include "core/io/run/dataset_files.h"
#include "core/io/strict_json.h"
#include "core/recipe/recipe.h"

namespace railcast {
namespace {

// Words as they are, and lists of words and numbers without brackets: "0, 40, 80".
std::string ValueText(const StrictOrderedJson& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const auto& item : value) {
    if (item.is_structured()) return value.dump();
    text += (text.empty() ? "" : ", ") + ValueText(item);
  }
  return text;
}

/// A value for a scenario, a distribution, or an object to place: "uniform, min 5, max 25".
std::string DrawText(const StrictOrderedJson& typed) {
  if (!typed.is_object() || !typed.contains("type")) return ValueText(typed);
  std::string text = ValueText(typed["type"]);
  for (const auto& [key, value] : typed.items()) {
    if (key != "type") text += ", " + key + " " + ValueText(value);
  }
  return text;
}

void AddRecipeRows(const StrictOrderedJson& value, const std::string& path, Table& table);

// An entry of a list, such as a group or a base, by its name or its file.
void AddEntryRows(const StrictOrderedJson& entry, const std::string& path, Table& table) {
  StrictOrderedJson rest = entry;
  const char* const title = entry.contains("name") ? "name" : "file";
  const std::string name = ValueText(entry.at(title));
  rest.erase(title);
  if (rest.empty()) {
    table.rows.push_back({path, name});
  } else {
    AddRecipeRows(rest, path + ": " + name, table);
  }
}

// A row for each value of the recipe.
void AddRecipeRows(const StrictOrderedJson& value, const std::string& path, Table& table) {
  if (value.is_object() && !value.contains("type")) {
    for (const auto& [key, member] : value.items()) {
      const std::string at = path.empty() ? key : path + ": " + key;
      // What a JSON pointer leads to is part of a scenario.
      if (key.starts_with('/')) {
        table.rows.push_back({at, DrawText(member)});
      } else {
        AddRecipeRows(member, at, table);
      }
    }
  } else if (value.is_array() && !value.empty() && value.front().is_object()) {
    for (const auto& entry : value) AddEntryRows(entry, path, table);
  } else {
    table.rows.push_back({path, DrawText(value)});
  }
}

Table RecipeTable(const StrictOrderedJson& recipe) {
  Table table = {.key = "recipe",
                 .title = "What the recipe says",
                 .note = "docs/dataset.md of railcast has the meanings of the keys.",
                 .columns = {{"key", "Key", ""}, {"value", "Value", ""}},
                 .is_open = true};
  StrictOrderedJson shown = recipe;
  shown.erase("$schema");
  shown.erase("version");
  AddRecipeRows(shown, "", table);
  return table;
}

// Whether bases are plans for recordings, which choose format and fields.
bool HasRecordings(const StrictOrderedJson& recipe) {
  for (const auto& base : recipe.at("bases")) {
    if (base.contains("recordings")) return true;
  }
  return false;
}

std::string CommandText(const StrictOrderedJson& recipe, const StrictJson& identity) {
  const auto text = [&](const char* key) { return identity.at(key).get<std::string>(); };
  std::string command = "railcast-generate dataset RECIPE --out DIR";
  const bool has_recordings = HasRecordings(recipe);
  if (!has_recordings || text("format") != "same") command += " --format " + text("format");
  if (!has_recordings) command += " --fields " + text("fields") + " --isa " + text("isa");
  if (!has_recordings && identity.at("merged").get<bool>()) command += " --merged";
  return command + ", with the recipe where its names of files lead to the bases";
}

Table OriginTable(const StrictOrderedJson& recipe, const StrictJson& identity) {
  Table table = {.key = "made_of",
                 .title = "What the bytes depend on",
                 .columns = {{"what", "What", ""}, {"value", "Value", ""}},
                 .is_open = true};
  const auto add = [&](const char* what, std::string value) {
    table.rows.push_back({std::string(what), std::move(value)});
  };
  const auto text = [&](const char* key) { return identity.at(key).get<std::string>(); };
  add("Seed", NumberText(recipe.value("seed", Recipe{}.seed)));
  add("Recipe", "recipe.json in the data set, hash " + text("recipe_xxh3"));
  add("Made by", "railcast " + text("version") + ", Embree " + text("embree") + ", " + text("isa"));
  add("To make it again", CommandText(recipe, identity));
  return table;
}

}  // namespace

Section MadeOfSection(const std::filesystem::path& dataset) {
  const std::string recipe = ReadDatasetFile(dataset, kRecipeFile);
  const std::string identity = ReadDatasetFile(dataset, kDatasetFile);
  return ReadRecordedJson<StrictOrderedJson>(
      recipe, ShownPath(dataset / kRecipeFile), [&](const StrictOrderedJson& of_recipe) {
        return ReadRecordedJson<StrictJson>(
            identity, ShownPath(dataset / kDatasetFile), [&](const StrictJson& of_run) {
              return Section{.key = "recipe",
                             .title = "Recipe",
                             .tables = {RecipeTable(of_recipe), OriginTable(of_recipe, of_run)}};
            });
      });
}

}  // namespace railcast
