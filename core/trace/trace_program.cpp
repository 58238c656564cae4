#include "core/trace/trace_program.h"

#include <array>
#include <memory>
#include <type_traits>
#include <vector>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/trace/embree.h"

namespace railcast {
namespace {

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release>;

/// Marks instruction sets for which no device property tells whether Embree was built for packets
/// of the corresponding width.
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

/// Makes a device; null if the processor lacks the instruction set. Querying the error also clears
/// it: Embree keeps a thread's first error until it is queried.
Device NewDevice(const std::string& config) {
  Device device(rtcNewDevice(config.c_str()));
  if (device == nullptr && rtcGetDeviceError(nullptr) == RTC_ERROR_OUT_OF_MEMORY) {
    throw OutOfMemory("asking Embree what it can do");
  }
  return device;
}

bool IsAvailable(const Isa& isa) {
  const Device device = NewDevice(std::string("isa=") + isa.name);
  return device != nullptr && rtcGetDeviceProperty(device.get(), isa.packets) != 0;
}

}  // namespace

std::string EmbreeVersion() {
  const Device device = NewDevice("");
  Check(device != nullptr, "Embree makes a device");
  const auto part = [&](RTCDeviceProperty property) {
    return std::to_string(rtcGetDeviceProperty(device.get(), property));
  };
  return part(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." + part(RTC_DEVICE_PROPERTY_VERSION_MINOR) +
         "." + part(RTC_DEVICE_PROPERTY_VERSION_PATCH);
}

std::vector<std::string> IsaNames() {
  std::vector<std::string> names;
  for (const Isa& isa : kIsas) names.emplace_back(isa.name);
  return names;
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
