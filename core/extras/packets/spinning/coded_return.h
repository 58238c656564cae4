#pragma once

#include <cstdint>
#include <utility>

#include "core/io/field_layout.h"

namespace railcast {

/// One return as a packet encodes it; all zeros if there is none.
struct CodedReturn {
  std::uint16_t distance{};
  std::uint8_t reflectivity{};
};

/// Writes a return as packets have it.
inline void StoreCoded(const CodedReturn& coded, char* place) {
  StoreAt<std::uint16_t>(place, coded.distance);
  StoreAt<std::uint8_t>(place + sizeof coded.distance, coded.reflectivity);
}

/// Returns a range in whole units; 0 if there is none, or if it lies beyond 65535 units.
[[nodiscard]] inline std::uint16_t CodedDistance(float range_m, double unit_m) {
  const double num_units = static_cast<double>(range_m) / unit_m + 0.5;
  // Written so that NaN, which means no return, is left out, too.
  if (!(num_units >= 1.0 && num_units < 65536.0)) return 0;
  return static_cast<std::uint16_t>(num_units);
}

/// The two returns of a firing as dual modes order them.
struct CodedPair {
  CodedReturn last;
  CodedReturn other;  ///< The strongest, or the second strongest if that is the last.
};

/// Orders the returns of ReturnMode::kDual. The second slot holds the last return if that differs
/// from the strongest, and otherwise the second strongest, which is then nearer: in both cases the
/// farther one is the last. A return that is missing repeats the other; where both are missing,
/// both say what is nearest of the reasons.
/// @param least The least distance that is one; smaller ones say why there is no return, those of
///   nearer things by smaller numbers.
[[nodiscard]] inline CodedPair LastAndOther(CodedReturn strongest,
                                            CodedReturn other,
                                            std::uint16_t least) {
  if (other.distance > strongest.distance) std::swap(strongest, other);
  if (strongest.distance < least) return {other, other};
  return {strongest, other.distance < least ? strongest : other};
}

}  // namespace railcast
