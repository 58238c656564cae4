#include "railcast/io/stream.h"

#include <gtest/gtest.h>

#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

TEST(Endpoint, IsReadFromHostAndPort) {
  EXPECT_EQ(ParseEndpoint("192.168.1.201:2368", 1), (Endpoint{0xC0A801C9, 2368}));
  EXPECT_EQ(ParseEndpoint("127.0.0.1", 27400), (Endpoint{0x7F000001, 27400}));
  EXPECT_EQ(ParseEndpoint("localhost:99", 1), (Endpoint{0x7F000001, 99}));
}

TEST(Endpoint, IsThisMachineWhereNoHostIsWritten) {
  EXPECT_EQ(ParseEndpoint(":2369", 1), (Endpoint{0x7F000001, 2369}));
}

TEST(Endpoint, IsReadBackFromItsText) {
  for (const char* text : {"127.0.0.1:2368", "255.255.255.255:1", "10.0.200.3:65535"}) {
    EXPECT_EQ(EndpointText(ParseEndpoint(text, 7)), text);
  }
}

TEST(Endpoint, KnowsLoopbackAndBroadcast) {
  EXPECT_TRUE(ParseEndpoint("127.9.8.7", 1).is_loopback());
  EXPECT_FALSE(ParseEndpoint("128.0.0.1", 1).is_loopback());
  EXPECT_TRUE(ParseEndpoint("255.255.255.255", 1).is_broadcast());
  EXPECT_FALSE(ParseEndpoint("192.168.1.255", 1).is_broadcast());
}

TEST(Endpoint, CoversItselfOrEveryPortOfItsAddress) {
  const Endpoint one{0x7F000001, 5};
  EXPECT_TRUE(one.Covers(one));
  EXPECT_FALSE(one.Covers({0x7F000001, 6}));
  const Endpoint any{0x7F000001, 0};
  EXPECT_TRUE(any.Covers(one));
  EXPECT_FALSE(any.Covers({0x7F000002, 5}));
}

TEST(Endpoint, SaysWhatIsWrongWithAText) {
  EXPECT_EQ(MessageOf([] { return ParseEndpoint("", 1); }),
            "must be HOST:PORT, HOST or :PORT (got nothing)");
  for (const std::string port : {"0", "65536", "-1", "12x", ""}) {
    EXPECT_EQ(MessageOf([&] { return ParseEndpoint("127.0.0.1:" + port, 1); }),
              "the port must be a whole number from 1 to 65535 (got 127.0.0.1:" + port + ")");
  }
  EXPECT_EQ(MessageOf([] { return ParseEndpoint("no.such.host.invalid:5", 1); }),
            "must be HOST:PORT with an IPv4 address or a known name (got no.such.host.invalid:5)");
}

TEST(Endpoint, TakesNumericAddressesInDottedDecimalAlone) {
  EXPECT_EQ(ParseEndpoint("10.0.0.1", 1), (Endpoint{0x0A000001, 1}));
  EXPECT_EQ(ParseEndpoint("0.0.0.0", 1), (Endpoint{0, 1}));
  // inet_aton would read the first as 8.0.0.1, and accept others as addresses, too.
  for (const std::string host :
       {"010.0.0.1", "127.0.0.01", "127.1", "2130706433", "0x7f.0.0.1", "127.0.0.0x1", "0X7F000001",
        "300.1.2.3", "1.2.3.4.5", "127.0.0.1.", "1.2.3.08"}) {
    EXPECT_EQ(MessageOf([&] { return ParseEndpoint(host + ":5", 1); }),
              "a numeric address must be four numbers from 0 to 255 with dots between, none with a "
              "leading 0 (got " +
                  host + ":5)");
  }
}

}  // namespace
}  // namespace railcast
