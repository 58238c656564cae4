#include "core/base/unread_formats.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/base/text_number.h"

namespace railcast {
namespace {

constexpr std::string_view kUnread = ", which is not read: ";

/// A format by the ending of its files, in lower case, or by their first bytes; either may be
/// empty.
struct UnreadFormat {
  std::string_view ending;
  std::string_view begin;
  std::string_view name;
  std::string_view advice;  ///< %f stands for the file's name, %n for it without ending.
};

constexpr auto kFormats = std::to_array<UnreadFormat>({
    {".bag", "#ROSBAG V", "a bag of ROS 1", "rosbags-convert --src %f --dst %n"},
    {".osf", "", "a recording of Ouster's SDK", "ouster-cli source %f save %n.pcap"},
    {".e57", "ASTM-E57", "a survey in E57", "pdal translate %f %n.las"},
    {".laz", "", "compressed LAS", "pdal translate %f %n.las (or las2las)"},
    {".lvx", "livox_tech", "a recording of Livox Viewer",
     "livox_ros_driver2 plays it as sensor_msgs/msg/PointCloud2 for ros2 bag record"},
    {".lvx2", "", "a recording of Livox Viewer",
     "livox_ros_driver2 plays it as sensor_msgs/msg/PointCloud2 for ros2 bag record"},
    {".drc", "DRACO", "a cloud compressed by Draco", "draco_decoder -i %f -o %n.ply"},
    {".npy", "\x93NUMPY", "an array of NumPy",
     "numpy.load('%f')[:, :4].astype('<f4').tofile('%n.bin'), with x, y, z and "
     "reflectance, makes it a file of KITTI's"},
    {".npz", "", "an archive of NumPy",
     "write x, y, z and reflectance of its points as '<f4' to "
     "%n.bin, a file of KITTI's"},
    {".ptx", "", "a cloud as text", "pdal translate -r readers.text %f %n.las (or CloudCompare)"},
    {".tum", "", "poses", "name the clouds, and these with --poses"},
    {".shp", "", "a shapefile", "ogr2ogr %n.geojson %f"},
    {".gpkg", "", "a GeoPackage", "ogr2ogr %n.geojson %f"},
    {".geojsonl", "", "GeoJSON by lines", "ogr2ogr %n.geojson %f"},
    {".o5m", "", "a map in o5m", "osmconvert %f -o=%n.osm.pbf"},
    {".nmea", "$GP", "a log of a GPS receiver", "gpsbabel -i nmea -f %f -o gpx -F %n.gpx"},
    {".fit", "", "a log of Garmin's", "gpsbabel -i garmin_fit -f %f -o gpx -F %n.gpx"},
    {".kmz", "", "packed KML", "unzip %f doc.kml"},
    {".zip", "PK\x03\x04", "a zip archive", "unzip %f"},
    {".gz", "\x1F\x8B\x08", "a file that gzip packed", "gunzip %f"},
    {".bz2", "BZh", "a file that bzip2 packed", "bunzip2 %f"},
    {".7z", "7z\xBC\xAF", "an archive of 7-Zip", "7z x %f"},
    {"", "ncols ", "a grid of heights", "railcast-generate import takes it by --heights"},
    {"", "version https://git-lfs", "a pointer of Git LFS to the file", "git lfs pull fetches it"},
});

constexpr auto kTextEndings = std::to_array<std::string_view>({".txt", ".csv"});

/// What a file of text holds, by the numbers of its first line of numbers; empty if it has none, or
/// is a cloud, as where it is named.
std::string AdviceOnText(std::string_view begin, bool is_named) {
  while (const auto line = TakeLine(begin)) {
    std::string plain(*line);
    std::ranges::replace_if(
        plain, [](char letter) { return letter == ',' || letter == ';'; }, ' ');
    const auto words = Words(plain);
    if (words.empty() || words[0].starts_with('#')) continue;
    const bool are_numbers = std::ranges::all_of(
        words, [](std::string_view word) { return ParseTextNumber<double>(word).has_value(); });
    if (!are_numbers || words.size() < 3) continue;  // The names of columns.
    const std::string numbers = NumberText(words.size()) + " numbers a line";
    if (words.size() == 8 || words.size() == 12) {
      return "is text with " + numbers + std::string(kUnread) +
             "if these are poses, name the clouds, and them with --poses; if it is a cloud, name "
             "its columns with --columns";
    }
    if (is_named) return {};
    return "is text with " + numbers +
           ", which is not read in a folder: if it is a cloud, name the file itself";
  }
  return {};
}

}  // namespace

std::string AdviceOnFile(const std::filesystem::path& file, bool is_named) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  std::string begin(4096, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(in.gcount()));
  const std::string ending = LowerCase(file.extension().string());
  if (std::ranges::count(kTextEndings, ending) > 0) {
    if (std::string advice = AdviceOnText(begin, is_named); !advice.empty()) return advice;
  }
  const auto format = std::ranges::find_if(kFormats, [&](const UnreadFormat& known) {
    return (!ending.empty() && known.ending == ending) ||
           (!known.begin.empty() && begin.starts_with(known.begin));
  });
  if (format == kFormats.end()) return {};
  std::string advice(format->advice);
  for (const auto& [word, name] : {std::pair("%f", file.filename()), {"%n", file.stem()}}) {
    const std::string shown = ShownPath(name);
    for (std::size_t at = advice.find(word); at != std::string::npos;
         at = advice.find(word, at + shown.size())) {
      advice.replace(at, 2, shown);
    }
  }
  return "is " + std::string(format->name) + std::string(kUnread) + advice;
}

std::string_view AdviceOnType(std::string_view type, std::string_view encoding) {
  const auto has = [&](std::string_view part) { return type.find(part) != std::string_view::npos; };
  if (encoding == "ros1" && has("Point")) {
    return "of ROS 1, which is not read: rosbags-convert makes a bag of ROS 2 of its .bag";
  }
  if (has("CompressedPointCloud")) {
    return "compressed, which is not read: ros2 run point_cloud_transport republish makes clouds "
           "of sensor_msgs/msg/PointCloud2";
  }
  if (has("foxglove") && has("PointCloud")) {
    return "Foxglove's own, which is not read: record sensor_msgs/msg/PointCloud2 beside it";
  }
  if (type == "sensor_msgs/msg/PointCloud") {
    return "the older cloud, which is not read: point_cloud_converter makes "
           "sensor_msgs/msg/PointCloud2";
  }
  if (type == "sensor_msgs/msg/LaserScan") {
    return "a scan of one plane, which is not read: laser_geometry makes "
           "sensor_msgs/msg/PointCloud2";
  }
  if (has("UdpFrame")) {
    return "packets of Hesai's driver, which are not read: hesai_ros_driver plays them as "
           "sensor_msgs/msg/PointCloud2";
  }
  if (has("rslidar_msg")) {
    return "packets of RoboSense, which are not read: rslidar_sdk plays them as "
           "sensor_msgs/msg/PointCloud2";
  }
  return {};
}

}  // namespace railcast
