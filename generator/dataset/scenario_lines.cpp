#include "generator/dataset/scenario_lines.h"

#include <string>

#include "core/base/input_file.h"
#include "core/io/dataset_files.h"

namespace railcast {

ScenarioLines::ScenarioLines(const std::filesystem::path& directory, const Shard& shard)
    : file_(directory / kScenariosFile), shard_(shard) {
  if (!std::filesystem::exists(file_)) {
    is_over_ = true;
  } else {
    stream_ = OpenInput(file_);
  }
}

std::optional<Json> ScenarioLines::Next() {
  if (is_over_) return std::nullopt;
  if (!stream_) {
    stream_ = OpenInput(file_);
    stream_->seekg(static_cast<std::streamoff>(size_));
  }
  std::string line;
  // A last line without its end is incomplete.
  is_over_ = !std::getline(*stream_, line) || stream_->eof();
  if (is_over_) return std::nullopt;
  Json json = Json::parse(line, nullptr, false);
  is_over_ =
      !json.is_object() || json.value("scenario", Json()) != Json(shard_.ScenarioAt(num_read_));
  if (is_over_) return std::nullopt;
  ++num_read_;
  size_ += line.size() + 1;
  return json;
}

std::uint32_t ScenarioLines::Skip(std::uint32_t most) {
  std::uint32_t num = 0;
  while (num < most && Next()) ++num;
  return num;
}

}  // namespace railcast
