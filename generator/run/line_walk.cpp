#include "generator/run/line_walk.h"

#include "core/io/content_hash.h"
#include "core/io/write_file.h"

namespace railcast {

LineWalk::LineWalk(const std::filesystem::path& file, std::string_view header) {
  if (std::filesystem::exists(file)) text_ = ReadFileWhole(file);
  has_header_ = std::string_view(text_).starts_with(header);
  if (has_header_) position_ = header.size();
}

std::string_view LineWalk::Next(std::size_t num_lines) const {
  if (!has_header_) return {};
  std::size_t end = position_;
  for (std::size_t i = 0; i < num_lines; ++i) {
    end = text_.find('\n', end);
    if (end == std::string::npos) return {};
    ++end;
  }
  return std::string_view(text_).substr(position_, end - position_);
}

bool HasContent(const std::filesystem::path& directory, const KnownFile& file) {
  const std::filesystem::path path = directory / file.name;
  return std::filesystem::exists(path) && std::filesystem::file_size(path) == file.bytes &&
         ContentHash(ReadFileWhole(path)) == file.hash;
}

}  // namespace railcast
