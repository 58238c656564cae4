#include <cstdint>
#include <utility>

#include "analysis/extras/card/dataset_card.h"
#include "analysis/extras/card/dataset_overview.h"
#include "analysis/report/words.h"
#include "core/base/text.h"
#include "core/extras/recipe/dataset_record.h"
#include "core/extras/recipe/recipe.h"
#include "core/io/record/read_record.h"
#include "core/io/run/dataset_files.h"

namespace railcast {
namespace {

// Words as they are, and lists of words and numbers without brackets: "0, 40, 80".
std::string ValueText(const Json& value) {
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
std::string DrawText(const Json& typed) {
  if (!typed.is_object() || !typed.contains("type")) return ValueText(typed);
  std::string text = ValueText(typed["type"]);
  for (const auto& [key, value] : typed.items()) {
    if (key != "type") text += ", " + key + " " + ValueText(value);
  }
  return text;
}

void AddRecipeRows(const Json& value, const std::string& path, Table& table);

// An entry of a list, such as a group or a base, by its name or its file.
void AddEntryRows(const Json& entry, const std::string& path, Table& table) {
  const char* const title = entry.contains("name") ? "name" : "file";
  if (!entry.contains(title)) return AddRecipeRows(entry, path, table);
  Json rest = entry;
  const std::string name = ValueText(entry.at(title));
  rest.erase(title);
  if (rest.empty()) {
    table.rows.push_back({path, name});
  } else {
    AddRecipeRows(rest, path + ": " + name, table);
  }
}

// A row for each value of the recipe.
void AddRecipeRows(const Json& value, const std::string& path, Table& table) {
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

Table RecipeTable(const Json& recipe) {
  Table table = TableOf(kCardWords, "recipe");
  Json shown = recipe;
  shown.erase("$schema");
  shown.erase("version");
  AddRecipeRows(shown, "", table);
  return table;
}

/// What the command that makes a data set again takes from its recipe.
struct RecipeFacts {
  std::uint64_t seed{};
  bool has_recordings{};  ///< Whether bases are plans for recordings, which choose the fields.
};

RecipeFacts FactsOfRecipe(const Json& recipe) {
  RecipeFacts facts{.seed = recipe.value("seed", Recipe{}.seed)};
  for (const auto& base : recipe.value("bases", Json::array())) {
    facts.has_recordings = facts.has_recordings || base.contains("recordings");
  }
  return facts;
}

std::string CommandText(const RecipeFacts& recipe, const DatasetRecord& identity) {
  std::string command = "railcast-generate dataset RECIPE --out DIR";
  const bool has_recordings = recipe.has_recordings;
  if (!has_recordings || identity.format != "same") command += " --format " + identity.format;
  if (!has_recordings) command += " --fields " + identity.fields + " --isa " + identity.isa;
  if (!has_recordings && identity.is_merged) command += " --merged";
  return command + ", with the recipe where its names of files lead to the bases";
}

Table OriginTable(const RecipeFacts& recipe, const DatasetRecord& identity) {
  Table table = TableOf(kCardWords, "made_of");
  const auto add = [&](const char* what, std::string value) {
    table.rows.push_back({std::string(what), std::move(value)});
  };
  add("Seed", NumberText(recipe.seed));
  add("Recipe", "recipe.json in the data set, hash " + identity.recipe_hash);
  add("Made by",
      "railcast " + identity.version + ", Embree " + identity.embree + ", " + identity.isa);
  add("To make it again", CommandText(recipe, identity));
  return table;
}

}  // namespace

Section MadeOfSection(const std::filesystem::path& dataset) {
  const Json recipe =
      ReadRecordedJson(ReadDatasetFile(dataset, kRecipeFile), ShownPath(dataset / kRecipeFile));
  const auto identity = ReadRecord<DatasetRecord>(ReadDatasetFile(dataset, kDatasetFile),
                                                  ShownPath(dataset / kDatasetFile));
  Section section = SectionOf(kCardWords, "recipe");
  section.tables = {RecipeTable(recipe), OriginTable(FactsOfRecipe(recipe), identity)};
  return section;
}

}  // namespace railcast
