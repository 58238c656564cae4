#include "core/base/recent.h"

#include <gtest/gtest.h>

#include <string>

namespace railcast {
namespace {

// Makes the text of a number, and counts how often.
struct Texts {
  int num_made = 0;

  std::string Of(int number, Recent<int, std::string>& recent) {
    return *recent.Get(
        number,
        [&] {
          ++num_made;
          return std::make_shared<const std::string>(std::to_string(number));
        },
        [](const std::string& text) { return text.size(); });
  }
};

TEST(Recent, MakesWhatWasUsedLastOnlyOnce) {
  Recent<int, std::string> recent(3);
  Texts texts;
  for (const int number : {1, 2, 1, 3, 1}) {
    EXPECT_EQ(texts.Of(number, recent), std::to_string(number));
  }
  EXPECT_EQ(texts.num_made, 3);
  // 4 takes the place of 2, which was used longest ago.
  for (const int number : {4, 1, 3, 4}) static_cast<void>(texts.Of(number, recent));
  EXPECT_EQ(texts.num_made, 4);
  static_cast<void>(texts.Of(2, recent));
  EXPECT_EQ(texts.num_made, 5);
}

TEST(Recent, KeepsNoMoreThanTheGivenWeight) {
  Recent<int, std::string> recent(3);
  Texts texts;
  for (const int number : {1, 22, 333}) static_cast<void>(texts.Of(number, recent));
  // 333 leaves no room for the others.
  static_cast<void>(texts.Of(333, recent));
  EXPECT_EQ(texts.num_made, 3);
  static_cast<void>(texts.Of(1, recent));
  EXPECT_EQ(texts.num_made, 4);
  // What is heavier than all may be is made each time.
  static_cast<void>(texts.Of(4444, recent));
  static_cast<void>(texts.Of(4444, recent));
  EXPECT_EQ(texts.num_made, 6);
}

TEST(Recent, KeepsNothingWithoutWeight) {
  Recent<int, std::string> recent(0);
  Texts texts;
  static_cast<void>(texts.Of(1, recent));
  static_cast<void>(texts.Of(1, recent));
  EXPECT_EQ(texts.num_made, 2);
}

}  // namespace
}  // namespace railcast
