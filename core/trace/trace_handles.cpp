#include "core/trace/trace_handles.h"

#include <stdexcept>

namespace railcast {

void ThrowIfEmbreeFailed(RTCDevice device, const std::string& doing) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw OutOfMemory(doing);
  throw std::runtime_error("Embree's error " + std::to_string(error) + " while " + doing);
}

}  // namespace railcast
