#include "core/track/track_survey.h"

#include <gtest/gtest.h>

#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "tests/core/io/message_of.h"
#include "tests/core/track/bars.h"

namespace railcast {
namespace {

/// Clouds of bars as a recording.
class BarRecording final : public Recording {
 public:
  explicit BarRecording(std::vector<std::vector<Bar>> frames)
      : frames_(frames.begin(), frames.end()) {
    info_.source = "bars";
  }
  [[nodiscard]] const RecordingInfo& info() const override { return info_; }
  [[nodiscard]] std::optional<FrameReader> Next() override {
    if (frames_.empty()) return std::nullopt;
    const std::vector<Bar> bars = frames_.front();
    frames_.pop_front();
    return [bars] {
      RecordedFrame recorded;
      Frame& frame = recorded.frame;
      for (const Eigen::Vector3f& point_m : PointsOfBars(2.5, bars)) {
        frame.x.push_back(point_m.x());
        frame.y.push_back(point_m.y());
        frame.z.push_back(point_m.z());
      }
      frame.rows = 1;
      frame.columns = static_cast<std::uint32_t>(frame.x.size());
      frame.returns = 1;
      return recorded;
    };
  }

 private:
  std::deque<std::vector<Bar>> frames_;
  RecordingInfo info_;
};

std::vector<Bar> TrackAt(double left_m) {
  constexpr double kHalf_m = 0.5 * (1.435 + kHeadWidth_m);
  return {{left_m + kHalf_m, kHeadWidth_m, 0.17}, {left_m - kHalf_m, kHeadWidth_m, 0.17}};
}

std::vector<Bar> Both(std::vector<Bar> a, const std::vector<Bar>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TrackSurvey Survey(std::vector<std::vector<Bar>> frames) {
  BarRecording recording(std::move(frames));
  return SurveyTracks(recording, {}, [](std::size_t) {});
}

TEST(TrackSurvey, TakesTheTrackThatMostFramesShow) {
  // One frame shows only another track, and one none.
  const TrackSurvey survey = Survey({TrackAt(0.2), TrackAt(0.2), TrackAt(4.0), {}, TrackAt(0.2)});
  ASSERT_EQ(survey.frames.size(), 5U);
  EXPECT_EQ(survey.num_own, 3U);
  EXPECT_EQ(survey.frames[2].track(), nullptr);
  EXPECT_EQ(survey.frames[3].track(), nullptr);
  EXPECT_NEAR(survey.sideways_m.median.value, -0.2, 0.008);
  EXPECT_TRUE(survey.is_on_track());
  EXPECT_EQ(survey.Mount().position_m[0], 0.0);
  EXPECT_NEAR(survey.Mount().position_m[1], -0.2, 0.008);
  EXPECT_NEAR(survey.Mount().position_m[2], 2.33, 0.008);
}

TEST(TrackSurvey, SaysHowTheSensorSwaysAndDrifts) {
  std::vector<std::vector<Bar>> frames;
  for (int i = 0; i < 8; ++i) frames.push_back(TrackAt(0.01 * i));
  const TrackSurvey survey = Survey(frames);
  // From the mean of the first two to that of the last two; medians are the upper of two.
  EXPECT_NEAR(survey.sideways_m.drift, -0.06, 0.012);
  EXPECT_NEAR(survey.sideways_m.sway, 1.4826 * 0.02, 0.012);
  EXPECT_NEAR(survey.height_m.drift, 0.0, 0.004);
}

TEST(TrackSurvey, ListsFurtherTracksFromTheOwnOne) {
  const TrackSurvey survey =
      Survey({Both(TrackAt(0.5), TrackAt(5.0)), Both(TrackAt(0.5), TrackAt(5.0))});
  ASSERT_EQ(survey.OtherTracks_m().size(), 1U);
  EXPECT_NEAR(survey.OtherTracks_m().front(), 4.5, 0.02);
}

TEST(TrackSurvey, SaysThatTheSensorStandsBesideTheTrack) {
  EXPECT_FALSE(Survey({TrackAt(3.0)}).is_on_track());
}

TEST(TrackSurvey, RefusesRecordingsWithoutATrackAndSaysWhy) {
  EXPECT_EQ(MessageOf([] { (void)Survey({{}}); }),
            "bars: no frame shows a track: no pair of ridges stands out of the ground");
  EXPECT_EQ(MessageOf([] { (void)Survey({}); }), "bars: must hold a frame");
}

}  // namespace
}  // namespace railcast
