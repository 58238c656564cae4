#pragma once

#include <cstdint>
#include <string>

#include "core/base/error.h"
#include "core/base/number_text.h"
#include "core/scan/scan_pattern.h"

namespace railcast {

/// @param option What the user named the frame by.
/// @throws InputError if the frame is so late that its stamp does not fit into 64 bits.
inline void CheckHasStamp(const std::string& option,
                          const ScanPattern& pattern,
                          std::uint32_t frame) {
  if (frame <= pattern.LastFrame()) return;
  std::string line = option;
  line.append(": must lead to no frame after ").append(std::to_string(pattern.LastFrame()));
  line.append(", since the next begins after 292 years at ").append(NumberText(pattern.rate_hz));
  line.append(" Hz (got frame ").append(std::to_string(frame)).append(")");
  throw InputError(line);
}

}  // namespace railcast
