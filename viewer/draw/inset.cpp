#include "viewer/draw/inset.h"

#include <vtkActor2D.h>
#include <vtkImageData.h>
#include <vtkImageMapper.h>
#include <vtkNew.h>
#include <vtkTextActor.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "viewer/draw/text_style.h"

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

}  // namespace railcast
