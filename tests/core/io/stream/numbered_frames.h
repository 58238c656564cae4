#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/io/stream/stream_encoder.h"
#include "railcast/io/stream.h"
#include "tests/core/io/stream/stream_example.h"

namespace railcast {

inline StreamSpec OfRun(std::uint32_t run, std::uint16_t sensor = 0) {
  StreamSpec spec;
  spec.run = run;
  spec.sensor = sensor;
  return spec;
}

inline std::vector<std::string> DatagramsOfFrames(std::uint32_t first,
                                                  std::uint32_t last,
                                                  const StreamSpec& spec = {}) {
  std::vector<std::string> datagrams;
  for (std::uint32_t index = first; index <= last; ++index) {
    for (std::string& datagram : DatagramsOf(StreamFrame(index), spec)) {
      datagrams.push_back(std::move(datagram));
    }
  }
  return datagrams;
}

inline std::vector<std::uint32_t> NumbersOf(const std::vector<ReceivedFrame>& frames) {
  std::vector<std::uint32_t> numbers;
  for (const ReceivedFrame& frame : frames) numbers.push_back(frame.header.frame);
  return numbers;
}

using Numbers = std::vector<std::uint32_t>;

}  // namespace railcast
