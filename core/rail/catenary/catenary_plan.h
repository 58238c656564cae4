#pragma once

#include <cstddef>
#include <vector>

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

/// A support of the contact line.
struct CatenarySupport {
  double s_m{};
  /// Lateral position of the wires relative to the middle of the pantograph, left positive.
  double stagger_m{};
};

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
class CatenaryPlan {
 public:
  /// @throws InputError as CheckSystemHeight() does.
  CatenaryPlan(const WorldSpec& spec, const Alignment& alignment);

  /// In ascending order; empty without a contact line.
  [[nodiscard]] const std::vector<CatenarySupport>& supports() const { return supports_; }

 private:
  std::vector<CatenarySupport> supports_;
};

/// Lateral displacement of a pantograph's middle by cant, at the height of the contact line, left
/// positive.
[[nodiscard]] double PantographShift_m(const CatenarySpec& spec, const AxisPoint& axis);

/// The level frame of one track at one support, in which cantilever and wires are described: x
/// along the heading, z up. The origin lies below the middle of a pantograph by the height of the
/// contact line, at PantographShift_m() from the track's axis.
[[nodiscard]] Transform WorldFromSupport(const Alignment& alignment,
                                         const WorldSpec& spec,
                                         const TrackSpec& track,
                                         double s_m);

}  // namespace railcast
