#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "railcast/io/recording.h"

namespace railcast {

/// A frame and its points as they are shown.
struct ShownFrame {
  std::shared_ptr<const RecordedFrame> recorded;
  /// x, y, z of each point in turn, in the sensor's axes at the stamp: the motion of the sensor and
  /// of objects within the scan is undone where pose and times are known.
  std::vector<float> positions_m;
  std::vector<std::uint32_t> slots;  ///< Slot of each point in `recorded`.

  [[nodiscard]] std::size_t num_points() const { return slots.size(); }
  [[nodiscard]] const Frame& frame() const { return recorded->frame; }
};

[[nodiscard]] ShownFrame MakeShownFrame(RecordedFrame recorded);

/// Returns the memory that a frame takes, without the names of its objects.
[[nodiscard]] std::size_t NumBytesOf(const ShownFrame& shown);

/// A cache of frames, most recently used first. Whatever the size of the frames, they stay within a
/// budget; only the frame put last is always kept.
class FrameShelf {
 public:
  struct Limits {
    std::size_t num_frames = std::numeric_limits<std::size_t>::max();
    std::size_t num_bytes = std::size_t{512} << 20U;
  };

  explicit FrameShelf(const Limits& limits) : limits_(limits) {}

  /// Puts a frame first; the least recently used ones are dropped if there is no room.
  /// @pre The shelf has no frame of that place.
  void Put(std::size_t place, std::shared_ptr<const ShownFrame> shown);
  /// Returns null if the frame is not, or no longer, on the shelf.
  [[nodiscard]] std::shared_ptr<const ShownFrame> Find(std::size_t place) const;
  /// As Find(), and moves the frame to the front.
  [[nodiscard]] std::shared_ptr<const ShownFrame> Use(std::size_t place);

  [[nodiscard]] std::size_t size() const { return frames_.size(); }
  [[nodiscard]] std::size_t num_bytes() const { return num_bytes_; }

 private:
  Limits limits_;
  std::list<std::pair<std::size_t, std::shared_ptr<const ShownFrame>>> frames_;
  std::size_t num_bytes_{};
};

/// One value for every point of a frame.
struct FieldValues {
  enum class Kind : std::uint8_t {
    kAmount,
    kDifference,  ///< A quantity that may be negative or positive, shown about 0.
    kCategory     ///< Whole numbers that stand for categories.
  };
  Kind kind{};
  std::string title;           ///< Title of the legend, with its unit: "range [m]".
  std::vector<double> values;  ///< One per point; NaN where there is none.
};

/// Returns the names of the fields that a frame can be coloured by, in the order in which the
/// viewer steps through them: "label", "instance", "outcome", "range", "height", ...; then the
/// foreign fields under the names in their file, or as "file_height" where a railcast field has the
/// same name.
[[nodiscard]] std::vector<std::string> ColorableFields(const RecordedFrame& recorded);

/// Returns the values of one field for every point.
/// @param name One of ColorableFields().
/// @throws InputError "has no field power to color by (has: ...)" if the frame has no such field.
[[nodiscard]] FieldValues ValuesOf(const ShownFrame& shown, const std::string& name);

/// Returns "label" if the frame has that field, else "height".
[[nodiscard]] std::string DefaultColorField(const RecordedFrame& recorded);

}  // namespace railcast
