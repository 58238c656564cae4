#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/io/net/udp.h"
#include "core/io/stream/image_receiver.h"
#include "core/io/stream/stream_encoder.h"
#include "railcast/camera.h"
#include "tests/core/io/stream/stream_example.h"
#include "tests/support/made_datagrams.h"

namespace railcast {

inline CameraSpec ExampleCamera() {
  CameraSpec spec;
  spec.width_px = 80;
  spec.height_px = 60;
  spec.horizontal_fov_deg = 60.0;
  return spec;
}

/// Returns an image of noise, which needs several datagrams; each frame has another.
inline CameraImage NoiseImage(std::uint32_t frame) {
  const CameraSpec spec = ExampleCamera();
  CameraImage image;
  image.width_px = spec.width_px;
  image.height_px = spec.height_px;
  image.stamp_ns = 100'000'000 * std::int64_t{frame};
  image.world_from_camera.translation() = Vector3(frame, 20.0, 3.5);
  std::minstd_rand random(frame + 1);
  for (std::size_t i = 0; i < 3 * image.num_pixels(); ++i) {
    image.rgb.push_back(static_cast<std::uint8_t>(random() >> 8U));
  }
  return image;
}

inline void EncodeImage(std::uint32_t frame, std::uint32_t run, Datagrams& datagrams) {
  EncodeImageDatagrams(NoiseImage(frame), ExampleCamera(),
                       {.run = run, .frame = frame, .spread_ns = 100'000'000}, datagrams);
}

/// Returns the datagrams of an image as separate strings.
inline std::vector<std::string> ImageDatagramsOf(std::uint32_t frame, std::uint32_t run = 1) {
  Datagrams datagrams;
  EncodeImage(frame, run, datagrams);
  return PayloadTexts(datagrams);
}

inline void SendImage(std::uint32_t frame, std::uint32_t run, UdpSender& sender) {
  Datagrams datagrams;
  EncodeImage(frame, run, datagrams);
  sender.Send(datagrams, datagrams.items);
}

/// Returns the images that an assembler gives for these datagrams.
inline std::vector<ReceivedImage> Feed(ImageAssembler& assembler,
                                       const std::vector<std::string>& datagrams,
                                       const DatagramOrigin& origin = {}) {
  std::vector<ReceivedImage> images;
  for (const std::string& datagram : datagrams) assembler.Take(datagram, images, origin);
  return images;
}

}  // namespace railcast
