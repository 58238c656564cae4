#pragma once

#include <string>
#include <utility>

#include "core/base/error.h"

namespace railcast {

/// Returns the message of the InputError that `work` throws, or "no error" if it throws none.
template <typename Work>
std::string MessageOf(Work&& work) {
  try {
    std::forward<Work>(work)();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace railcast
