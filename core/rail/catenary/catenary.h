#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/catenary/catenary_plan.h"
#include "core/rail/catenary/independent_wires.h"
#include "core/rail/catenary/support_layout.h"
#include "core/rail/chunk/chunk_context.h"
#include "railcast/scene.h"
#include "railcast/world_spec.h"

namespace railcast {

/// An upright HEB 240 on a concrete block. The origin is at its middle at the height of top of
/// rail; the mast rises at least 8 m above it, more if the height of the wires requires it. 54
/// triangles.
[[nodiscard]] Model MakeMast(const CatenarySpec& spec, const RailSurfaces& surfaces);

/// The post below the roof of a tunnel or the deck of a bridge that carries a cantilever in place
/// of a mast, HEB 240. Origin as that of a mast. 44 triangles.
[[nodiscard]] Model MakeHangingPost(const CatenarySpec& spec, const RailSurfaces& surfaces);

/// A portal: a beam of HEB 240 on two masts, with posts of the same section that hang from it down
/// to the lower hinges of their cantilevers. In the frame of WorldFromSupport of a track at offset
/// 0. 44 triangles, and 44 more per post.
/// @param shift_m PantographShift_m() at the support.
[[nodiscard]] Model MakePortal(const CatenarySpec& spec,
                               const PortalSite& site,
                               double shift_m,
                               const RailSurfaces& surfaces);

/// A wire on a cantilever.
struct CantileverWire {
  double y_m{};               ///< Lateral position, left positive.
  double contact_lift_m{};    ///< Lift of its contact wire above contact height.
  double messenger_lift_m{};  ///< Lift of its messenger above that of a plain wire.
};

/// What a cantilever carries, in the frame of WorldFromSupport.
struct CantileverShape {
  double face_m{};                    ///< Face of the mast or post that carries it, left positive.
  std::vector<CantileverWire> wires;  ///< At least one.
  double room_m{};  ///< Where its room ends on the other side; infinite if it does not.
};

/// A cantilever: a top tube from the mast to the farthest messenger wire, a strut below it, both on
/// ceramic insulators, a registration tube, and for each wire the steady arm that pulls the contact
/// wire to its stagger. Tubes of 42 and 60 mm. 620 triangles with one wire.
[[nodiscard]] Model MakeCantilever(const CatenarySpec& spec,
                                   const CantileverShape& shape,
                                   const RailSurfaces& surfaces);

/// Lowest height of a wire's end above the contact height where it is anchored, and that of the
/// messenger above its height at supports.
inline constexpr double kAnchoredContact_m = 0.5;
inline constexpr double kAnchoredMessenger_m = 0.4;

/// Where the wires of a track end a span.
struct WireEnd {
  double s_m{};
  Vector3 contact_m;  ///< Position of the contact wire in the world.
  double system_height_m{};
};

/// The wires of one track between two supports, in world coordinates.
class WireSpanShape {
 public:
  /// @param axis Above which the contact wire keeps its height.
  WireSpanShape(const Alignment& alignment,
                WireAxis axis,
                const WireEnd& first,
                const WireEnd& last)
      : alignment_(&alignment),
        axis_(std::move(axis)),
        first_(first),
        last_(last),
        length_m_(last.s_m - first.s_m) {}

  [[nodiscard]] double first_s_m() const { return first_.s_m; }
  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] Vector3 Contact(double fraction) const;
  [[nodiscard]] Vector3 Messenger(double fraction) const;
  /// Whether the track lies higher or lower than the alignment at one of the places `step_m` apart.
  [[nodiscard]] bool IsLifted(double step_m) const;

  /// The span in world coordinates. The wind moves all its wires alike, since droppers join them.
  [[nodiscard]] WireSpan InWind(std::uint32_t number) const;
  /// How far this one is left of another between the same supports, at a fraction of the span.
  [[nodiscard]] double LeftOf_m(const WireSpanShape& other, double fraction) const;

 private:
  [[nodiscard]] Vector3 Chord(double fraction) const {
    return first_.contact_m + fraction * (last_.contact_m - first_.contact_m);
  }

  const Alignment* alignment_;
  WireAxis axis_;
  WireEnd first_;
  WireEnd last_;
  double length_m_;
};

/// The wires of a track in the span behind a support.
struct SpanOfTrack {
  std::size_t track{};
  WireSpanShape shape;
  /// Whether it only leads to the mast at which the wires are anchored.
  bool is_anchored{};
};

/// All wires in the span from a support to the next. The wires of a branch are led on by one span
/// before the first support that carries them, and behind the last, and end at a mast there:
/// that for which they pass above the fewest other wires, and then the nearest.
[[nodiscard]] std::vector<SpanOfTrack> SpansBehind(const ChunkContext& context,
                                                   const CatenaryPlan& plan,
                                                   std::size_t support);

/// Fractions of span `index` at which a wire that is led to its mast passes above it, or it above
/// another. No dropper may be there.
[[nodiscard]] std::vector<double> CrossingsOf(const std::vector<SpanOfTrack>& spans,
                                              std::size_t index);

/// Makes all conductors of the chunk (docs/physics.md 7.2). They extend half the overlap beyond its
/// ends.
/// - Contact wire, 12 mm: straight in plan from support to support, at contact height above the
///   track with a sag of span / 1000.
/// - Messenger wire, 9 mm: a parabola w x (L - x) / 2T from support to support, vertically above
///   the contact wire.
/// - Droppers, 4.5 mm: evenly spaced, at most CatenarySpec's distance apart and half of it from a
///   support. Each belongs to the chunk it stands in.
///
/// Chords deviate from the true lines by at most 2 mm. Their corners depend on the span alone, so
/// that the same wire continues through neighbouring chunks.
[[nodiscard]] std::vector<Wire> WiresInChunk(const ChunkContext& context, const CatenaryPlan& plan);

/// Adds masts and cantilevers, as placements whose instance is kFirstMastInstance plus the mast's
/// number along the whole line, and the wires as tubes. Tubes have 16 sides (droppers 8). Their
/// corners lie as far outside the true surface as the middles of their faces lie inside: 0.06 mm
/// for the contact wire, 0.04 mm for the messenger wire, 0.09 mm for droppers.
/// @param mast_model MakeMast().
void AddCatenary(const ChunkContext& context,
                 const CatenaryPlan& plan,
                 const std::shared_ptr<const Model>& mast_model,
                 Chunk& chunk);

inline constexpr std::uint32_t kFirstMastInstance = 20'000;

}  // namespace railcast
