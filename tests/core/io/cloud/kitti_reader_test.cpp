#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "core/io/cloud/cloud_file.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

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

TEST(KittiReader, SaysHowManyNumbersAPointTheLabelsAreFor) {
  const std::string labels(640 * 4, '\0');
  EXPECT_EQ(MessageOf([&] { (void)ParseKittiFile("a.bin", BinRoom<float>(5), labels); }),
            "a.bin: its .label file must have 3200 bytes (got 2560); 640 labels are as many as "
            "points of 5 numbers: --kitti-columns nuscenes?");
}

}  // namespace
}  // namespace railcast
