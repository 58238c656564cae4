#include "generator/live/camera_stream.h"

#include "core/base/error.h"
#include "core/io/stream/stream_encoder.h"
#include "core/scenario/sensors.h"

namespace railcast {

std::vector<Endpoint> ImageReceivers(const ScenarioSpec& scenario) {
  std::vector<Endpoint> receivers;
  if (!scenario.camera) return receivers;
  for (const std::string& to : scenario.camera->udp) {
    receivers.push_back(AtPlace("/camera/udp: ", [&] { return ParseEndpoint(to, 0); }));
  }
  return receivers;
}

CameraStream::CameraStream(const ScenarioSpec& scenario, bool has_offload, std::uint32_t run)
    : camera_(*MakeCamera(scenario)),
      num_frames_(FramesPerImage(scenario)),
      run_(run),
      sender_(ImageReceivers(scenario), kVelodynePositionPort, has_offload) {}

void CameraStream::Make(Simulator& simulator, std::uint32_t image, Datagrams& datagrams) {
  const std::uint32_t frame = FrameOf(image);
  camera_.Render(simulator, frame, image_);
  // Spread over a period of the sensor, as its own datagrams are.
  const std::int64_t period_ns = simulator.pattern().PeriodNs();
  EncodeImageDatagrams(image_, camera_.spec(),
                       {.run = run_, .frame = frame, .spread_ns = period_ns}, datagrams);
}

}  // namespace railcast
