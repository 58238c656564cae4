#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/message_type.h"

// Messages of ROS 2's package sensor_msgs. `kFields` as in geometry_messages.h.

namespace railcast::ros {

struct PointField {
  static constexpr std::string_view kName = "sensor_msgs/msg/PointField";
  static constexpr std::array kFields = {"name", "offset", "datatype", "count"};
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

  bool operator==(const PointField&) const = default;
};

struct PointCloud2 {
  static constexpr std::string_view kName = "sensor_msgs/msg/PointCloud2";
  static constexpr std::array kFields = {"header",   "height",       "width",
                                         "fields",   "is_bigendian", "point_step",
                                         "row_step", "data",         "is_dense"};
  Header header;
  std::uint32_t height{};  ///< 1 = unorganised.
  std::uint32_t width{};
  std::vector<PointField> fields;
  bool is_bigendian{};
  std::uint32_t point_step{};  ///< Bytes of a point.
  std::uint32_t row_step{};    ///< Bytes of a row.
  std::vector<std::uint8_t> data;
  bool is_dense{};  ///< Whether no point is invalid (NaN).

  bool operator==(const PointCloud2&) const = default;
};

struct Imu {
  static constexpr std::string_view kName = "sensor_msgs/msg/Imu";
  static constexpr std::array kFields = {"header",
                                         "orientation",
                                         "orientation_covariance",
                                         "angular_velocity",
                                         "angular_velocity_covariance",
                                         "linear_acceleration",
                                         "linear_acceleration_covariance"};
  Header header;
  Quaternion orientation;
  /// As all covariances here: rows of x, y, z; 0 = unknown, first element -1 = not measured.
  std::array<double, 9> orientation_covariance{};
  RosVector3 angular_velocity;
  std::array<double, 9> angular_velocity_covariance{};
  RosVector3 linear_acceleration;
  std::array<double, 9> linear_acceleration_covariance{};

  bool operator==(const Imu&) const = default;
};

struct NavSatStatus {
  static constexpr std::string_view kName = "sensor_msgs/msg/NavSatStatus";
  static constexpr std::array kFields = {"status", "service"};
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

  bool operator==(const NavSatStatus&) const = default;
};

struct NavSatFix {
  static constexpr std::string_view kName = "sensor_msgs/msg/NavSatFix";
  static constexpr std::array kFields = {"header",
                                         "status",
                                         "latitude",
                                         "longitude",
                                         "altitude",
                                         "position_covariance",
                                         "position_covariance_type"};
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

  bool operator==(const NavSatFix&) const = default;
};

struct Image {
  static constexpr std::string_view kName = "sensor_msgs/msg/Image";
  static constexpr std::array kFields = {"header",       "height", "width", "encoding",
                                         "is_bigendian", "step",   "data"};
  Header header;
  std::uint32_t height{};
  std::uint32_t width{};
  std::string encoding;  ///< "rgb8"
  std::uint8_t is_bigendian{};
  std::uint32_t step{};  ///< Bytes of a row.
  std::vector<std::uint8_t> data;

  bool operator==(const Image&) const = default;
};

struct CompressedImage {
  static constexpr std::string_view kName = "sensor_msgs/msg/CompressedImage";
  static constexpr std::array kFields = {"header", "format", "data"};
  Header header;
  std::string format;  ///< "jpeg" or "png"
  std::vector<std::uint8_t> data;

  bool operator==(const CompressedImage&) const = default;
};

struct RegionOfInterest {
  static constexpr std::string_view kName = "sensor_msgs/msg/RegionOfInterest";
  static constexpr std::array kFields = {"x_offset", "y_offset", "height", "width", "do_rectify"};
  std::uint32_t x_offset{};
  std::uint32_t y_offset{};
  std::uint32_t height{};
  std::uint32_t width{};
  bool do_rectify{};

  bool operator==(const RegionOfInterest&) const = default;
};

struct CameraInfo {
  static constexpr std::string_view kName = "sensor_msgs/msg/CameraInfo";
  static constexpr std::array kFields = {"header",    "height",    "width", "distortion_model",
                                         "d",         "k",         "r",     "p",
                                         "binning_x", "binning_y", "roi"};
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

  bool operator==(const CameraInfo&) const = default;
};

}  // namespace railcast::ros
