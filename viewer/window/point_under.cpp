#include "viewer/window/point_under.h"

#include <vtkCamera.h>
#include <vtkMatrix4x4.h>

#include "viewer/pick/point_at.h"

namespace railcast {
namespace {

/// From a view's axes to the clip volume.
Eigen::Matrix4d ClipFromView(vtkRenderer& renderer) {
  constexpr double kNearClip = -1.0;
  constexpr double kFarClip = 1.0;
  // Another view may have left its own range to the camera that they share.
  renderer.ResetCameraClippingRange();
  vtkMatrix4x4* const matrix = renderer.GetActiveCamera()->GetCompositeProjectionTransformMatrix(
      renderer.GetTiledAspectRatio(), kNearClip, kFarClip);
  return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(matrix->GetData());
}

/// All clouds' points as one list, so that the one that a click means is chosen among all.
std::vector<float> AllPositions_m(const Scene& scene) {
  std::vector<float> positions_m;
  for (const PlacedCloud& cloud : scene.clouds) {
    const std::vector<float>& own_m = cloud.shown->positions_m;
    const Eigen::Affine3f view_from_sensor(cloud.view_from_sensor.cast<float>());
    const std::size_t first = positions_m.size();
    positions_m.resize(first + own_m.size());
    for (std::size_t i = 0; i < own_m.size(); i += 3) {
      const Eigen::Map<const Eigen::Vector3f> own(&own_m[i]);
      Eigen::Map<Eigen::Vector3f> placed(&positions_m[first + i]);
      placed = view_from_sensor * own;
    }
  }
  return positions_m;
}

}  // namespace

std::optional<ScreenPoint> PointUnder(Stage& stage,
                                      const Session& session,
                                      const std::array<int, 2>& place_px) {
  const std::size_t index = stage.ViewAt(place_px[0]);
  SceneView& view = stage.view(index);
  const auto in_view_px = stage.InView(index, place_px[0], place_px[1]);
  const Scene& scene = view.scene();
  const auto found = PointAt(AllPositions_m(scene), ClipFromView(view.renderer()),
                             view.SizeIn(stage.size_px()), in_view_px[0], in_view_px[1]);
  if (!found) return std::nullopt;
  std::size_t cloud = 0;
  std::size_t point = *found;
  while (point >= scene.clouds[cloud].shown->num_points()) {
    point -= scene.clouds[cloud++].shown->num_points();
  }
  // Where one view shows two sources, the first cloud is the first's and the second the second's.
  const std::size_t source = stage.num_views() < session.num_sources() ? cloud : index;
  return ScreenPoint{source, scene.clouds[cloud].shown, point};
}

}  // namespace railcast
