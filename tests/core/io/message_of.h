#pragma once

#include <string>
#include <utility>

#include "core/base/error.h"

namespace railcast {

/// What `work` says when it throws InputError; "no error" if it does not.
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
