#include "core/io/stream/image_receiver.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/base/out_of_memory.h"

namespace railcast {
namespace {

constexpr std::size_t kMaxOpenImages = 2;
constexpr std::uint32_t kMaxImageStrays = 16;
/// Packets of images at most this many frames behind the last one are late, all others strays.
constexpr std::uint32_t kLateFrames = 8;

}  // namespace

void ImageAssembler::Take(std::span<const char> bytes,
                          std::vector<ReceivedImage>& images,
                          const DatagramOrigin& origin) {
  const auto datagram = CheckImageDatagram(bytes);
  if (sender_.IsAnother(origin)) {
    ++counts_.other_sender_packets;
    return;
  }
  if (!datagram) {
    ++counts_.refused_packets;
    return;
  }
  const bool is_next_sender = sender_.Follow(origin);
  if (is_next_sender || !FollowsOn(*datagram)) {
    if (!is_next_sender && !BeginsAnew(*datagram)) {
      ++counts_.stray_packets;
      return;
    }
    while (!open_.empty()) GiveUpFirst();
    run_ = datagram->head.run;
    last_closed_.reset();
  }
  num_strays_ = 0;
  if (IsPast(*datagram)) {
    ++counts_.received_packets;
  } else {
    Store(*datagram, images);
  }
}

bool ImageAssembler::IsPast(const ImageDatagram& datagram) const {
  return last_closed_ && datagram.head.frame <= *last_closed_;
}

bool ImageAssembler::FollowsOn(const ImageDatagram& datagram) const {
  if (run_ != datagram.head.run) return false;
  return !IsPast(datagram) || *last_closed_ - datagram.head.frame <= kLateFrames;
}

bool ImageAssembler::BeginsAnew(const ImageDatagram& datagram) {
  const bool is_later_run = run_ && IsLaterRun(datagram.head.run, *run_);
  return !run_ || is_later_run || ++num_strays_ == kMaxImageStrays;
}

void ImageAssembler::Store(const ImageDatagram& datagram, std::vector<ReceivedImage>& images) {
  const auto [at, is_new] = open_.try_emplace(datagram.head.frame);
  OpenImage& open = at->second;
  if (is_new) {
    open.whole = datagram.head.OfWhole();
    open.bytes_each = datagram.bytes_each;
    open.has_packet.resize(datagram.head.num_packets);
  } else if (open.whole != datagram.head.OfWhole() || open.bytes_each != datagram.bytes_each) {
    ++counts_.refused_packets;
    return;
  }
  ++counts_.received_packets;
  if (open.has_packet[datagram.head.packet]) return;
  open.has_packet[datagram.head.packet] = true;
  open.pieces.push_back({datagram.head.packet, open.bytes.size(), datagram.piece.size()});
  open.bytes.append(datagram.piece.begin(), datagram.piece.end());
  if (open.pieces.size() == datagram.head.num_packets) {
    while (open_.begin()->first < datagram.head.frame) GiveUpFirst();
    images.push_back({.run = datagram.head.run,
                      .frame = datagram.head.frame,
                      .stamp_ns = datagram.head.stamp_ns,
                      .size = {datagram.head.width_px, datagram.head.height_px},
                      .jpeg = JoinArrivals(open.pieces, open.bytes)});
    ++counts_.complete_images;
    last_closed_ = datagram.head.frame;
    open_.erase(at);
  }
  while (open_.size() > kMaxOpenImages) GiveUpFirst();
}

void ImageAssembler::GiveUpFirst() {
  ++counts_.incomplete_images;
  last_closed_ = open_.begin()->first;
  open_.erase(open_.begin());
}

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
