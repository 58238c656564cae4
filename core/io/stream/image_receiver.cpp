#include "core/io/stream/image_receiver.h"

#include <chrono>
#include <utility>

#include "core/base/out_of_memory.h"

namespace railcast {

ImageReceiver::ImageReceiver(const Endpoint& at, const std::optional<Endpoint>& from)
    : socket_(at),
      assembler_(from),
      thread_(StartThread("starting to listen at " + EndpointText(socket_.at()),
                          [this] { Listen(); })) {}

ImageReceiver::~ImageReceiver() {
  is_stopping_ = true;
  socket_.Interrupt();
  thread_.join();
}

std::vector<ReceivedImage> ImageReceiver::Take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(waiting_, {});
}

ImageCounts ImageReceiver::counts() const {
  const std::lock_guard lock(mutex_);
  return assembler_.counts();
}

void ImageReceiver::Listen() {
  constexpr int kForever_ms = -1;
  while (!is_stopping_) {
    const auto received = socket_.Receive(kForever_ms);
    if (!received) continue;
    const std::chrono::nanoseconds now = std::chrono::steady_clock::now().time_since_epoch();
    const std::lock_guard lock(mutex_);
    assembler_.Take(received->bytes, waiting_, {received->from, now.count()});
    if (waiting_.size() > kMaxWaitingImages) waiting_.erase(waiting_.begin());
  }
}

}  // namespace railcast
