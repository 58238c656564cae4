#include "core/base/text_encoding.h"

#include <gtest/gtest.h>

#include <string>

namespace railcast {
namespace {

TEST(AsUtf8, EncodesEveryLength) {
  // "<", U+00E9, U+20AC, U+1F682 as two units, and half of such a pair.
  const std::string utf16("<\0\xE9\0\xAC\x20\x3D\xD8\x82\xDE\x3D\xD8", 12);
  EXPECT_EQ(AsUtf8(utf16), "<\xC3\xA9\xE2\x82\xAC\xF0\x9F\x9A\x82\xEF\xBF\xBD");
  EXPECT_EQ(AsUtf8("<a"), "<a");
}

TEST(AsUtf8, TakesByteOrderMarksOff) {
  EXPECT_EQ(AsUtf8("\xEF\xBB\xBFstamp_ns"), "stamp_ns");
  EXPECT_EQ(AsUtf8(std::string("\xFF\xFE{\0}\0", 6)), "{}");
  EXPECT_EQ(AsUtf8(std::string("\xFE\xFF\0{\0}", 6)), "{}");
}

TEST(AsUtf8, KnowsUtf16ByTheZeroBesideItsFirstLetter) {
  EXPECT_EQ(AsUtf8(std::string("v\0 \0", 4)), "v ");
  EXPECT_EQ(AsUtf8(std::string("\0v\0 ", 4)), "v ");
}

TEST(AsUtf8, LeavesBinaryDataThatBeginWithALetter) {
  const std::string bytes("A\0\0\0\xFF", 5);
  EXPECT_EQ(AsUtf8(bytes), bytes);
}

}  // namespace
}  // namespace railcast
