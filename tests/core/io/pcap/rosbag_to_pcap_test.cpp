// scripts/rosbag_to_pcap.py, on recordings that Python's sqlite3 makes.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/io/pcap/pcap_reader.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

// Writes recording.db3 with the messages that a script adds by put(topic, time, message).
constexpr const char* kMaker = R"py(
import sqlite3, struct
SCAN = "pandar_msgs/msg/PandarScan"
base = sqlite3.connect("recording.db3")
base.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT)")
base.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data BLOB)")
base.executemany("INSERT INTO topics VALUES(?, ?, ?)",
                 [(1, "/packets", SCAN), (2, "/other", "std_msgs/msg/String")])

def put(topic, time, message):
    base.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                 (topic, time, message))

def scan(frame, packets):
    name = frame.encode() + b"\0"
    body = struct.pack("<iII", 7, 8, len(name)) + name
    body += bytes(-len(body) % 4) + struct.pack("<I", len(packets))
    for seconds, nanoseconds, data in packets:
        body += struct.pack("<iI1500sI", seconds, nanoseconds, data, len(data))
    return b"\0\1\0\0" + body
)py";

class RosbagToPcap : public testing::Test {
 protected:
  void SetUp() override {
    if (RunCommand("/usr/bin/python3 -c 'import sqlite3'").status != 0) {
      GTEST_SKIP() << "/usr/bin/python3 with its module sqlite3 is not there";
    }
  }

  Ended Convert(const std::string& messages) const {
    std::ofstream(folder_.path() / "make.py") << kMaker << messages << "\nbase.commit()\n";
    EXPECT_EQ(RunInFolder("make.py").said, "");
    return RunInFolder(script_ + " recording.db3 capture.pcap");
  }

  Ended RunInFolder(const std::string& command) const {
    return RunCommand("cd " + folder_.path().string() + " && /usr/bin/python3 " + command);
  }

  const std::string script_ = RAILCAST_SOURCE_DIR "/scripts/rosbag_to_pcap.py";

  TemporaryDirectory folder_;
};

// Names of frames are of any length, and so end where the next number does not begin.
TEST_F(RosbagToPcap, WritesThePacketsOfAllScansInTheOrderOfTheirTimes) {
  const Ended run = Convert(R"(
put(1, 20, scan("hesai", [(3, 4000, b"third")]))
put(2, 15, b"\0\1\0\0" + bytes(3))
put(1, 10, scan("", [(1, 2000, b"first"), (1, 999_999_999, b"second" * 200)]))
)");
  ASSERT_EQ(run.status, 0) << run.said;
  PcapReader reader(folder_.path() / "capture.pcap");
  std::vector<std::string> payloads;
  std::vector<std::int64_t> times_ns;
  while (const auto datagram = reader.Next()) {
    payloads.emplace_back(datagram->payload.begin(), datagram->payload.end());
    times_ns.push_back(datagram->time_ns);
    EXPECT_EQ(datagram->source_port, 2368);
    EXPECT_EQ(datagram->destination_port, 2368);
  }
  ASSERT_EQ(payloads.size(), 3U);
  EXPECT_EQ(payloads[0], "first");
  EXPECT_EQ(payloads[1].size(), 1200U);
  EXPECT_EQ(payloads[2], "third");
  // Of microseconds.
  EXPECT_EQ(times_ns, (std::vector<std::int64_t>{1'000'002'000, 1'999'999'000, 3'000'004'000}));
}

TEST_F(RosbagToPcap, RefusesWhatIsNoScan) {
  EXPECT_EQ(Convert("put(2, 1, b'')").said,
            "recording.db3: must hold messages of type pandar_msgs/msg/PandarScan\n");
}

TEST_F(RosbagToPcap, RefusesAScanThatIsCutShort) {
  EXPECT_EQ(Convert(R"(put(1, 1, scan("a", [(1, 2, b"x"), (1, 3, b"y")])[:-9]))").said,
            "recording.db3: must hold 2 packets of 1512 bytes\n");
  EXPECT_FALSE(exists(folder_.path() / "capture.pcap"));
}

TEST_F(RosbagToPcap, RefusesAnotherByteOrder) {
  EXPECT_EQ(Convert(R"(put(1, 1, b"\0\0\0\0" + bytes(40)))").said,
            "recording.db3: must be little-endian CDR\n");
}

TEST_F(RosbagToPcap, RefusesAFileThatIsNoRecording) {
  std::ofstream(folder_.path() / "text.db3") << "no recording, whatever its name is";
  const Ended run = RunInFolder(script_ + " text.db3 capture.pcap");
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.said, "text.db3: file is not a database\n");
}

TEST_F(RosbagToPcap, RefusesMessagesThatAreNoBlobs) {
  for (const char* message : {"None", "5"}) {
    remove(folder_.path() / "recording.db3");
    const Ended run = Convert("put(1, 1, " + std::string(message) + ")");
    EXPECT_EQ(run.status, 1) << message;
    EXPECT_EQ(run.said, "recording.db3: messages must be blobs\n") << message;
  }
}

TEST_F(RosbagToPcap, LeavesARecordingThatIsNamedAsTheCaptureAsItIs) {
  ASSERT_EQ(Convert(R"(put(1, 1, scan("a", [(1, 2, b"x")])))").status, 0);
  const Ended run = RunInFolder(script_ + " recording.db3 ./recording.db3");
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.said, "recording.db3: must be another file than the recording\n");
  EXPECT_EQ(RunInFolder(script_ + " recording.db3 capture.pcap").status, 0);
}

}  // namespace
}  // namespace railcast
