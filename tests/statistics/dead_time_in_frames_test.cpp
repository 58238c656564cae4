// The figures of docs/validation.md about dead time on the demo's scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "railcast/scenario.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

constexpr double kDeadTime_m = 0.5 * 299'792'458.0 * 7.9e-9;

struct Pairs {
  std::size_t num{};
  std::size_t num_near{};  ///< Nearer than the dead time of VLP-16 allows.
  double nearest_m = std::numeric_limits<double>::infinity();
};

Pairs CountPairs(const std::string& dead_time_ns) {
  const TemporaryFolder folder;
  const std::string scenarios = ScenariosDir().string();
  const auto file = folder.Write("scenario.json", R"({"version": 1, "file": ")" + scenarios +
                                                      R"(/st_gallen_approach.json",
    "fidelity": "footprint", "lidar": {"file": ")" + scenarios +
                                                      R"(/sensors/vlp16.json",
    "mount": {"position_m": [2.2, 0, 2.5]}, "receiver": {"return_mode": "dual", "dead_time_ns": )" +
                                                      dead_time_ns + "}}}");
  const auto simulator = MakeSimulator(ReadScenario(file), 0);
  Pairs pairs;
  Frame frame;
  for (std::uint32_t index = 0; index < 5; ++index) {
    simulator->Scan(index, frame);
    for (std::size_t slot = 0; slot + 1 < frame.num_slots(); slot += 2) {
      const double apart_m = std::abs(static_cast<double>(frame.range_m[slot]) -
                                      static_cast<double>(frame.range_m[slot + 1]));
      if (std::isnan(apart_m)) continue;
      ++pairs.num;
      if (apart_m < 1.18) ++pairs.num_near;
      pairs.nearest_m = std::min(pairs.nearest_m, apart_m);
    }
  }
  return pairs;
}

TEST(DeadTimeInFrames, SeparatesTheReturnsOfAVlp16InTheDemo) {
  const Pairs without = CountPairs("0");
  const double share = static_cast<double>(without.num_near) / static_cast<double>(without.num);
  // A fifth of 9,402: what the plants of the scene make of it.
  EXPECT_GT(without.num, 5000U);
  EXPECT_NEAR(share, 0.20, 0.05);
  const Pairs with = CountPairs("7.9");
  EXPECT_EQ(with.num_near, 0U);
  EXPECT_GE(with.nearest_m, kDeadTime_m - 1e-4);
  // An echo that is lost to its forerunner may leave its place to one farther off.
  EXPECT_LE(with.num, without.num);
  EXPECT_GE(with.num, without.num - without.num_near);
}

}  // namespace
}  // namespace railcast
