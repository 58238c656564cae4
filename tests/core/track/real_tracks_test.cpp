#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/track/track_survey.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

/// A frame of a real railway, and what is known of its track by hand.
struct RealFrame {
  std::string file;
  double height_m{}, aside_m{};  ///< Of the sensor.
};

// Source: luckyLukac/SymmetryRailwayDetection, University of Maribor; measured here, not shipped.
class RealTracks : public testing::TestWithParam<RealFrame> {};

TEST_P(RealTracks, LieWhereTheyWereMeasuredByHand) {
  const RealFrame& frame = GetParam();
  const std::filesystem::path file =
      std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / "railway_frames" / frame.file;
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const auto recording = OpenRecording(file);
  const FoundTracks found = FindTracks((*recording->Next())(), std::nullopt);
  ASSERT_FALSE(found.tracks.empty()) << found.why_not;
  const FoundTrack& track = found.tracks.front();
  EXPECT_NEAR(track.gauge_m.value, 1.435, 0.02);
  EXPECT_NEAR(track.height_m.value, frame.height_m, 0.03);
  EXPECT_NEAR(std::abs(track.sideways_m.value), frame.aside_m, 0.06);
}

INSTANTIATE_TEST_SUITE_P(Frames,
                         RealTracks,
                         testing::Values(RealFrame{"Vizmarje.pc", 4.14, 2.69},
                                         RealFrame{"Vizmarje2.pc", 4.14, 2.69},
                                         RealFrame{"Vizmarje3.pc", 4.14, 2.69},
                                         RealFrame{"Jesenice1.pc", 5.04, 1.62},
                                         RealFrame{"Jesenice2.pc", 5.04, 1.62},
                                         RealFrame{"JesenicePartialObstacle.pc", 5.04, 1.60},
                                         RealFrame{"Vienna.csv", 4.11, 1.61}),
                         [](const auto& frame) {
                           return frame.param.file.substr(0, frame.param.file.find('.'));
                         });

}  // namespace
}  // namespace railcast
