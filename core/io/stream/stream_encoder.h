#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/io/datagrams.h"
#include "core/io/stream/stream_layout.h"
#include "railcast/camera.h"
#include "railcast/frame.h"
#include "railcast/io/cloud_files.h"
#include "railcast/lidar.h"

namespace railcast {

/// What is sent of each point unless told otherwise: of sensors without, and with velocities.
inline constexpr const char* kUsualFields = "x,y,z,intensity,ring,time_ns,label,instance";
[[nodiscard]] inline FieldSelection UsualFields(bool has_velocity) {
  return has_velocity ? FieldSelection(std::string(kUsualFields) + ",radial_velocity_mps", true)
                      : FieldSelection(kUsualFields);
}

/// The content of a stream in the railcast protocol.
struct StreamSpec {
  FieldSelection fields = FieldSelection(kUsualFields);
  bool has_all_slots = false;  ///< If not set, only the returned points are sent.
  OutputSpec output{};         ///< The axes of the frames' points.
  std::uint16_t sensor{};      ///< Number of the sensor on the vehicle.
  std::uint32_t run{};         ///< Larger at each restart, since frame numbers begin anew.
};

/// Encodes frames in the railcast protocol (docs/stream.md). Points are in the order of their
/// firings, so that a datagram can leave when its last point has been fired.
///
/// All datagrams of a frame but the last have equal size. A frame without a point is one datagram,
/// due at its last firing. Large frames are written on all threads of the caller's TBB arena.
class StreamEncoder final : public FrameEncoder {
 public:
  StreamEncoder(const ScanPattern& pattern, const StreamSpec& spec);
  /// For frames of any shape, as recordings have them. The times of their points say in which order
  /// they were fired.
  explicit StreamEncoder(const StreamSpec& spec);

  /// @throws InputError if a frame may need more than the 65535 datagrams that the protocol can
  ///   count.
  void Encode(const Frame& frame, Datagrams& datagrams) override;

 private:
  /// Where the values of one field are, and where they go in a point.
  struct FieldSource {
    const char* values{};
    std::size_t size{};
    std::size_t offset{};
  };

  void OrderCells(const Frame& frame);
  void FindSources(const Frame& frame);
  void ChooseSlots(const Frame& frame);
  void BeginFrame(const Frame& frame);
  /// Writes the header and the points of a frame's datagram, each but the last of which has as
  /// many.
  void WriteDatagram(std::size_t packet, std::size_t points_each, char* datagram) const;

  /// The rows and columns of the grid whose firings have a known order.
  struct Shape {
    std::uint32_t rows{};
    std::uint32_t columns{};
  };

  StreamSpec spec_;
  std::optional<Shape> shape_;        ///< Absent: frames have any.
  std::vector<std::uint32_t> cells_;  ///< Cells of the grid in firing order.
  PointsHead head_;   ///< Head of the current frame's datagrams, but for their numbers and points.
  std::string list_;  ///< List of the fields, which follows the head.
  std::size_t point_size_{};
  std::vector<FieldSource> sources_;  ///< Sources of the current frame.
  std::vector<std::uint32_t> slots_;  ///< Slots to be sent, in firing order.
};

/// What the datagrams of an image say beside the image.
struct ImageSending {
  std::uint32_t run{};            ///< Distinguishes this start from others, as in StreamSpec.
  std::uint32_t frame{};          ///< Number of the sensor's frame that has the image's stamp.
  std::int64_t spread_ns{};       ///< Time from the stamp over which the datagrams are spread.
  std::int64_t clock_ahead_ns{};  ///< How far the stated stamp is ahead of the image's.
};

/// Appends the datagrams that carry an image as JPEG, in the railcast protocol for images
/// (docs/stream.md). All but the last have equal size.
void EncodeImageDatagrams(const CameraImage& image,
                          const CameraSpec& spec,
                          const ImageSending& sending,
                          Datagrams& datagrams);

}  // namespace railcast
