#pragma once

#include <string>

#include "core/base/error.h"
#include "railcast/alignment.h"

namespace railcast {

/// Returns the error for an alignment that is not possible; "none" for one that is.
inline std::string FaultOf(const AlignmentSpec& spec) {
  try {
    const Alignment alignment(spec);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

}  // namespace railcast
