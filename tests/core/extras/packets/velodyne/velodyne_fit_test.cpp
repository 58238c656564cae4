#include "core/extras/packets/spinning/spinning_encoder.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/core/io/message_of.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

/// Returns the encoder's error for a sensor's scan after a change.
std::string FitSaid(std::string_view format,
                    const std::string& sensor,
                    const std::function<void(SpinningSpec&)>& change,
                    ReturnMode return_mode = ReturnMode::kStrongest) {
  ScanSpec scan = ReadSensor(sensor);
  change(std::get<SpinningSpec>(scan.pattern));
  return MessageOf(
      [&] { (void)MakeSpinningEncoder(*FindSpinningModel(format), scan, return_mode); });
}
void Nothing(SpinningSpec& /*unused*/) {}

TEST(VelodyneFit, TakesTheSensorsThatShip) {
  EXPECT_EQ(FitSaid("vlp16", "vlp16", Nothing), "no error");
  EXPECT_EQ(FitSaid("vlp16", "vlp16_20hz", Nothing, ReturnMode::kLast), "no error");
  EXPECT_EQ(FitSaid("vlp16-dual", "vlp16", Nothing, ReturnMode::kDual), "no error");
  EXPECT_EQ(FitSaid("hdl32e", "hdl32e", Nothing), "no error");
  EXPECT_EQ(FitSaid("vlp32c", "vlp32c", Nothing), "no error");
  EXPECT_EQ(FitSaid("vls128", "vls128", Nothing), "no error");
  EXPECT_EQ(FitSaid("hdl64e", "hdl64e", Nothing), "no error");
}

TEST(VelodyneFit, SaysWhatDoesNotFit) {
  EXPECT_EQ(FitSaid("hdl32e", "vlp16", Nothing),
            "--protocol hdl32e: /lidar/scan/pattern/channels: must be 32 as HDL-32E has (got 16)");
  EXPECT_EQ(FitSaid("vlp32c", "hdl32e", Nothing),
            "--protocol vlp32c: /lidar/scan/pattern/cycle_us: must be 55.296 as of VLP-32C (got "
            "46.08)");
  EXPECT_EQ(
      FitSaid("vlp16", "vlp16", [](auto& scan) { scan.rotation = Rotation::kCounterclockwise; }),
      "--protocol vlp16: /lidar/scan/pattern/rotation: must be \"clockwise\" (got "
      "\"counterclockwise\")");
  EXPECT_EQ(FitSaid("vlp16", "vlp16", [](auto& scan) { scan.channels[3].elevation_deg = 3.02; }),
            "--protocol vlp16: /lidar/scan/pattern/channels/3/elevation_deg: must be 3 as of "
            "VLP-16 (got 3.02)");
  EXPECT_EQ(FitSaid("vlp16", "vlp16", [](auto& scan) { scan.channels[3].elevation_deg = 3.009; }),
            "no error");
  EXPECT_EQ(FitSaid("vlp32c", "vlp32c", [](auto& scan) { scan.channels[1].azimuth_deg = 4.2; }),
            "--protocol vlp32c: /lidar/scan/pattern/channels/1/azimuth_deg: must be -4.2 as of "
            "VLP-32C (got 4.2)");
  EXPECT_EQ(FitSaid("vlp16", "vlp16", [](auto& scan) { scan.channels[1].time_us = 2.4; }),
            "--protocol vlp16: /lidar/scan/pattern/channels/1/time_us: must be 2.304 as of VLP-16 "
            "(got 2.4)");
}

TEST(VelodyneFit, WantsTheCyclesOfAWholeTurn) {
  EXPECT_EQ(FitSaid("vlp16", "vlp16", [](auto& scan) { scan.columns = 300; }),
            "--protocol vlp16: /lidar/scan/pattern/columns: must be 1808, a whole turn (got 300)");
  // With two cycles per block, an odd cycle would have to wait for the next turn.
  ScanSpec scan = ReadSensor("vlp16");
  scan.rate_hz = 15.0;
  std::get<SpinningSpec>(scan.pattern).columns = 1205;
  EXPECT_EQ(MessageOf([&] {
              (void)MakeSpinningEncoder(*FindSpinningModel("vlp16"), scan, ReturnMode::kStrongest);
            }),
            "--protocol vlp16: /lidar/scan/pattern/columns: must be 1204, a whole turn (got 1205)");
}

TEST(VelodyneFit, WantsTheReturnsOfTheFormat) {
  EXPECT_EQ(FitSaid("vlp16-dual", "vlp16", Nothing, ReturnMode::kStrongest),
            "--protocol vlp16-dual: /lidar/receiver/return_mode: must be \"dual\" (got "
            "\"strongest\")");
  EXPECT_EQ(FitSaid("vlp16", "vlp16", Nothing, ReturnMode::kDual),
            "--protocol vlp16: /lidar/receiver/return_mode: must be \"strongest\" or \"last\" (got "
            "\"dual\")");
}

TEST(VelodyneFit, WantsASpinningSensor) {
  const ScanSpec raster{.rate_hz = 10.0, .pattern = RasterSpec{60.0, 30.0, 0.25}};
  EXPECT_EQ(MessageOf([&] {
              (void)MakeSpinningEncoder(*FindSpinningModel("vlp16"), raster,
                                        ReturnMode::kStrongest);
            }),
            "--protocol vlp16: /lidar/scan/pattern/type: must be \"spinning\"");
}

TEST(VelodyneFit, LetsHdl64eHaveAnyAnglesAndCycle) {
  EXPECT_EQ(FitSaid("hdl64e", "hdl64e",
                    [](auto& scan) {
                      scan.cycle_us = 57.6;
                      scan.columns = 1736;
                      scan.channels[5] = {
                          .elevation_deg = 40.0, .azimuth_deg = -90.0, .time_us = 5.0};
                    }),
            "no error");
}

}  // namespace
}  // namespace railcast
