#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/frame.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Turns "below_threshold" into "below threshold".
[[nodiscard]] inline std::string InWords(std::string_view key) {
  std::string words(key);
  std::ranges::replace(words, '_', ' ');
  return words;
}

/// Name of a label, or its number where it has none.
[[nodiscard]] inline std::string LabelName(std::uint32_t id, const LabelTable& labels) {
  const Label* const label = labels.Find(id);
  return label == nullptr ? std::to_string(id) : label->name;
}

/// Names of a recording's labels and materials, or their numbers where it has no names.
class Names {
 public:
  explicit Names(const RecordingInfo& info) : labels_(info.labels), materials_(info.materials) {}

  [[nodiscard]] std::string OfLabel(std::uint32_t id) const { return LabelName(id, labels_); }
  [[nodiscard]] std::string OfMaterial(std::uint16_t id) const {
    return id < materials_.size() ? materials_[id] : std::to_string(id);
  }

 private:
  LabelTable labels_;
  std::vector<std::string> materials_;
};

}  // namespace railcast
