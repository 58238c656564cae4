#include "viewer/frames/live_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/datagrams.h"
#include "core/io/image/jpeg.h"
#include "core/io/recording/live_frame.h"

namespace railcast {

namespace {

// As many as frames are kept, unless they are very large. The latest is kept in any case.
constexpr std::size_t kMaxKeptImages = 64;
constexpr std::size_t kMaxKeptBytes = std::size_t{256} << 20U;

}  // namespace

bool LivePictures::Poll() {
  std::vector<ReceivedImage> images = receiver_.Take();
  for (ReceivedImage& image : images) {
    num_kept_bytes_ += image.jpeg.size();
    kept_.push_back(std::move(image));
    while (kept_.size() > kMaxKeptImages || (num_kept_bytes_ > kMaxKeptBytes && kept_.size() > 1)) {
      num_kept_bytes_ -= kept_.front().jpeg.size();
      kept_.pop_front();
    }
  }
  return !images.empty();
}

const ReceivedImage* LivePictures::LatestAt(const Instant& instant) const {
  const ReceivedImage* latest = nullptr;
  for (const ReceivedImage& image : kept_) {
    if (image.run != instant.run || image.stamp_ns > instant.stamp_ns) continue;
    if (latest == nullptr || image.stamp_ns >= latest->stamp_ns) latest = &image;
  }
  return latest;
}

bool LivePictures::IsSettled(const Instant& instant) const {
  return LatestAt(instant) != nullptr && std::ranges::any_of(kept_, [&](const auto& image) {
           return image.run == instant.run && image.stamp_ns >= instant.stamp_ns;
         });
}

std::shared_ptr<const CameraPicture> LivePictures::At(const Instant& instant, PictureKind kind) {
  if (kind == PictureKind::kOff) return nullptr;
  if (kind != PictureKind::kColor) {
    throw InputError(ShownPath(source_) + ": images of kind " +
                     std::string(kPictureKindNames[static_cast<std::size_t>(kind)]) +
                     " are not sent live");
  }
  const ReceivedImage* const image = LatestAt(instant);
  if (image == nullptr) return nullptr;
  const std::pair wanted{image->run, image->frame};
  if (last_ && last_is_ == wanted) return last_;
  const std::string frame = "frame " + NumberText(image->frame);
  CameraPicture picture = AtPlace(ShownPath(source_) + ": image of " + frame + ": ", [&] {
    return MakeColorPicture(DecodeJpegRgb(image->jpeg, image->size));
  });
  picture.title = "color   " + frame;
  last_ = std::make_shared<const CameraPicture>(std::move(picture));
  last_is_ = wanted;
  return last_;
}

std::string LivePictures::StatusText() const {
  const ImageCounts counts = receiver_.counts();
  if (counts.complete_images == 0) return "no image has come";
  if (counts.incomplete_images == 0) return {};
  return NumberText(counts.incomplete_images) + " images lost";
}

LiveFrames::LiveFrames(const std::string& source,
                       const Endpoint& at,
                       const WantedStream& wanted,
                       const std::optional<Endpoint>& images_at)
    : grabber_(at, wanted) {
  info_.source = source;
  info_.kind = "live stream";
  grabber_.registerCallback(
      std::function([this](const std::shared_ptr<const ReceivedFrame>& frame) {
        const std::lock_guard lock(mutex_);
        latest_ = frame;
        last_arrival_ = std::chrono::steady_clock::now();
      }));
  grabber_.start();
  if (!images_at) return;
  // Images leave through another port than frames do.
  std::optional<Endpoint> from = wanted.from;
  if (from) from->port = 0;
  pictures_.emplace(source, *images_at, from);
}

LiveFrames::~LiveFrames() {
  grabber_.stop();
}

bool LiveFrames::Poll() {
  std::shared_ptr<const ReceivedFrame> received;
  {
    const std::lock_guard lock(mutex_);
    received = std::exchange(latest_, nullptr);
  }
  if (!received) return false;
  fault_.clear();
  try {
    // Simulation time does not come that far.
    if (info_.scenario && received->header.stamp_ns >= kSimulationEpoch_s * kNsPerS) {
      throw InputError(
          ShownPath(info_.source) +
          ": stamps must be simulation time where a scenario is drawn (got the time of "
          "day)");
    }
    kept_.Put(num_taken_, Shown(MakeLiveFrame(*received, ShownPath(info_.source))));
  } catch (const InputError& error) {
    fault_ = error.what();
    return false;
  }
  ++num_taken_;
  taken_.push_back({.instant = {received->header.run, received->header.stamp_ns},
                    .is_whole = received->is_complete()});
  while (taken_.size() > kept_.size()) taken_.pop_front();
  return true;
}

bool LiveFrames::PollImages() {
  return pictures_ && pictures_->Poll();
}

std::optional<std::size_t> LiveFrames::FirstWhole(std::size_t first, bool with_picture) const {
  for (std::size_t place = std::max(first, first_known()); place < num_taken_; ++place) {
    const Taken& taken = TakenAt(place);
    if (taken.is_whole && (!with_picture || pictures_->IsSettled(taken.instant))) return place;
  }
  return std::nullopt;
}

bool LiveFrames::MayGetPicture(std::size_t place) const {
  return pictures_ && place >= first_known() && place < num_taken_ &&
         !pictures_->IsSettled(TakenAt(place).instant);
}

std::shared_ptr<const ShownFrame> LiveFrames::Get(std::size_t place) {
  return kept_.Find(place);
}

std::shared_ptr<const CameraPicture> LiveFrames::Picture(std::size_t place, PictureKind kind) {
  if (!pictures_ || place < first_known() || place >= num_taken_) return nullptr;
  return pictures_->At(TakenAt(place).instant, kind);
}

std::string LiveFrames::PictureNeeds() const {
  return pictures_ ? "no image of this frame has come"
                   : "images of a live source need --image-port";
}

std::optional<Endpoint> LiveFrames::images_at() const {
  if (!pictures_) return std::nullopt;
  return pictures_->at();
}

double LiveFrames::seconds_since_last() const {
  const std::lock_guard lock(mutex_);
  if (!last_arrival_) return std::numeric_limits<double>::infinity();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - *last_arrival_).count();
}

std::string LiveFrames::StatusText() const {
  const UdpGrabber::Counts counts = grabber_.counts();
  std::array<char, 128> text{};
  const double silent_s = seconds_since_last();
  const bool is_silent = silent_s >= 2.0;
  std::snprintf(text.data(), text.size(), "live %.1f frames/s   %llu packets lost",
                is_silent ? 0.0 : static_cast<double>(grabber_.getFramesPerSecond()),
                static_cast<unsigned long long>(counts.stream.lost_packets));
  std::string status = text.data();
  if (counts.stream.missing_frames > 0) {
    status += "   " + std::to_string(counts.stream.missing_frames) + " whole frames lost";
  }
  if (counts.stream.other_sensor) {
    status += "   also heard: sensor " + std::to_string(*counts.stream.other_sensor);
  } else if (counts.stream.other_sender) {
    status += "   also heard: " + EndpointText(*counts.stream.other_sender);
  }
  if (is_silent && std::isfinite(silent_s)) {
    std::snprintf(text.data(), text.size(), "   no frame for %.0f s", std::floor(silent_s));
    status += text.data();
  }
  if (const std::string images = pictures_ ? pictures_->StatusText() : ""; !images.empty()) {
    status += "   " + images;
  }
  if (!fault_.empty()) {
    status += "   not shown: ";
    status += fault_;
  }
  return status;
}

}  // namespace railcast
