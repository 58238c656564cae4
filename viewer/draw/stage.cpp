#include "viewer/draw/stage.h"

#include <vtkCamera.h>

#include <algorithm>
#include <span>
#include <utility>

#include "viewer/draw/text_style.h"
#include "viewer/draw/vtk_values.h"

namespace railcast {

Stage::Stage(const std::array<int, 2>& size_px)
    : window_(vtkSmartPointer<vtkRenderWindow>::New()),
      plates_renderer_(vtkSmartPointer<vtkRenderer>::New()),
      camera_(vtkSmartPointer<vtkCamera>::New()) {
  window_->SetSize(size_px[0], size_px[1]);
  window_->SetMultiSamples(0);
  window_->SetWindowName("railcast-view");
  // The views are in layer 0.
  window_->SetNumberOfLayers(2);
  plates_renderer_->SetLayer(1);
  plates_renderer_->InteractiveOff();
  window_->AddRenderer(plates_renderer_);
  PlaceCamera(PresetCamera(preset_, {}, false), *camera_);
  SetViews(1);
}

void Stage::SetViews(std::size_t count) {
  if (views_.size() == count) return;
  for (const auto& view : views_) window_->RemoveRenderer(&view->renderer());
  views_.clear();
  const auto share = 1.0 / static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto left = static_cast<double>(i) * share;
    views_.push_back(std::make_unique<Pane>(left, i + 1 == count ? 1.0 : left + share));
    views_.back()->renderer().SetActiveCamera(camera_);
    window_->AddRenderer(&views_.back()->renderer());
  }
}

std::array<int, 2> Stage::size_px() const {
  const int* const size = window_->GetSize();
  return {size[0], size[1]};
}

void Stage::Show(std::vector<Composition> compositions, const Look& look) {
  look_ = look;
  SetViews(compositions.size());
  for (std::size_t i = 0; i < compositions.size(); ++i) {
    views_[i]->Show(std::make_shared<const Composition>(std::move(compositions[i])), look,
                    size_px());
  }
  if (!is_placed_) PlaceNow();
}

void Stage::Redraw(const Look& look) {
  look_ = look;
  for (const auto& view : views_) view->Show(view->shared_composition(), look, size_px());
  for (std::size_t i = 0; i < plates_.size(); ++i) {
    ShowPlate(static_cast<Plate>(i), std::exchange(plate_words_[i], {}));
  }
}

void Stage::ShowStatus(const std::string& status) {
  views_.front()->ShowStatus(status, look_);
}

void Stage::PlaceNow() {
  const Composition& composition = views_.front()->composition();
  const std::span<const float> positions_m = composition.clouds.empty()
                                                 ? std::span<const float>()
                                                 : composition.clouds[0].shown->positions_m;
  PlaceCamera(place_ ? *place_ : PresetCamera(preset_, positions_m, composition.is_origin_on_rails),
              *camera_);
  for (const auto& view : views_) view->renderer().ResetCameraClippingRange();
  is_placed_ = !composition.clouds.empty();
}

void Stage::UseCamera(const std::string& preset) {
  preset_ = preset;
  place_.reset();
  PlaceNow();
}

void Stage::UseCamera(const CameraPlace& place) {
  place_ = place;
  PlaceNow();
}

void Stage::MoveCamera(const Transform& new_from_old) {
  CameraPlace place = camera_place();
  Eigen::Map<Vector3> eye_m(place.eye_m.data());
  Eigen::Map<Vector3> target_m(place.target_m.data());
  Eigen::Map<Vector3> up(place.up.data());
  eye_m = (new_from_old * eye_m).eval();
  target_m = (new_from_old * target_m).eval();
  up = (new_from_old.linear() * up).eval();
  PlaceCamera(place, *camera_);
}

void Stage::TurnAbout(const Eigen::Vector3f& target_m) {
  const Eigen::Vector3d target = target_m.cast<double>();
  PlaceCamera(UprightCamera(camera_place().eye_m, {target.x(), target.y(), target.z()}), *camera_);
}

CameraPlace Stage::camera_place() {
  return PlaceOf(*camera_);
}

void Stage::ShowMarks(std::size_t view, const Overlay& marks) {
  views_[view]->ShowMarks(marks, look_);
}

void Stage::ShowPlate(Plate plate, const std::string& words) {
  auto& actor = plates_[static_cast<std::size_t>(plate)];
  if (actor) plates_renderer_->RemoveActor(actor);
  actor = nullptr;
  plate_words_[static_cast<std::size_t>(plate)] = words;
  if (words.empty()) return;
  const auto [width_px, height_px] = size_px();
  actor = MakeText(words, look_.background, height_px, {0.0, 0.0}, TextAnchor::kLeftBottom);
  vtkTextProperty& text = *actor->GetTextProperty();
  text.SetFontFamilyToCourier();
  text.SetFontSize(std::max(9, height_px / 60));
  text.SetBackgroundColor(VtkColor(look_.background.rgb).data());
  text.SetBackgroundOpacity(0.85);
  plates_renderer_->AddActor(actor);
  std::array<double, 2> extent_px{};
  actor->GetSize(plates_renderer_, extent_px.data());
  const double margin_px = height_px / 60.0;
  const double right_px = width_px - margin_px - extent_px[0];
  switch (plate) {
    case Plate::kFacts:
      actor->SetPosition(right_px, height_px - margin_px - extent_px[1]);
      break;
    case Plate::kTrace:
      actor->SetPosition(right_px, 6.0 * margin_px);
      break;
    case Plate::kHelp:
      actor->SetPosition(0.5 * (width_px - extent_px[0]), 0.5 * (height_px - extent_px[1]));
      break;
  }
}

std::size_t Stage::ViewAt(double x_px) const {
  const double share = x_px / size_px()[0];
  const auto found =
      std::ranges::find_if(views_, [&](const auto& view) { return view->Contains(share); });
  return found == views_.end() ? views_.size() - 1
                               : static_cast<std::size_t>(found - views_.begin());
}

std::array<double, 2> Stage::InView(std::size_t view, double x_px, double y_px) const {
  return {x_px - views_[view]->left() * size_px()[0], y_px};
}

}  // namespace railcast
