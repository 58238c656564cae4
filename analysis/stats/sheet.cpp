#include "analysis/stats/sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <utility>

#include "analysis/report/chart_script.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/camera_files.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kColumns = 4;
constexpr int kPictureWidth_px = 480;
constexpr int kPictureHeight_px = 300;
constexpr double kSide_deg = 60.0;
constexpr std::size_t kMostPoints = 60'000;  // More do not fit a picture.
constexpr double kDegPerRad = 180.0 / std::numbers::pi;

/// The recordings of one sensor, with the numbers of their frames.
struct SensorSource {
  std::string name;
  std::vector<fs::path> recordings;
  std::vector<std::size_t> num_frames;
  std::map<std::string, std::vector<fs::path>> images;  ///< By the name of the camera.
};

/// A frame of a recording.
struct PickedFrame {
  fs::path recording;
  std::size_t place{};
};

std::string SensorNameOf(const RecordingInfo& info) {
  return info.scenario ? info.scenario->lidar.name : info.kind;
}

void AddImages(const fs::path& recording,
               const std::string& camera,
               std::map<std::string, std::vector<fs::path>>& images) {
  const fs::path folder = (recording / CameraFileNames(camera, 0).front()).parent_path();
  if (!fs::is_directory(folder)) return;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".png") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<fs::path>& all = images[camera];
  all.insert(all.end(), files.begin(), files.end());
}

// A capture does not say how many frames it has; the first ones stand for it.
std::vector<SensorSource> SensorsOf(const std::vector<fs::path>& recordings) {
  std::vector<SensorSource> sensors;
  for (const fs::path& path : recordings) {
    const RecordingInfo info = OpenRecording(path)->info();
    const std::string name = SensorNameOf(info);
    auto sensor = std::ranges::find(sensors, name, &SensorSource::name);
    if (sensor == sensors.end()) {
      sensors.push_back({name, {}, {}, {}});
      sensor = sensors.end() - 1;
    }
    sensor->recordings.push_back(path);
    sensor->num_frames.push_back(info.num_frames.value_or(kColumns));
    if (info.scenario && info.scenario->camera) {
      AddImages(path, info.scenario->camera->name, sensor->images);
    }
  }
  return sensors;
}

// The one of `num` that stands for part `i` of as many equal parts as there are columns.
std::size_t PlaceOfColumn(std::size_t i, std::size_t num) {
  const std::size_t num_parts = std::min(kColumns, num);
  return (2 * i + 1) * num / (2 * num_parts);
}

// Frames in the middles of equal parts of all.
std::vector<PickedFrame> PickFrames(const SensorSource& sensor) {
  std::size_t num = 0;
  for (const std::size_t more : sensor.num_frames) num += more;
  std::vector<PickedFrame> picked;
  for (std::size_t i = 0; i < std::min(kColumns, num); ++i) {
    std::size_t place = PlaceOfColumn(i, num);
    std::size_t recording = 0;
    while (place >= sensor.num_frames[recording]) place -= sensor.num_frames[recording++];
    picked.push_back({sensor.recordings[recording], place});
  }
  return picked;
}

/// Nothing where the recording ends before that frame.
std::optional<RecordedFrame> ReadAt(const PickedFrame& picked, RecordingInfo& info) {
  const auto recording = OpenRecording(picked.recording);
  info = recording->info();
  std::optional<Recording::FrameReader> reader;
  for (std::size_t i = 0; i <= picked.place; ++i) {
    reader = recording->Next();
    if (!reader) return std::nullopt;
  }
  return (*reader)();
}

struct SeenPoint {
  double azimuth_deg{}, elevation_deg{}, range_m{};
  unsigned int color{};
};

unsigned int ColorOf(unsigned int red, unsigned int green, unsigned int blue) {
  return red << 16U | green << 8U | blue;
}

unsigned int ColorAt(const RecordedFrame& recorded, const RecordingInfo& info, std::size_t slot) {
  if (recorded.Has("label")) {
    const Label* const label = info.labels.Find(recorded.frame.label[slot]);
    return label == nullptr ? ColorOf(200, 200, 200)
                            : ColorOf(label->rgb[0], label->rgb[1], label->rgb[2]);
  }
  // From yellow at 2 m to blue at 200 m.
  const double share = std::clamp(
      std::log10(static_cast<double>(recorded.frame.range_m[slot]) / 2.0) / 2.0, 0.0, 1.0);
  const auto mixed = [&](double near, double far) {
    return static_cast<unsigned int>(std::lround(near + share * (far - near)));
  };
  return ColorOf(mixed(255.0, 40.0), mixed(220.0, 110.0), mixed(60.0, 255.0));
}

// From the farthest on, so that the nearest are drawn last.
std::vector<SeenPoint> SeenPointsOf(const RecordedFrame& recorded, const RecordingInfo& info) {
  std::vector<SeenPoint> points;
  const Frame& frame = recorded.frame;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const auto x = static_cast<double>(frame.x[slot]);
    const auto y = static_cast<double>(frame.y[slot]);
    const auto z = static_cast<double>(frame.z[slot]);
    if (!std::isfinite(x + y + z)) continue;
    points.push_back({kDegPerRad * std::atan2(y, x), kDegPerRad * std::atan2(z, std::hypot(x, y)),
                      std::hypot(x, y, z), ColorAt(recorded, info, slot)});
  }
  const auto is_ahead = [](const SeenPoint& point) {
    return std::abs(point.azimuth_deg) <= kSide_deg;
  };
  if (std::ranges::any_of(points, is_ahead)) {
    std::erase_if(points, [&](const SeenPoint& point) { return !is_ahead(point); });
  }
  const std::size_t step = points.size() / kMostPoints + 1;
  std::vector<SeenPoint> kept;
  for (std::size_t i = 0; i < points.size(); i += step) kept.push_back(points[i]);
  std::ranges::stable_sort(kept, std::greater(), &SeenPoint::range_m);
  return kept;
}

std::string EmptyPicture(const std::string& title) {
  return "set title " + GnuplotQuoted(title) +
         "\nset xrange [0:1]\nset yrange [0:1]\nset size noratio\nplot NaN notitle\n";
}

std::string CloudPicture(const std::string& title,
                         const std::vector<SeenPoint>& points,
                         std::size_t number) {
  if (points.empty()) return EmptyPicture(title + ": no point");
  const auto [right, left] = std::ranges::minmax(points, {}, &SeenPoint::azimuth_deg);
  const auto [low, high] = std::ranges::minmax(points, {}, &SeenPoint::elevation_deg);
  const double width_deg = std::max(1.0, left.azimuth_deg - right.azimuth_deg);
  const double height_deg = std::max(1.0, high.elevation_deg - low.elevation_deg);
  const double px_per_deg =
      std::min(0.95 * kPictureWidth_px / width_deg, 0.8 * kPictureHeight_px / height_deg);
  // Points a little larger than the way from one to the next; gnuplot's size 1 is about 8 pixels.
  const double way_px =
      px_per_deg * std::sqrt(width_deg * height_deg / static_cast<double>(points.size()));
  std::ostringstream text;
  text << "$cloud" << number << " << END\n";
  text.precision(6);
  for (const SeenPoint& point : points) {
    text << point.azimuth_deg << ' ' << point.elevation_deg << ' ' << point.color << '\n';
  }
  text << "END\nset title " << GnuplotQuoted(title) << "\nset xrange ["
       << left.azimuth_deg + 0.01 * width_deg << ':' << right.azimuth_deg - 0.01 * width_deg
       << "]\nset yrange [" << low.elevation_deg - 0.01 * height_deg << ':'
       << high.elevation_deg + 0.01 * height_deg << "]\nset size ratio -1\nplot $cloud" << number
       << " using 1:2:3 with points pointtype 7 pointsize " << std::clamp(way_px / 8.0, 0.12, 0.8)
       << " linecolor rgb variable notitle\n";
  return text.str();
}

std::string ImagePicture(const std::string& title, const fs::path& image) {
  return "set title " + GnuplotQuoted(title) +
         "\nset autoscale\nset xrange [*:*] noreverse\nset yrange [*:*]\nset size ratio -1\nplot " +
         GnuplotQuoted(image.string()) + " binary filetype=png with rgbimage notitle\n";
}

/// The last two folders of a path: "000003/front".
std::string ShortName(const fs::path& path) {
  const fs::path folder = fs::absolute(path / "").lexically_normal().parent_path();
  return ShownText((folder.parent_path().filename() / folder.filename()).string());
}

// A row has as many places as the sheet has columns.
std::string WithEmptyPlaces(std::string row, std::size_t num) {
  for (std::size_t i = num; i < kColumns; ++i) row += EmptyPicture("");
  return row;
}

std::string CloudRow(const SensorSource& sensor, std::size_t& number) {
  std::string row;
  std::size_t num = 0;
  for (const PickedFrame& picked : PickFrames(sensor)) {
    RecordingInfo info;
    const auto recorded = ReadAt(picked, info);
    if (!recorded) break;
    row += CloudPicture(sensor.name + ": " + ShortName(picked.recording) + ", frame " +
                            NumberText(recorded->frame.index),
                        SeenPointsOf(*recorded, info), number++);
    ++num;
  }
  return WithEmptyPlaces(std::move(row), num);
}

std::string ImageRow(const std::string& camera, const std::vector<fs::path>& images) {
  std::string row;
  const std::size_t num = std::min(kColumns, images.size());
  for (std::size_t i = 0; i < num; ++i) {
    const fs::path& image = images[PlaceOfColumn(i, images.size())];
    // RECORDING/camera/NAME/color/000012.png
    const fs::path recording = image.parent_path().parent_path().parent_path().parent_path();
    row += ImagePicture("camera " + camera + ": " + ShortName(recording) + ", " +
                            ShownText(image.filename().string()),
                        image);
  }
  return WithEmptyPlaces(std::move(row), num);
}

}  // namespace

SheetScript MakeSheet(const std::vector<fs::path>& recordings) {
  std::vector<std::string> rows;
  std::size_t number = 0;
  for (const SensorSource& sensor : SensorsOf(recordings)) {
    rows.push_back(CloudRow(sensor, number));
    for (const auto& [camera, images] : sensor.images) rows.push_back(ImageRow(camera, images));
  }
  SheetScript sheet{.text = {},
                    .width_px = kPictureWidth_px * static_cast<int>(kColumns),
                    .height_px = kPictureHeight_px * static_cast<int>(rows.size())};
  // Room for a line of text above each row.
  const double line = 26.0 / sheet.height_px;
  sheet.text =
      "unset key\nunset border\nunset tics\nset title textcolor rgb '#ffffff' noenhanced\n"
      "set multiplot layout " +
      std::to_string(rows.size()) + "," + std::to_string(kColumns) + " margins 0.005,0.995,0.01," +
      GnuplotNumber(1.0 - line) + " spacing 0.005," + GnuplotNumber(line) + "\n";
  for (const std::string& row : rows) sheet.text += row;
  sheet.text += "unset multiplot\n";
  return sheet;
}

}  // namespace railcast
