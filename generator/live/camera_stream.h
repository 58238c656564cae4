#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/io/datagrams.h"
#include "core/io/net/udp.h"
#include "railcast/camera.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// Renders the images of a scenario's camera and sends them to its receivers.
class CameraStream {
 public:
  /// @param scenario Has a camera with receivers, and one sensor, whose stamps the images have.
  /// @param run Distinguishes this start from others.
  /// @throws InputError if a receiver cannot be sent to.
  CameraStream(const ScenarioSpec& scenario, bool has_offload, std::uint32_t run);

  [[nodiscard]] const std::string& name() const { return camera_.spec().name; }
  /// The sensor's frame that has the stamp of an image.
  [[nodiscard]] std::uint32_t FrameOf(std::uint32_t image) const { return image * num_frames_; }

  /// Appends the datagrams of an image.
  /// @param simulator The sensor's, in the state of that frame.
  void Make(Simulator& simulator, std::uint32_t image, Datagrams& datagrams);
  /// Restarts with image 0.
  void Restart(std::uint32_t run) { run_ = run; }

  /// May be called from another thread than the other functions.
  void Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items) {
    sender_.Send(datagrams, items);
  }
  [[nodiscard]] const UdpSender::Counts& delivered() const { return sender_.counts(); }

 private:
  Camera camera_;
  std::uint32_t num_frames_;
  std::uint32_t run_;
  CameraImage image_;
  UdpSender sender_;
};

/// The receivers of the scenario's images; empty if it has no camera or the camera names none.
/// @throws InputError "/camera/udp: ..." if one cannot be understood.
[[nodiscard]] std::vector<Endpoint> ImageReceivers(const ScenarioSpec& scenario);

}  // namespace railcast
