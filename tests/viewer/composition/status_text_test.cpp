#include "viewer/composition/status_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

#include "analysis/stats/statistics.h"
#include "railcast/scenario.h"
#include "tests/analysis/recorded_frames.h"
#include "tests/core/io/example_frame.h"
#include "tests/viewer/pick/shown_cloud.h"

namespace railcast {
namespace {

constexpr float kNoReturn = std::numeric_limits<float>::quiet_NaN();

/// The outcome of a firing, and the range of the surface that it met.
struct Firing {
  Outcome outcome{};
  float true_range_m = 20.0F;
};

RecordedFrame FrameOf(const std::vector<Firing>& firings, std::uint32_t returns = 1) {
  Frame frame;
  frame.Resize(1, static_cast<std::uint32_t>(firings.size()), returns);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const Firing& firing = firings[slot / returns];
    const bool is_first = slot % returns == 0;
    frame.outcome[slot] = is_first ? firing.outcome : Outcome::kNoFurtherEcho;
    frame.true_range_m[slot] = firing.true_range_m;
  }
  return Record(std::move(frame));
}

std::string WithOneDecimal(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

const Table& TableOf(const Section& section, const std::string& key) {
  return *std::ranges::find(section.tables, key, &Table::key);
}

/// Returns what `railcast-analyze stats` says of a frame, in the viewer's format. Giving all points
/// one label makes its table by label a single row.
std::string AnalysedText(RecordedFrame recorded) {
  std::ranges::fill(recorded.frame.label, 1U);
  Dropout dropout;
  dropout.Add(recorded);
  const Section section = dropout.MakeSection(Names(RecordingInfo{}));
  std::string text = "dropout ";
  text += WithOneDecimal(100.0 * dropout.Share().value);
  text += " % (";
  const Table& by_label = TableOf(section, "dropout_by_label");
  for (std::size_t i = 3; i < by_label.columns.size(); ++i) {
    if (i > 3) text += ", ";
    const std::string& key = by_label.columns[i].key;
    text += key.substr(0, key.rfind("_percent"));
    text += ' ';
    text += WithOneDecimal(std::get<Estimate>(by_label.rows.at(0)[i]).value);
  }
  text += ')';
  for (const auto& row : TableOf(section, "outcomes").rows) {
    if (std::get<std::string>(row[0]) != "clutter") continue;
    text += "   clutter ";
    text += GroupedDigits(std::get<std::uint64_t>(row[1]));
  }
  return text;
}

TEST(GroupedDigits, HaveACommaBeforeEveryThird) {
  EXPECT_EQ(GroupedDigits(0), "0");
  EXPECT_EQ(GroupedDigits(999), "999");
  EXPECT_EQ(GroupedDigits(1000), "1,000");
  EXPECT_EQ(GroupedDigits(12345678), "12,345,678");
  EXPECT_EQ(GroupedDigits(18446744073709551615U), "18,446,744,073,709,551,615");
}

TEST(FrameText, SaysNumberTimeAndPoints) {
  RecordedFrame recorded = RecordedCloud("a.pcd", std::vector<Vector3>(26812, {1, 2, 3}));
  recorded.frame.index = 20;
  recorded.frame.stamp_ns = 2'000'400'000;
  EXPECT_EQ(FrameText(Show(recorded)), "frame 20   2.000 s   26,812 points");
  recorded.frame.stamp_ns = -1'500'000;
  EXPECT_EQ(FrameText(Show(recorded)), "frame 20   -0.002 s   26,812 points");
}

TEST(FrameText, LeavesOutATimeThatIsNotKnown) {
  RecordedFrame recorded = RecordedCloud("a.pcd", {{1, 2, 3}});
  EXPECT_EQ(FrameText(Show(recorded)), "frame 0   1 points");
  recorded.has_pose = true;  // A railcast frame at the beginning of the run.
  EXPECT_EQ(FrameText(Show(recorded)), "frame 0   0.000 s   1 points");
}

TEST(DropoutText, SaysWhatWasLostOfFiringsOnSurfacesByCause) {
  std::vector<Firing> firings(5, {Outcome::kReturned});
  firings.push_back({Outcome::kBelowThreshold});
  firings.push_back({Outcome::kBelowThreshold});
  firings.push_back({Outcome::kRainAbsorbed});
  // These firings met no surface, or an unknown one.
  firings.push_back({Outcome::kNoSurface, kNoReturn});
  firings.push_back({Outcome::kClutter});
  firings.push_back({Outcome::kClutter, kNoReturn});
  // Hits on the ego vehicle are not counted.
  firings.push_back({Outcome::kEgo});
  EXPECT_EQ(DropoutText(FrameOf(firings)),
            "dropout 37.5 % (below_threshold 25.0, rain_absorbed 12.5)   clutter 2");
  EXPECT_EQ(DropoutText(FrameOf(firings, 2)), DropoutText(FrameOf(firings)))
      << "a second slot is no firing";
}

TEST(DropoutText, HasNoCausesWhereNothingWasLost) {
  EXPECT_EQ(DropoutText(FrameOf({{Outcome::kReturned}, {Outcome::kNoSurface, kNoReturn}})),
            "dropout 0.0 %");
}

TEST(DropoutText, HasNoShareWithoutASurface) {
  EXPECT_EQ(DropoutText(FrameOf({{Outcome::kNoSurface, kNoReturn}})), "no firing met a surface");
  EXPECT_EQ(DropoutText(FrameOf(std::vector<Firing>(1234, {Outcome::kClutter, kNoReturn}))),
            "no firing met a surface   clutter 1,234");
}

TEST(DropoutText, IsEmptyWhereTheFrameDoesNotSay) {
  for (const char* needed : {"outcome", "true_range_m"}) {
    RecordedFrame recorded = FrameOf({{Outcome::kReturned}});
    recorded.fields.erase(needed);
    EXPECT_EQ(DropoutText(recorded), "") << needed;
  }
  RecordedFrame loose = FrameOf({{Outcome::kReturned}});
  loose.is_grid = false;
  EXPECT_EQ(DropoutText(loose), "") << "firings that brought nothing may be left out";
}

TEST(DropoutText, IsWhatAnalysisCounts) {
  ScenarioSpec scenario =
      ReadScenario(std::filesystem::path(RAILCAST_SOURCE_DIR) / "scenarios" / "minimal.json");
  scenario.weather.rain_rate_mmph = 20.0;
  scenario.weather.snow_rate_mmph = 10.0;
  // The draws of this sensor put the point of a leaf in frame 3 beyond the gate.
  scenario.lidar.name = "";
  scenario.world.detail = SceneDetail::kFull;
  Frame frame;
  MakeSimulator(scenario, 1)->Scan(3, frame);
  const std::string expected = AnalysedText(Record(frame));
  for (const char* part : {"below_threshold", "rain_absorbed", "out_of_range", "clutter"}) {
    EXPECT_NE(expected.find(part), std::string::npos) << part << " is wanted: " << expected;
  }
  EXPECT_EQ(DropoutText(Record(frame)), expected);
}

TEST(SelectionText, CountsThePointsOfTheLabelsSelected) {
  RecordedFrame recorded = RecordedCloud("a.pcd", std::vector<Vector3>(1100, {1, 2, 3}));
  recorded.fields.emplace("label");
  std::ranges::fill(recorded.frame.label, 12U);
  recorded.frame.label[0] = 1;
  recorded.frame.label[1] = 90;
  const ShownFrame shown = Show(std::move(recorded));
  EXPECT_EQ(SelectionText(shown, {}, ExampleLabels()), "");
  EXPECT_EQ(SelectionText(shown, {1}, ExampleLabels()), "selected rail: 1 points");
  EXPECT_EQ(SelectionText(shown, {12, 1}, ExampleLabels()), "selected rail, wagon: 1,099 points");
  EXPECT_EQ(SelectionText(shown, {90, 91}, ExampleLabels()),
            "selected label 90, label 91: 1 points");
}

}  // namespace
}  // namespace railcast
