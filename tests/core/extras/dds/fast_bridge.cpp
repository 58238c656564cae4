#include <iostream>
#include <map>
#include <mutex>
#include <string>

#include "tests/core/extras/dds/fast_dds.h"

// Messages of Fast DDS for a program that has no DDS itself: fast_bridge DOMAIN
// It is told "read TOPIC TYPE" and "write TOPIC TYPE", a line each, and "send TOPIC SIZE", a line
// that so many bytes follow. Of each message that arrives it tells "TOPIC SIZE" and the bytes.

namespace {

class Teller final : public eprosima::fastdds::dds::DataReaderListener {
 public:
  Teller(std::string topic, std::mutex& mutex) : topic_(std::move(topic)), mutex_(mutex) {}

  void on_data_available(eprosima::fastdds::dds::DataReader* reader) override {
    railcast::MessageBytes bytes;
    eprosima::fastdds::dds::SampleInfo info;
    while (reader->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      const std::lock_guard lock(mutex_);
      std::cout << topic_ << ' ' << bytes.size() << '\n';
      std::cout.write(reinterpret_cast<const char*>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
      std::cout.flush();
    }
  }

 private:
  std::string topic_;
  std::mutex& mutex_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  std::mutex mutex;
  std::map<std::string, Teller> tellers;
  std::map<std::string, eprosima::fastdds::dds::DataWriter*> writers;
  railcast::FastParticipant participant(static_cast<std::uint32_t>(std::stoul(argv[1])));
  std::string verb, topic, argument;
  // Until whoever started it has gone.
  while (std::cin >> verb >> topic >> argument) {
    if (verb == "read") {
      Teller& teller = tellers.try_emplace(topic, topic, mutex).first->second;
      participant.Read(topic, argument, teller);
    } else if (verb == "write") {
      writers[topic] = &participant.Write(topic, argument);
    } else {
      railcast::MessageBytes bytes(std::stoul(argument));
      std::cin.ignore();  // The end of the line.
      std::cin.read(reinterpret_cast<char*>(bytes.data()),
                    static_cast<std::streamsize>(bytes.size()));
      writers.at(topic)->write(&bytes);
    }
  }
  return 0;
}
