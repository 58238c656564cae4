#include "core/io/cloud/kitti_names.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/io/cloud/kitti.h"
#include "core/io/write_file.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

std::string MessageOfYaml(const std::string& yaml) {
  return MessageOf([&] { (void)ParseSemanticKittiNames(yaml, "x.yaml"); });
}

TEST(SemanticKittiNames, AreThoseThatWeWrite) {
  const LabelTable ours = ReadLabelTable(ScenariosDir() / "labels.json");
  const LabelTable expected = SemanticKittiLabels(ours);
  const LabelTable found = ParseSemanticKittiNames(SemanticKittiYaml(ours), "x.yaml");
  ASSERT_EQ(found.labels().size(), expected.labels().size());
  for (const Label& label : expected.labels()) {
    const Label* const same = found.Find(label.id);
    ASSERT_NE(same, nullptr) << label.id;
    EXPECT_EQ(same->name, label.name);
    EXPECT_EQ(same->rgb, label.rgb);
    EXPECT_EQ(same->semantic_kitti, label.id);
  }
}

// As in semantic-kitti.yaml of semantic-kitti-api, which has many keys more.
TEST(SemanticKittiNames, OfOtherFilesMayHaveOtherKeysAndLackColours) {
  const LabelTable found = ParseSemanticKittiNames(
      "# a comment\nname: \"kitti\"\nlabels:\n  252: \"moving-car\"\n  0 : \"unlabeled\"\n"
      "color_map: # bgr\n  0: [0, 0, 0]\n  10: [245, 150, 100]\nsplit:\n  train: [0, 1]\n",
      "x.yaml");
  ASSERT_EQ(found.labels().size(), 2U);
  EXPECT_EQ(found.labels()[0].name, "unlabeled");
  EXPECT_EQ(found.labels()[1].id, 252U);
  EXPECT_EQ(found.labels()[1].name, "moving-car");
  using Color = std::array<std::uint8_t, 3>;
  EXPECT_EQ(found.labels()[0].rgb, (Color{0, 0, 0}));
  EXPECT_EQ(found.labels()[1].rgb, (Color{128, 128, 128}));
}

TEST(SemanticKittiNames, FaultsAreListedOneByOne) {
  EXPECT_EQ(MessageOfYaml("labels: {10: car, 65536: bus, 10: bike, 12: [a], 13: car}\n"
                          "color_map: {10: [1, 2], 12: [1, 2, 256]}\n"),
            "x.yaml: /labels: a key must be a whole number from 0 to 65535 (got 65536)\n"
            "x.yaml: /labels/10: duplicate key\n"
            "x.yaml: /labels/12: must be a name (got no scalar)\n"
            "x.yaml: /labels/13: must have a name of its own, not that of 10 (got car)\n"
            "x.yaml: /color_map/10: must be three whole numbers from 0 to 255: b, g, r\n"
            "x.yaml: /color_map/12: must be three whole numbers from 0 to 255: b, g, r");
  EXPECT_EQ(MessageOfYaml("labels: 5"), "x.yaml: /labels: must be a map by label numbers");
  EXPECT_EQ(MessageOfYaml("labels: {1: a}\nlabels: {2: b}"), "x.yaml: /labels: duplicate key");
  EXPECT_EQ(MessageOfYaml("split: {}"), "x.yaml: /labels: missing");
  EXPECT_EQ(MessageOfYaml(""), "x.yaml: must be a map with the key labels");
  EXPECT_EQ(MessageOfYaml("labels: [1"),
            "x.yaml: is no YAML: line 1, column 1: end of sequence flow not found");
  EXPECT_EQ(MessageOfYaml(std::string(1'000'001, '#')),
            "x.yaml: must have at most 1000000 bytes (got 1000001)");
}

TEST(SemanticKittiNames, AreLookedForBesideTheCloudsAndAboveVelodyne) {
  const TemporaryDirectory directory;
  const fs::path clouds = directory.path() / "set/sequences/03/velodyne";
  fs::create_directories(clouds);
  EXPECT_EQ(FindSemanticKittiYaml(clouds), std::nullopt);
  const fs::path yaml = directory.path() / "set/semantic-kitti.yaml";
  WriteFileWhole(yaml, "labels: {1: \"a\"}\n");
  EXPECT_EQ(FindSemanticKittiYaml(clouds), yaml);
  // Clouds of no KITTI layout have no business with what is above them.
  EXPECT_EQ(FindSemanticKittiYaml(clouds.parent_path()), std::nullopt);
  const fs::path nearer = directory.path() / "set/sequences/semantic-kitti-mine.yaml";
  WriteFileWhole(nearer, "labels: {1: \"b\"}\n");
  EXPECT_EQ(FindSemanticKittiYaml(clouds), nearer);
  EXPECT_EQ(SemanticKittiNamesOf(clouds).labels().at(0).name, "b");
}

TEST(SemanticKittiNames, OfTwoFilesAreAFault) {
  const TemporaryDirectory directory;
  WriteFileWhole(directory.path() / "semantic-kitti.yaml", "labels: {}");
  WriteFileWhole(directory.path() / "semantic-kitti-all.yaml", "labels: {}");
  EXPECT_EQ(MessageOf([&] { (void)FindSemanticKittiYaml(directory.path()); }),
            directory.path().string() +
                ": must hold one semantic-kitti*.yaml (got semantic-kitti-all.yaml, "
                "semantic-kitti.yaml)");
}

}  // namespace
}  // namespace railcast
