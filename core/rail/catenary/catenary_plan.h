#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/rail/catenary/independent_wires.h"
#include "core/rail/network/world_tracks.h"
#include "railcast/alignment.h"
#include "railcast/transform.h"
#include "railcast/world_spec.h"

namespace railcast {

/// A support of the contact line.
struct CatenarySupport {
  double s_m{};
  /// Lateral position of the wires relative to the middle of the pantograph, left positive: of the
  /// tracks that are parallel to the alignment.
  double stagger_m{};
};

/// The wire of a track with a course of its own (independent_wires.h), at consecutive supports.
struct IndependentWire {
  std::size_t first_support{};
  std::vector<HungWire> at;  ///< Empty: the track has none.

  [[nodiscard]] std::size_t last_support() const { return first_support + at.size() - 1; }
};

/// The supports of the contact line, placed once for the whole line; 16 bytes each.
///
/// The wire between two supports is straight in plan. With the staggers a_0 and a_1, its lateral
/// position relative to the middle of a pantograph at contact height h is
///
///     w(s) = lerp(c_0 + a_0, c_1 + a_1) - c(s)
///
/// where c is the lateral offset of the axis from the chord (c'' = curvature), less h sin(cant). A
/// span is the longest of max_span / 26, ..., max_span for which |w| <= stagger + 0.05 m
/// throughout. On an arc of radius R with both supports on its outside, this means
///
///     L <= sqrt(8 R (2 stagger + 0.05 m))
///
/// Staggers alternate where the rise L^2 / 8R of a full span is less than half the stagger, and lie
/// on the outside of the curve otherwise. All tracks share the supports. A span is shorter where
/// its second support would stand in the road of a level crossing.
///
/// Tracks with a course of their own have staggers of their own (independent_wires.h), and spans
/// are shorter where the wire of such a track would leave its limits: within stagger + 0.05 m of
/// the pantograph's middle, and 0.2 m from all other wires. Where no span keeps them, 0.55 m (the
/// working width of the pantograph's head) and 0.1 m must do; where none keeps these, the wires of
/// such tracks do not shorten the span.
class CatenaryPlan {
 public:
  /// @throws InputError as CheckSystemHeight() does.
  CatenaryPlan(const WorldTracks& tracks, const Alignment& alignment);

  /// In ascending order; empty without a contact line.
  [[nodiscard]] const std::vector<CatenarySupport>& supports() const { return supports_; }
  /// Number of spans that do not keep the strict limits of stagger + 0.05 m and 0.2 m.
  [[nodiscard]] std::size_t num_relaxed_spans() const { return num_relaxed_spans_; }
  /// The wire of a track that does not follow the alignment's staggers.
  [[nodiscard]] const IndependentWire& IndependentWireOf(std::size_t track) const {
    return independent_wires_[track];
  }
  /// All wires that a support carries, in the order of tracks.
  [[nodiscard]] std::vector<HungWire> WiresAt(const WorldTracks& tracks, std::size_t support) const;

 private:
  std::vector<CatenarySupport> supports_;
  std::vector<IndependentWire> independent_wires_;  ///< In the order of tracks.
  std::size_t num_relaxed_spans_ = 0;
};

}  // namespace railcast
