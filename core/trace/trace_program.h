#pragma once

#include <string>
#include <vector>

namespace railcast {

// Besides the scene, Embree and the instruction set it uses decide the last bits of a trace.

/// Version of the loaded Embree library, such as "3.13.5".
[[nodiscard]] std::string EmbreeVersion();

/// The instruction sets that Embree knows, oldest first: "sse2", "sse4.2", "avx", "avx2", "avx512".
[[nodiscard]] std::vector<std::string> IsaNames();

/// The instruction set that a TraceDevice made with `isa` uses: `isa` itself or, if it is empty,
/// the best one that this machine has and Embree was built for.
/// @throws InputError "isa: must be an instruction set of this machine, ... (got avx512)".
[[nodiscard]] std::string IsaInUse(const std::string& isa);

}  // namespace railcast
