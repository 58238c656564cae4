#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/io/stream/image_receiver.h"
#include "viewer/frames/camera_picture.h"

namespace railcast {

/// The pictures beside the frames of a live stream: the images that came last, as they were sent.
class LivePictures {
 public:
  /// What a frame and its image have in common.
  struct Instant {
    std::uint32_t run{};  ///< Of the sender, as in StreamHeader.
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

}  // namespace railcast
