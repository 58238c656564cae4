
#include <gtest/gtest.h>

#include <string>

#include "core/io/content_hash.h"

namespace railcast {
namespace {

TEST(LineHash, IsThatOfTheTextBeforeIt) {
  EXPECT_EQ(WithLineHash(R"({"a":1})"),
            R"({"a":1,"line_xxh3":")" + ContentHash(R"({"a":1)") + "\"}");
}

TEST(LineHash, NoticesEveryChangedByte) {
  const std::string line = WithLineHash(R"({"a":1,"b":[true,"x"]})");
  EXPECT_EQ(LineHashFault(line), "");
  for (std::size_t i = 0; i < line.size(); ++i) {
    std::string changed = line;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    EXPECT_NE(LineHashFault(changed), "") << changed;
    EXPECT_NE(LineHashFault(line.substr(0, i)), "") << i;
  }
  EXPECT_NE(LineHashFault(line + "}"), "");
}

TEST(LineHash, SaysWhatItMustBe) {
  std::string line = WithLineHash(R"({"a":1})");
  line[5] = '2';
  EXPECT_EQ(LineHashFault(line), "/line_xxh3: must be " + ContentHash(R"({"a":2)") +
                                     ", that of all before it (got " + ContentHash(R"({"a":1)") +
                                     ")");
  EXPECT_EQ(LineHashFault(R"({"a":1})"), "must end with line_xxh3, the hash of all before it");
}

}  // namespace
}  // namespace railcast
