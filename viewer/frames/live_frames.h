#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "core/io/stream/image_receiver.h"
#include "railcast/io/udp_grabber.h"
#include "viewer/frames/camera_picture.h"
#include "viewer/frames/frames.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {

/// The pictures beside the frames of a live stream: the images that came last, as they were sent.
class LivePictures {
 public:
  /// What a frame and its image have in common.
  struct Instant {
    std::uint32_t run{};  ///< Run of the sender, as in StreamHeader.
    std::int64_t stamp_ns{};
  };

  /// Starts listening.
  /// @param source "udp://...", for messages.
  /// @param from As for ImageReceiver.
  /// @throws InputError if the port cannot be listened to.
  LivePictures(std::string source, const Endpoint& at, const std::optional<Endpoint>& from)
      : source_(std::move(source)), receiver_(at, from) {}

  /// Takes the images that have come since the last call; returns whether there were any.
  bool Poll();

  /// Returns the latest picture that was there at an instant; null if none has come.
  /// @throws InputError with one line if it cannot be decoded, or if images of this kind are not
  ///   sent.
  [[nodiscard]] std::shared_ptr<const CameraPicture> At(const Instant& instant, PictureKind kind);
  /// Whether At() has a picture that no image still to come will replace, because one of this
  /// instant or of a later one is there.
  [[nodiscard]] bool IsSettled(const Instant& instant) const;

  [[nodiscard]] Endpoint at() const { return receiver_.at(); }
  /// Returns "no image has come" or "2 images lost"; empty if there is nothing to say.
  [[nodiscard]] std::string StatusText() const;

 private:
  [[nodiscard]] const ReceivedImage* LatestAt(const Instant& instant) const;

  std::string source_;
  ImageReceiver receiver_;
  std::deque<ReceivedImage> kept_;  ///< In the order in which they came.
  std::size_t num_kept_bytes_{};
  std::shared_ptr<const CameraPicture> last_;          ///< The picture that was decoded last, ...
  std::pair<std::uint32_t, std::uint32_t> last_is_{};  ///< ... its run and its frame.
};

/// A live stream in the railcast protocol: its latest frame and some before it.
class LiveFrames final : public Frames {
 public:
  /// Starts listening.
  /// @param source "udp://...", for messages.
  /// @param wanted Which sender and sensor are shown, if several send to the port.
  /// @param images_at Where the camera's images are received; absent: nowhere. They have the same
  ///   sender's address, but any port.
  /// @throws InputError if a port cannot be listened to.
  LiveFrames(const std::string& source,
             const Endpoint& at,
             const WantedStream& wanted = {},
             const std::optional<Endpoint>& images_at = {});
  ~LiveFrames() override;
  LiveFrames(const LiveFrames&) = delete;
  LiveFrames& operator=(const LiveFrames&) = delete;

  [[nodiscard]] std::shared_ptr<const ShownFrame> Get(std::size_t place) override;
  [[nodiscard]] std::shared_ptr<const CameraPicture> Picture(std::size_t place,
                                                             PictureKind kind) override;
  [[nodiscard]] std::string PictureNeeds() const override;
  [[nodiscard]] std::size_t num_known() const override { return num_taken_; }
  /// At most the last 64 frames are kept.
  [[nodiscard]] std::size_t first_known() const override { return num_taken_ - kept_.size(); }

  /// Takes the latest frame that has come since the last call, if any, as the next one. Frames in
  /// between are skipped, so that a display slower than the stream does not fall behind.
  /// @returns Whether a frame was taken; if one came that cannot be shown, fault() says why.
  bool Poll();
  /// Takes the images that have come since the last call; returns whether there were any. An image
  /// may come after its frame, so that the picture of a frame that is shown may change.
  bool PollImages();
  /// Says what is wrong with the frame that came last; empty if nothing is.
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// Returns the place of the first kept frame from `first` on of which no packet is missing;
  /// nothing if there is none.
  /// @param with_picture Whether it must also have a picture, and for good.
  /// @pre Images are received if `with_picture` is set.
  [[nodiscard]] std::optional<std::size_t> FirstWhole(std::size_t first, bool with_picture) const;
  /// Whether an image still to come may be the picture of a frame, which must be kept for that.
  [[nodiscard]] bool MayGetPicture(std::size_t place) const;

  [[nodiscard]] Endpoint at() const { return grabber_.at(); }
  /// Where images are received; nothing if they are not.
  [[nodiscard]] std::optional<Endpoint> images_at() const;
  /// Returns the time since a frame came, whether or not it was taken or could be shown; infinite
  /// before the first.
  [[nodiscard]] double seconds_since_last() const;
  /// Returns "live 10.0 frames/s   0 packets lost", counted since listening began. "   also heard:
  /// sensor 1" is added if a sensor other than the one shown sends to the port, "   also heard:
  /// 10.0.0.7:4711" if another sender of that sensor does, "   no frame for 5 s" once frames stop
  /// coming, and what LivePictures says.
  [[nodiscard]] std::string StatusText() const;

 private:
  /// What is known of a frame beside what it shows.
  struct Taken {
    LivePictures::Instant instant;
    bool is_whole{};  ///< Whether all of its packets came.
  };
  [[nodiscard]] const Taken& TakenAt(std::size_t place) const {
    return taken_[taken_.size() - (num_taken_ - place)];
  }

  FrameShelf kept_{{.num_frames = 64}};  ///< The latest frames.
  std::deque<Taken> taken_;              ///< The latest, in the order of their places.
  std::size_t num_taken_{};
  std::string fault_;
  mutable std::mutex mutex_;  ///< Guards what the grabber's thread changes.
  std::shared_ptr<const ReceivedFrame> latest_;
  std::optional<std::chrono::steady_clock::time_point> last_arrival_;
  std::optional<LivePictures> pictures_;  ///< Absent if images are not received.
  /// The last member, so that it ends before what its callback uses is destroyed.
  UdpGrabber grabber_;
};

}  // namespace railcast
