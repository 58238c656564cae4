#pragma once

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include "core/io/net/udp.h"
#include "tests/core/io/stream/stream_example.h"

namespace railcast {

/// Sends these datagrams over and over, 20 ms apart, until it is destroyed.
class EndlessSender {
 public:
  EndlessSender(const Endpoint& to, std::vector<Datagrams> scans)
      : thread_([this, to, scans = std::move(scans)] {
          UdpSender sender({to}, 0);
          while (goes_on_) {
            for (const Datagrams& scan : scans) {
              sender.Send(scan, scan.items);
              std::this_thread::sleep_for(std::chrono::milliseconds(20));
            }
          }
        }) {}
  ~EndlessSender() {
    goes_on_ = false;
    thread_.join();
  }
  EndlessSender(const EndlessSender&) = delete;
  EndlessSender& operator=(const EndlessSender&) = delete;

 private:
  std::atomic<bool> goes_on_{true};
  std::thread thread_;
};

inline Datagrams Scan(const Frame& frame, const StreamSpec& spec = {}) {
  Datagrams scan;
  StreamEncoder(StreamPattern(frame.rows, frame.columns), spec).Encode(frame, scan);
  return scan;
}

}  // namespace railcast
