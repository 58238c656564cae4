#pragma once

#include <cstdint>
#include <string>

namespace railcast {

/// Tells systemd that the program is ready and goes on (sd_notify, Type=notify and WatchdogSec= of
/// a unit). Does nothing where no manager has started the program.
class ServiceManager {
 public:
  ServiceManager();

  void SayReady();
  /// To be called often; the manager hears of it as often as its watchdog wants.
  /// @param status One line that `systemctl status` shows; empty: keeps the one before.
  void SayAlive(const std::string& status = {});
  void SayStopping();

 private:
  std::int64_t pause_ns_;
  std::int64_t said_ns_{};
};

}  // namespace railcast
