#include "core/recipe/scenario_lines.h"

#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/run/dataset_files.h"

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

std::string ScenarioLines::Take(const PlacedLine& line, Json& record) {
  record = Json::parse(line.text, nullptr, false);
  if (!record.is_object()) return "is damaged: is no JSON object";
  std::string fault = LineHashFault(line.text);
  if (!fault.empty()) return fault;
  const std::uint32_t expected = shard_.ScenarioAt(num_read_);
  const Json number = record.value("scenario", Json());
  if (number != Json(expected)) {
    return "must be the line of scenario " + std::to_string(expected) + " (got " +
           ShownText(number.dump()) + ")";
  }
  record.erase("line_xxh3");
  ++num_read_;
  size_ += line.text.size() + 1;
  return "";
}

std::optional<ScenarioLines::Line> ScenarioLines::Next() {
  auto read = Read();
  if (!read) return std::nullopt;
  Line line{std::move(*read), {}};
  is_over_ = !Take(line.placed, line.record).empty();
  if (is_over_) return std::nullopt;
  return line;
}

ScenarioLines::Line ScenarioLines::Need() {
  auto read = Read();
  if (!read) {
    throw InputError(ShownPath(file_) + ":" + std::to_string(num_read_ + 1) + ": missing");
  }
  Line line{std::move(*read), {}};
  const std::string fault = Take(line.placed, line.record);
  if (!fault.empty()) throw InputError(line.placed.place + ": " + fault);
  return line;
}

std::uint32_t ScenarioLines::Skip(std::uint32_t most) {
  std::uint32_t num = 0;
  while (num < most && Next()) ++num;
  return num;
}

}  // namespace railcast
