#include "generator/extras/insert/packets/insertion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/extras/packets/recording/packet_recording.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/packets/hand_edits.h"
#include "tests/generator/extras/insert/packets/sent_as_written.h"
#include "tests/support/hesai_bag.h"

namespace railcast {
namespace {

class SentCaptures : public testing::TestWithParam<const char*> {};

// What is sent live is what is written to the file.
TEST_P(SentCaptures, AreWhatIsWritten) {
  const auto source = std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / GetParam();
  if (!exists(source)) GTEST_SKIP() << source << " is not there";
  const TemporaryDirectory folder;
  ExpectSentAsWritten(source, folder.path(), EditedByHand);
}

INSTANTIATE_TEST_SUITE_P(All,
                         SentCaptures,
                         testing::Values("lidar_packets_nebula/vlp16_dual.pcap",
                                         "lidar_packets_nebula/pandar64.pcap",
                                         "lidar_ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap"),
                         [](const auto& test) { return "Number" + std::to_string(test.index); });

// `replay` takes them from there, turn by turn.
TEST(InsertedDatagrams, OfABagAreItsPacketsWithTheEdits) {
  if (const auto why = WhyNoHesaiBag("xt32"); !why.empty()) GTEST_SKIP() << why;
  const TemporaryDirectory folder;
  static_cast<void>(CopyWithEdits(HesaiBag("xt32"), folder.path(), EditedByHand));
  const auto written = OpenBagPackets(folder.path() / "xt32.db3");
  PacketRecording sent(PlaceOfInserted(*FindBagPackets(HesaiBag("xt32"), ""), EditedByHand));
  std::size_t num_sent = 0;
  for (auto turn = sent.NextTurn(); !turn.empty(); turn = sent.NextTurn()) {
    for (const RecordedDatagram& datagram : turn) {
      const auto expected = written->Next();
      ASSERT_TRUE(expected);
      ASSERT_TRUE(std::ranges::equal(datagram.bytes, expected->payload)) << num_sent;
      ++num_sent;
    }
  }
  EXPECT_FALSE(written->Next());
  EXPECT_GT(num_sent, 50U);
}

}  // namespace
}  // namespace railcast
