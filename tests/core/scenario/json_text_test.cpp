#include "core/scenario/json_text.h"

#include <gtest/gtest.h>

#include <string>

#include "core/base/text.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

// As ShownText() and RFC 6901 say, key by key.
std::string StepOfAnyKey(const std::string& key) {
  std::string step = "/";
  for (const char c : ShownText(key)) step += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return step;
}

TEST(PointerStep, ShowsWordsAsAnyKey) {
  for (const std::size_t length : {1U, 59U, 60U, 61U, 200U}) {
    for (const char last : std::string("a9_-Z/~ \n\x7f\xc3")) {
      const std::string key = std::string(length - 1, 'x') + last;
      EXPECT_EQ(PointerStep(key), StepOfAnyKey(key)) << key;
    }
  }
  EXPECT_EQ(PointerStep(""), "/");
  EXPECT_EQ(PointerStep("ridge_m/2"), "/ridge_m~12");
}

}  // namespace
}  // namespace railcast
