#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "analysis/estimate/streams.h"
#include "analysis/report/report.h"
#include "analysis/stats/names.h"
#include "analysis/stats/plane_patches.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Intensity of points against range and incidence, and by label.
///
/// The incidence is the true one where frames have it, else that of flat pieces of surface
/// (plane_patches.h), whose samples are pieces rather than points.
class Intensity {
 public:
  /// Frames without intensity are skipped.
  void Add(const RecordedFrame& recorded, const std::vector<PlanePatch>& patches);
  void Add(const Intensity& other);

  struct Sum {
    Moments plain;
    LogHistogram robust;

    void Add(double intensity);
    void Add(const Sum& other);
  };

  [[nodiscard]] bool is_empty() const { return all_.plain.num() == 0; }
  [[nodiscard]] const std::vector<Sum>& by_range() const { return by_range_; }
  [[nodiscard]] const std::vector<Sum>& by_incidence() const { return by_incidence_; }
  [[nodiscard]] Section MakeSection(const Names& names) const;

 private:
  bool has_true_incidence_{};
  Sum all_;
  std::vector<Sum> by_range_, by_incidence_;
  std::map<std::uint32_t, Sum> by_label_;
};

}  // namespace railcast
