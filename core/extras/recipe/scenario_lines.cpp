#include "core/extras/recipe/scenario_lines.h"

#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/extras/recipe/shard.h"
#include "core/io/content_hash.h"

namespace railcast {

ScenarioLines::ScenarioLines(std::filesystem::path file, const Shard& shard)
    : file_(std::move(file)), shard_(shard) {
  if (!std::filesystem::exists(file_)) {
    is_over_ = true;
  } else {
    stream_ = OpenInput(file_);
  }
}

std::optional<PlacedLine> ScenarioLines::Read() {
  if (is_over_) return std::nullopt;
  if (!stream_) {
    stream_ = OpenInput(file_);
    stream_->seekg(static_cast<std::streamoff>(size_));
  }
  PlacedLine line;
  // A last line without its end is incomplete.
  is_over_ = !std::getline(*stream_, line.text) || stream_->eof();
  if (is_over_) return std::nullopt;
  line.place = ShownPath(file_) + ":" + std::to_string(num_read_ + 1);
  return line;
}

std::string ScenarioLines::Take(const PlacedLine& line) {
  std::string fault = LineHashFault(line.text);
  if (!fault.empty()) return fault;
  // A line that has its hash is as it was written, with the scenario's number first.
  const std::string expected = std::to_string(shard_.ScenarioAt(num_read_));
  constexpr std::string_view kBegin = "{\"scenario\":";
  const std::string_view rest = std::string_view(line.text).substr(kBegin.size());
  const std::string_view number = rest.substr(0, rest.find(','));
  if (!line.text.starts_with(kBegin) || number != expected) {
    return "must be the line of scenario " + expected + " (got " + ShownText(number) + ")";
  }
  ++num_read_;
  size_ += line.text.size() + 1;
  return "";
}

std::optional<PlacedLine> ScenarioLines::Next() {
  auto line = Read();
  if (!line) return std::nullopt;
  const std::string fault = Take(*line);
  if (fault.empty()) return line;
  fault_ = line->place + ": " + fault;
  is_over_ = true;
  return std::nullopt;
}

PlacedLine ScenarioLines::Need() {
  auto line = Read();
  if (!line) {
    throw InputError(ShownPath(file_) + ":" + std::to_string(num_read_ + 1) + ": missing");
  }
  const std::string fault = Take(*line);
  if (!fault.empty()) throw InputError(line->place + ": " + fault);
  return *line;
}

std::uint32_t ScenarioLines::Skip(std::uint32_t most) {
  std::uint32_t num = 0;
  while (num < most && Next()) ++num;
  return num;
}

}  // namespace railcast
