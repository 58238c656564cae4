#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace railcast {

/// Tells systemd that the program is ready and goes on (sd_notify, Type=notify and WatchdogSec= of
/// a unit). Does nothing where no manager has started the program.
class ServiceManager {
 public:
  ServiceManager();

  void SayReady();
  /// Sets the line that `systemctl status` shows from the next SayAlive() on that is passed on.
  void SetStatus(std::string status) { status_ = std::move(status); }
  /// To be called often; the manager hears of it as often as its watchdog wants.
  void SayAlive();
  void SayStopping();

 private:
  std::int64_t pause_ns_;
  std::int64_t said_ns_{};
  std::string status_ = "making frames";
};

}  // namespace railcast
