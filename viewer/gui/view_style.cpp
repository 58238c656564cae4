#include "viewer/gui/view_style.h"

#include <vtkCamera.h>
#include <vtkObjectFactory.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "railcast/transform.h"

namespace railcast {

vtkStandardNewMacro(ViewStyle);

void ViewStyle::OnKeyPress() {
  if (on_key) on_key(Interactor->GetKeySym() == nullptr ? "" : Interactor->GetKeySym());
}

void ViewStyle::OnLeftButtonDown() {
  const int* const place = Interactor->GetEventPosition();
  pressed_at_px_ = {place[0], place[1]};
  vtkInteractorStyleTrackballCamera::OnLeftButtonDown();
}

void ViewStyle::OnLeftButtonUp() {
  constexpr int kStill_px = 3;
  vtkInteractorStyleTrackballCamera::OnLeftButtonUp();
  const int* const place = Interactor->GetEventPosition();
  const int moved_px =
      std::max(std::abs(place[0] - pressed_at_px_[0]), std::abs(place[1] - pressed_at_px_[1]));
  if (moved_px > kStill_px || !on_click) return;
  on_click({place[0], place[1]}, Interactor->GetShiftKey() != 0);
}

// The camera turns in azimuth and elevation about the target. Where it looks straight down, the
// azimuth follows from the direction that is up on the screen.
void ViewStyle::Rotate() {
  if (CurrentRenderer == nullptr) return;
  vtkCamera* const camera = CurrentRenderer->GetActiveCamera();
  const Vector3 target_m(camera->GetFocalPoint());
  const Vector3 offset_m = Vector3(camera->GetPosition()) - target_m;
  const Vector3 up(camera->GetViewUp());
  const double level_m = offset_m.head<2>().norm();
  double azimuth_rad = std::atan2(offset_m.y(), offset_m.x());
  if (level_m < 1e-6 * offset_m.norm()) azimuth_rad = std::atan2(-up.y(), -up.x());
  double elevation_rad = std::atan2(offset_m.z(), level_m);

  const int* const now = Interactor->GetEventPosition();
  const int* const before = Interactor->GetLastEventPosition();
  const int* const size_px = CurrentRenderer->GetSize();
  azimuth_rad -= 2.0 * std::numbers::pi * (now[0] - before[0]) / std::max(1, size_px[0]);
  elevation_rad -= std::numbers::pi * (now[1] - before[1]) / std::max(1, size_px[1]);
  elevation_rad = std::clamp(elevation_rad, -0.5 * std::numbers::pi, 0.5 * std::numbers::pi);

  const Vector3 outward(std::cos(elevation_rad) * std::cos(azimuth_rad),
                        std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad));
  const Vector3 eye_m = target_m + offset_m.norm() * outward;
  const Vector3 new_up(-std::sin(elevation_rad) * std::cos(azimuth_rad),
                       -std::sin(elevation_rad) * std::sin(azimuth_rad), std::cos(elevation_rad));
  camera->SetPosition(eye_m.data());
  camera->SetViewUp(new_up.data());
  CurrentRenderer->ResetCameraClippingRange();
  Interactor->Render();
}

}  // namespace railcast
