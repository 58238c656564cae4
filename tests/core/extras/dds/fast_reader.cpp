#include <cstdio>
#include <string>
#include <thread>

#include "tests/core/extras/dds/fast_dds.h"

// A reader in a process of its own, which tests stop and kill:
// fast_reader DOMAIN TOPIC TYPE [MILLISECONDS FOR EACH MESSAGE [BYTES OF THE SOCKET'S BUFFER]]
// It prints a line once it has a writer, and one for each message: its size in bytes, and how many
// nanoseconds ago it was written.

namespace {

class SlowReader final : public eprosima::fastdds::dds::DataReaderListener {
 public:
  explicit SlowReader(int delay_ms) : delay_ms_(delay_ms) {}

  void on_data_available(eprosima::fastdds::dds::DataReader* reader) override {
    railcast::MessageBytes bytes;
    eprosima::fastdds::dds::SampleInfo info;
    while (reader->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      const std::int64_t latency_ns = railcast::LatencyNs(info);
      std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms_));
      Say(std::to_string(bytes.size()) + " " + std::to_string(latency_ns));
    }
  }
  void on_subscription_matched(
      eprosima::fastdds::dds::DataReader*,
      const eprosima::fastdds::dds::SubscriptionMatchedStatus& status) override {
    if (status.current_count_change > 0) Say("ready");
  }

 private:
  static void Say(const std::string& line) {
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
  }
  int delay_ms_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  SlowReader listener(argc > 4 ? std::stoi(argv[4]) : 0);
  const auto buffer_bytes = static_cast<std::uint32_t>(argc > 5 ? std::stoul(argv[5]) : 0);
  railcast::FastParticipant participant(static_cast<std::uint32_t>(std::stoul(argv[1])),
                                        buffer_bytes);
  participant.Read(argv[2], argv[3], listener);
  // Until it is killed, or whoever started it has gone.
  while (std::getchar() != EOF) continue;
  return 0;
}
