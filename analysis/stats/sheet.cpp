#include "analysis/stats/statistics.h"

#include <algorithm>

#include "analysis/pictures/grid_pictures.h"
#include "core/base/text.h"
#include "core/io/run/camera_files.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kColumns = 3;

/// The recordings of one sensor, with the numbers of their frames.
struct SensorSource {
  std::string name;
  std::vector<fs::path> recordings;
  std::vector<std::size_t> num_frames;
  std::map<std::string, std::vector<fs::path>> images;  ///< By the name of the camera.
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
std::vector<PlacedFrame> PickFrames(const SensorSource& sensor) {
  std::size_t num = 0;
  for (const std::size_t more : sensor.num_frames) num += more;
  std::vector<PlacedFrame> picked;
  for (std::size_t i = 0; i < std::min(kColumns, num); ++i) {
    std::size_t place = PlaceOfColumn(i, num);
    std::size_t recording = 0;
    while (place >= sensor.num_frames[recording]) place -= sensor.num_frames[recording++];
    picked.push_back({sensor.recordings[recording], place});
  }
  return picked;
}

// The end of a name that would not fit above a picture.
std::string TailOf(const std::string& text) {
  constexpr std::size_t kMostBytes = 26;
  if (text.size() <= kMostBytes) return text;
  std::size_t begin = text.size() - (kMostBytes - 3);
  // Do not cut within a UTF-8 character.
  while (begin < text.size() && (static_cast<unsigned char>(text[begin]) >> 6) == 2) ++begin;
  return "..." + text.substr(begin);
}

/// The last two parts of a path as it was given, such as "000003/front", or the last, if they are
/// too long.
std::string ShortName(const fs::path& path) {
  // A path that ends in a slash has an empty last component.
  const fs::path whole = (path / "").lexically_normal().parent_path();
  const std::string both = ShownText((whole.parent_path().filename() / whole.filename()).string());
  const std::string name = TailOf(both);
  return name == both ? both : TailOf(ShownText(whole.filename().string()));
}

std::vector<GridPicture> CloudRow(const SensorSource& sensor) {
  std::vector<GridPicture> row;
  for (const PlacedFrame& picked : PickFrames(sensor)) {
    RecordingInfo info;
    const auto recorded = ReadFrameAt(picked, info);
    if (!recorded) break;
    row.push_back(CloudPicture(*recorded, info,
                               {.title = TailOf(sensor.name) + ": " + ShortName(picked.recording) +
                                         ", frame " + NumberText(recorded->frame.index)}));
  }
  return row;
}

/// "12" for "000012.png".
std::string FrameOf(const fs::path& image) {
  const std::string name = ShownText(image.stem().string());
  return name.substr(std::min(name.find_first_not_of('0'), name.size() - 1));
}

std::vector<GridPicture> ImageRow(const std::string& camera, const std::vector<fs::path>& images) {
  std::vector<GridPicture> row;
  for (std::size_t i = 0; i < std::min(kColumns, images.size()); ++i) {
    const fs::path& image = images[PlaceOfColumn(i, images.size())];
    // RECORDING/camera/NAME/color/000012.png
    const fs::path recording = image.parent_path().parent_path().parent_path().parent_path();
    row.push_back(
        ImagePicture(camera + ": " + ShortName(recording) + ", frame " + FrameOf(image), image));
  }
  return row;
}

}  // namespace

Picture MakeSheet(const std::vector<fs::path>& recordings) {
  std::vector<std::vector<GridPicture>> rows;
  for (const SensorSource& sensor : SensorsOf(recordings)) {
    rows.push_back(CloudRow(sensor));
    for (const auto& [camera, images] : sensor.images) rows.push_back(ImageRow(camera, images));
  }
  std::erase_if(rows, [](const auto& row) { return row.empty(); });
  Picture sheet = GridOf(rows);
  sheet.key = "sheet";
  sheet.title = "Frames of each sensor and camera";
  sheet.caption =
      "Points as the sensor sees them, up to 60 degrees to either side of its x axis, in the "
      "colours of their labels or, without labels, by range from yellow to blue.";
  return sheet;
}

}  // namespace railcast
