#include "core/io/recording/line_reader.h"

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"

namespace railcast {

LineReader::LineReader(const std::filesystem::path& file) : file_(file), stream_(OpenInput(file)) {}

std::optional<PlacedLine> LineReader::Next() {
  PlacedLine line;
  if (!std::getline(stream_, line.text) || stream_.eof()) return std::nullopt;
  if (line.text.ends_with('\r')) line.text.pop_back();
  line.place = ShownPath(file_) + ":" + NumberText(++num_lines_);
  return line;
}

PlacedLine LineReader::Need() {
  if (auto line = Next()) return std::move(*line);
  throw InputError(ShownPath(file_) + ":" + NumberText(num_lines_ + 1) + ": missing");
}

std::size_t CountLines(const std::filesystem::path& file) {
  std::ifstream stream = OpenInput(file);
  std::size_t num_lines = 0;
  std::array<char, 1U << 16U> block{};
  while (stream) {
    stream.read(block.data(), block.size());
    num_lines +=
        static_cast<std::size_t>(std::count(block.begin(), block.begin() + stream.gcount(), '\n'));
  }
  return num_lines;
}

}  // namespace railcast
