#include "generator/live/service_manager.h"

#include <systemd/sd-daemon.h>

#include <algorithm>

#include "generator/live/live_clock.h"

namespace railcast {

ServiceManager::ServiceManager() : pause_ns_(5'000'000'000) {
  std::uint64_t watchdog_us = 0;
  if (::sd_watchdog_enabled(0, &watchdog_us) <= 0) return;
  // sd_watchdog_enabled(3) recommends half of it; a third survives a slow frame.
  pause_ns_ = std::min(pause_ns_, static_cast<std::int64_t>(watchdog_us) * 1000 / 3);
}

void ServiceManager::SayReady() {
  ::sd_notify(0, ("READY=1\nSTATUS=" + status_).c_str());
}

void ServiceManager::SayAlive() {
  const std::int64_t now_ns = MonotonicClock().NowNs();
  if (now_ns - said_ns_ < pause_ns_) return;
  said_ns_ = now_ns;
  ::sd_notify(0, ("WATCHDOG=1\nSTATUS=" + status_).c_str());
}

void ServiceManager::SayStopping() {
  ::sd_notify(0, "STOPPING=1");
}

}  // namespace railcast
