#ifndef RAILCAST_TESTS_FUZZ_FUZZ_TARGET_H_
#define RAILCAST_TESTS_FUZZ_FUZZ_TARGET_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace railcast {

/// What reads the bytes that a fuzzer makes; 0 where it has read them or refused them as it should.
using FuzzTarget = int (*)(const std::uint8_t* data, std::size_t size);

/// The targets of this program by the names of their corpora.
inline std::map<std::string, FuzzTarget>& FuzzTargets() {
  static std::map<std::string, FuzzTarget> targets;
  return targets;
}

inline bool AddFuzzTarget(const char* name, FuzzTarget target) {
  return FuzzTargets().emplace(name, target).second;
}

}  // namespace railcast

/// Begins the definition of the target of corpus/NAME, a function of `data` and `size`: libFuzzer's
/// entry point in a fuzzer, which has one, else one of FuzzTargets().
#ifdef RAILCAST_FUZZER
#define RAILCAST_FUZZ_TARGET(name) \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
#else
#define RAILCAST_FUZZ_TARGET(name)                                                            \
  static int Try_##name(const std::uint8_t* data, std::size_t size);                          \
  static const bool has_##name [[maybe_unused]] = railcast::AddFuzzTarget(#name, Try_##name); \
  static int Try_##name(const std::uint8_t* data, std::size_t size)
#endif

#endif  // RAILCAST_TESTS_FUZZ_FUZZ_TARGET_H_
