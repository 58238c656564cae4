#include "core/io/verify/dataset_verification.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/io/content_hash.h"
#include "core/io/record/record_text.h"
#include "core/io/run/sensors_record.h"
#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using Faults = std::vector<std::string>;

class VerifyMergedClouds : public testing::Test {
 protected:
  VerifyMergedClouds() {
    fs::create_directories(merged_.folder / "frames");
    std::string lines;
    for (const std::string name : {"frames/000000.pcd", "frames/000001.pcd"}) {
      WriteFileWhole(merged_.folder / name, name);
      lines += RecordText(MergedRecord{.file = {name, ContentHash(name), 17}}) + "\n";
    }
    WriteFileWhole(merged_.folder / "merged.jsonl", lines);
    merged_.files = {{"merged.jsonl", ContentHash(lines), std::nullopt}};
  }
  [[nodiscard]] Faults FaultsFound() const {
    Faults faults = VerifyMerged(merged_, [](double) {}).faults;
    const std::string folder = merged_.folder.string() + "/";
    for (std::string& fault : faults) fault.erase(0, folder.size());
    return faults;
  }

  const TemporaryDirectory directory_;
  MergedFolder merged_{directory_.path() / "merged", {}};
};

TEST_F(VerifyMergedClouds, ReadsEveryFile) {
  const Verification found = VerifyMerged(merged_, [](double) {});
  EXPECT_EQ(found.faults, Faults());
  EXPECT_EQ(found.num_frames, 2U);
  EXPECT_EQ(found.num_files, 3U);
}

TEST_F(VerifyMergedClouds, NamesAChangedCloud) {
  std::ofstream(merged_.folder / "frames/000001.pcd") << "frames/00000X.pcd";
  ASSERT_EQ(FaultsFound().size(), 1U);
  EXPECT_EQ(FaultsFound()[0].find("frames/000001.pcd: "), 0U);
}

TEST_F(VerifyMergedClouds, NamesAMissingCloudAndAForeignFile) {
  fs::remove(merged_.folder / "frames/000000.pcd");
  std::ofstream(merged_.folder / "photo.jpg") << "mine";
  const Faults faults = FaultsFound();
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].find("frames/000000.pcd: "), 0U);
  EXPECT_EQ(faults[1], "photo.jpg: is named neither in sensors.json nor in merged.jsonl");
}

TEST_F(VerifyMergedClouds, NamesAChangedListOfClouds) {
  std::ofstream(merged_.folder / "merged.jsonl", std::ios::app) << "{}\n";
  const Faults faults = FaultsFound();
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].find("merged.jsonl: "), 0U);
  EXPECT_EQ(faults[1].find("merged.jsonl:3: /frame: missing"), 0U);
}

}  // namespace
}  // namespace railcast
