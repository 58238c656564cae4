#include "core/base/text.h"

#include <gtest/gtest.h>

#include <string>

#include "core/base/join.h"
#include "core/base/text_encoding.h"

namespace railcast {
namespace {

using std::string_literals::operator""s;

TEST(ShownText, LeavesReadableTextAlone) {
  for (const std::string text : {"", "range_m", "a \"b\" \\ c", "Zürich → 東京 🚆"}) {
    EXPECT_EQ(ShownText(text), text);
  }
}

TEST(ShownText, StaysOnOneLineAndMovesNoCursor) {
  EXPECT_EQ(ShownText("a\nb\r\tc"), "a\\nb\\r\\tc");
  EXPECT_EQ(ShownText("\x1b[2J\0\x7f"s), "\\u001b[2J\\u0000\\u007f");
  // U+009B starts a control sequence, as ESC [ does.
  EXPECT_EQ(ShownText("\xc2\x9b"), "\\u009b");
}

TEST(ShownText, ShowsWhatIsInvisibleByItsNumber) {
  EXPECT_EQ(ShownText("a\u202Egpj.b"), "a\\u202egpj.b");  // Right to left from here on.
  EXPECT_EQ(ShownText("a\u200Bb\uFEFF\u00AD"), "a\\u200bb\\ufeff\\u00ad");
  EXPECT_EQ(ShownText("a\u2028b\u2066\u2069"), "a\\u2028b\\u2066\\u2069");
  EXPECT_EQ(ShownText("a\U000E0041"), "a\\U000e0041");
  EXPECT_EQ(ShownPath("out/\u202Egnp.x"), "out/\\u202egnp.x");
  EXPECT_EQ(ShownLines("a\n\u202Eb"), "a\n\\u202eb");
}

TEST(ShownText, ShowsTheBytesOfWhatIsNoUtf8) {
  EXPECT_EQ(ShownText("Z\xfcrich"), "Z\\xfcrich");
  // Truncated, overlong, half of a surrogate pair, and beyond U+10FFFF.
  for (const std::string bytes : {"\xe2\x82", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80"}) {
    EXPECT_EQ(ShownText(bytes).substr(0, 2), "\\x") << ShownText(bytes);
  }
}

TEST(ShownText, CutsWhatIsLong) {
  EXPECT_EQ(ShownText(std::string(60, 'a')), std::string(60, 'a'));
  EXPECT_EQ(ShownText(std::string(61, 'a')), std::string(60, 'a') + "...");
  EXPECT_EQ(ShownText(std::string(59, 'a') + "\n\n"), std::string(59, 'a') + "...");
}

TEST(ShownPath, IsOneWholeLine) {
  const std::string name = std::string(200, 'a') + "/b\nc\x1b.pcd";
  EXPECT_EQ(ShownPath(name), std::string(200, 'a') + "/b\\nc\\u001b.pcd");
  EXPECT_EQ(ShownPath("out/Zürich 1.pcd"), "out/Zürich 1.pcd");
  // Applying the function twice changes nothing.
  EXPECT_EQ(ShownPath(ShownPath(name)), ShownPath(name));
}

TEST(ShownLines, KeepsNothingOfControlButLineBreaks) {
  EXPECT_EQ(ShownLines("a\tb\r\n\x1b]0;title\x07\n\xc2\x9b" + std::string(100, 'z')),
            "a\\tb\\r\n\\u001b]0;title\\u0007\n\\u009b" + std::string(100, 'z'));
  EXPECT_EQ(ShownLines("x: rule\ny: rule\n"), "x: rule\ny: rule\n");
}

}  // namespace

namespace {

TEST(EditDistance, CountsInsertionsDeletionsAndChanges) {
  EXPECT_EQ(EditDistance("", ""), 0U);
  EXPECT_EQ(EditDistance("label", "label"), 0U);
  EXPECT_EQ(EditDistance("labl", "label"), 1U);
  EXPECT_EQ(EditDistance("label", "labl"), 1U);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3U);
  EXPECT_EQ(EditDistance("", "ring"), 4U);
}

TEST(Amount, IsSingularForOne) {
  EXPECT_EQ(Amount(0, "frames"), "0 frames");
  EXPECT_EQ(Amount(1, "frames, "), "1 frame, ");
  EXPECT_EQ(Amount(2, "boxes of objects"), "2 boxes of objects");
  EXPECT_EQ(Amount(1, "boxes of objects"), "1 box of objects");
  EXPECT_EQ(Amount(1, "intensities not known, now 0"), "1 intensity not known, now 0");
  EXPECT_EQ(Amount(1, "tiles: 2 along lines\n"), "1 tile: 2 along lines\n");
}

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
