#include "core/io/content_hash.h"

#include <gtest/gtest.h>

namespace railcast {
namespace {

// XXH3's published value for empty input and seed 0.
TEST(ContentHash, IsXxh3) {
  EXPECT_EQ(ContentHash(""), "2d06800538d394c2");
}

TEST(ContentHash, DependsOnEveryByte) {
  EXPECT_NE(ContentHash("frame 0"), ContentHash("frame 1"));
  EXPECT_EQ(ContentHash("frame 0").size(), 16U);
}

}  // namespace
}  // namespace railcast
