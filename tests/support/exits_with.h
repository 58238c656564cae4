#pragma once

#include <gmock/gmock.h>

#include <ostream>

#include "tests/support/run_command.h"

namespace railcast {

inline void PrintTo(const Ended& run, std::ostream* out) {
  *out << "exit status " << run.status << ": " << run.said;
}

/// Matches a command that ended with this status.
[[nodiscard]] inline auto ExitsWith(int status) {
  return testing::Field("status", &Ended::status, status);
}

/// The same for one that also said what `said` matches, which is a text or a matcher of texts.
template <typename Said>
[[nodiscard]] auto ExitsWith(int status, Said said) {
  return testing::AllOf(ExitsWith(status), testing::Field("said", &Ended::said, said));
}

}  // namespace railcast
