#pragma once

#include <cstdint>

#include "core/io/datagrams.h"
#include "railcast/camera.h"

namespace railcast {

/// What the datagrams of an image say beside the image.
struct ImageSending {
  std::uint32_t run{};       ///< Distinguishes this start from others, as in StreamSpec.
  std::uint32_t frame{};     ///< Number of the sensor's frame that has the image's stamp.
  std::int64_t spread_ns{};  ///< Time from the stamp over which the datagrams are spread.
};

/// Appends the datagrams that carry an image as JPEG, in the railcast protocol for images
/// (docs/stream.md). All but the last have equal size.
void EncodeImageDatagrams(const CameraImage& image,
                          const CameraSpec& spec,
                          const ImageSending& sending,
                          Datagrams& datagrams);

}  // namespace railcast
