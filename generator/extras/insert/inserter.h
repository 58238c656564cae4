#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/certify/certified_figures.h"
#include "generator/extras/insert/insert_plan.h"
#include "generator/extras/insert/inserted_frame.h"
#include "generator/extras/insert/recorded_firings.h"

namespace railcast {

/// Puts the objects and the weather of a plan into recorded frames.
class Inserter {
 public:
  /// @param num_threads 0 = all cores.
  /// @param certify Share of the frames' time that their certificates may take; absent: they have
  ///   none.
  /// @throws InputError if the plan cannot be simulated or certified.
  Inserter(const InsertPlan& plan, int num_threads, std::optional<double> certify = {});
  ~Inserter();

  /// Whether frames of the plan can have certificates: whether it has objects, and another rung
  /// than `reference`.
  [[nodiscard]] static bool CanCertify(const InsertPlan& plan);
  /// What the certificates are about, if frames have them.
  [[nodiscard]] const std::optional<CertifySpec>& certify() const;

  /// The result depends on the plan, the frame and its index alone. One caller at a time.
  /// @param frame_index Counted from 0 in the recording.
  [[nodiscard]] InsertedFrame Insert(const RecordedFirings& firings, std::uint32_t frame_index);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace railcast
