// Packets of sensors that fire in a window of azimuths.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "core/scan/spinning_pattern.h"
#include "tests/core/extras/packets/hesai/made_packet.h"
#include "tests/core/extras/packets/hesai/sent_turns.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

/// The columns of a frame that were fired in a window.
Frame ColumnsOf(const Frame& whole, const std::vector<std::uint32_t>& cycles) {
  Frame frame;
  frame.Resize(whole.rows, static_cast<std::uint32_t>(cycles.size()), whole.returns);
  frame.index = whole.index;
  frame.stamp_ns = whole.stamp_ns;
  for (std::uint32_t row = 0; row < whole.rows; ++row) {
    for (std::uint32_t column = 0; column < frame.columns; ++column) {
      for (std::uint32_t r = 0; r < whole.returns; ++r) {
        const std::size_t to = row * std::size_t{frame.width()} + column * whole.returns + r;
        const std::size_t from =
            row * std::size_t{whole.width()} + cycles[column] * whole.returns + r;
        frame.range_m[to] = whole.range_m[from];
        frame.intensity[to] = whole.intensity[from];
        frame.time_ns[to] = whole.time_ns[from];
        frame.outcome[to] = whole.outcome[from];
        frame.true_range_m[to] = whole.true_range_m[from];
      }
    }
  }
  return frame;
}

/// A point as it was decoded.
using SentPoint = std::tuple<std::int64_t, std::uint8_t, float, float, float>;

/// Returns the points of all turns whose firing cycle is one of these.
/// @param num_cycles Of a turn; the first turn begins with cycle 0.
std::vector<SentPoint> PointsIn(const std::vector<SensorTurn>& turns,
                                const std::vector<std::uint32_t>& cycles,
                                std::int64_t begin_ns,
                                double cycle_us) {
  std::vector<SentPoint> points;
  for (const SensorTurn& turn : turns) {
    for (const TurnPoint& point : turn.points) {
      const std::int64_t cycle_ns = turn.stamp_ns + turn.column_time_ns[point.column] - begin_ns;
      const auto cycle = static_cast<std::uint32_t>(
          std::lround(static_cast<double>(cycle_ns % 100'000'000) / (1e3 * cycle_us)));
      if (!std::ranges::binary_search(cycles, cycle)) continue;
      points.emplace_back(turn.stamp_ns + point.time_ns, point.laser, point.x, point.y, point.z);
    }
  }
  return points;
}

class HesaiWindow : public testing::TestWithParam<SentAs> {};

// Three turns, of which a packet may lack the end.
TEST_P(HesaiWindow, HasThePacketsOfAWholeTurnThatHoldFirings) {
  const SpinningModel& model = *FindSpinningModel(GetParam().protocol);
  const std::uint32_t returns = GetParam().mode == ReturnMode::kDual ? 2 : 1;
  const MadeScan whole(ReadSensor(FileOf(model)));
  ScanSpec spec = whole.spec();
  std::get<SpinningSpec>(spec.pattern).azimuth_window_deg = {{310.0, 49.5}};
  const MadeScan window(spec);
  const auto cycles = FiredCycles(window.spinning(), spec.rate_hz);
  std::vector<Frame> of_whole;
  std::vector<Frame> of_window;
  for (std::uint32_t i = 0; i < 3; ++i) {
    of_whole.push_back(whole.MakeFrame(i, returns));
    of_window.push_back(ColumnsOf(of_whole.back(), cycles));
  }
  const Datagrams all = Encoded(model, whole, of_whole, GetParam().mode);
  const Datagrams some = Encoded(model, window, of_window, GetParam().mode);
  const double share = static_cast<double>(cycles.size()) / whole.spinning().columns;
  EXPECT_NEAR(static_cast<double>(some.items.size()), share * static_cast<double>(all.items.size()),
              7.0);
  const auto turns_of_all = TurnsIn(model, all);
  const auto turns_of_some = TurnsIn(model, some);
  // A turn ends where the azimuth falls, and not at the gap.
  EXPECT_EQ(turns_of_some.size(), turns_of_all.size());
  const std::int64_t begin_ns = turns_of_all[0].stamp_ns;
  const double cycle_us = whole.spinning().cycle_us;
  const auto points = PointsIn(turns_of_some, cycles, begin_ns, cycle_us);
  EXPECT_EQ(points, PointsIn(turns_of_all, cycles, begin_ns, cycle_us));
  std::size_t num_points = 0;
  for (const SensorTurn& turn : turns_of_some) num_points += turn.points.size();
  EXPECT_EQ(points.size(), num_points) << "no point is outside of the window";
  if (model.sequence_place == 0) return;
  for (std::size_t i = 0; i < some.items.size(); ++i) {
    const char* const packet = some.BytesOf(some.items[i]).data();
    ASSERT_EQ(LoadAt<std::uint32_t>(packet + model.sequence_place), i);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, HesaiWindow, testing::ValuesIn(Sendings()), [](const auto& test) {
  std::string name = test.param.protocol + "_" + std::string(NameOf(test.param.mode));
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST(HesaiWindowPackets, AreNumberedAsIfNoFrameWereLeftOut) {
  const SpinningModel& model = *FindSpinningModel("xt32");
  ScanSpec spec = ReadSensor("xt32");
  std::get<SpinningSpec>(spec.pattern).azimuth_window_deg = {{100.0, 131.0}};
  const MadeScan scan(spec);
  const auto numbers_of = [&](const std::vector<std::uint32_t>& indices) {
    std::vector<Frame> frames;
    for (const std::uint32_t index : indices) frames.push_back(scan.MakeFrame(index));
    const Datagrams datagrams = Encoded(model, scan, frames);
    std::vector<std::uint32_t> numbers;
    for (const Datagrams::Item& item : datagrams.items) {
      numbers.push_back(
          LoadAt<std::uint32_t>(datagrams.BytesOf(item).data() + model.sequence_place));
    }
    return numbers;
  };
  auto expected = numbers_of({0, 1, 2});
  // 2000 blocks of 0.18 deg a turn, 250 packets. The window has the blocks 556 to 727, which are in
  // the packets 69 to 90.
  EXPECT_EQ(expected.size(), 66U);
  expected.erase(expected.begin() + 22, expected.begin() + 44);
  EXPECT_EQ(numbers_of({0, 2}), expected);
}

}  // namespace
}  // namespace railcast
