#include "railcast/enum_names.h"

#include <gtest/gtest.h>

#include "tests/core/io/message_of.h"

namespace railcast {

enum class Colour { kRed, kGreen };
template <>
inline constexpr auto kEnumNames<Colour> =
    std::to_array<EnumName<Colour>>({{Colour::kGreen, "green"}, {Colour::kRed, "red"}});

enum class Nameless { kIt };

namespace {

static_assert(NamedEnum<Colour> && !NamedEnum<Nameless> && !NamedEnum<int>);

TEST(EnumNames, LeadFromValuesToNamesAndBack) {
  EXPECT_EQ(NameOf(Colour::kRed), "red");
  EXPECT_EQ(ValueNamed<Colour>("green"), Colour::kGreen);
  EXPECT_EQ(ValueNamed<Colour>("Green"), std::nullopt);
  EXPECT_EQ(ValueNamed<Colour>(""), std::nullopt);
}

TEST(EnumNames, AreListedInTheOrderOfTheirTable) {
  EXPECT_EQ(NamesOf<Colour>(), (std::vector<std::string>{"green", "red"}));
}

TEST(EnumNames, ThrowForWhatIsNoValue) {
  EXPECT_EQ(MessageOf([&] { static_cast<void>(NameOf(static_cast<Colour>(7))); }),
            "must be a value of its enumeration (got 7)");
}

}  // namespace
}  // namespace railcast
