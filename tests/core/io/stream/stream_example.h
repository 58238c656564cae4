#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <string>
#include <vector>

#include "core/io/stream/frame_assembler.h"
#include "core/io/stream/stream_encoder.h"
#include "railcast/lidar.h"
#include "tests/core/io/example_frame.h"
#include "tests/support/made_datagrams.h"

namespace railcast {

inline constexpr std::uint32_t kStreamRows = 16;
inline constexpr std::uint32_t kStreamColumns = 300;
inline constexpr std::uint32_t kFiringSpacing_ns = 50'000;

/// Fires column by column, all rows of a column one after the other, which is not the order of
/// slots.
inline ScanPattern StreamPattern(std::uint32_t rows = kStreamRows,
                                 std::uint32_t columns = kStreamColumns) {
  ScanPattern pattern;
  pattern.rate_hz = 10.0;
  pattern.rows = rows;
  pattern.columns = columns;
  for (std::uint32_t column = 0; column < columns; ++column) {
    for (std::uint32_t row = 0; row < rows; ++row) {
      pattern.time_ns.push_back(kFiringSpacing_ns * (column * rows + row));
      pattern.row.push_back(static_cast<std::uint16_t>(row));
      pattern.column.push_back(column);
    }
  }
  return pattern;
}

/// Returns an example frame whose firings have the times of StreamPattern.
inline Frame StreamFrame(std::uint32_t index,
                         std::uint32_t rows = kStreamRows,
                         std::uint32_t columns = kStreamColumns) {
  Frame frame = ExampleFrame(index, rows, columns);
  frame.duration_ns = kFiringSpacing_ns * (rows * columns - 1);
  for (std::uint32_t slot = 0; slot < frame.num_slots(); ++slot) {
    frame.time_ns[slot] = kFiringSpacing_ns * (slot % columns * rows + slot / columns);
  }
  return frame;
}

/// Returns the datagrams of one scan as separate strings.
inline std::vector<std::string> DatagramsOf(const Frame& frame, const StreamSpec& spec = {}) {
  StreamEncoder encoder(StreamPattern(frame.rows, frame.columns), spec);
  Datagrams datagrams;
  encoder.Encode(frame, datagrams);
  return PayloadTexts(datagrams);
}

/// Corrects the CRC, as a forger would.
inline void Seal(std::string& datagram) {
  const std::size_t checked = datagram.size() - 4;
  const auto crc = static_cast<std::uint32_t>(::crc32(
      0, reinterpret_cast<const unsigned char*>(datagram.data()), static_cast<unsigned>(checked)));
  std::memcpy(datagram.data() + checked, &crc, sizeof crc);
}

/// Returns the datagram with another value at an offset of its header and a correct CRC.
template <typename T>
std::string With(std::string datagram, std::size_t at, T value) {
  std::memcpy(datagram.data() + at, &value, sizeof value);
  Seal(datagram);
  return datagram;
}

/// Returns the frames that an assembler gives for these datagrams.
inline std::vector<ReceivedFrame> Feed(FrameAssembler& assembler,
                                       const std::vector<std::string>& datagrams) {
  std::vector<ReceivedFrame> frames;
  for (const std::string& datagram : datagrams) assembler.Take(datagram, frames);
  return frames;
}

/// Returns a frame as received without any loss.
inline ReceivedFrame ReceiveWhole(const Frame& frame, const StreamSpec& spec = {}) {
  FrameAssembler assembler;
  auto frames = Feed(assembler, DatagramsOf(frame, spec));
  EXPECT_EQ(frames.size(), 1U);
  EXPECT_EQ(assembler.counts().num_refused(), 0U);
  if (frames.empty()) return {};
  return std::move(frames.front());
}

}  // namespace railcast
