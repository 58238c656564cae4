#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "core/io/stream/udp_grabber.h"
#include "viewer/frames/frame_shelf.h"
#include "viewer/frames/frames.h"

namespace railcast {

/// A live stream in the railcast protocol: its latest frame and some before it.
class LiveFrames final : public Frames {
 public:
  /// Listens from now on.
  /// @param source "udp://...", for messages.
  /// @param wanted Whose frames are shown, if several send to the port.
  /// @throws InputError if the port cannot be listened to.
  LiveFrames(const std::string& source, const Endpoint& at, const WantedStream& wanted = {});
  ~LiveFrames() override;
  LiveFrames(const LiveFrames&) = delete;
  LiveFrames& operator=(const LiveFrames&) = delete;

  [[nodiscard]] std::shared_ptr<const ShownFrame> Get(std::size_t place) override;
  [[nodiscard]] std::size_t num_known() const override { return num_taken_; }
  /// Of the frames the last ones are kept, at most 64.
  [[nodiscard]] std::size_t first_known() const override { return num_taken_ - kept_.size(); }

  /// Takes the frame that came last since the last call, if any, as the next one. Others between
  /// are passed over: whoever shows frames more slowly than they come falls not behind.
  /// @returns Whether there was one that can be shown; if it cannot, fault() says why.
  bool Poll();
  /// Of the frame that came last; empty if there is none.
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// Packets that the frame taken last lacks.
  [[nodiscard]] std::size_t num_lost_packets() const { return num_lost_packets_; }

  [[nodiscard]] Endpoint at() const { return grabber_.at(); }
  /// Since a frame came, whether or not it was taken or can be shown; infinite before the first.
  [[nodiscard]] double seconds_since_last() const;
  /// "live 10.0 frames/s   0 packets lost", since it listens; "   also heard: sensor 1" if another
  /// sensor than the one shown sends to the port, "   also heard: 10.0.0.7:4711" if another sender
  /// of that sensor does, "   no frame for 5 s" once they stop.
  [[nodiscard]] std::string StatusText() const;

 private:
  FrameShelf kept_{{.num_frames = 64}};  ///< The last ones.
  std::size_t num_taken_{};
  std::string fault_;
  std::size_t num_lost_packets_{};
  mutable std::mutex mutex_;  ///< Of what the grabber's thread changes.
  std::shared_ptr<const ReceivedFrame> latest_;
  std::optional<std::chrono::steady_clock::time_point> last_arrival_;
  UdpGrabber grabber_;  ///< Ends before what its callback uses.
};

}  // namespace railcast
