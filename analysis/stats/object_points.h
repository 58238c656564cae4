#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "analysis/estimate/moments.h"
#include "analysis/report/report.h"
#include "core/io/recording/recording.h"

namespace railcast {

/// Points on each object by its distance, from objects.jsonl of our sequences; and of the beams
/// that met it, from the frames' truth, how many came back.
class ObjectPoints {
 public:
  void Add(const RecordedFrame& recorded);
  void Add(const ObjectPoints& other);

  [[nodiscard]] bool is_empty() const { return objects_.empty(); }
  [[nodiscard]] Section MakeSection() const;

 private:
  /// In one bin of distance, over frames.
  struct Bin {
    Moments points;
    std::uint64_t num_met{};       ///< Firings that met it, ...
    std::uint64_t num_returned{};  ///< ... and those that came back.
  };
  struct Object {
    std::string label;
    std::vector<Bin> bins;  ///< Of RangeBins(), by the distance of the box's middle.
  };
  std::map<std::string, Object> objects_;  ///< By name.
};

}  // namespace railcast
