#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "tests/core/track/bars.h"
#include "tests/core/track/scenes.h"

namespace railcast {
namespace {

constexpr double kHalf_m = 0.5 * (1.435 + kHeadWidth_m);

FoundTracks FindBars(const std::vector<Bar>& bars) {
  return FindTracks(PointsOfBars(2.5, bars), std::nullopt);
}

std::vector<Bar> PairOf(double left_m, const Bar& bar) {
  Bar left = bar;
  Bar right = bar;
  left.left_m = left_m + kHalf_m;
  right.left_m = left_m - kHalf_m;
  return {left, right};
}

TEST(FindTracks, FindsTwoBarsOfARailsSize) {
  const FoundTracks found = FindBars(PairOf(0.4, {.width_m = kHeadWidth_m, .height_m = 0.17}));
  ASSERT_EQ(found.tracks.size(), 1U) << found.why_not;
  const FoundTrack& track = found.tracks.front();
  EXPECT_NEAR(track.height_m.value, 2.5 - 0.17, 0.006);
  EXPECT_NEAR(track.sideways_m.value, -0.4, 0.006);
  EXPECT_NEAR(track.gauge_m.value, 1.435, 0.008);
  EXPECT_NEAR(track.yaw_rad.value, 0.0, 0.001);
  EXPECT_NEAR(track.pitch_rad.value, 0.0, 0.001);
  EXPECT_NEAR(track.roll_rad.value, 0.0, 0.002);
  EXPECT_NEAR(track.curvature_per_m.value, 0.0, 1e-4);
}

TEST(FindTracks, FindsTheTrackOfASensorThatLiesOnItsSide) {
  std::vector<Eigen::Vector3f> points_m =
      PointsOfBars(2.5, PairOf(0.4, {.width_m = kHeadWidth_m, .height_m = 0.17}));
  // The sensor's z is to the right of the track.
  for (Eigen::Vector3f& point_m : points_m)
    point_m = Eigen::Vector3f(point_m.x(), point_m.z(), -point_m.y());
  const FoundTracks found = FindTracks(points_m, std::nullopt);
  ASSERT_EQ(found.tracks.size(), 1U) << found.why_not;
  EXPECT_NEAR(found.tracks.front().height_m.value, 2.5 - 0.17, 0.006);
  EXPECT_NEAR(found.tracks.front().sideways_m.value, -0.4, 0.006);
  EXPECT_NEAR(found.tracks.front().roll_rad.value, std::numbers::pi / 2.0, 0.002);
}

TEST(FindTracks, FindsAnyGaugeOrTheOneThatIsGiven) {
  const auto bars_of = [](double gauge_m) {
    const double half_m = 0.5 * (gauge_m + kHeadWidth_m);
    return PointsOfBars(2.0, {{half_m, kHeadWidth_m, 0.15}, {-half_m, kHeadWidth_m, 0.15}});
  };
  for (const double gauge_m : {0.6, 0.864, 1.0, 1.067, 1.52, 1.668}) {
    const FoundTracks found = FindTracks(bars_of(gauge_m), std::nullopt);
    ASSERT_EQ(found.tracks.size(), 1U) << gauge_m << ": " << found.why_not;
    EXPECT_NEAR(found.tracks.front().gauge_m.value, gauge_m, 0.008);
  }
  EXPECT_EQ(FindTracks(bars_of(1.0), 1.0).tracks.size(), 1U);
  EXPECT_TRUE(FindTracks(bars_of(1.0), 1.435).tracks.empty());
}

TEST(FindTracks, FindsEachOfSeveralTracks) {
  std::vector<Bar> bars;
  for (const double left_m : {-4.5, 0.0, 4.5}) {
    for (const Bar& bar : PairOf(left_m, {.width_m = kHeadWidth_m, .height_m = 0.17}))
      bars.push_back(bar);
  }
  const FoundTracks found = FindBars(bars);
  ASSERT_EQ(found.tracks.size(), 3U) << found.why_not;
  EXPECT_NEAR(found.tracks[0].sideways_m.value, 0.0, 0.008);
  EXPECT_NEAR(std::abs(found.tracks[1].sideways_m.value), 4.5, 0.015);
  EXPECT_NEAR(std::abs(found.tracks[2].sideways_m.value), 4.5, 0.015);
}

void ExpectNone(const std::vector<Bar>& bars, const std::string& why) {
  const FoundTracks found = FindBars(bars);
  EXPECT_TRUE(found.tracks.empty()) << why;
  EXPECT_NE(found.why_not, "") << why;
}

TEST(FindTracks, TakesNothingElseForATrack) {
  ExpectNone({}, "a road");
  ExpectNone(PairOf(0.0, {.width_m = 0.05, .height_m = 0.05}), "cables");
  ExpectNone(PairOf(0.0, {.width_m = 0.2, .height_m = 0.2, .is_round = true}), "pipes");
  ExpectNone(PairOf(0.0, {.width_m = 0.16, .height_m = 0.16, .is_round = true}), "thinner pipes");
  ExpectNone(PairOf(0.0, {.width_m = 0.04, .height_m = 0.6, .is_round = true}), "wires");
  ExpectNone(PairOf(0.0, {.width_m = 0.3, .height_m = 0.17}), "troughs");
  ExpectNone({{kHalf_m + 2.0, 4.0, 0.15}, {-kHalf_m - 2.0, 4.0, 0.15}}, "kerbs of a lane");
  ExpectNone({{3.6, 4.0, 0.55}, {-3.6, 4.0, 0.55}}, "platforms");
  ExpectNone({{kHalf_m, kHeadWidth_m, 0.17}}, "one rail");
}

TEST(FindTracks, SaysWhyThereIsNone) {
  EXPECT_EQ(FindTracks({}, std::nullopt).why_not, "no ground is seen");
  EXPECT_EQ(FindBars({}).why_not, "no pair of ridges stands out of the ground");
}

/// What must hold in 95 % of frames in which each head has 30 points.
struct Tolerance {
  BoundedFigure FoundTrack::*figure{};
  double most{};
  double per_unit{};  ///< As printed: mm, mrad, 1e-5 / m.
};
constexpr double kDeg_rad = std::numbers::pi / 180.0;
const std::vector<Tolerance> kTolerances = {
    {&FoundTrack::height_m, 0.010, 1e3},          {&FoundTrack::sideways_m, 0.015, 1e3},
    {&FoundTrack::yaw_rad, 0.2 * kDeg_rad, 1e3},  {&FoundTrack::pitch_rad, 0.1 * kDeg_rad, 1e3},
    {&FoundTrack::roll_rad, 0.1 * kDeg_rad, 1e3}, {&FoundTrack::gauge_m, 0.010, 1e3},
    {&FoundTrack::curvature_per_m, 2e-4, 1e5},
};

// Prints the table of docs/results/track.md: the greatest errors of each scene.
TEST(FindTracks, AgreesWithTheTruthOfScenes) {
  const char* const wanted = std::getenv("RAILCAST_TRACK_FRAMES");
  const auto num_frames = static_cast<std::uint32_t>(wanted != nullptr ? std::stoi(wanted) : 8);
  int num_trials = 0;
  int num_good = 0;
  int num_figures = 0;
  int num_held = 0;
  for (const TrackScene& scene : TrackScenes()) {
    std::vector<double> worst(kTolerances.size());
    int num_of_scene = 0;
    for (const TrackTrial& trial : TryScene(scene, num_frames, 12)) {
      const FoundTrack* own = trial.own();
      EXPECT_NE(own, nullptr) << scene.name << ": " << trial.found.why_not;
      if (own == nullptr || std::min(own->points[0], own->points[1]) < 30) continue;
      ++num_of_scene;
      bool is_good = true;
      for (std::size_t i = 0; i < kTolerances.size(); ++i) {
        const Tolerance& each = kTolerances[i];
        const BoundedFigure& found = own->*each.figure;
        const double error = std::abs(found.value - (trial.truth.*each.figure).value);
        worst[i] = std::max(worst[i], error);
        ++num_figures;
        num_held += error <= found.margin ? 1 : 0;
        is_good = is_good && error <= each.most;
      }
      num_good += is_good ? 1 : 0;
    }
    num_trials += num_of_scene;
    std::printf("| %s | %d", scene.name.c_str(), num_of_scene);
    for (std::size_t i = 0; i < worst.size(); ++i)
      std::printf(" | %.1f", kTolerances[i].per_unit * worst[i]);
    std::printf(" |\n");
  }
  std::printf("%d of %d frames within all tolerances, %d of %d figures within their intervals\n",
              num_good, num_trials, num_held, num_figures);
  EXPECT_GE(num_trials, 10 * static_cast<int>(num_frames));
  EXPECT_GE(num_good, 0.95 * num_trials);
  // Of 840 figures 0.94 is more than a standard deviation below 0.95.
  EXPECT_GE(num_held, 0.94 * num_figures);
}

}  // namespace
}  // namespace railcast
