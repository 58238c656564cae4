#pragma once

#include <cstddef>
#include <vector>

#include "core/base/transform.h"
#include "core/rail/line/alignment.h"
#include "core/rail/world_spec.h"

namespace railcast {

/// Heights and sag of the contact line, physics.md 7.2: Bz50 rope carrying an AC-100 wire at 10 kN.
inline constexpr double kWireWeight_n_per_m = 13.0;
inline constexpr double kMessengerTension_n = 10e3;
inline constexpr double kContactPresag = 1.0 / 1000.0;  ///< Of the span.

/// Where the contact line is held up.
struct CatenarySupport {
  double s_m{};
  double stagger_m{};  ///< Of the wires from the middle of the pantograph, left positive.
};

/// @throws InputError if the messenger would sag to less than 0.3 m above the contact wire:
///   "/catenary/system_height_m: rule (got value)", relative to the world's JSON object.
void CheckSystemHeight(const WorldSpec& world);

/// The supports of the contact line, placed once for the whole line; 16 bytes for each.
///
/// The wire between two supports is straight in plan. With a_0, a_1 the staggers, the wire is at
///   w(s) = lerp(c_0 + a_0, c_1 + a_1) - c(s)
/// from the middle of a pantograph at contact height h, where c'' = curvature is the axis' course
/// beside the chord, less h sin(cant). A span is the longest of max_span / 26, ..., max_span for
/// which |w| <= stagger + 0.05 m throughout; on an arc of radius R with both supports on its
/// outside that is L <= sqrt(8 R (2 stagger + 0.05 m)). Staggers alternate where a full span's rise
/// L^2 / 8R is less than half the stagger, and lie on the outside where it is more. All tracks
/// share the supports.
class CatenaryPlan {
 public:
  /// @throws InputError as CheckSystemHeight() does.
  CatenaryPlan(const WorldSpec& spec, const Alignment& alignment);

  /// Ascending; empty without a contact line.
  [[nodiscard]] const std::vector<CatenarySupport>& supports() const { return supports_; }

 private:
  std::vector<CatenarySupport> supports_;
};

/// How far cant moves the middle of a pantograph at the contact line's height, left positive.
[[nodiscard]] double PantographShift_m(const CatenarySpec& spec, const AxisPoint& axis);

/// The level frame of one track at one support: x along the heading, z up; its origin is the
/// contact line's height below the middle of a pantograph there, which is PantographShift_m() from
/// the track's axis. Cantilever and wires stand in it.
[[nodiscard]] Transform WorldFromSupport(const Alignment& alignment,
                                         const WorldSpec& spec,
                                         const TrackSpec& track,
                                         double s_m);

}  // namespace railcast
