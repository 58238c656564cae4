#pragma once

#include <cstddef>
#include <limits>
#include <list>
#include <memory>
#include <utility>

#include "viewer/frames/shown_frame.h"

namespace railcast {

/// What a frame takes in memory, but for the names of its objects.
[[nodiscard]] std::size_t NumBytesOf(const ShownFrame& shown);

/// Frames that are kept in case that they are asked for again. Whatever their size, they take no
/// more than a budget; only the frame that was put last is kept in any case.
class FrameShelf {
 public:
  struct Limits {
    std::size_t num_frames = std::numeric_limits<std::size_t>::max();
    std::size_t num_bytes = std::size_t{512} << 20U;
  };

  explicit FrameShelf(const Limits& limits) : limits_(limits) {}

  /// Puts a frame before all others; the last ones go if there is no room.
  /// @pre None of that place is there.
  void Put(std::size_t place, std::shared_ptr<const ShownFrame> shown);
  /// Null if it is not there (any more).
  [[nodiscard]] std::shared_ptr<const ShownFrame> Find(std::size_t place) const;
  /// The same, and puts it before all others again.
  [[nodiscard]] std::shared_ptr<const ShownFrame> Use(std::size_t place);

  [[nodiscard]] std::size_t size() const { return frames_.size(); }
  [[nodiscard]] std::size_t num_bytes() const { return num_bytes_; }

 private:
  Limits limits_;
  std::list<std::pair<std::size_t, std::shared_ptr<const ShownFrame>>> frames_;
  std::size_t num_bytes_{};
};

}  // namespace railcast
