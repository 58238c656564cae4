#pragma once

#include <string>
#include <vector>

namespace railcast {

// What decides a trace's last bits besides the scene: Embree and the instruction set it uses.

/// Embree's version as the loaded library tells it: "3.13.5".
[[nodiscard]] std::string EmbreeVersion();

/// The instruction sets that Embree knows, from the oldest: "sse2", "sse4.2", "avx", "avx2",
/// "avx512".
[[nodiscard]] std::vector<std::string> IsaNames();

/// The instruction set that a TraceDevice of `isa` uses: `isa` itself, or, where that is empty, the
/// best of this machine that Embree was built for.
/// @throws InputError "isa: must be an instruction set of this machine, ... (got avx512)".
[[nodiscard]] std::string IsaInUse(const std::string& isa);

}  // namespace railcast
