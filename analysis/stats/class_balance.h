#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "analysis/estimate/streams.h"
#include "analysis/report/report.h"
#include "analysis/stats/names.h"
#include "core/io/run/dataset_files.h"
#include "railcast/io/recording.h"

namespace railcast {

/// How the points are divided among the labels, in all and by range.
class ClassBalance {
 public:
  /// Frames without labels are skipped.
  void Add(const RecordedFrame& recorded);
  void Add(const ClassBalance& other);

  [[nodiscard]] bool is_empty() const { return classes_.empty(); }
  [[nodiscard]] Section MakeSection(const Names& names) const;

 private:
  struct Class {
    Moments points;  ///< Per frame that has any.
    std::array<std::uint64_t, kNumDistanceBins> by_range{};

    [[nodiscard]] std::uint64_t num_points() const;
  };
  /// Labels with the largest number of points first.
  [[nodiscard]] std::vector<std::pair<std::uint32_t, const Class*>> Sorted() const;
  [[nodiscard]] Table LabelsTable(const Names& names) const;

  std::map<std::uint32_t, Class> classes_;
  std::uint64_t num_frames_{};  ///< Frames with labels.
};

}  // namespace railcast
