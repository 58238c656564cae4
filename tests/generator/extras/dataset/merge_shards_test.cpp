#include "generator/extras/dataset/run_dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>

#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/dataset/dataset_project.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A way in which a shard may come to harm.
struct Harm {
  std::string name;
  std::function<void(const fs::path& shard)> work;
  std::string said;  ///< Part of the message.
};

void Replace(const fs::path& file, const std::string& from, const std::string& to) {
  std::string text = ReadFileWhole(file);
  const std::size_t place = text.find(from);
  ASSERT_NE(place, std::string::npos) << file;
  WriteFileWhole(file, text.replace(place, from.size(), to));
}

/// Replaces text in scenarios.jsonl.
std::function<void(const fs::path&)> InLines(const std::string& from, const std::string& to) {
  return [=](const fs::path& shard) { Replace(shard / "scenarios.jsonl", from, to); };
}

// NOLINTNEXTLINE(readability-function-size): a table
std::vector<Harm> Harms() {
  const std::string sequence = "sequences/000/000002/";
  const std::string line = "scenarios.jsonl:1: /line_xxh3: must be ";
  return {
      {"missing cloud",
       [=](const fs::path& shard) { fs::remove(shard / sequence / "frames/000001.pcd"); },
       sequence + "frames/000001.pcd: no such file or directory"},
      {"cut cloud",
       [=](const fs::path& shard) { fs::resize_file(shard / sequence / "frames/000001.pcd", 100); },
       sequence + "frames/000001.pcd: must have "},
      {"other cloud",
       [=](const fs::path& shard) {
         fs::copy_file(shard / sequence / "frames/000000.pcd",
                       shard / sequence / "frames/000001.pcd",
                       fs::copy_options::overwrite_existing);
       },
       sequence + "frames/000001.pcd: must have "},
      {"missing poses", [=](const fs::path& shard) { fs::remove(shard / sequence / "poses.csv"); },
       sequence + "poses.csv: no such file or directory"},
      {"changed objects",
       [=](const fs::path& shard) {
         Replace(shard / sequence / "objects.jsonl", "\"points\":", "\"points\":1");
       },
       sequence + "objects.jsonl: must have the hash "},
      {"changed counts",
       [=](const fs::path& shard) {
         Replace(shard / sequence / "frames.jsonl", "\"points\":", "\"points\":1");
       },
       sequence + "frames.jsonl:1: /points: must be "},
      {"stranger",
       [=](const fs::path& shard) { WriteFileWhole(shard / sequence / "notes.txt", "mine"); },
       sequence + "notes.txt: is named neither in manifest.json nor in frames.jsonl"},
      {"link",
       [=](const fs::path& shard) {
         fs::create_symlink("000001.pcd", shard / sequence / "frames/000002.pcd");
       },
       sequence + "frames/000002.pcd: must not be a symbolic link"},
      {"other scenario",
       [=](const fs::path& shard) {
         fs::remove_all(shard / sequence);
         fs::copy(shard / "sequences/000/000000", shard / sequence, fs::copy_options::recursive);
       },
       sequence + "manifest.json: must have the hash "},
      {"part", InLines("\"split\":\"", "\"split\":\"x"), line},
      {"start", InLines("\"start_s_m\":", "\"start_s_m\":1"), line},
      {"points", InLines("\"points\":", "\"points\":1"), line},
      {"type", InLines("\"folder\":", "\"folder\":7,\"f\":"), line},
      {"line twice",
       [](const fs::path& shard) {
         const std::string lines = ReadFileWhole(shard / "scenarios.jsonl");
         WriteFileWhole(shard / "scenarios.jsonl", lines.substr(0, lines.find('\n') + 1) + lines);
       },
       "scenarios.jsonl:2: must be the line of scenario 2 (got 0)"},
      {"line too many",
       [](const fs::path& shard) {
         const std::string lines = ReadFileWhole(shard / "scenarios.jsonl");
         WriteFileWhole(shard / "scenarios.jsonl", lines + "{}\n");
       },
       "scenarios.jsonl: must have the hash "},
      {"other version",
       [](const fs::path& shard) {
         Replace(shard / "dataset.json", "\"version\": \"", "\"version\": \"9");
       },
       "dataset.json: must have the hash "},
      {"other recipe", [](const fs::path& shard) { Replace(shard / "recipe.json", "5", "6"); },
       "dataset.json: is damaged: does not suit recipe.json"},
      {"changed manifest",
       [](const fs::path& shard) { Replace(shard / "manifest.json", "\"1/2\"", "\"2/2\""); },
       "manifest.json: /manifest_xxh3: must be "},
  };
}

TEST(MergeShards, RefuseAShardThatIsNotAsItsRunWroteIt) {
  const TemporaryDirectory directory;
  nlohmann::json json = ProjectRecipe();
  json["num_scenarios"] = 4;
  json["num_frames"] = 2;
  const Recipe recipe = ReadProjectRecipe(directory.path() / "project", json);
  const fs::path whole = directory.path() / "whole";
  const fs::path other = directory.path() / "other";
  (void)MakeDataset(recipe, whole, {1, 2});
  (void)MakeDataset(recipe, other, {2, 2});
  const fs::path shard = directory.path() / "shard";
  const fs::path merged = directory.path() / "merged";
  for (const auto& [name, work, said] : Harms()) {
    fs::copy(whole, shard, fs::copy_options::recursive);
    work(shard);
    const std::string message = MessageOf([&] {
      (void)MergeShards({shard, other}, merged, [](auto, auto) {});
    });
    EXPECT_THAT(message, HasSubstr(shard.string() + "/")) << name;
    EXPECT_THAT(message, HasSubstr(said)) << name;
    EXPECT_FALSE(fs::exists(merged / "manifest.json")) << name;
    fs::remove_all(shard);
    fs::remove_all(merged);
  }
  EXPECT_EQ(MergeShards({whole, other}, merged, [](auto, auto) {}), 4U);
}

}  // namespace
}  // namespace railcast
