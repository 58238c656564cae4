#include "viewer/frames/live_pictures.h"

#include <algorithm>

#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/image/jpeg.h"

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

}  // namespace railcast
