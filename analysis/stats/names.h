#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/frame/labels.h"
#include "core/io/recording/recording.h"

namespace railcast {

/// What a recording calls its labels and materials; their numbers where it has no names.
class Names {
 public:
  explicit Names(const RecordingInfo& info) : labels_(info.labels), materials_(info.materials) {}

  [[nodiscard]] std::string OfLabel(std::uint32_t id) const {
    const Label* const label = labels_.Find(id);
    return label == nullptr ? std::to_string(id) : label->name;
  }
  [[nodiscard]] std::string OfMaterial(std::uint16_t id) const {
    return id < materials_.size() ? materials_[id] : std::to_string(id);
  }

 private:
  LabelTable labels_;
  std::vector<std::string> materials_;
};

}  // namespace railcast
