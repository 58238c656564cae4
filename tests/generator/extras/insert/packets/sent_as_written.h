#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>

#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/extras/packets/recording/packet_recording.h"
#include "generator/extras/insert/packets/insertion.h"
#include "tests/generator/extras/insert/packets/hand_edits.h"

namespace railcast {

/// Expects the datagrams of a capture that are sent with edits to be those of its edited copy.
inline void ExpectSentAsWritten(const std::filesystem::path& capture,
                                const std::filesystem::path& folder,
                                const InsertIntoFrame& edit) {
  static_cast<void>(CopyWithEdits(capture, folder, edit));
  PcapReader written(folder / capture.filename());
  InsertedDatagrams sent(*FindCapture(capture), edit);
  std::size_t num_sent = 0;
  while (const auto datagram = sent.Next()) {
    const auto expected = written.Next();
    ASSERT_TRUE(expected);
    ASSERT_TRUE(std::ranges::equal(datagram->payload, expected->payload)) << num_sent;
    EXPECT_EQ(datagram->time_ns, expected->time_ns);
    EXPECT_EQ(datagram->destination_port, expected->destination_port);
    ++num_sent;
  }
  EXPECT_FALSE(written.Next());
  EXPECT_GT(num_sent, 7U);
}

}  // namespace railcast
