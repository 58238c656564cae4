#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/io/image/png.h"
#include "core/io/recording/image_list.h"
#include "railcast/frame.h"
#include "viewer/color/palette.h"

namespace railcast {

/// Which of a camera's images is shown over the points.
enum class PictureKind : std::uint8_t { kColor, kLabel, kDepth, kOff };
inline constexpr std::array<std::string_view, 4> kPictureKindNames = {"color", "label", "depth",
                                                                      "off"};

/// Depths are shown on a logarithmic scale between these, because they range over two powers of
/// ten.
inline constexpr double kNearestDepth_m = 2.0;
inline constexpr double kFarthestDepth_m = 200.0;

/// A camera's image as it is shown.
struct CameraPicture {
  std::uint32_t width_px{};
  std::uint32_t height_px{};
  std::vector<Rgb> pixels{};  ///< Row by row, from the upper left.
  std::string title{};        ///< "front   color   frame 20".
  /// Whether neighbouring pixels may be averaged; colours that stand for labels or depths may not.
  bool is_blendable{};
};

/// Returns the picture of an image in colours, without a title.
[[nodiscard]] CameraPicture MakeColorPicture(const DecodedImage<std::uint8_t>& image);

/// Returns a picture in another size: the averages of the pixels that fall onto each of the new
/// ones, or the pixel in their middle where they may not be averaged.
/// @pre Neither size is 0.
[[nodiscard]] std::vector<Rgb> ScaledPixels(const CameraPicture& picture,
                                            const std::array<int, 2>& size_px);

/// The pictures beside the frames of a recording.
class RecordedPictures {
 public:
  /// @param source Reads nothing if it is not the directory of a sequence with a camera.
  explicit RecordedPictures(std::filesystem::path source) : source_(std::move(source)) {}

  /// Returns the latest picture that was there when a frame was taken; null if there is none.
  /// @param place Of the frame in the directory, counted from 0.
  /// @throws InputError with one line if it cannot be read.
  [[nodiscard]] std::shared_ptr<const CameraPicture> At(std::size_t place, PictureKind kind);

 private:
  [[nodiscard]] CameraPicture Read(const ImageList::FrameImages& images, PictureKind kind);

  std::filesystem::path source_;
  std::optional<ImageList> list_;                  ///< Absent until it is first needed.
  std::optional<LabelTable> labels_;               ///< Absent until they are first needed.
  std::shared_ptr<const CameraPicture> last_;      ///< The picture that was read last, ...
  std::pair<std::size_t, PictureKind> last_is_{};  ///< ... its frame's place and its kind.
};

}  // namespace railcast
