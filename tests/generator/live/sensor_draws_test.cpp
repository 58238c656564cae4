// Sensors of one vehicle draw independently, also when they are streamed.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "railcast/io/stream.h"
#include "railcast/outcome.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/live/live_process.h"

namespace railcast {
namespace {

constexpr double kLost = 0.3;

// Sensors "left" and "right" in one place, over open ground in heavy rain, that lose pulses and err
// in range. The channels' constant errors are off: they would correlate the errors of a channel.
std::filesystem::path TwoSensors(const std::filesystem::path& folder) {
  const auto lidar = [](const std::string& name) {
    return R"({"name": ")" + name + R"(", "mount": {"position_m": [2, 0, 2.5]},
      "plausibility": {"dropout_probability": )" +
           std::to_string(kLost) + R"(},
      "receiver": {"clutter_gain": 1, "channel_bias_sigma_m": 0},
      "scan": {"rate_hz": 20, "pattern": {"type": "raster", "horizontal_fov_deg": 60,
               "vertical_fov_deg": 30, "angular_resolution_deg": 0.5}}})";
  };
  const auto file = folder / "two.json";
  WriteFileWhole(file, R"({"version": 1, "fidelity": "surface",
    "lidars": [)" + lidar("left") +
                           ", " + lidar("right") + R"(],
    "weather": {"rain_rate_mmph": 50},
    "world": {"alignment": {"course": {"type": "elements",
                                       "elements": [{"type": "straight", "length_m": 600}]}}},
    "vehicle": {"start_s_m": 200, "motion": {"profile": [{"time_s": 0, "speed_mps": 10}]}},
    "materials": ")" + kScenariosFolder +
                           R"(materials/railway.json",
    "labels": ")" + kScenariosFolder +
                           R"(labels.json"
  })");
  return file;
}

const std::string kOptions =
    " --duration 0.2 --pacing burst --all-slots --fields "
    "x,y,z,range_m,true_range_m,power_ratio,outcome,label";

std::vector<ReceivedFrame> FourFrames(StreamReceiver& receiver) {
  std::vector<ReceivedFrame> frames;
  while (frames.size() < 4) {
    auto frame = receiver.Next(kPatience_ms);
    if (!frame || !frame->is_complete()) {
      ADD_FAILURE() << "frame " << frames.size() << " has not arrived whole";
      break;
    }
    frames.push_back(std::move(*frame));
  }
  return frames;
}

// Both sensors' frames, streamed at once.
struct Pair {
  std::vector<ReceivedFrame> left, right;
};

Pair StreamTogether(const std::filesystem::path& scenario, const std::filesystem::path& folder) {
  StreamReceiver left(kAnyLoopbackPort);
  StreamReceiver right(kAnyLoopbackPort);
  const auto file = folder / "streamed.json";
  WriteFileWhole(file, R"({"version": 1, "file": ")" + scenario.string() +
                           R"(", "interfaces": {"sensors": [
    {"sensor": "left", "udp": [")" +
                           EndpointText(left.at()) + R"("]},
    {"sensor": "right", "udp": [")" +
                           EndpointText(right.at()) + R"("]}]}})");
  Stream stream(file.string() + kOptions);
  Pair pair{FourFrames(left), FourFrames(right)};
  const Ended ended = stream.Wait();
  EXPECT_EQ(ended.status, 0) << ended.said;
  return pair;
}

float ValueOf(const ReceivedFrame& frame, const char* field, std::size_t slot) {
  return frame.At<float>(*frame.header.Find(field), slot);
}
Outcome OutcomeIn(const ReceivedFrame& frame, std::size_t slot) {
  return static_cast<Outcome>(frame.At<std::uint8_t>(*frame.header.Find("outcome"), slot));
}
double ErrorIn(const ReceivedFrame& frame, std::size_t slot) {
  return static_cast<double>(ValueOf(frame, "range_m", slot)) -
         static_cast<double>(ValueOf(frame, "true_range_m", slot));
}

TEST(StreamedSensors, DrawIndependently) {
  const TemporaryDirectory folder;
  const Pair pair = StreamTogether(TwoSensors(folder.path()), folder.path());
  ASSERT_EQ(pair.left.size(), 4U);
  ASSERT_EQ(pair.right.size(), 4U);
  double num = 0.0, lost_both = 0.0, clutter_both = 0.0, clutter_same = 0.0;
  double num_errors = 0.0, product = 0.0, squares_left = 0.0, squares_right = 0.0;
  for (std::size_t f = 0; f < 4; ++f) {
    const ReceivedFrame& left = pair.left[f];
    const ReceivedFrame& right = pair.right[f];
    ASSERT_EQ(left.num_points(), right.num_points());
    for (std::size_t slot = 0; slot < left.num_points(); ++slot) {
      num += 1.0;
      const Outcome outcome = OutcomeIn(left, slot);
      if (OutcomeIn(right, slot) != outcome) continue;
      lost_both += outcome == Outcome::kSensorDropout ? 1.0 : 0.0;
      if (outcome == Outcome::kClutter) {
        clutter_both += 1.0;
        clutter_same += ValueOf(left, "true_range_m", slot) == ValueOf(right, "true_range_m", slot);
      } else if (outcome == Outcome::kReturned) {
        const double a = ErrorIn(left, slot);
        const double b = ErrorIn(right, slot);
        num_errors += 1.0;
        product += a * b;
        squares_left += a * a;
        squares_right += b * b;
      }
    }
  }
  ASSERT_GT(num_errors, 1000.0);
  EXPECT_NEAR(product / std::sqrt(squares_left * squares_right), 0.0, 4.0 / std::sqrt(num_errors));
  const double p = kLost * kLost;
  EXPECT_NEAR(lost_both, p * num, 4.0 * std::sqrt(num * p * (1.0 - p)));
  EXPECT_GT(clutter_both, 10.0);
  EXPECT_EQ(clutter_same, 0.0);
}

TEST(StreamedSensors, GiveTheSamePointsAloneAndBesideOthers) {
  const TemporaryDirectory folder;
  const auto scenario = TwoSensors(folder.path());
  const Pair pair = StreamTogether(scenario, folder.path());
  ASSERT_EQ(pair.left.size(), 4U);
  ASSERT_EQ(pair.right.size(), 4U);
  for (const auto& [name, together, other] : {std::tuple("left", &pair.left, &pair.right),
                                              std::tuple("right", &pair.right, &pair.left)}) {
    StreamReceiver receiver(kAnyLoopbackPort);
    Stream stream(scenario.string() + kOptions + " --sensor " + name + " --to " +
                  EndpointText(receiver.at()));
    const std::vector<ReceivedFrame> alone = FourFrames(receiver);
    const Ended ended = stream.Wait();
    EXPECT_EQ(ended.status, 0) << ended.said;
    ASSERT_EQ(alone.size(), 4U);
    for (std::size_t f = 0; f < 4; ++f) {
      EXPECT_TRUE(alone[f].points == (*together)[f].points) << name << " " << f;
      EXPECT_FALSE(alone[f].points == (*other)[f].points) << name << " " << f;
    }
  }
}

}  // namespace
}  // namespace railcast
