// Captures of Ouster's sensors as recordings, with the metadata that stands beside them.
#include <gtest/gtest.h>

#include <cmath>

#include "core/extras/packets/recording/capture_recording.h"
#include "core/io/write_file.h"
#include "core/scenario/sensors.h"
#include "railcast/io/recording.h"
#include "tests/core/extras/packets/ouster/shared_captures.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/captures.h"
#include "tests/support/made_datagrams.h"
#include "tests/support/ouster_metadata_text.h"

namespace railcast {
namespace {

std::size_t NumOusterPoints(const Frame& frame) {
  std::size_t num = 0;
  for (const float x : frame.x) num += std::isnan(x) ? 0 : 1;
  return num;
}

// Found under the capture's name, under a shorter one, and under that of Ouster's programs.
TEST(OusterRecording, FindsItsMetadataBesideTheCapture) {
  for (const std::size_t i : {0U, 2U, 8U}) {
    const OusterCapture& capture = kOusterCaptures[i];
    if (!capture.is_there()) GTEST_SKIP() << capture.pcap << " is not there";
    EXPECT_EQ(OpenRecording(OusterCapture::Path(capture.pcap))->info().kind,
              "capture of " + capture.metadata().product_line);
  }
}

TEST(OusterRecording, HasAGridOfBeamsAndColumnsWithAllThatPixelsSay) {
  if (!kOs2Capture.is_there()) GTEST_SKIP() << kOs2Capture.pcap << " is not there";
  const auto frames = ReadAll(OusterCapture::Path(kOs2Capture.pcap));
  ASSERT_EQ(frames.size(), 1U);
  const RecordedFrame& recorded = frames[0];
  const Frame& frame = recorded.frame;
  EXPECT_TRUE(recorded.is_grid);
  EXPECT_EQ(frame.rows, 128U);
  EXPECT_EQ(frame.columns, 1024U);
  EXPECT_EQ(frame.returns, 1U);
  EXPECT_TRUE(recorded.Has("time_ns"));
  EXPECT_NEAR(frame.duration_ns, 1e8 * 1023 / 1024, 3e5);
  ASSERT_EQ(recorded.foreign.size(), 2U);
  EXPECT_EQ(recorded.foreign[0].name, "signal");
  EXPECT_EQ(recorded.foreign[1].name, "near_ir");
  // As many points as the packets have ranges.
  const OusterLayout layout(kOs2Capture.metadata());
  std::size_t num_ranges = 0;
  for (const std::vector<char>& packet : LidarPacketsOf(kOs2Capture)) {
    for (std::size_t i = 0; i < 16 * layout.num_pixels(); ++i) {
      num_ranges += layout.PixelOf(packet, i / 128, i % 128).returns[0].range_mm > 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(NumOusterPoints(frame), num_ranges);
}

TEST(OusterRecording, TakesTheMetadataThatAreNamedBehindTheCapture) {
  if (!kOs2Capture.is_there()) GTEST_SKIP() << kOs2Capture.pcap << " is not there";
  const TemporaryDirectory folder;
  const auto capture = folder.path() / "a:b.pcap";
  std::filesystem::copy_file(OusterCapture::Path(kOs2Capture.pcap), capture);
  const std::string source =
      capture.string() + ":" + OusterCapture::Path(kOs2Capture.json).string();
  const auto recording = OpenRecording(source);
  EXPECT_EQ(recording->info().source, source) << "it can be opened again";
  EXPECT_EQ(ReadAll(*recording).size(), 1U);
  EXPECT_EQ(MessageOf([&] { static_cast<void>(OpenRecording(capture.string() + ":none")); }),
            "none: no such file or directory");
}

// Nearly all of them are above 255.
TEST(OusterRecording, OfFirmwareBefore2_1HasIntensitiesOfUnknownScale) {
  const OusterCapture& capture = kOusterCaptures[5];
  if (!capture.is_there()) GTEST_SKIP() << capture.pcap << " is not there";
  const auto frames = ReadAll(OusterCapture::Path(capture.pcap));
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_FALSE(frames[0].Has("intensity"));
  ASSERT_EQ(frames[0].foreign.size(), 3U);
  EXPECT_EQ(frames[0].foreign[2].name, "intensity_16_bit");
  std::size_t num_above = 0;
  for (std::size_t i = 0; i < frames[0].frame.num_slots(); ++i) {
    ASSERT_TRUE(std::isnan(frames[0].frame.intensity[i]));
    num_above += frames[0].foreign[2].values[i] > 255.0F ? 1 : 0;
  }
  EXPECT_GT(100 * num_above, 95 * NumOusterPoints(frames[0].frame));
}

class MadeOusterCapture : public testing::Test {
 protected:
  /// Writes a capture of datagrams of these sizes, each of which begins as a lidar packet.
  void WriteCapture(const std::vector<std::size_t>& sizes) const {
    Datagrams datagrams;
    for (const std::size_t size : sizes) {
      AddDatagram("\1" + std::string(size - 1, '\0'), datagrams);
    }
    WriteDatagrams(file(), datagrams, kOusterLidarPort, kOusterImuPort);
  }
  [[nodiscard]] std::string FaultOfCapture() const {
    std::string message = MessageOf([&] { static_cast<void>(OpenRecording(file())); });
    const std::string folder = directory_.path().string() + "/";
    for (std::size_t at = message.find(folder); at != std::string::npos;
         at = message.find(folder)) {
      message.erase(at, folder.size());
    }
    return message;
  }
  void WriteMetadata(const std::string& name, const std::string& text) const {
    WriteFileWhole(directory_.path() / name, text);
  }
  [[nodiscard]] std::filesystem::path file() const { return directory_.path() / "drive.pcap"; }

 private:
  TemporaryDirectory directory_;
};

TEST_F(MadeOusterCapture, WithoutMetadataSaysWhatIsMissing) {
  WriteCapture({48, 24'832});
  EXPECT_EQ(FaultOfCapture(),
            "drive.pcap: must be a capture of " + ReadableSensorsText() +
                " (got packets of 24832 bytes of an Ouster sensor, whose metadata must stand "
                "beside the capture)");
}

TEST_F(MadeOusterCapture, WithMetadataOfAnotherModelSaysWhatDiffers) {
  WriteCapture({48, 24'832});
  WriteMetadata("drive.json", MadeOusterMetadataText());
  EXPECT_EQ(FaultOfCapture(),
            "drive.pcap: packets are not of the sensor of drive.json: must be 1024 bytes "
            "(got 24832)");
  // The same size, but of another sensor.
  WriteCapture({8448});
  nlohmann::ordered_json metadata = MadeOusterMetadata("RNG15_RFL8_NIR8");
  metadata["lidar_data_format"]["pixels_per_column"] = 128;
  metadata["beam_intrinsics"]["beam_altitude_angles"] = std::vector<double>(128, 1.0);
  metadata["beam_intrinsics"]["beam_azimuth_angles"] = std::vector<double>(128, 1.0);
  WriteMetadata("drive.json", metadata.dump());
  EXPECT_EQ(FaultOfCapture(),
            "drive.pcap: packets are not of the sensor of drive.json: serial number must "
            "be 122201000998 (got 0)");
}

TEST_F(MadeOusterCapture, WithFaultyMetadataSaysWhatIsWrongWithThem) {
  WriteCapture({24'832});
  WriteMetadata("drive.json", R"({"lidar_mode": "1024x10"})");
  EXPECT_EQ(FaultOfCapture(),
            "drive.json: /beam_altitude_angles: missing\n"
            "drive.json: /beam_azimuth_angles: missing");
  WriteMetadata("drive.json", std::string(2'000'000, ' '));
  EXPECT_EQ(FaultOfCapture(), "drive.json: must have at most 1048576 bytes (got 2000000)");
}

}  // namespace
}  // namespace railcast
