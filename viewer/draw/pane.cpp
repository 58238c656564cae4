#include "viewer/draw/pane.h"

#include <vtkActor2D.h>
#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkImageData.h>
#include <vtkImageMapper.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkTextActor.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "viewer/draw/actors.h"
#include "viewer/draw/text_style.h"
#include "viewer/draw/vtk_values.h"

namespace railcast {
namespace {

vtkSmartPointer<vtkImageData> MakeImage(const CameraPicture& picture,
                                        const std::array<int, 2>& size_px) {
  const std::vector<Rgb> pixels = ScaledPixels(picture, size_px);
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(size_px[0], size_px[1], 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  for (int y = 0; y < size_px[1]; ++y) {
    // VTK's rows begin at the foot.
    const auto row = static_cast<std::size_t>(size_px[1] - 1 - y);
    const auto width = static_cast<std::size_t>(size_px[0]);
    std::memcpy(image->GetScalarPointer(0, y, 0), &pixels[row * width], width * sizeof(Rgb));
  }
  return image;
}

constexpr double kLineWidth_px = 1.5;

}  // namespace

Inset MakeInset(const CameraPicture& picture,
                const std::array<int, 2>& size_px,
                bool has_scale,
                const Background& background) {
  constexpr double kMostOfView = 0.4;
  const double factor = kMostOfView * std::min(static_cast<double>(size_px[0]) / picture.width_px,
                                               static_cast<double>(size_px[1]) / picture.height_px);
  const auto length_px = [&](std::uint32_t own_px) {
    return std::max(1, static_cast<int>(std::lround(factor * own_px)));
  };
  const std::array shown_px = {length_px(picture.width_px), length_px(picture.height_px)};
  const double margin_px = std::round(size_px[1] / 60.0);
  const double right_px = size_px[0] - (has_scale ? std::round(0.18 * size_px[1]) : margin_px);
  Inset inset;
  inset.to_px = {right_px, size_px[1] - margin_px};
  inset.from_px = {inset.to_px[0] - shown_px[0], inset.to_px[1] - shown_px[1]};

  vtkNew<vtkImageMapper> mapper;
  mapper->SetInputData(MakeImage(picture, shown_px));
  // Bytes are shown as they are.
  mapper->SetColorWindow(255.0);
  mapper->SetColorLevel(127.5);
  vtkNew<vtkActor2D> image;
  image->SetMapper(mapper);
  image->SetPosition(inset.from_px[0], inset.from_px[1]);
  const auto title =
      MakeText(picture.title, background, size_px[1],
               {inset.to_px[0], inset.from_px[1] - 0.03 * size_px[1]}, TextAnchor::kRightBottom);
  AddPlate(*title->GetTextProperty(), background);
  inset.props = {image.Get(), title};
  return inset;
}

Pane::Pane(double left, double right)
    : left_(left), right_(right), composition_(std::make_shared<const Composition>()) {
  renderer_->SetViewport(left, 0.0, right, 1.0);
  // Views share a camera, but each has its own depth range: with another view's range its points
  // would be clipped.
  renderer_->AddObserver(
      vtkCommand::StartEvent, renderer_.Get(),
      static_cast<void (vtkRenderer::*)()>(&vtkRenderer::ResetCameraClippingRange));
}

std::array<int, 2> Pane::SizeIn(const std::array<int, 2>& window_px) const {
  return {static_cast<int>(std::lround((right_ - left_) * window_px[0])), window_px[1]};
}

void Pane::ShowClouds(const Look& look) {
  while (clouds_.size() > composition_->clouds.size()) {
    renderer_->RemoveActor(&clouds_.back()->actor());
    clouds_.pop_back();
  }
  while (clouds_.size() < composition_->clouds.size()) {
    clouds_.push_back(std::make_unique<CloudActor>());
    renderer_->AddActor(&clouds_.back()->actor());
  }
  for (std::size_t i = 0; i < clouds_.size(); ++i) {
    clouds_[i]->Show(composition_->clouds[i], look);
  }
}

void Pane::ShowSurfaces() {
  auto old = std::exchange(surfaces_, {});
  for (const PlacedParts& placed : composition_->surfaces) {
    auto node = old.extract(placed.parts);
    if (node) {
      surfaces_.insert(std::move(node));
    } else {
      for (const auto& actor :
           surfaces_[placed.parts] = MakeSurfaces(*placed.parts, composition_->labels)) {
        renderer_->AddActor(actor);
      }
    }
    for (const auto& actor : surfaces_[placed.parts]) {
      vtkNew<vtkMatrix4x4> matrix;
      SetMatrix(placed.view_from_parts, *matrix);
      actor->SetUserMatrix(matrix);
    }
  }
  for (const auto& [parts, actors] : old) {
    for (const auto& actor : actors) renderer_->RemoveActor(actor);
  }
}

void Pane::Show(std::shared_ptr<const Composition> composition,
                const Look& look,
                const std::array<int, 2>& window_px) {
  composition_ = std::move(composition);
  height_px_ = window_px[1];
  renderer_->SetBackground(VtkColor(look.background.rgb).data());
  for (const auto& prop : fleeting_) renderer_->RemoveViewProp(prop);
  fleeting_.clear();
  ShowClouds(look);
  ShowSurfaces();
  const Overlay overlays = OnBackground(composition_->overlays, look.background);
  if (!composition_->empty_beams.segments.empty()) {
    fleeting_.emplace_back(MakeLines(composition_->empty_beams, 1.0));
  }
  if (!overlays.segments.empty()) {
    fleeting_.emplace_back(MakeLines(overlays, kLineWidth_px));
  }
  for (auto& word : MakeWords(overlays, height_px_ / 50, look.background))
    fleeting_.push_back(std::move(word));
  legend_ = MakeLegend(composition_->coloring, composition_->beam_kinds, SizeIn(window_px),
                       look.background);
  fleeting_.insert(fleeting_.end(), legend_.props.begin(), legend_.props.end());
  inset_ = composition_->picture
               ? MakeInset(*composition_->picture, SizeIn(window_px),
                           composition_->coloring.ends.has_value(), look.background)
               : Inset();
  fleeting_.insert(fleeting_.end(), inset_.props.begin(), inset_.props.end());
  for (const auto& prop : fleeting_) renderer_->AddViewProp(prop);
  ShowStatus(composition_->status, look);
  renderer_->ResetCameraClippingRange();
}

void Pane::ShowStatus(const std::string& status, const Look& look) {
  if (status_) renderer_->RemoveViewProp(status_);
  // Leaves room for the slider at the window's foot.
  const std::array<double, 2> place_px = {height_px_ / 60.0, height_px_ / 27.0};
  const auto text =
      MakeText(status, look.background, height_px_, place_px, TextAnchor::kLeftBottom);
  AddPlate(*text->GetTextProperty(), look.background);
  text->GetTextProperty()->SetLineSpacing(1.15);
  status_ = text;
  renderer_->AddViewProp(status_);
}

void Pane::ShowMarks(const Overlay& marks, const Look& look) {
  for (const auto& prop : marks_) renderer_->RemoveViewProp(prop);
  marks_.clear();
  const Overlay visible = OnBackground(marks, look.background);
  if (!visible.segments.empty()) marks_.emplace_back(MakeLines(visible, 2.0));
  for (auto& word : MakeWords(visible, height_px_ / 40, look.background))
    marks_.push_back(std::move(word));
  for (const auto& prop : marks_) renderer_->AddViewProp(prop);
}

}  // namespace railcast
