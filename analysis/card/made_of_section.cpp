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

namespace railcast {
namespace {

// Words as they are, numbers and anything else as in JSON: "0, 40, 80".
std::string ValueText(const StrictOrderedJson& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const auto& item : value) text += (text.empty() ? "" : ", ") + ValueText(item);
  return text;
}

/// "uniform, min 5, max 25".
std::string DrawText(const StrictOrderedJson& draw) {
  if (!draw.is_object()) return ValueText(draw);
  std::string text = draw.value("type", "");
  for (const auto& [key, value] : draw.items()) {
    if (key != "type") text += (text.empty() ? "" : ", ") + key + " " + ValueText(value);
  }
  return text;
}

/// "open (weight 2), woods", or the families of a random weather.
std::string GroupText(const StrictOrderedJson& group) {
  if (group.contains("random_weather")) return "random " + ValueText(group["random_weather"]);
  std::string text;
  for (const auto& option : group.at("options")) {
    text += (text.empty() ? "" : ", ") + option.at("name").get<std::string>();
    if (option.contains("weight")) text += " (weight " + option["weight"].dump() + ")";
  }
  return text;
}

void AddDraws(const StrictOrderedJson& of, const std::string& prefix, Table& table) {
  if (!of.contains("draws")) return;
  for (const auto& [pointer, draw] : of["draws"].items()) {
    table.rows.push_back({prefix + pointer, DrawText(draw)});
  }
}

Table DrawsTable(const StrictOrderedJson& recipe) {
  Table table = {.key = "draws",
                 .title = "What is set and drawn",
                 .note = "In each scenario; docs/dataset.md has the meanings of the keys.",
                 .columns = {{"what", "What", ""}, {"values", "Values", ""}},
                 .is_open = true};
  if (recipe.contains("set")) {
    for (const auto& [pointer, value] : recipe["set"].items()) {
      table.rows.push_back({pointer, ValueText(value)});
    }
  }
  if (recipe.contains("groups")) {
    for (const auto& group : recipe["groups"]) {
      const std::string name = group.at("name");
      table.rows.push_back({name, GroupText(group)});
      if (!group.contains("options")) continue;
      for (const auto& option : group["options"]) {
        AddDraws(option, option.at("name").get<std::string>() + ": ", table);
      }
    }
  }
  AddDraws(recipe, "", table);
  if (recipe.contains("start_s_m")) {
    table.rows.push_back({std::string("start_s_m"), DrawText(recipe["start_s_m"])});
  }
  if (!recipe.contains("objects")) return table;
  for (const auto& object : recipe["objects"]) {
    const std::string prefix = object.at("name").get<std::string>() + ": ";
    for (const char* const key : {"count", "ahead_m", "gauge"}) {
      if (object.contains(key)) table.rows.push_back({prefix + key, DrawText(object[key])});
    }
    AddDraws(object, prefix, table);
  }
  return table;
}

std::string BasesText(const StrictOrderedJson& recipe) {
  std::string text;
  for (const auto& base : recipe.at("bases")) {
    text += (text.empty() ? "" : ", ") + base.at("file").get<std::string>();
  }
  return text;
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
  add("Seed", NumberText(recipe.value("seed", std::uint64_t{1})));
  add("Scenarios", recipe.at("num_scenarios").dump());
  add("Bases", BasesText(recipe));
  if (recipe.contains("split")) add("Divided by", recipe["split"].value("by", "scenario"));
  add("Recipe", "recipe.json in the data set, hash " + text("recipe_xxh3"));
  add("Made by", "railcast " + text("version") + ", Embree " + text("embree"));
  add("To make it again", "railcast-generate dataset RECIPE --out DIR --format " + text("format") +
                              " --fields " + text("fields") + " --isa " + text("isa") +
                              (identity.value("merged", false) ? " --merged" : "") +
                              ", with the recipe where its names of files lead to the bases");
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
                             .tables = {DrawsTable(of_recipe), OriginTable(of_recipe, of_run)}};
            });
      });
}

}  // namespace railcast
