#include "core/trace/trace_program.h"

#include <embree3/rtcore.h>

#include <array>
#include <memory>
#include <type_traits>
#include <vector>

#include "core/base/error.h"

namespace railcast {
namespace {

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release>;

/// Without a property that tells: whether Embree was built for packets that wide.
constexpr RTCDeviceProperty kNone = RTC_DEVICE_PROPERTY_VERSION;

struct Isa {
  const char* name;
  RTCDeviceProperty packets;
};

constexpr std::array<Isa, 5> kIsas = {{{"sse2", kNone},
                                       {"sse4.2", kNone},
                                       {"avx", RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED},
                                       {"avx2", RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED},
                                       {"avx512", RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED}}};

// Embree makes no device for what the processor lacks.
bool IsAvailable(const Isa& isa) {
  const Device device(rtcNewDevice((std::string("isa=") + isa.name).c_str()));
  return device != nullptr && rtcGetDeviceProperty(device.get(), isa.packets) != 0;
}

}  // namespace

std::string EmbreeVersion() {
  const Device device(rtcNewDevice(""));
  Check(device != nullptr, "Embree makes a device");
  const auto part = [&](RTCDeviceProperty property) {
    return std::to_string(rtcGetDeviceProperty(device.get(), property));
  };
  return part(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." + part(RTC_DEVICE_PROPERTY_VERSION_MINOR) +
         "." + part(RTC_DEVICE_PROPERTY_VERSION_PATCH);
}

std::string IsaInUse(const std::string& isa) {
  std::string best;
  std::string all;
  for (const Isa& one : kIsas) {
    if (!IsAvailable(one)) continue;
    if (one.name == isa) return isa;
    best = one.name;
    all += (all.empty() ? "" : ", ") + best;
  }
  if (isa.empty()) return best;
  throw InputError("isa: must be an instruction set of this machine, one of " + all + " (got " +
                   isa + ")");
}

}  // namespace railcast
