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

// What a reader of `{"a": [1], "b": "text"}` is told.
template <typename Read>
std::string FaultOf(const Read& read) {
  const Json json = {{"a", {1}}, {"b", "text"}};
  return MessageOf([&] { ReadJson("FILE:3", [&] { static_cast<void>(read(json)); }); });
}

TEST(ReadJson, SaysInItsOwnWordsWhatIsNotThere) {
  const std::string begin = "FILE:3: is damaged: ";
  EXPECT_EQ(FaultOf([](const Json& json) { return json.at("x\ny"); }),
            begin + R"(key x\ny is missing)");
  EXPECT_EQ(FaultOf([](const Json& json) { return json.at("b").get<int>(); }),
            begin + "a value must be number (got string)");
  EXPECT_EQ(FaultOf([](const Json& json) { return json.at("b").at("c"); }),
            begin + "a value must be an object or an array (got string)");
  EXPECT_EQ(FaultOf([](const Json& json) { return json.at("a").at(1); }),
            begin + "array index 1 is out of range");
  EXPECT_EQ(
      FaultOf([](const Json&) { return Json::parse("[1,]"); }),
      begin + "syntax error while parsing value - unexpected ']'; expected '[', '{', or a literal");
}

TEST(JsonFault, LeavesOtherTexts) {
  EXPECT_EQ(JsonFault("out of luck"), "out of luck");
}

}  // namespace
}  // namespace railcast
