#pragma once

#include <string>

#include "core/base/error.h"
#include "core/rail/line/alignment.h"

namespace railcast {

/// What is said of a line that cannot be; "none" of one that can.
inline std::string FaultOf(const AlignmentSpec& spec) {
  try {
    const Alignment alignment(spec);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

}  // namespace railcast
