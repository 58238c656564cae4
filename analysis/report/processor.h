#pragma once

#include <string>

namespace railcast {

/// Returns the processor's name as Linux gives it, "Intel(R) Xeon(R) CPU @ 2.20GHz"; "unknown"
/// where it gives none, as on ARM.
[[nodiscard]] std::string ProcessorName();

}  // namespace railcast
