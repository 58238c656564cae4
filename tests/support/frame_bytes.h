#pragma once

#include <string>
#include <string_view>

#include "railcast/frame.h"

namespace railcast {

/// Returns every bit of every field, so that frames that hold NaN can be compared.
[[nodiscard]] inline std::string FrameBytes(const Frame& frame) {
  std::string bytes;
  ForEachField(frame, [&](std::string_view, std::string_view, const auto& values) {
    const std::string_view all(reinterpret_cast<const char*>(values.data()),
                               values.size() * sizeof(values[0]));
    bytes += all;
  });
  return bytes;
}

}  // namespace railcast
