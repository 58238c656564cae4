#include "core/io/strict_json.h"

#include <gtest/gtest.h>

namespace railcast {
namespace {

template <typename T>
std::string JsonFaultOf(const std::string& text) {
  try {
    static_cast<void>(StrictJson::parse(text).get<T>());
  } catch (const StrictJson::exception& error) {
    return JsonFault(error.what());
  }
  return "";
}

std::string NotUnsigned(const std::string& got) {
  return "a value must be a whole number from 0 to 4294967295 (got " + got + ")";
}

TEST(StrictJson, GivesWholeNumbersToThoseThatHoldThem) {
  EXPECT_EQ(StrictJson::parse("4294967295").get<std::uint32_t>(), 4294967295U);
  EXPECT_EQ(StrictJson::parse("-9223372036854775808").get<std::int64_t>(),
            std::numeric_limits<std::int64_t>::min());
  const auto many = StrictJson::parse("[0, 65535]").get<std::array<std::uint16_t, 2>>();
  EXPECT_EQ(many, (std::array<std::uint16_t, 2>{0, 65535}));
  EXPECT_EQ(StrictJson::parse("[1, 2.5]").get<std::vector<double>>(),
            (std::vector<double>{1.0, 2.5}));
}

TEST(StrictJson, RefusesNumbersThatWouldBecomeOthers) {
  EXPECT_EQ(JsonFaultOf<std::uint32_t>("4294967296"), NotUnsigned("4294967296"));
  EXPECT_EQ(JsonFaultOf<std::uint32_t>("-1"), NotUnsigned("-1"));
  EXPECT_EQ(JsonFaultOf<std::uint32_t>("1.5"), NotUnsigned("1.5"));
  EXPECT_EQ(JsonFaultOf<std::uint32_t>("1e30"), NotUnsigned("1e+30"));
  EXPECT_EQ(JsonFaultOf<std::uint32_t>("true"), NotUnsigned("boolean"));
  EXPECT_EQ(JsonFaultOf<std::uint32_t>(std::string(100'000, '[') + std::string(100'000, ']')),
            NotUnsigned("array"));
  EXPECT_EQ(JsonFaultOf<std::int64_t>("9223372036854775808"),
            "a value must be a whole number from -9223372036854775808 to 9223372036854775807 (got "
            "9223372036854775808)");
  using Counts = std::map<std::string, std::uint64_t>;
  EXPECT_NE(JsonFaultOf<Counts>(R"({"rail": 1e30})"), "");
}

}  // namespace
}  // namespace railcast
