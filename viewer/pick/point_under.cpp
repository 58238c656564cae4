#include "viewer/pick/point_under.h"

#include <vtkCamera.h>
#include <vtkMatrix4x4.h>

#include "viewer/pick/picks.h"

namespace railcast {
namespace {

/// Returns the matrix from a view's axes to the clip volume.
Eigen::Matrix4d ClipFromView(vtkRenderer& renderer) {
  constexpr double kNearClip = -1.0;
  constexpr double kFarClip = 1.0;
  // Views share the camera, so another view may have left its own clipping range.
  renderer.ResetCameraClippingRange();
  vtkMatrix4x4* const matrix = renderer.GetActiveCamera()->GetCompositeProjectionTransformMatrix(
      renderer.GetTiledAspectRatio(), kNearClip, kFarClip);
  return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(matrix->GetData());
}

/// Returns the points of all clouds as one list, so that the point clicked is chosen among all of
/// them.
std::vector<float> AllPositions_m(const Composition& composition) {
  std::vector<float> positions_m;
  for (const PlacedCloud& cloud : composition.clouds) {
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
  Pane& view = stage.view(index);
  const auto in_view_px = stage.InView(index, place_px[0], place_px[1]);
  if (view.IsInInset(in_view_px)) return std::nullopt;
  const Composition& composition = view.composition();
  const auto found = PointAt(AllPositions_m(composition), ClipFromView(view.renderer()),
                             view.SizeIn(stage.size_px()), in_view_px[0], in_view_px[1]);
  if (!found) return std::nullopt;
  std::size_t cloud = 0;
  std::size_t point = *found;
  while (point >= composition.clouds[cloud].shown->num_points()) {
    point -= composition.clouds[cloud++].shown->num_points();
  }
  const PlacedCloud& hit = composition.clouds[cloud];
  return ScreenPoint{session.num_views() < session.num_sources() ? hit.source : index, hit.shown,
                     point};
}

}  // namespace railcast
