#include "core/io/recording/image_list.h"

#include <algorithm>

#include "core/io/recording/line_reader.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/frame_record.h"
#include "core/io/run/sequence_files.h"

namespace railcast {

const ImageList::FrameImages* ImageList::LatestAt(std::size_t place) const {
  const auto after = std::ranges::upper_bound(frames, place, {}, &FrameImages::place);
  return after == frames.begin() ? nullptr : &*std::prev(after);
}

const KnownFile* ImageList::FrameImages::Find(std::string_view folder) const {
  const auto found = std::ranges::find_if(files, [&](const KnownFile& file) {
    // The camera's own name may be that of a kind, too.
    const std::size_t at = kCameraFolder.size() + 1 + CameraNameIn(file.name).size() + 1;
    return std::string_view(file.name).substr(at).starts_with(folder);
  });
  return found == files.end() ? nullptr : &*found;
}

std::string ImageList::Read(const KnownFile& file) const {
  return ReadKnownFile(directory, file, kFramesFile);
}

ImageList ReadImageList(const std::filesystem::path& directory) {
  ImageList list{directory, {}};
  if (!std::filesystem::is_directory(directory / kCameraFolder) ||
      !std::filesystem::is_regular_file(directory / kFramesFile)) {
    return list;
  }
  LineReader lines(directory / kFramesFile);
  for (std::size_t place = 0; auto text = lines.Next(); ++place) {
    FrameRecord line = ReadFrameLine(text->text, text->place);
    std::erase_if(line.files, [](const KnownFile& file) { return !IsCameraFile(file.name); });
    if (!line.files.empty()) list.frames.push_back({place, line.frame, std::move(line.files)});
  }
  return list;
}

std::string CameraNameIn(std::string_view name) {
  name.remove_prefix(kCameraFolder.size() + 1);
  return std::string(name.substr(0, name.find('/')));
}

}  // namespace railcast
