#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/message_type.h"

// Messages of ROS 2's package sensor_msgs. VisitFields() as in geometry_messages.h.

namespace railcast::ros {

struct PointField {
  static constexpr std::string_view kName = "sensor_msgs/msg/PointField";
  static constexpr std::uint8_t kInt8 = 1;
  static constexpr std::uint8_t kUint8 = 2;
  static constexpr std::uint8_t kInt16 = 3;
  static constexpr std::uint8_t kUint16 = 4;
  static constexpr std::uint8_t kInt32 = 5;
  static constexpr std::uint8_t kUint32 = 6;
  static constexpr std::uint8_t kFloat32 = 7;
  static constexpr std::uint8_t kFloat64 = 8;
  static constexpr auto kConstants = std::to_array<MessageConstant>({
      {"uint8", "INT8", kInt8},
      {"uint8", "UINT8", kUint8},
      {"uint8", "INT16", kInt16},
      {"uint8", "UINT16", kUint16},
      {"uint8", "INT32", kInt32},
      {"uint8", "UINT32", kUint32},
      {"uint8", "FLOAT32", kFloat32},
      {"uint8", "FLOAT64", kFloat64},
  });
  std::string name;
  std::uint32_t offset{};   ///< Bytes from the beginning of a point.
  std::uint8_t datatype{};  ///< One of the constants.
  std::uint32_t count{};

  static void VisitFields(auto& self, auto&& visit) {
    visit("name", self.name);
    visit("offset", self.offset);
    visit("datatype", self.datatype);
    visit("count", self.count);
  }
  bool operator==(const PointField&) const = default;
};

struct PointCloud2 {
  static constexpr std::string_view kName = "sensor_msgs/msg/PointCloud2";
  Header header;
  std::uint32_t height{};  ///< 1 = unorganised.
  std::uint32_t width{};
  std::vector<PointField> fields;
  bool is_bigendian{};
  std::uint32_t point_step{};  ///< Bytes of a point.
  std::uint32_t row_step{};    ///< Bytes of a row.
  std::vector<std::uint8_t> data;
  bool is_dense{};  ///< Whether no point is invalid (NaN).

  static void VisitFields(auto& self, auto&& visit) {
    visit("header", self.header);
    visit("height", self.height);
    visit("width", self.width);
    visit("fields", self.fields);
    visit("is_bigendian", self.is_bigendian);
    visit("point_step", self.point_step);
    visit("row_step", self.row_step);
    visit("data", self.data);
    visit("is_dense", self.is_dense);
  }
  bool operator==(const PointCloud2&) const = default;
};

struct Imu {
  static constexpr std::string_view kName = "sensor_msgs/msg/Imu";
  Header header;
  Quaternion orientation;
  /// As all covariances here: rows of x, y, z; 0 = unknown, first element -1 = not measured.
  std::array<double, 9> orientation_covariance{};
  RosVector3 angular_velocity;
  std::array<double, 9> angular_velocity_covariance{};
  RosVector3 linear_acceleration;
  std::array<double, 9> linear_acceleration_covariance{};

  static void VisitFields(auto& self, auto&& visit) {
    visit("header", self.header);
    visit("orientation", self.orientation);
    visit("orientation_covariance", self.orientation_covariance);
    visit("angular_velocity", self.angular_velocity);
    visit("angular_velocity_covariance", self.angular_velocity_covariance);
    visit("linear_acceleration", self.linear_acceleration);
    visit("linear_acceleration_covariance", self.linear_acceleration_covariance);
  }
  bool operator==(const Imu&) const = default;
};

struct NavSatStatus {
  static constexpr std::string_view kName = "sensor_msgs/msg/NavSatStatus";
  static constexpr std::int8_t kNoFix = -1;
  static constexpr std::int8_t kFix = 0;
  static constexpr std::uint16_t kGps = 1;
  static constexpr auto kConstants = std::to_array<MessageConstant>({
      {"int8", "STATUS_NO_FIX", kNoFix},
      {"int8", "STATUS_FIX", kFix},
      {"int8", "STATUS_SBAS_FIX", 1},
      {"int8", "STATUS_GBAS_FIX", 2},
      {"uint16", "SERVICE_GPS", kGps},
      {"uint16", "SERVICE_GLONASS", 2},
      {"uint16", "SERVICE_COMPASS", 4},
      {"uint16", "SERVICE_GALILEO", 8},
  });
  std::int8_t status{};
  std::uint16_t service{};

  static void VisitFields(auto& self, auto&& visit) {
    visit("status", self.status);
    visit("service", self.service);
  }
  bool operator==(const NavSatStatus&) const = default;
};

struct NavSatFix {
  static constexpr std::string_view kName = "sensor_msgs/msg/NavSatFix";
  static constexpr std::uint8_t kCovarianceUnknown = 0;
  static constexpr std::uint8_t kCovarianceApproximated = 1;
  static constexpr std::uint8_t kCovarianceDiagonalKnown = 2;
  static constexpr std::uint8_t kCovarianceKnown = 3;
  static constexpr auto kConstants = std::to_array<MessageConstant>({
      {"uint8", "COVARIANCE_TYPE_UNKNOWN", kCovarianceUnknown},
      {"uint8", "COVARIANCE_TYPE_APPROXIMATED", kCovarianceApproximated},
      {"uint8", "COVARIANCE_TYPE_DIAGONAL_KNOWN", kCovarianceDiagonalKnown},
      {"uint8", "COVARIANCE_TYPE_KNOWN", kCovarianceKnown},
  });
  Header header;
  NavSatStatus status;
  double latitude{};                            ///< Degrees, WGS 84, north positive.
  double longitude{};                           ///< Degrees, WGS 84, east positive.
  double altitude{};                            ///< Metres above the ellipsoid.
  std::array<double, 9> position_covariance{};  ///< m^2; east, north, up.
  std::uint8_t position_covariance_type{};

  static void VisitFields(auto& self, auto&& visit) {
    visit("header", self.header);
    visit("status", self.status);
    visit("latitude", self.latitude);
    visit("longitude", self.longitude);
    visit("altitude", self.altitude);
    visit("position_covariance", self.position_covariance);
    visit("position_covariance_type", self.position_covariance_type);
  }
  bool operator==(const NavSatFix&) const = default;
};

struct Image {
  static constexpr std::string_view kName = "sensor_msgs/msg/Image";
  Header header;
  std::uint32_t height{};
  std::uint32_t width{};
  std::string encoding;  ///< "rgb8"
  std::uint8_t is_bigendian{};
  std::uint32_t step{};  ///< Bytes of a row.
  std::vector<std::uint8_t> data;

  static void VisitFields(auto& self, auto&& visit) {
    visit("header", self.header);
    visit("height", self.height);
    visit("width", self.width);
    visit("encoding", self.encoding);
    visit("is_bigendian", self.is_bigendian);
    visit("step", self.step);
    visit("data", self.data);
  }
  bool operator==(const Image&) const = default;
};

struct CompressedImage {
  static constexpr std::string_view kName = "sensor_msgs/msg/CompressedImage";
  Header header;
  std::string format;  ///< "jpeg" or "png"
  std::vector<std::uint8_t> data;

  static void VisitFields(auto& self, auto&& visit) {
    visit("header", self.header);
    visit("format", self.format);
    visit("data", self.data);
  }
  bool operator==(const CompressedImage&) const = default;
};

struct RegionOfInterest {
  static constexpr std::string_view kName = "sensor_msgs/msg/RegionOfInterest";
  std::uint32_t x_offset{};
  std::uint32_t y_offset{};
  std::uint32_t height{};
  std::uint32_t width{};
  bool do_rectify{};

  static void VisitFields(auto& self, auto&& visit) {
    visit("x_offset", self.x_offset);
    visit("y_offset", self.y_offset);
    visit("height", self.height);
    visit("width", self.width);
    visit("do_rectify", self.do_rectify);
  }
  bool operator==(const RegionOfInterest&) const = default;
};

struct CameraInfo {
  static constexpr std::string_view kName = "sensor_msgs/msg/CameraInfo";
  Header header;
  std::uint32_t height{};
  std::uint32_t width{};
  std::string distortion_model;  ///< "plumb_bob"
  std::vector<double> d;         ///< k1, k2, p1, p2, k3
  std::array<double, 9> k{};     ///< Pixels, by rows.
  std::array<double, 9> r{};     ///< Rectification.
  std::array<double, 12> p{};    ///< Projection of the rectified image.
  std::uint32_t binning_x{};
  std::uint32_t binning_y{};
  RegionOfInterest roi;

  static void VisitFields(auto& self, auto&& visit) {
    visit("header", self.header);
    visit("height", self.height);
    visit("width", self.width);
    visit("distortion_model", self.distortion_model);
    visit("d", self.d);
    visit("k", self.k);
    visit("r", self.r);
    visit("p", self.p);
    visit("binning_x", self.binning_x);
    visit("binning_y", self.binning_y);
    visit("roi", self.roi);
  }
  bool operator==(const CameraInfo&) const = default;
};

}  // namespace railcast::ros
