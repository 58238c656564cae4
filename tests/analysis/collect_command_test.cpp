#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "core/io/net/udp.h"
#include "core/io/write_file.h"
#include "tests/core/io/stream/listening_program.h"
#include "tests/core/io/stream/live_stream.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

using testing::HasSubstr;

class CollectCommand : public testing::Test {
 protected:
  [[nodiscard]] std::string Collect(const std::string& options) const {
    return RAILCAST_ANALYZE " collect " + EndpointText(OwnEndpoint()) + " --out " +
           file().string() + " " + options;
  }
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "mine.jsonl"; }

  void Send(const ListeningProgram& to, const std::string& datagram) const {
    detector_.Answer(datagram, to.at());
  }
  [[nodiscard]] std::string detector() const { return EndpointText(detector_.at()); }

 private:
  TemporaryDirectory folder_;
  UdpReceiver detector_{kAnyLoopbackPort};
};

std::string LineOf(const std::string& frame) {
  return "{\"frame\": " + frame + ", \"detections\": []}\n";
}

TEST_F(CollectCommand, WritesLinesByRisingFrameWhenItHasThem) {
  ListeningProgram program(Collect("--frames 3"));
  Send(program, LineOf("7"));
  Send(program, LineOf("4"));
  Send(program, LineOf("7"));
  Send(program, LineOf("5"));
  EXPECT_EQ(program.Rest(), "frames: 3, from 4 to 7, 1 missing between; 1 repeated datagrams\n");
  EXPECT_EQ(program.ExitStatus(), 0);
  EXPECT_EQ(ReadFileWhole(file()), LineOf("4") + LineOf("5") + LineOf("7"));
}

TEST_F(CollectCommand, EndsAtASignalWithWhatHadArrived) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    ListeningProgram program(Collect(""));
    for (const char* const frame : {"2", "3", "4"}) Send(program, LineOf(frame));
    program.Interrupt(signal);
    EXPECT_THAT(program.Rest(), HasSubstr("frames: 3, from 2 to 4, 0 missing between"));
    EXPECT_EQ(program.ExitStatus(), 0);
    EXPECT_EQ(ReadFileWhole(file()), LineOf("2") + LineOf("3") + LineOf("4"));
    std::filesystem::remove(file());
  }
}

TEST_F(CollectCommand, EndsAtTheFirstFaultyDatagramWithTheLinesBeforeIt) {
  for (const auto& [datagram, fault] :
       {std::pair{R"({"frame": 5})", "/detections: missing"},
        std::pair{R"({"frame": 4, "detections": [{"points": [1]}]})",
                  "/frame: must be that of one line only (got 4)"}}) {
    ListeningProgram program(Collect(""));
    Send(program, LineOf("4"));
    Send(program, datagram);
    EXPECT_EQ(program.Rest(), "frames: 1, from 4 to 4, 0 missing between; 0 repeated datagrams\n" +
                                  detector() + ": " + fault + "\n");
    EXPECT_EQ(program.ExitStatus(), 1);
    EXPECT_EQ(ReadFileWhole(file()), LineOf("4"));
    std::filesystem::remove(file());
  }
}

TEST_F(CollectCommand, FollowsTheFirstSenderThatItHears) {
  ListeningProgram program(Collect("--frames 2"));
  const UdpReceiver other(kAnyLoopbackPort);
  Send(program, LineOf("4"));
  other.Answer(std::string("nonsense"), program.at());
  other.Answer(LineOf("6"), program.at());
  Send(program, LineOf("5"));
  EXPECT_EQ(program.Rest(),
            "frames: 2, from 4 to 5, 0 missing between; 0 repeated datagrams\ndatagrams of other "
            "senders: 2, dropped; the last from " +
                EndpointText(other.at()) + "\n");
  EXPECT_EQ(ReadFileWhole(file()), LineOf("4") + LineOf("5"));
}

TEST_F(CollectCommand, KeepsEachLineAsItComes) {
  const std::filesystem::path kept = file().string() + ".part";
  ListeningProgram program(Collect(""));
  Send(program, LineOf("7"));
  Send(program, LineOf("4"));
  const std::string lines = LineOf("7") + LineOf("4");
  while (!exists(kept) || std::filesystem::file_size(kept) < lines.size()) ::usleep(1000);
  EXPECT_EQ(ReadFileWhole(kept), lines);
  program.Interrupt();
  static_cast<void>(program.Rest());  // It ends by SIGPIPE where nobody reads.
  EXPECT_EQ(program.ExitStatus(), 0);
  EXPECT_EQ(ReadFileWhole(file()), LineOf("4") + LineOf("7"));
  EXPECT_FALSE(exists(kept));
}

TEST_F(CollectCommand, RefusesToWriteOverTheLinesOfOneThatWasKilled) {
  const std::string kept = file().string() + ".part";
  WriteFileWhole(kept, LineOf("4"));
  EXPECT_EQ(RunCommand(Collect("")).said,
            kept + ": holds the lines of a collection that was killed; move it away\n");
  EXPECT_EQ(ReadFileWhole(kept), LineOf("4"));
}

TEST_F(CollectCommand, TakesNobodyButWhoItIsToldAndWritesNothingWithoutDetections) {
  ListeningProgram program(Collect("--from 127.9.9.9 --duration 1"));
  Send(program, LineOf("4"));
  Send(program, "nonsense");
  const std::string at = EndpointText(program.at());
  EXPECT_EQ(program.Rest(),
            "frames: 0; 0 repeated datagrams\ndatagrams of other senders: 2, dropped; the last "
            "from " +
                detector() + "\n" + at + ": must be sent a line for each frame (got none)\n");
  EXPECT_EQ(program.ExitStatus(), 1);
  EXPECT_FALSE(exists(file()));
}

TEST_F(CollectCommand, NamesWhatItCannotListenToOrWrite) {
  const UdpReceiver taken(kAnyLoopbackPort);
  const std::string at = EndpointText(taken.at());
  EXPECT_EQ(RunCommand(RAILCAST_ANALYZE " collect " + at + " --out " + file().string()).said,
            "cannot listen: Address already in use (got " + at + ")\n");
  EXPECT_EQ(RunCommand(Collect("--from 127.1")).said,
            "--from: a numeric address must be four numbers from 0 to 255 with dots between, none "
            "with a leading 0 (got 127.1)\n");
  const std::string folder = file().parent_path().string();
  EXPECT_EQ(RunCommand(RAILCAST_ANALYZE " collect --out " + folder).said,
            folder + ": must be a regular file (got a directory)\n");
  EXPECT_EQ(RunCommand(RAILCAST_ANALYZE " collect").status, 2);
}

}  // namespace
}  // namespace railcast
