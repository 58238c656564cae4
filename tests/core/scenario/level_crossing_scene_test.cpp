#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "railcast/scenario.h"
#include "railcast/simulator.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

/// Intensities of the returned points, by label.
std::map<std::string, std::vector<float>> IntensitiesByLabel(const ScenarioSpec& spec) {
  std::map<std::string, std::vector<float>> intensities;
  const Frame frame = ScanFrame(*MakeSimulator(spec, 0));
  for (const Label& label : spec.labels) {
    for (std::size_t i = 0; i < frame.label.size(); ++i) {
      if (frame.label[i] != label.id || frame.outcome[i] != Outcome::kReturned) continue;
      intensities[label.name].push_back(frame.intensity[i]);
    }
  }
  return intensities;
}

float MedianOf(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

TEST(LevelCrossingScene, ShowsAllThatStandsAlongIt) {
  const auto seen = IntensitiesByLabel(ReadScenario(ScenariosDir() / "level_crossing.json"));
  for (const char* label : {"signal", "board", "balise", "relay_box", "building", "road",
                            "level_crossing", "furniture", "person", "road_vehicle"}) {
    EXPECT_TRUE(seen.contains(label)) << label;
  }
}

/// White sheeting has 570 times the answer of a white Lambertian, everything else at most 1.
TEST(LevelCrossingScene, ShowsItsBoardsAHundredTimesAsBrightAsAllElse) {
  const auto seen = IntensitiesByLabel(ReadScenario(ScenariosDir() / "level_crossing.json"));
  const float boards = MedianOf(seen.at("board"));
  EXPECT_GT(boards, 100.0F);
  for (const auto& [label, intensities] : seen) {
    // At 200 m, half of what is seen of the buffer stop is its board.
    if (label == "board" || label == "buffer_stop") continue;
    EXPECT_LT(100.0F * MedianOf(intensities), boards) << label;
  }
}

}  // namespace
}  // namespace railcast
