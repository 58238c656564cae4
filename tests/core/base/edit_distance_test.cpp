#include "core/base/edit_distance.h"

#include <gtest/gtest.h>

namespace railcast {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsAndChanges) {
  EXPECT_EQ(EditDistance("", ""), 0U);
  EXPECT_EQ(EditDistance("label", "label"), 0U);
  EXPECT_EQ(EditDistance("labl", "label"), 1U);
  EXPECT_EQ(EditDistance("label", "labl"), 1U);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3U);
  EXPECT_EQ(EditDistance("", "ring"), 4U);
}

}  // namespace
}  // namespace railcast
