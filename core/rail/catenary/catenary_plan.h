#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/rail/catenary/own_wires.h"
#include "core/rail/network/world_tracks.h"
#include "railcast/alignment.h"
#include "railcast/rail_world.h"
#include "railcast/transform.h"

namespace railcast {

/// Weight, tension and sag of the contact line (docs/physics.md 7.2): a Bz50 messenger wire carries
/// an AC-100 contact wire at 10 kN.
inline constexpr double kWireWeight_n_per_m = 13.0;
inline constexpr double kMessengerTension_n = 10e3;
inline constexpr double kContactTension_n = 10e3;
inline constexpr double kContactPresag = 1.0 / 1000.0;  ///< Sag as a fraction of the span.

/// Supports stand at multiples of this part of the longest span.
inline constexpr std::size_t kStepsOfASpan = 26;

/// A support of the contact line.
struct CatenarySupport {
  double s_m{};
  /// Lateral position of the wires relative to the middle of the pantograph, left positive: of the
  /// tracks that are parallel to the alignment.
  double stagger_m{};
};

/// The wire of a track with a course of its own (own_wires.h), at consecutive supports.
struct OwnWire {
  std::size_t first_support{};
  std::vector<HungWire> at;  ///< Empty: the track has none.

  [[nodiscard]] std::size_t last_support() const { return first_support + at.size() - 1; }
};

/// Stagger towards the outside of a curve; nothing where the line is straight enough for staggers
/// to alternate.
[[nodiscard]] std::optional<double> StaggerInCurve(const CatenarySpec& spec,
                                                   double curvature_per_m);

/// The least system height with which the messenger wire, sagging over the longest span, stays 0.3
/// m above the contact wire.
[[nodiscard]] double LeastSystemHeight_m(const WorldSpec& world);

/// @throws InputError if the messenger wire would sag to less than 0.3 m above the contact wire:
///   "/catenary/system_height_m: rule (got value)", relative to the world's JSON object.
void CheckSystemHeight(const WorldSpec& world);

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
/// Tracks with a course of their own have staggers of their own (own_wires.h), and spans are
/// shorter where the wire of such a track would leave its limits: within stagger + 0.05 m of the
/// pantograph's middle, and 0.2 m from all other wires. Where no span keeps them, 0.55 m (the
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
  [[nodiscard]] const OwnWire& OwnWireOf(std::size_t track) const { return own_wires_[track]; }
  /// All wires that a support carries, in the order of tracks.
  [[nodiscard]] std::vector<HungWire> WiresAt(const WorldTracks& tracks, std::size_t support) const;

 private:
  std::vector<CatenarySupport> supports_;
  std::vector<OwnWire> own_wires_;  ///< In the order of tracks.
  std::size_t num_relaxed_spans_ = 0;
};

/// Lateral displacement of a pantograph's middle by cant, at the height of the contact line, left
/// positive.
[[nodiscard]] double PantographShift_m(const CatenarySpec& spec, const AxisPoint& axis);

/// A track's axis at a support: left of the alignment, and above it.
struct AxisOffset {
  double d_m{};
  double lift_m = 0.0;
};

/// The level frame of one track at one support, in which cantilever and wires are described: x
/// along the heading, z up. The origin lies below the middle of a pantograph by the height of the
/// contact line, at PantographShift_m() from the track's axis.
[[nodiscard]] Transform WorldFromSupport(const Alignment& alignment,
                                         const WorldSpec& spec,
                                         const AxisOffset& axis,
                                         double s_m);

}  // namespace railcast
