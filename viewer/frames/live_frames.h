#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "railcast/io/udp_grabber.h"
#include "viewer/frames/frame_shelf.h"
#include "viewer/frames/frames.h"

namespace railcast {

/// A live stream in the railcast protocol: its latest frame and some before it.
class LiveFrames final : public Frames {
 public:
  /// Starts listening.
  /// @param source "udp://...", for messages.
  /// @param wanted Which sender and sensor are shown, if several send to the port.
  /// @throws InputError if the port cannot be listened to.
  LiveFrames(const std::string& source, const Endpoint& at, const WantedStream& wanted = {});
  ~LiveFrames() override;
  LiveFrames(const LiveFrames&) = delete;
  LiveFrames& operator=(const LiveFrames&) = delete;

  [[nodiscard]] std::shared_ptr<const ShownFrame> Get(std::size_t place) override;
  [[nodiscard]] std::size_t num_known() const override { return num_taken_; }
  /// At most the last 64 frames are kept.
  [[nodiscard]] std::size_t first_known() const override { return num_taken_ - kept_.size(); }

  /// Takes the latest frame that has come since the last call, if any, as the next one. Frames in
  /// between are skipped, so that a display slower than the stream does not fall behind.
  /// @returns Whether a frame was taken; if one came that cannot be shown, fault() says why.
  bool Poll();
  /// Says what is wrong with the frame that came last; empty if nothing is.
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// Number of packets missing from the frame taken last.
  [[nodiscard]] std::size_t num_lost_packets() const { return num_lost_packets_; }

  [[nodiscard]] Endpoint at() const { return grabber_.at(); }
  /// Returns the time since a frame came, whether or not it was taken or could be shown; infinite
  /// before the first.
  [[nodiscard]] double seconds_since_last() const;
  /// Returns "live 10.0 frames/s   0 packets lost", counted since listening began. "   also heard:
  /// sensor 1" is added if a sensor other than the one shown sends to the port, "   also heard:
  /// 10.0.0.7:4711" if another sender of that sensor does, and "   no frame for 5 s" once frames
  /// stop coming.
  [[nodiscard]] std::string StatusText() const;

 private:
  FrameShelf kept_{{.num_frames = 64}};  ///< The latest frames.
  std::size_t num_taken_{};
  std::string fault_;
  std::size_t num_lost_packets_{};
  mutable std::mutex mutex_;  ///< Guards what the grabber's thread changes.
  std::shared_ptr<const ReceivedFrame> latest_;
  std::optional<std::chrono::steady_clock::time_point> last_arrival_;
  /// The last member, so that it ends before what its callback uses is destroyed.
  UdpGrabber grabber_;
};

}  // namespace railcast
