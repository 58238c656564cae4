#include "core/io/run/motion_files.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/base/text.h"
#include "core/io/run/sequence_files.h"
#include "railcast/camera.h"

namespace railcast {
namespace {

constexpr std::string_view kMotionExtension = ".csv";

/// Writes the names of columns: "time_ns", "specific_force_x_mps2".
class CsvHeader {
 public:
  template <typename Value>
  void operator()(std::string_view name, std::string_view unit, const Value&) {
    std::string end = unit.empty() ? "" : "_";
    end += unit;
    if constexpr (std::is_same_v<Value, Vector3>) {
      for (const char* axis : {"_x", "_y", "_z"}) Add(std::string(name) + axis + end);
    } else {
      Add(std::string(name) + end);
    }
  }
  [[nodiscard]] std::string Ended() const { return text_ + '\n'; }

 private:
  void Add(const std::string& column) {
    if (!text_.empty()) text_ += ',';
    text_ += column;
  }
  std::string text_;
};

/// Writes the values of columns. NaN is left empty.
class CsvLine {
 public:
  template <typename Value>
  void operator()(std::string_view /*name*/, std::string_view /*unit*/, const Value& value) {
    if constexpr (std::is_same_v<Value, Vector3>) {
      for (const double each : value) Add(each);
    } else if constexpr (std::is_same_v<Value, bool>) {
      Add(value ? 1 : 0);
    } else {
      Add(value);
    }
  }
  [[nodiscard]] std::string Ended() const { return text_ + '\n'; }

 private:
  template <typename Number>
  void Add(Number value) {
    if (is_begun_) text_ += ',';
    is_begun_ = true;
    if constexpr (std::is_floating_point_v<Number>) {
      if (std::isnan(value)) return;
      value += 0.0;  // No negative zeros.
    }
    text_ += NumberText(value);
  }
  std::string text_;
  bool is_begun_ = false;
};

template <typename Sample>
std::string HeaderOf() {
  CsvHeader header;
  ForEachColumn(Sample{}, header);
  return header.Ended();
}

template <typename Sample>
void AddLines(const std::vector<std::vector<Sample>>& sensors, std::vector<std::string>& lines) {
  for (const std::vector<Sample>& samples : sensors) {
    std::string& text = lines.emplace_back();
    for (const Sample& sample : samples) {
      CsvLine line;
      ForEachColumn(sample, line);
      text += line.Ended();
    }
  }
}

}  // namespace

std::string MotionFileName(std::string_view sensor) {
  return std::string(kMotionFolder) + "/" + std::string(sensor) + std::string(kMotionExtension);
}

bool IsMotionFile(std::string_view name) {
  if (!name.ends_with(kMotionExtension) || !name.starts_with(kMotionFolder)) return false;
  name.remove_suffix(kMotionExtension.size());
  name.remove_prefix(std::min(name.size(), kMotionFolder.size()));
  return name.starts_with('/') && IsCameraName(name.substr(1));
}

std::vector<MotionFile> MotionFilesOf(const MotionSensorsSpec& spec) {
  std::vector<MotionFile> files;
  for (const ImuSpec& imu : spec.imus) files.push_back({imu.name, HeaderOf<ImuSample>()});
  for (const GnssSpec& gnss : spec.gnss) files.push_back({gnss.name, HeaderOf<GnssSample>()});
  for (const OdometerSpec& odometer : spec.odometers) {
    files.push_back({odometer.name, HeaderOf<OdometerSample>()});
  }
  return files;
}

std::vector<std::string> MotionLinesOf(const MotionSamples& samples) {
  std::vector<std::string> lines;
  AddLines(samples.imus, lines);
  AddLines(samples.gnss, lines);
  AddLines(samples.odometers, lines);
  return lines;
}

}  // namespace railcast
