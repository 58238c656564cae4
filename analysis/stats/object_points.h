#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "analysis/estimate/streams.h"
#include "analysis/report/report.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Points on each object by its distance, from objects.jsonl of railcast sequences, and, from the
/// frames' truth, the share of the beams that met it and returned.
class ObjectPoints {
 public:
  void Add(const RecordedFrame& recorded);
  void Add(const ObjectPoints& other);

  [[nodiscard]] bool is_empty() const { return objects_.empty(); }
  [[nodiscard]] Section MakeSection() const;

 private:
  /// Counts in one bin of distance, over frames.
  struct Bin {
    Moments points;
    std::uint64_t num_met{};       ///< Firings that met it ...
    std::uint64_t num_returned{};  ///< ... and those that returned a point.
  };
  struct Object {
    std::string label;
    std::vector<Bin> bins;  ///< By bin of RangeBins(), by the distance of the box's middle.
  };
  std::map<std::string, Object> objects_;  ///< By name.
};

}  // namespace railcast
