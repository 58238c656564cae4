#include "viewer/frames/frame_counter.h"

#include <gtest/gtest.h>

#include "tests/core/io/stream/live_stream.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/viewer/frames/made_capture.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

TEST(FrameCounter, CountsTheTurnsOfACapture) {
  const TemporaryDirectory directory;
  WriteCapture(directory.path() / "a.pcap", 12);
  const FrameCounter counter(directory.path() / "a.pcap");
  EXPECT_TRUE(Eventually([&] { return counter.num_counted() == 12; })) << counter.num_counted();
}

TEST(FrameCounter, EndsAtAnyTime) {
  const TemporaryDirectory directory;
  WriteCapture(directory.path() / "a.pcap", 12);
  for (int i = 0; i < 20; ++i) {
    const FrameCounter counter(directory.path() / "a.pcap");
    EXPECT_LE(counter.num_counted(), 12U);
  }
}

TEST(FrameCounter, CountsAsFarAsACaptureIsSound) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "a.pcap";
  WriteCapture(file, 12);
  fs::resize_file(file, fs::file_size(file) / 2);
  const FrameCounter counter(file);
  // The file holds half of twelve turns, the last of them cut short.
  EXPECT_TRUE(Eventually([&] { return counter.num_counted() >= 5; })) << counter.num_counted();
}

TEST(FrameCounter, CountsNothingOfWhatCannotBeRead) {
  const FrameCounter counter("/nowhere/a.pcap");
  EXPECT_EQ(counter.num_counted(), 0U);
}

}  // namespace
}  // namespace railcast
