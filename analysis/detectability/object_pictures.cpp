#include "analysis/detectability/detect_report.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "analysis/pictures/grid_pictures.h"
#include "analysis/report/words.h"
#include "core/base/text.h"
#include "core/io/recording/recorded_motion.h"
#include "core/io/run/camera_files.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// About a dozen rows of beams of the published scan.
constexpr double kMinHalfHeight_deg = 1.5;

/// A frame of a run in which an object is looked at.
struct ShownFrame {
  RecordedFrame recorded;
  RecordingInfo info;
  RecordedObject object;
  Sighting sighting;
};

const DetectRun* RunToShow(const std::vector<DetectRun>& runs, const std::string& name) {
  for (const Fate fate : {Fate::kDetected, Fate::kNeverDetected}) {
    for (const DetectRun& run : runs) {
      const auto found = run.detections.find(name);
      if (found != run.detections.end() && found->second.fate == fate) return &run;
    }
  }
  return nullptr;
}

std::optional<ShownFrame> ShownAt(const DetectRun& run,
                                  const std::string& name,
                                  std::optional<std::uint32_t> frame) {
  if (!frame) return std::nullopt;
  ShownFrame shown;
  auto recorded = ReadFrameAt({run.source, *frame}, shown.info);
  if (!recorded) return std::nullopt;
  shown.recorded = std::move(*recorded);
  shown.object = *std::ranges::find(shown.recorded.objects, name, &RecordedObject::name);
  shown.sighting =
      *std::ranges::find(run.courses.objects.at(name).sightings, *frame, &Sighting::frame);
  return shown;
}

std::string FrameText(const ShownFrame& shown) {
  return "frame " + NumberText(shown.recorded.frame.index);
}

GridPicture ClosePicture(const std::string& what, const ShownFrame& shown) {
  const Transform box = RecordedMotion(shown.recorded, Compensation::kAll).BoxOf(shown.object);
  std::array<char, 64> seen{};
  std::snprintf(seen.data(), seen.size(), ", %.1f m, %u point%s", shown.sighting.distance_m,
                shown.sighting.points, shown.sighting.points == 1 ? "" : "s");
  return CloudPicture(shown.recorded, shown.info,
                      {.title = what + ": " + FrameText(shown) + seen.data(),
                       .window = WindowAbout(box, shown.object.size_m, kMinHalfHeight_deg),
                       .lines = LinesOf(box, shown.object.size_m)});
}

GridPicture ScenePicture(const ShownFrame& shown) {
  const Transform box = RecordedMotion(shown.recorded, Compensation::kAll).BoxOf(shown.object);
  const SeenWindow window = WindowAbout(box, shown.object.size_m, kMinHalfHeight_deg);
  return CloudPicture(
      shown.recorded, shown.info,
      {.title = "The scene: " + FrameText(shown), .window = {}, .lines = {LineOf(window)}});
}

// The camera's image of the frame or, of a camera with a lower rate, the latest before it.
std::optional<GridPicture> SceneImage(const ShownFrame& shown) {
  if (!shown.info.scenario || !shown.info.scenario->camera) return std::nullopt;
  const std::string& camera = shown.info.scenario->camera->name;
  for (std::uint32_t i = shown.recorded.frame.index + 1; i-- > 0;) {
    const fs::path image = shown.info.source / CameraFileNames(camera, i).front();
    if (!fs::exists(image)) continue;
    return ImagePicture(ShownText(camera) + ": frame " + NumberText(i), image);
  }
  return std::nullopt;
}

std::optional<Picture> PictureOf(const DetectRun& run, const std::string& name) {
  const ObjectDetection& detection = run.detections.at(name);
  const auto missed = ShownAt(run, name, detection.missed_frame);
  const auto detected = ShownAt(run, name, detection.frame);
  const auto& last = detected ? detected : missed;
  if (!last) return std::nullopt;
  std::vector<GridPicture> row;
  if (auto image = SceneImage(*last)) row.push_back(std::move(*image));
  row.push_back(ScenePicture(*last));
  if (missed) row.push_back(ClosePicture(detected ? "Last missed" : "Never detected", *missed));
  if (detected) row.push_back(ClosePicture("Detected", *detected));
  Picture picture = GridOf({row});
  picture.key = KeyOfObject("seen_", name);
  picture.title = name;
  picture.caption = "Run of seed " + NumberText(run.seed) +
                    ". Outlined: the object's box; in the scene, the part that is enlarged.";
  return picture;
}

}  // namespace

Section MakePictureSection(const std::vector<DetectRun>& runs) {
  Section section = SectionOf(kDetectabilityWords, "pictures");
  for (const Verdict& object : MakeVerdicts(runs)) {
    if (!object.is_in_way || section.pictures.size() == kMaxCharts) continue;
    const DetectRun* const run = RunToShow(runs, object.name);
    if (run == nullptr) continue;
    if (auto picture = PictureOf(*run, object.name)) section.pictures.push_back(*picture);
  }
  return section;
}

}  // namespace railcast
