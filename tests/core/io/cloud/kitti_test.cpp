#include "core/io/cloud/kitti.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "core/io/write_file.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

std::size_t NumPointsIn(const Frame& frame) {
  std::size_t count = 0;
  for (const Outcome outcome : frame.outcome) count += HasPoint(outcome) ? 1 : 0;
  return count;
}

TEST(KittiPoints, AreFourFloatsForEveryPoint) {
  Frame frame = ExampleFrame(1);
  frame.intensity[0] = std::numeric_limits<float>::quiet_NaN();  // As at the geometry rung.
  std::string bytes;
  EncodeKittiPoints(frame, bytes);
  ASSERT_EQ(bytes.size(), NumPointsIn(frame) * 16);
  std::size_t point = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!HasPoint(frame.outcome[slot])) continue;
    std::array<float, 4> stored{};
    std::memcpy(stored.data(), bytes.data() + 16 * point++, 16);
    const float remission = slot == 0 ? 0.0F : frame.intensity[slot];
    EXPECT_EQ(stored, (std::array{frame.x[slot], frame.y[slot], frame.z[slot], remission}));
  }
}

TEST(KittiLabels, HoldTheClassBelowAndTheInstanceAbove) {
  const Frame frame = ExampleFrame(1);
  std::string bytes;
  EncodeKittiLabels(frame, ExampleLabels(), {}, bytes);
  ASSERT_EQ(bytes.size(), NumPointsIn(frame) * 4);
  std::size_t point = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!HasPoint(frame.outcome[slot])) continue;
    std::uint32_t stored = 0;
    std::memcpy(&stored, bytes.data() + 4 * point++, 4);
    EXPECT_EQ(stored & 0xFFFFU, frame.label[slot] == 12 ? 16U : 260U);
    EXPECT_EQ(stored >> 16U, frame.instance[slot]);
  }
}

TEST(KittiLabels, TellWhatMovesOfAClassThatHasAnIdForIt) {
  Frame frame = ExampleFrame(1);
  for (std::size_t slot = 0; slot < 27; ++slot) {
    // All others are instance 3, which does not move.
    if (frame.instance[slot] != 0) frame.instance[slot] = 4;
  }
  std::string bytes;
  EncodeKittiLabels(frame, ExampleLabels(), {4, 5}, bytes);
  std::size_t point = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!HasPoint(frame.outcome[slot])) continue;
    std::uint32_t stored = 0;
    std::memcpy(&stored, bytes.data() + 4 * point++, 4);
    const std::uint32_t expected = frame.label[slot] != 12 ? 260 : slot < 27 ? 256 : 16;
    EXPECT_EQ(stored & 0xFFFFU, expected) << slot;
    EXPECT_EQ(stored >> 16U, frame.instance[slot]);
  }
  EXPECT_EQ(MovingSemanticKitti(30), 254);
  EXPECT_EQ(MovingSemanticKitti(50), 50);  // Buildings have no moving variant.
}

TEST(KittiLabels, RefuseAnInstanceTheyCannotHold) {
  Frame frame = ExampleFrame(1);
  frame.instance[0] = 65536;
  std::string bytes;
  EXPECT_EQ(MessageOf([&] { EncodeKittiLabels(frame, ExampleLabels(), {}, bytes); }),
            "--format kitti: instance must be <= 65535 (got 65536)");
}

TEST(KittiPoseLine, IsThePoseByRows) {
  Eigen::Matrix3d quarter_turn;
  quarter_turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_EQ(KittiPoseLine(MakeTransform(quarter_turn, Vector3(1.5, 0.1, -3))),
            "0 -1 0 1.5 1 0 0 0.1 0 0 1 -3\n");
}

TEST(SemanticKittiLabels, AreOurLabelsUnderTheNumbersOfLabelFiles) {
  const LabelTable kitti = SemanticKittiLabels(ExampleLabels());
  ASSERT_EQ(kitti.labels().size(), 4U);
  EXPECT_EQ(kitti.Find(0U)->name, "unlabeled");
  EXPECT_EQ(kitti.Find(16U)->name, "wagon");
  EXPECT_EQ(kitti.Find(256U)->name, "moving wagon");
  EXPECT_EQ(kitti.Find(256U)->rgb, ExampleLabels().Find("wagon")->rgb);
  EXPECT_EQ(kitti.Find(260U)->name, "rail");
  EXPECT_EQ(kitti.Find(260U)->rgb, ExampleLabels().Find("rail")->rgb);
}

TEST(SemanticKittiYaml, NamesAllLabelsThatShareAClass) {
  std::vector<Label> labels(2);
  labels[0].name = "grass";
  labels[1].name = "tree";
  labels[0].semantic_kitti = labels[1].semantic_kitti = 70;
  EXPECT_NE(SemanticKittiYaml(LabelTable(labels)).find("labels:\n  70: \"grass/tree\"\n"),
            std::string::npos);
}

// Both sides are compared as Python's ASCII representation of the strings.
TEST(SemanticKittiYaml, IsReadByPythonWhateverLabelsAreCalled) {
  if (RunCommand("/usr/bin/python3 -c 'import yaml'").status != 0) {
    GTEST_SKIP() << "python3-yaml is not installed";
  }
  const std::vector<std::pair<std::string, std::string>> names = {
      {R"(the "old" shed)", R"('the "old" shed')"},
      {R"(C:\n #1: {[*&!|>'%@`)", R"x("C:\\n #1: {[*&!|>'%@`")x"},
      {"Gleis\u00e4ste \U0001F6A6 \U0001F6A6", R"('Gleis\xe4ste \U0001f6a6 \U0001f6a6')"},
      {"\x7F \u0085 \u0080 \u2028 \ufeff \uffff", R"('\x7f \x85 \x80 \u2028 \ufeff \uffff')"}};
  std::vector<Label> labels(names.size());
  std::string expected;
  for (std::size_t i = 0; i < names.size(); ++i) {
    labels[i].name = names[i].first;
    labels[i].semantic_kitti = static_cast<std::uint16_t>(300 + i);
    expected += names[i].second + "\n";
  }
  const TemporaryDirectory directory;
  const std::string file = (directory.path() / "a.yaml").string();
  WriteFileWhole(file, SemanticKittiYaml(LabelTable(labels)));
  const Ended run = RunCommand(
      "/usr/bin/python3 -c \"import yaml; [print(ascii(name)) for name in yaml.safe_load(open('" +
      file + "', encoding='utf-8'))['labels'].values()]\"");
  EXPECT_EQ(run.said, expected);
}

TEST(SemanticKittiYaml, HasTheKeysOfSemanticKittiApi) {
  EXPECT_EQ(
      SemanticKittiYaml(ExampleLabels()),
      "# Classes of the .label files beside; ids above 259 are railcast's own.\n"
      "name: \"railcast\"\n"
      "labels:\n  0: \"unlabeled\"\n  16: \"wagon\"\n  256: \"moving wagon\"\n  260: \"rail\"\n"
      "color_map: # bgr\n  0: [0, 0, 0]\n  16: [0, 94, 213]\n  256: [0, 94, 213]\n"
      "  260: [0, 159, 230]\n"
      "content: # shares of points; 0 = not counted\n"
      "  0: 0.0\n  16: 0.0\n  256: 0.0\n  260: 0.0\n"
      "learning_map: # to the classes of training\n  0: 0\n  16: 1\n  256: 1\n  260: 2\n"
      "learning_map_inv:\n  0: 0\n  1: 16\n  2: 260\n"
      "learning_ignore: # nothing, and points that are of no surface\n"
      "  0: true\n  1: false\n  2: false\n"
      "split: # sequence numbers\n  train: [0]\n  valid: []\n  test: []\n"
      "nearest_map: # to the nearest of SemanticKITTI's own labels\n"
      "  0: 0\n  16: 16\n  256: 256\n  260: 49\n");
}

TEST(SemanticKittiYaml, IgnoresWhatIsNoSurfaceInTraining) {
  std::vector<Label> labels(2);
  labels[0] = {1, "rain", {}, "", "", 272, 1};
  labels[1] = {2, "rail", {}, "", "", 260, 49};
  const std::string yaml = SemanticKittiYaml(LabelTable(labels));
  EXPECT_NE(yaml.find("learning_map: # to the classes of training\n  260: 1\n  272: 0\n"),
            std::string::npos);
}

}  // namespace
}  // namespace railcast
