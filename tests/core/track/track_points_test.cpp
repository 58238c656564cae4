#include "core/track/track_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/io/cloud/track_fields.h"
#include "tests/core/track/track_truth.h"

namespace railcast {
namespace {

TEST(TrackPoints, AgreeWithTheFieldsOfASimulationWithinTheirMargin) {
  const TrackScene scene{.name = "bend", .sensor = "pandar64", .radius_m = "400", .cant_mm = 100};
  const ScenarioSpec scenario = ScenarioOf(scene);
  const auto simulator = MakeSimulator(scenario, 0);
  RecordedFrame recorded;
  recorded.has_pose = true;
  Frame& frame = recorded.frame;
  simulator->Scan(0, frame);
  const FoundTracks found = FindTracks(PointsOf(frame), std::nullopt);
  ASSERT_FALSE(found.tracks.empty()) << found.why_not;
  const FoundTrack& track = found.tracks.front();
  const double known_m = track.KnownFor_m(kMostTrackMargin_m);
  EXPECT_GT(known_m, 15.0);
  EXPECT_LE(track.Margin_m(known_m), kMostTrackMargin_m);
  EXPECT_GT(track.Margin_m(known_m + 0.5), kMostTrackMargin_m);

  const auto world = MakeWorld(scenario);
  const TrackFields truth =
      TrackFieldsOf(frame, {OwnTrack(*world, scenario.world.catenary), scenario.output,
                            VehicleFromSensor(scenario.lidar.mount)});
  const auto places = PlacePoints(recorded, track, 0.1);
  ASSERT_EQ(places.size(), frame.num_slots());
  int num = 0;
  int num_held = 0;
  int num_in_gauge = 0;
  int num_told_apart = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const PointByTrack& place = places[i];
    if (std::isnan(place.ahead_m)) {
      EXPECT_FALSE(place.is_in_gauge || place.is_in_clear_space);
      continue;
    }
    // Curve and cant widen it by less than 0.5 m.
    if (std::abs(place.lateral_m) > 2.3F || place.height_m > 5.0F || place.height_m < 0.0F) {
      EXPECT_FALSE(place.is_in_clear_space);
    }
    // The margins are those of points near the track.
    if (std::abs(place.lateral_m) > 3.0F) continue;
    ++num;
    const auto margin_m = static_cast<float>(track.Margin_m(static_cast<double>(place.ahead_m)));
    const bool is_held = std::abs(place.lateral_m - truth.track_lateral_m[i]) < margin_m &&
                         std::abs(place.height_m - truth.track_height_m[i]) < margin_m;
    num_held += is_held ? 1 : 0;
    num_in_gauge += truth.in_gauge[i];
    num_told_apart += place.is_in_gauge == (truth.in_gauge[i] != 0) ? 1 : 0;
    // The clear space is wider than a wagon, but for what may be low beside the rails.
    if (place.is_in_gauge && place.height_m > 0.4F && place.height_m < 3.5F) {
      EXPECT_TRUE(place.is_in_clear_space);
    }
  }
  EXPECT_GT(num, 5000);
  EXPECT_GT(num_held, 0.95 * num);
  EXPECT_GT(num_told_apart, 0.95 * num);
  EXPECT_GT(num_in_gauge, 10);
}

}  // namespace
}  // namespace railcast
