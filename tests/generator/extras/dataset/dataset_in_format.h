#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "core/extras/recipe/dataset_verification.h"
#include "generator/extras/dataset/run_dataset.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/dataset/dataset_project.h"

namespace railcast {

/// Data sets of two sensors, or of one, whose frames are in one file: a bag or a trace.
class DatasetInFormat : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] std::filesystem::path Path(const std::string& name) const {
    return directory_.path() / name;
  }
  [[nodiscard]] DatasetChoices Choices(const std::string& name, const Shard& shard = {}) const {
    DatasetChoices choices = OnOneThread(Path(name), shard);
    choices.format = GetParam();
    return choices;
  }
  void Make(const std::string& name, const Shard& shard = {}) const {
    EXPECT_TRUE(RunDataset(recipe_, Choices(name, shard), NoDatasetHooks()).is_complete);
  }
  [[nodiscard]] std::vector<std::string> FaultsOf(const std::string& name) const {
    return VerifyDataset(Path(name), [](double) {}).faults;
  }

  void ExpectTheSameOfShards() const {
    Make("whole");
    Make("a", {1, 2});
    Make("b", {2, 2});
    EXPECT_EQ(MergeShards({Path("a"), Path("b")}, Path("merged"), [](auto, auto) {}), 3U);
    EXPECT_EQ(FilesOfDataset(Path("merged")), FilesOfDataset(Path("whole")));
    EXPECT_THAT(FaultsOf("merged"), testing::IsEmpty());
  }
  void ExpectTheSameAfterAnInterruption() const {
    Make("whole");
    for (const int after : {2, 7, 11}) {
      const std::string name = "stopped_" + std::to_string(after);
      std::atomic<int> num_asked = 0;
      const DatasetHooks hooks = {NoDatasetHooks().on_progress,
                                  [&] { return ++num_asked > after; }};
      (void)RunDataset(recipe_, Choices(name), hooks);
      Make(name);
      EXPECT_EQ(FilesOfDataset(Path(name)), FilesOfDataset(Path("whole"))) << after;
    }
  }

  /// @param file Of a scenario, in its folder: its bag or trace.
  void ExpectMendedWithout(const std::string& file) const {
    Make("whole");
    const auto whole = FilesOfDataset(Path("whole"));
    std::filesystem::remove_all(Path("whole/sequences/000/000001") / file);
    EXPECT_THAT(RunDataset(recipe_, Choices("whole"), NoDatasetHooks()).changed,
                testing::Contains(testing::HasSubstr(file + ": ")));
    EXPECT_TRUE(FilesOfDataset(Path("whole")) == whole);
  }

  const TemporaryDirectory directory_;
  Recipe recipe_ = ReadProjectRecipe(directory_.path() / "project", RecipeOfTwoSensors());
};

}  // namespace railcast
