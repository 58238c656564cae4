#pragma once

#include <string>

#include "railcast/alignment.h"
#include "tests/core/io/message_of.h"

namespace railcast {

/// Returns the error for an alignment that is not possible; "no error" for one that is.
inline std::string FaultOf(const AlignmentSpec& spec) {
  return MessageOf([&] { const Alignment alignment(spec); });
}

}  // namespace railcast
