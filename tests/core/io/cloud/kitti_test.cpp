#include "core/io/cloud/kitti.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/io/cloud/cloud_file.h"
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

/// The numbers of points in a room: x y z intensity (0 to 1), and behind them ring, elongation,
/// time.
template <typename Number>
std::string BinRoom(std::size_t num_columns, bool has_ring = true) {
  constexpr int kRings = 16;
  constexpr int kColumns = 40;
  std::string bytes;
  for (int column = 0; column < kColumns; ++column) {
    for (int ring = 0; ring < kRings; ++ring) {
      const double azimuth = 2.0 * std::numbers::pi * (column + 0.3) / kColumns;
      const double elevation = -0.26 + 0.035 * ring;
      const double range_m =
          std::min({9.0 / std::abs(std::cos(azimuth)), 6.0 / std::abs(std::sin(azimuth)), 30.0});
      const std::vector<double> point = {range_m * std::cos(azimuth),
                                         range_m * std::sin(azimuth),
                                         range_m * std::tan(elevation),
                                         0.3 + 0.01 * (column % 5),
                                         has_ring ? ring : 0.25 * (ring % 3) + 0.1,
                                         0.0025 * column,
                                         0.5};
      for (std::size_t i = 0; i < num_columns; ++i) {
        const auto number = static_cast<Number>(point[i]);
        bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
      }
    }
  }
  return bytes;
}

std::string BinFault(const std::string& bytes) {
  return MessageOf([&] { (void)ParseKittiFile("a.bin", bytes, {}); });
}

constexpr const char* kNotFour =
    "a.bin: its values are not those of 4 numbers a point, x y z intensity, in metres; ";

TEST(KittiReader, NamesTheColumnsThatFitTheValues) {
  EXPECT_EQ(BinFault(BinRoom<float>(4)), "no error");
  EXPECT_EQ(BinFault(BinRoom<float>(3)), std::string(kNotFour) + "those of --kitti-columns 3 fit");
  EXPECT_EQ(BinFault(BinRoom<float>(5)),
            std::string(kNotFour) +
                "those of nuScenes (x y z intensity ring) fit: --kitti-columns nuscenes");
  EXPECT_EQ(BinFault(BinRoom<float>(5, false)),
            std::string(kNotFour) + "those of --kitti-columns 5 fit");
  EXPECT_EQ(BinFault(BinRoom<float>(6)), std::string(kNotFour) + "those of --kitti-columns 6 fit");
  EXPECT_EQ(BinFault(BinRoom<float>(6, false)),
            std::string(kNotFour) +
                "those of Waymo (x y z intensity elongation timestamp) fit: "
                "--kitti-columns waymo");
  EXPECT_EQ(BinFault(BinRoom<double>(4)),
            std::string(kNotFour) + "those of --kitti-columns float64 fit");
}

/// What PCL has of points with normals and padding, in any order.
std::string BinNormals(std::size_t num_columns) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place_m(-20.0F, 20.0F);
  std::string bytes;
  for (int point = 0; point < 500; ++point) {
    const float angle = place_m(random);
    std::vector<float> row = {place_m(random),
                              place_m(random),
                              place_m(random) / 10.0F,
                              1.0F,
                              std::cos(angle),
                              std::sin(angle),
                              0.0F};
    row.resize(num_columns);
    bytes.append(reinterpret_cast<const char*>(row.data()), num_columns * sizeof(float));
  }
  return bytes;
}

TEST(KittiReader, NamesTheColumnsOfPointsWithNormals) {
  for (const std::size_t num : {8UL, 12UL, 16UL}) {
    EXPECT_EQ(BinFault(BinNormals(num)),
              std::string(kNotFour) + "those of --kitti-columns " + NumberText(num) + " fit");
  }
}

TEST(KittiReader, TakesFiringsWithoutAReturnAndNationalGridsAsTheyAre) {
  std::string sky(15'000 * 16, '\0');
  EXPECT_EQ(BinFault(sky + BinRoom<float>(4)), "no error");
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), 0.0F}) {
    std::string bytes = BinRoom<float>(4);
    for (std::size_t point = 0; point < 300; ++point) {
      for (std::size_t i = 0; i < 3; ++i) {
        std::memcpy(&bytes[point * 16 + i * 4], &value, sizeof value);
      }
    }
    EXPECT_EQ(BinFault(bytes), "no error") << value;
  }
  std::string grid = BinRoom<float>(4);
  for (std::size_t point = 0; point < grid.size(); point += 16) {
    float x = 0.0F;
    std::memcpy(&x, &grid[point], sizeof x);
    x += 500'000.0F;
    std::memcpy(&grid[point], &x, sizeof x);
  }
  EXPECT_EQ(BinFault(grid), "no error");
}

TEST(KittiReader, TakesNoNumbersOfRowsForCoordinates) {
  std::string bytes = BinRoom<float>(4);
  for (std::size_t point = 0; 16 * point < bytes.size(); ++point) {
    const auto ring = static_cast<float>(point % 16);
    std::memcpy(&bytes[16 * point], &ring, sizeof ring);
  }
  EXPECT_EQ(BinFault(bytes),
            std::string(kNotFour) +
                "nor those of 3, 5, 6, 7, 8, 12 or 16 numbers, of 4 of float64, or of rows; "
                "--kitti-columns N takes N numbers a point as they are");
}

TEST(KittiReader, NamesTheColumnsOfAnUnevenLength) {
  std::string bytes = BinRoom<float>(5);
  bytes.resize(bytes.size() - 20);
  EXPECT_EQ(BinFault(bytes),
            "a.bin: must have 16 bytes for each point (got 12780); those of "
            "nuScenes (x y z intensity ring) fit: --kitti-columns nuscenes");
}

TEST(KittiReader, ReadsTheColumnsThatAreChosen) {
  const Cloud nuscenes = ParseKittiColumns("a.bin", BinRoom<float>(5), {}, "nuscenes").cloud;
  EXPECT_EQ(nuscenes.num_points(), 640U);
  ASSERT_NE(nuscenes.Find("ring"), nullptr);
  VisitField(nuscenes, *nuscenes.Find("ring"),
             [](std::size_t i, auto value) { ASSERT_EQ(static_cast<std::size_t>(value), i % 16); });
  const std::string bytes = BinRoom<double>(4);
  const CloudFile doubles = ParseKittiColumns("a.bin", bytes, {}, "float64");
  EXPECT_EQ(doubles.cloud.Find("x")->type, NumberType::kDouble);
  EXPECT_EQ(Rewritten(doubles, {doubles.cloud.data, std::vector<std::uint32_t>(640)}).at(0), bytes);
  EXPECT_NE(ParseKittiColumns("a.bin", BinRoom<float>(7), {}, "7").cloud.Find("number_7"), nullptr);
  EXPECT_TRUE(IsKittiColumns("16"));
  for (const char* const none : {"", "2", "17", "kitti", "5x"}) EXPECT_FALSE(IsKittiColumns(none));
}

TEST(KittiReader, TurnsThePointsOfNuScenes) {
  const std::string bytes = BinRoom<float>(5);
  std::vector<float> stored(bytes.size() / sizeof(float));
  std::memcpy(stored.data(), bytes.data(), bytes.size());
  const CloudFile file = ParseKittiColumns("a.bin", bytes, {}, "nuscenes");
  // Stored to the right and forward.
  VisitField(file.cloud, *file.cloud.Find("x"),
             [&](std::size_t i, auto x) { ASSERT_EQ(static_cast<float>(x), stored[5 * i + 1]); });
  VisitField(file.cloud, *file.cloud.Find("y"),
             [&](std::size_t i, auto y) { ASSERT_EQ(static_cast<float>(y), -stored[5 * i]); });
  EXPECT_EQ(Rewritten(file, {file.cloud.data, std::vector<std::uint32_t>(640)}).at(0), bytes);
}

// In the order of rings; numbers of points that make every step of what is looked at, over a period
// of the columns.
TEST(KittiReader, TakesNoPointsOfManyForRows) {
  for (const std::size_t num_columns : {4UL, 5UL, 6UL}) {
    const std::string room = BinRoom<float>(num_columns, num_columns == 5);
    const std::size_t point_bytes = 4 * num_columns;
    constexpr std::size_t kMost = 15'000 * 13;
    std::string bytes;
    while (bytes.size() < kMost * point_bytes) bytes += room;
    for (std::size_t step = 2; step <= 12; ++step) {
      for (std::size_t i = 0; i < num_columns; ++i) {
        const std::size_t num = 15'000 * (step - 1) + 1 + i;
        EXPECT_EQ(MessageOf([&] {
                    (void)ParseKittiColumns("a.bin", bytes.substr(0, num * point_bytes), {},
                                            NumberText(num_columns));
                  }),
                  "no error")
            << num << " points of " << num_columns;
      }
    }
  }
}

TEST(KittiReader, NamesRowsThatStandOneAfterTheOther) {
  for (const std::size_t num_rows : {4UL, 5UL, 6UL}) {
    const std::string bytes = BinRoom<float>(num_rows);
    std::string by_rows(bytes.size(), '\0');
    const std::size_t num = bytes.size() / 4 / num_rows;
    for (std::size_t i = 0; i < bytes.size() / 4; ++i) {
      std::memcpy(&by_rows[4 * (i % num_rows * num + i / num_rows)], &bytes[4 * i], 4);
    }
    const std::string rows = NumberText(num_rows);
    const std::string what = "they stand in " + rows +
                             " rows, x, y, z and others, one after the other: numpy.fromfile(FILE, "
                             "'float32').reshape(" +
                             rows + ", -1).T.tofile(FILE) stores them by points";
    EXPECT_EQ(BinFault(by_rows), kNotFour + what);
    EXPECT_EQ(MessageOf([&] { (void)ParseKittiColumns("a.bin", by_rows, {}, "16"); }),
              "a.bin: must have the numbers of a point side by side; " + what);
  }
}

TEST(KittiReader, SaysHowManyNumbersAPointTheLabelsAreFor) {
  const std::string labels(640 * 4, '\0');
  EXPECT_EQ(MessageOf([&] { (void)ParseKittiFile("a.bin", BinRoom<float>(5), labels); }),
            "a.bin: its .label file must have 3200 bytes (got 2560); 640 labels are as many as "
            "points of 5 numbers: --kitti-columns nuscenes?");
}

}  // namespace
}  // namespace railcast
