#include "viewer/frames/camera_picture.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/image/npy_decoder.h"
#include "core/io/image/png.h"
#include "core/io/run/sequence_files.h"
#include "railcast/scenario.h"
#include "viewer/color/palette.h"

namespace railcast {
namespace {

CameraPicture PictureOf(const ImageSize& size) {
  CameraPicture picture{.width_px = size.width_px, .height_px = size.height_px};
  picture.pixels.reserve(std::size_t{size.width_px} * size.height_px);
  return picture;
}

CameraPicture LabelPicture(std::string_view bytes, const LabelTable& labels) {
  const auto image = DecodePngGrey16(bytes);
  std::unordered_map<std::uint16_t, Rgb> colors;
  for (const Label& label : labels.labels()) {
    colors.emplace(static_cast<std::uint16_t>(label.id), label.rgb);
  }
  CameraPicture picture = PictureOf(image.size);
  for (const std::uint16_t id : image.values) {
    const auto color = colors.find(id);
    picture.pixels.push_back(color == colors.end() ? kNoValueColor : color->second);
  }
  return picture;
}

CameraPicture DepthPicture(std::string_view bytes) {
  const auto image = DecodeNpy(bytes);
  CameraPicture picture = PictureOf(image.size);
  const double num_nepers = std::log(kFarthestDepth_m / kNearestDepth_m);
  for (const float depth_m : image.values) {
    const double place = std::log(std::max<double>(depth_m, 1e-3) / kNearestDepth_m) / num_nepers;
    picture.pixels.push_back(std::isnan(depth_m) ? kNoValueColor
                                                 : MapColor(ColorMap::kViridis, place));
  }
  return picture;
}

/// Returns the range of source pixels under a target pixel; at least one.
std::pair<std::size_t, std::size_t> PixelsUnder(int target, int num_targets, std::uint32_t count) {
  const auto edge = [&](int at) {
    return static_cast<std::size_t>(at) * count / static_cast<std::size_t>(num_targets);
  };
  return {edge(target), std::max(edge(target) + 1, edge(target + 1))};
}

Rgb MeanOf(const CameraPicture& picture,
           const std::pair<std::size_t, std::size_t>& rows,
           const std::pair<std::size_t, std::size_t>& columns) {
  std::array<std::size_t, 3> sums{};
  for (std::size_t row = rows.first; row < rows.second; ++row) {
    for (std::size_t column = columns.first; column < columns.second; ++column) {
      const Rgb& pixel = picture.pixels[row * picture.width_px + column];
      for (std::size_t i = 0; i < 3; ++i) sums[i] += pixel[i];
    }
  }
  const std::size_t count = (rows.second - rows.first) * (columns.second - columns.first);
  Rgb mean;
  for (std::size_t i = 0; i < 3; ++i) {
    mean[i] = static_cast<std::uint8_t>((sums[i] + count / 2) / count);
  }
  return mean;
}

}  // namespace

CameraPicture MakeColorPicture(const DecodedImage<std::uint8_t>& image) {
  CameraPicture picture = PictureOf(image.size);
  picture.is_blendable = true;
  for (std::size_t i = 0; i < image.values.size(); i += 3) {
    picture.pixels.push_back({image.values[i], image.values[i + 1], image.values[i + 2]});
  }
  return picture;
}

std::vector<Rgb> ScaledPixels(const CameraPicture& picture, const std::array<int, 2>& size_px) {
  std::vector<Rgb> pixels;
  pixels.reserve(static_cast<std::size_t>(size_px[0]) * static_cast<std::size_t>(size_px[1]));
  for (int y = 0; y < size_px[1]; ++y) {
    const auto rows = PixelsUnder(y, size_px[1], picture.height_px);
    for (int x = 0; x < size_px[0]; ++x) {
      const auto columns = PixelsUnder(x, size_px[0], picture.width_px);
      const std::size_t middle =
          (rows.first + rows.second) / 2 * picture.width_px + (columns.first + columns.second) / 2;
      pixels.push_back(picture.is_blendable ? MeanOf(picture, rows, columns)
                                            : picture.pixels[middle]);
    }
  }
  return pixels;
}

CameraPicture RecordedPictures::Read(const ImageList::FrameImages& images, PictureKind kind) {
  const std::string folder = std::string(kPictureKindNames[static_cast<std::size_t>(kind)]) + "/";
  const KnownFile* const file = images.Find(folder);
  if (file == nullptr) {
    throw InputError(ShownPath(source_ / kFramesFile) + ": frame " + NumberText(images.frame) +
                     " has no image in " + folder);
  }
  const std::string bytes = list_->Read(*file);
  CameraPicture picture = AtPlace(ShownPath(source_ / file->name) + ": ", [&] {
    if (kind == PictureKind::kColor) return MakeColorPicture(DecodePngRgb(bytes));
    if (kind == PictureKind::kDepth) return DepthPicture(bytes);
    // Label images in KITTI's format have railcast's own ids, too.
    if (!labels_) labels_ = ReadLabelTable(source_ / kLabelsFile);
    return LabelPicture(bytes, *labels_);
  });
  picture.title = CameraNameIn(file->name) + "   ";
  picture.title += kPictureKindNames[static_cast<std::size_t>(kind)];
  if (kind == PictureKind::kDepth) {
    picture.title += ", " + NumberText(kNearestDepth_m) + " to " + NumberText(kFarthestDepth_m) +
                     " m, logarithmic";
  }
  picture.title += "   frame " + NumberText(images.frame);
  return picture;
}

std::shared_ptr<const CameraPicture> RecordedPictures::At(std::size_t place, PictureKind kind) {
  if (kind == PictureKind::kOff) return nullptr;
  if (!list_) list_ = ReadImageList(source_);
  const ImageList::FrameImages* const images = list_->LatestAt(place);
  if (images == nullptr) return nullptr;
  const std::pair wanted{images->place, kind};
  if (last_ && last_is_ == wanted) return last_;
  last_ = std::make_shared<const CameraPicture>(Read(*images, kind));
  last_is_ = wanted;
  return last_;
}

}  // namespace railcast
