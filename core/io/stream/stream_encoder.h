#pragma once

#include <cstdint>
#include <vector>

#include "core/frame/output_spec.h"
#include "core/io/datagrams.h"
#include "core/io/field_selection.h"
#include "core/scan/scan_pattern.h"

namespace railcast {

/// What a stream in the railcast protocol carries.
struct StreamSpec {
  FieldSelection fields{"x,y,z,intensity,ring,time_ns,label,instance"};
  bool has_all_slots = false;  ///< Else only the returned points are sent.
  OutputSpec output{};         ///< Of the frames.
  std::uint16_t sensor{};      ///< Of the vehicle.
  std::uint32_t run{};         ///< Larger at each restart: frame numbers begin anew.
};

/// Frames in the railcast protocol (docs/stream.md): points in the order of their firings, so that
/// a datagram can leave when its last point has been fired.
///
/// All datagrams of a frame but the last have equal size. A frame without a point is one datagram,
/// due at its last firing.
class StreamEncoder final : public FrameEncoder {
 public:
  StreamEncoder(const ScanPattern& pattern, const StreamSpec& spec);

  /// @throws InputError if a frame may need more than the 65535 datagrams that the protocol counts.
  void Encode(const Frame& frame, Datagrams& datagrams) override;

 private:
  /// Where one field's values are, and how they go into a point.
  struct FieldSource {
    const char* values{};
    std::size_t size{};
    std::size_t offset{};
  };

  void FindSources(const Frame& frame);
  void ChooseSlots(const Frame& frame);
  void WriteFrameHeader(const Frame& frame);
  /// The points of slots_[first, first + count) behind the header at `datagram`.
  void WriteDatagram(std::size_t first, std::size_t count, char* datagram) const;

  StreamSpec spec_;
  std::uint32_t rows_;
  std::uint32_t columns_;
  std::vector<std::uint32_t> cells_;  ///< Of the grid, in firing order.
  std::vector<char> header_;          ///< Of every datagram but for its number, its points.
  std::size_t point_size_{};
  std::vector<FieldSource> sources_;  ///< Of the frame at hand.
  std::vector<std::uint32_t> slots_;  ///< That are sent, in firing order.
};

}  // namespace railcast
