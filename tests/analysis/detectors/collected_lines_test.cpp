#include <gtest/gtest.h>

#include <string>

#include "analysis/detectors/reported_detections.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

std::string CollectedLine(int frame, const std::string& detections = "") {
  return "{\"frame\": " + std::to_string(frame) + ", \"detections\": [" + detections + "]}";
}

TEST(CollectedLines, StandByRisingFrameInWhateverOrderTheyCome) {
  CollectedLines collected;
  collected.Take(CollectedLine(7) + "\n", "peer");
  collected.Take(CollectedLine(4), "peer");
  collected.Take(CollectedLine(5, R"({"points": [3]})") + "\r\n", "other");
  EXPECT_EQ(collected.num_frames(), 3U);
  EXPECT_EQ(collected.Text(), CollectedLine(4) + "\n" + CollectedLine(5, R"({"points": [3]})") +
                                  "\n" + CollectedLine(7) + "\n");
  EXPECT_EQ(ReadDetectionLines(collected.Text(), "d.jsonl").size(), 3U);
  EXPECT_EQ(collected.Summary(), "frames: 3, from 4 to 7, 1 missing between; 0 repeated datagrams");
}

TEST(CollectedLines, MayBeRepeatedButNotContradicted) {
  CollectedLines collected;
  collected.Take(CollectedLine(4), "peer");
  collected.Take(CollectedLine(4) + "\n", "peer");
  EXPECT_EQ(
      MessageOf([&] { collected.Take(CollectedLine(4, R"({"points": [3]})"), "127.0.0.1:9"); }),
      "127.0.0.1:9: /frame: must be that of one line only (got 4)");
  EXPECT_EQ(collected.Text(), CollectedLine(4) + "\n");
  EXPECT_EQ(collected.Summary(), "frames: 1, from 4 to 4, 0 missing between; 1 repeated datagrams");
}

TEST(CollectedLines, AreReadStrictlyAndNothingIsTakenOfAFaultyOne) {
  CollectedLines collected;
  const auto fault = [&](const std::string& datagram) {
    return MessageOf([&] { collected.Take(datagram, "127.0.0.1:9"); });
  };
  EXPECT_EQ(fault(CollectedLine(1, R"({"points": []})")),
            "127.0.0.1:9: /detections/0/points: must not be empty (got [])");
  EXPECT_EQ(fault("{\"frame\": 1}"), "127.0.0.1:9: /detections: missing");
  EXPECT_EQ(fault(CollectedLine(1) + "\n" + CollectedLine(2)),
            "127.0.0.1:9: must send one line in each datagram (got {\"frame\": 1, "
            "\"detections\": []}\\n{\"frame\": 2, \"detections\": [...)");
  EXPECT_EQ(fault(""), "127.0.0.1:9: is empty");
  EXPECT_EQ(fault("[1]"), "127.0.0.1:9: must be an object (got [1])");
  EXPECT_EQ(collected.num_frames(), 0U);
  EXPECT_EQ(collected.Text(), "");
  EXPECT_EQ(collected.Summary(), "frames: 0; 0 repeated datagrams");
}

}  // namespace
}  // namespace railcast
