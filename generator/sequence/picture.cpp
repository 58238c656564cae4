#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/camera/lens.h"
#include "core/io/image/png.h"
#include "generator/run/frame_maker.h"
#include "generator/run/run_plan.h"
#include "generator/sequence/summary.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

constexpr int kHalfPoint_px = 1;

void DrawPoint(const Eigen::Vector2d& place_px,
               const std::array<std::uint8_t, 3>& rgb,
               CameraImage& image) {
  const auto middle_u = static_cast<int>(std::lround(place_px.x()));
  const auto middle_v = static_cast<int>(std::lround(place_px.y()));
  for (int v = middle_v - kHalfPoint_px; v <= middle_v + kHalfPoint_px; ++v) {
    for (int u = middle_u - kHalfPoint_px; u <= middle_u + kHalfPoint_px; ++u) {
      if (u < 0 || v < 0 || u >= static_cast<int>(image.width_px) ||
          v >= static_cast<int>(image.height_px)) {
        continue;
      }
      const std::size_t pixel =
          static_cast<std::size_t>(v) * image.width_px + static_cast<std::size_t>(u);
      std::ranges::copy(rgb, image.rgb.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
    }
  }
}

/// The slots with a point, the farthest first, so that near points lie over far ones.
std::vector<std::size_t> SlotsFromAfar(const Frame& frame) {
  std::vector<std::size_t> slots(frame.num_slots());
  std::iota(slots.begin(), slots.end(), std::size_t{0});
  std::erase_if(slots, [&](std::size_t slot) { return !HasPoint(frame.outcome[slot]); });
  std::ranges::stable_sort(slots, std::ranges::greater(),
                           [&](std::size_t slot) { return frame.range_m[slot]; });
  return slots;
}

void DrawPoints(const MadeFrame& made,
                const CameraSpec& spec,
                const LabelTable& labels,
                CameraImage& image) {
  constexpr double kNearest_m = 0.1;  // Before the camera: nearer ones would fill the picture.
  const Lens lens(spec);
  const Transform camera_from_sensor =
      image.world_from_camera.inverse() * made.frame.world_from_sensor;
  for (const std::size_t slot : SlotsFromAfar(made.frame)) {
    const Vector3 point = camera_from_sensor * Vector3(static_cast<double>(made.frame.x[slot]),
                                                       static_cast<double>(made.frame.y[slot]),
                                                       static_cast<double>(made.frame.z[slot]));
    const Label* const label = labels.Find(made.frame.label[slot]);
    if (point.z() < kNearest_m || label == nullptr) continue;
    // What is far beside the picture may have no place in it.
    const Eigen::Vector2d place_px = lens.Project(point);
    if (place_px.cwiseAbs().maxCoeff() < 1e6) DrawPoint(place_px, label->rgb, image);
  }
}

}  // namespace

std::string PictureOfFrame(const RunPlan& plan, std::uint32_t frame, int num_threads) {
  ScenarioSpec scenario = plan.sensors.front().scenario;
  scenario.output = {};
  if (scenario.fidelity == Fidelity::kAuto) scenario.fidelity = Fidelity::kFootprint;
  if (!scenario.camera) {
    scenario.camera = {.width_px = 1280, .height_px = 720, .horizontal_fov_deg = 45.0};
  }
  scenario.motion_sensors.reset();
  scenario.camera->rate_hz.reset();  // It has an image of each frame.
  FrameMaker maker(scenario, num_threads, plan.sensors.front().spec.isa);
  maker.Apply(plan.commands);
  MadeFrame made;
  maker.Begin(0, frame)(made);
  DrawPoints(made, *scenario.camera, maker.labels(), made.image);
  return EncodePngRgb({made.image.width_px, made.image.height_px}, made.image.rgb);
}

}  // namespace railcast
