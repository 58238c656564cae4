#include "core/extras/packets/ouster/ouster_http.h"

#include <gtest/gtest.h>

#include "core/extras/packets/ouster/ouster_encoder.h"
#include "tests/support/ouster_metadata_text.h"

namespace railcast {
namespace {

class OusterHttp : public testing::Test {
 protected:
  [[nodiscard]] HttpAnswer Get(const std::string& target) const {
    return AnswerAsOuster(metadata_, {.method = "GET", .target = target, .body = {}});
  }
  [[nodiscard]] HttpAnswer Post(const std::string& body) const {
    return AnswerAsOuster(metadata_, {.method = "POST",
                                      .target = "/api/v1/sensor/config?staging=true&reinit=false",
                                      .body = body});
  }
  Json metadata_ = MetadataOfStream(MadeOusterMetadataText(), {0x7F000001, 7600});
};

TEST_F(OusterHttp, GivesTheMetadataAsAWholeAndSectionBySection) {
  const Json whole = Json::parse(Get("/api/v1/sensor/metadata").body);
  EXPECT_EQ(whole, metadata_);
  for (const auto& [name, section] : whole.items()) {
    EXPECT_EQ(Json::parse(Get("/api/v1/sensor/metadata/" + name).body), section) << name;
  }
  EXPECT_EQ(Get("/api/v1/sensor/metadata/none").status, 404U);
}

TEST_F(OusterHttp, SaysWhereThePacketsGo) {
  for (const char* const target : {"/api/v1/sensor/config", "/api/v1/sensor/config?staging=true",
                                   "/api/v1/sensor/cmd/get_config_param?args=active"}) {
    const Json config = Json::parse(Get(target).body);
    EXPECT_EQ(config["udp_dest"], "127.0.0.1");
    EXPECT_EQ(config["udp_port_lidar"], 7600);
    EXPECT_EQ(config["udp_port_imu"], 7503);
    EXPECT_EQ(config["lidar_mode"], "512x10");
  }
}

TEST_F(OusterHttp, SaysWhichFirmwareTheMetadataIsOf) {
  EXPECT_EQ(Get("/api/v1/system/firmware").body,
            R"({"fw":"ousteros-image-prod-bootes-v3.1.0+20240425131508"})");
  EXPECT_EQ(Get("/api/v1/user/data").body, R"("")");
}

TEST_F(OusterHttp, AcceptsAConfigurationThatIsSoAlready) {
  EXPECT_EQ(Post(R"({"udp_dest": "@auto"})").status, 200U);
  EXPECT_EQ(Post(R"({"lidar_mode": "512x10", "udp_port_lidar": 7600})").status, 200U);
  EXPECT_EQ(Get("/api/v1/sensor/cmd/set_config_param?args=lidar_mode+512x10").body,
            R"("set_config_param")");
  EXPECT_EQ(Get("/api/v1/sensor/cmd/set_config_param?args=.+%7B%22udp_port_imu%22%3A7503%7D").body,
            R"("set_config_param")");
  EXPECT_EQ(Get("/api/v1/sensor/cmd/reinitialize").body, "{}");
}

TEST_F(OusterHttp, SaysWhatOfAConfigurationIsOtherwise) {
  const HttpAnswer other = Post(R"({"lidar_mode": "1024x10"})");
  EXPECT_EQ(other.status, 400U);
  EXPECT_EQ(Json::parse(other.body)["error"],
            "lidar_mode must be \"512x10\", as railcast streams it (got \"1024x10\")");
  EXPECT_EQ(Json::parse(Post(R"({"speed": 1})").body)["error"],
            "speed must be left out, as railcast streams it (got 1)");
  EXPECT_EQ(Get("/api/v1/sensor/cmd/set_config_param?args=a%FF+%FE").status, 400U);
  EXPECT_EQ(Post("[1]").status, 400U);
  EXPECT_EQ(Post("{").status, 400U);
}

TEST_F(OusterHttp, KnowsNoOtherPlaces) {
  EXPECT_EQ(Get("/").status, 404U);
  EXPECT_EQ(Get("/api/v1/sensor/cmd/erase").status, 404U);
  EXPECT_EQ(
      AnswerAsOuster(metadata_, {.method = "DELETE", .target = "/api/v1/sensor/config", .body = {}})
          .status,
      405U);
}

// What firmware before 1.14 did not say is filled in.
TEST(MetadataOfStream, HasAllSectionsThatDriversExpect) {
  nlohmann::ordered_json flat = {{"prod_line", "OS-1-64"},
                                 {"lidar_mode", "1024x10"},
                                 {"beam_altitude_angles", {10.5, 0.25, -3.0}},
                                 {"beam_azimuth_angles", {3.1, 0.9, -3.2}}};
  const Json metadata = MetadataOfStream(flat.dump(), {0x0A000001, 7502});
  EXPECT_EQ(metadata["sensor_info"]["prod_line"], "OS-1-64");
  EXPECT_EQ(metadata["sensor_info"]["status"], "RUNNING");
  EXPECT_EQ(metadata["lidar_data_format"]["pixels_per_column"], 3);
  EXPECT_EQ(metadata["lidar_data_format"]["column_window"], Json({0, 1023}));
  EXPECT_EQ(metadata["lidar_data_format"]["pixel_shift_by_row"], Json({9, 3, -9}));
  EXPECT_EQ(metadata["config_params"]["udp_dest"], "10.0.0.1");
  EXPECT_EQ(metadata["lidar_intrinsics"]["lidar_to_sensor_transform"][11], 36.18);
  EXPECT_TRUE(metadata["calibration_status"].is_object());
  // And it reads back as it was.
  const OusterMetadata before = ParseOusterMetadata(flat.dump());
  const OusterMetadata after = ParseOusterMetadata(metadata.dump());
  EXPECT_EQ(after.beam_origin_m, before.beam_origin_m);
  EXPECT_EQ(after.column_window, before.column_window);
  EXPECT_TRUE(after.sensor_from_imu.isApprox(before.sensor_from_imu));
}

}  // namespace
}  // namespace railcast
