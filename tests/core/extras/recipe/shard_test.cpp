#include "core/extras/recipe/shard.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>

namespace railcast {
namespace {

TEST(Shards, DivideAllScenariosBetweenThem) {
  for (const std::uint32_t num_scenarios : {0U, 1U, 6U, 7U, 8U, 50U}) {
    std::set<std::uint32_t> scenarios;
    std::uint32_t sum = 0;
    for (std::uint32_t number = 1; number <= 7; ++number) {
      const Shard shard = {number, 7};
      sum += shard.NumOf(num_scenarios);
      for (std::uint32_t i = 0; i < shard.NumOf(num_scenarios); ++i) {
        scenarios.insert(shard.ScenarioAt(i));
      }
    }
    EXPECT_EQ(sum, num_scenarios);
    EXPECT_EQ(scenarios.size(), num_scenarios);
    if (num_scenarios > 0) {
      EXPECT_EQ(*scenarios.rbegin(), num_scenarios - 1);
    }
  }
}

TEST(Shards, AreReadAsTheyAreWritten) {
  const auto shard = ParseShard(ShardText({3, 16}));
  ASSERT_TRUE(shard);
  EXPECT_EQ(shard->number, 3U);
  EXPECT_EQ(shard->of, 16U);
}

TEST(Shards, AreNothingElse) {
  for (const char* text : {"", "3", "/", "3/", "/7", "0/7", "8/7", "1/0", "-1/7", "1/7/2",
                           "1/100001", "1.0/2", " 1/2"}) {
    EXPECT_FALSE(ParseShard(text)) << text;
  }
}

}  // namespace
}  // namespace railcast
