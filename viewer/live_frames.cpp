#include "viewer/live_frames.h"

#include <functional>
#include <utility>

namespace railcast {

LiveFrames::LiveFrames(const Endpoint& at) : grabber_(at) {
  grabber_.registerCallback(
      std::function([this](const std::shared_ptr<const ReceivedFrame>& frame) {
        {
          const std::lock_guard lock(mutex_);
          latest_ = frame;
        }
        changed_.notify_all();
      }));
  grabber_.start();
}

std::shared_ptr<const ReceivedFrame> LiveFrames::WaitForWhole() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return latest_ && latest_->is_complete(); });
  return std::exchange(latest_, nullptr);
}

std::shared_ptr<const ReceivedFrame> LiveFrames::TakeLatest() {
  const std::lock_guard lock(mutex_);
  return std::exchange(latest_, nullptr);
}

}  // namespace railcast
