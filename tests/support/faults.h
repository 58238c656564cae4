#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "tests/core/io/message_of.h"

namespace railcast {

/// Returns the message of the InputError that `work` throws, without the place with which it
/// begins, or "no error" if it throws none.
template <typename Work>
[[nodiscard]] std::string MessageBehind(const std::string& place, Work&& work) {
  std::string message = MessageOf(std::forward<Work>(work));
  if (message == "no error") return message;
  EXPECT_TRUE(message.starts_with(place)) << message;
  return message.erase(0, place.size());
}

}  // namespace railcast
