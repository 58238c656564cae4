#include "core/rail/catenary/catenary.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/catenary/support_layout.h"
#include "core/rail/chunk/sweep.h"
#include "core/rail/clearance/cleared.h"
#include "core/rail/clearance/tunnel_shape.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

constexpr double kContactRadius_m = 0.006;
constexpr double kMessengerRadius_m = 0.0045;
constexpr double kDropperRadius_m = 0.00225;
constexpr int kWireSides = 16;
constexpr int kDropperSides = 8;

constexpr double kWireTolerance_m = 2e-3;
/// The contact wire follows the track's vertical curves: at a radius of 2000 m, chords of 5 m
/// deviate by less than 1.6 mm. That of a crossover between canted tracks has vertical curves of 50
/// m, where chords of 0.85 m deviate by 1.8 mm.
constexpr double kContactChord_m = 5.0;
constexpr double kLiftedContactChord_m = 0.85;

/// A wire of a span as a polyline with corners at integer multiples of 1 / num_chords.
template <typename Curve>
class Polyline {
 public:
  Polyline(Curve curve, double length_m, double chord_m)
      : curve_(std::move(curve)), num_chords_(std::ceil(length_m / chord_m)) {}

  /// A point on the polyline (not on the curve).
  [[nodiscard]] Vector3 At(double fraction) const {
    const double corner = std::clamp(std::floor(fraction * num_chords_), 0.0, num_chords_ - 1.0);
    const Vector3 a = curve_(corner / num_chords_);
    const Vector3 b = curve_((corner + 1.0) / num_chords_);
    return a + (fraction * num_chords_ - corner) * (b - a);
  }

  /// The part of the polyline between two fractions. A corner so close to an end that the piece
  /// would be a sliver is dropped.
  [[nodiscard]] std::vector<Vector3> Between(double first, double last) const {
    constexpr double kSliver = 0.01;  // Fraction of a chord.
    std::vector<Vector3> points_m{At(first)};
    for (double corner = std::ceil(first * num_chords_ + kSliver);
         corner < last * num_chords_ - kSliver; corner += 1.0) {
      points_m.push_back(curve_(corner / num_chords_));
    }
    points_m.push_back(At(last));
    return points_m;
  }

 private:
  Curve curve_;
  double num_chords_;
};

/// Places of the droppers as fractions of a span, clear of where other wires pass.
std::vector<double> DroppersOf(const CatenarySpec& spec,
                               double length_m,
                               const std::vector<double>& crossings) {
  // A wire that is led to a mast 3 m aside passes at an angle of 1:20 or more.
  const double clear = 1.0 / length_m;
  const auto num = static_cast<int>(std::ceil(length_m / spec.dropper_spacing_m));
  std::vector<double> places;
  for (int i = 0; i < num; ++i) {
    double at = (i + 0.5) / num;
    for (const double crossing : crossings) {
      if (std::abs(at - crossing) >= clear) continue;
      const bool goes_back = at < crossing ? crossing > 2.0 * clear : crossing > 1.0 - 2.0 * clear;
      at = goes_back ? crossing - clear : crossing + clear;
    }
    places.push_back(at);
  }
  return places;
}

void AddWiresOfSpan(const ChunkContext& context,
                    const WireSpanShape& span,
                    const std::vector<double>& crossings,
                    std::vector<Wire>& wires) {
  const double messenger_chord_m =
      std::sqrt(8.0 * kWireTolerance_m * kMessengerTension_n / kWireWeight_n_per_m);
  const Polyline contact([&](double at) { return span.Contact(at); }, span.length_m(),
                         span.IsLifted(kContactChord_m) ? kLiftedContactChord_m : kContactChord_m);
  const Polyline messenger([&](double at) { return span.Messenger(at); }, span.length_m(),
                           messenger_chord_m);

  const auto fraction = [&](double s_m) { return (s_m - span.first_s_m()) / span.length_m(); };
  const double first = std::max(0.0, fraction(context.begin_s_m - 0.5 * kChunkOverlap_m));
  const double last = std::min(1.0, fraction(context.end_s_m + 0.5 * kChunkOverlap_m));
  // A piece shorter than the overlap belongs to the neighbouring chunk.
  if ((last - first) * span.length_m() <= kChunkOverlap_m) return;
  const RailSurfaces& surfaces = context.surfaces;
  const auto add = [&](const SurfaceClass& surface, double radius_m,
                       std::vector<Vector3> points_m) {
    wires.push_back({surface.material, surface.label, radius_m, std::move(points_m)});
  };
  add(surfaces.contact_wire, kContactRadius_m, contact.Between(first, last));
  add(surfaces.messenger_wire, kMessengerRadius_m, messenger.Between(first, last));

  for (const double at : DroppersOf(context.spec.catenary, span.length_m(), crossings)) {
    const double s_m = span.first_s_m() + at * span.length_m();
    if (s_m < context.begin_s_m || s_m >= context.end_s_m) continue;
    add(surfaces.dropper, kDropperRadius_m, {contact.At(at), messenger.At(at)});
  }
}

/// The supports of the spans that extend into the chunk.
struct SupportRange {
  std::size_t first{};
  std::size_t end{};
};

SupportRange SupportsAround(const ChunkContext& context, const CatenaryPlan& plan) {
  const auto& supports = plan.supports();
  const auto at_or_after = [&](double s_m) {
    const auto found = std::lower_bound(
        supports.begin(), supports.end(), s_m,
        [](const CatenarySupport& support, double chainage_m) { return support.s_m < chainage_m; });
    return static_cast<std::size_t>(found - supports.begin());
  };
  const std::size_t begin = at_or_after(context.begin_s_m);
  const std::size_t end = at_or_after(context.end_s_m);
  return {.first = begin == 0 ? 0 : begin - 1, .end = std::min(end + 1, supports.size())};
}

void AddSupport(const ChunkContext& context,
                const CatenaryPlan& plan,
                const std::shared_ptr<const Model>& mast_model,
                std::size_t number,
                Chunk& chunk) {
  const WorldSpec& spec = context.spec;
  const CatenarySupport& support = plan.supports()[number];
  const double shift_m = PantographShift_m(spec.catenary, context.alignment.At(support.s_m));
  const auto chunk_from_support = [&](const AxisOffset& axis) -> Transform {
    return context.chunk_from_world * WorldFromSupport(context.alignment, spec, axis, support.s_m);
  };
  const auto add = [&](std::shared_ptr<const Model> model, const Transform& chunk_from_model,
                       std::size_t structure) {
    chunk.placements.push_back(
        {.model = std::move(model),
         .chunk_from_model = Eigen::Affine3d(chunk_from_model),
         .instance = kFirstMastInstance +
                     static_cast<std::uint32_t>(number * spec.tracks.size() + structure)});
  };
  const auto shared = [](Model model) { return std::make_shared<const Model>(std::move(model)); };

  const SupportLayout layout =
      LayOutSupport(spec, context.tracks, support.s_m, plan.WiresAt(TracksOf(context), number));
  CatenarySpec here = spec.catenary;
  here.system_height_m = SystemHeightAt_m(spec, support.s_m);
  for (const MastSite& mast : layout.masts) {
    const bool is_carried = IsCleared(context, support.s_m, mast.d_m(), Clearing::kSupport);
    add(is_carried ? shared(MakeHangingPost(here, context.surfaces)) : mast_model,
        chunk_from_support({mast.axis_d_m}) *
            Eigen::Translation3d(0.0, mast.from_axis_m - shift_m, 0.0),
        mast.structure);
  }
  for (const CantileverSite& site : layout.cantilevers) {
    CantileverShape shape{.face_m = site.hangs ? site.face_m : site.face_m - shift_m,
                          .wires = {},
                          .room_m = site.room_m};
    for (const HungWire& wire : site.wires) {
      const double lift_m = wire.axis_lift_m - site.lift_m;
      shape.wires.push_back({wire.axis_d_m - site.axis_d_m + wire.stagger_m,
                             lift_m + (wire.is_lifted ? kRunInLift_m : 0.0),
                             lift_m + (wire.is_lifted ? kMessengerLift_m : 0.0)});
    }
    add(shared(MakeCantilever(here, shape, context.surfaces)),
        chunk_from_support({site.axis_d_m, site.lift_m}), site.structure);
  }
  for (const PortalSite& site : layout.portals) {
    add(shared(MakePortal(spec.catenary, site, shift_m, context.surfaces)), chunk_from_support({}),
        site.structure);
  }
}

/// Corner radius for which a tube's corners and the middles of its faces are equally far from the
/// true surface.
double CornerRadius_m(double radius_m, int num_sides) {
  return 2.0 * radius_m / (1.0 + std::cos(std::numbers::pi / num_sides));
}

}  // namespace

std::vector<Wire> WiresInChunk(const ChunkContext& context, const CatenaryPlan& plan) {
  std::vector<Wire> wires;
  const SupportRange around = SupportsAround(context, plan);
  std::vector<std::vector<SpanOfTrack>> spans;
  for (std::size_t i = around.first; i + 1 < around.end; ++i) {
    spans.push_back(SpansBehind(context, plan, i));
  }
  // Track by track along the chunk.
  for (std::size_t track = 0; track < context.tracks.size(); ++track) {
    for (std::size_t i = 0; i < spans.size(); ++i) {
      for (std::size_t j = 0; j < spans[i].size(); ++j) {
        if (spans[i][j].track != track) continue;
        const std::size_t num_known = wires.size();
        AddWiresOfSpan(context, spans[i][j].shape, CrossingsOf(spans[i], j), wires);
        const WireSpan in_wind = spans[i][j].shape.InWind(
            static_cast<std::uint32_t>((around.first + i) * context.tracks.size() + track));
        for (std::size_t w = num_known; w < wires.size(); ++w) wires[w].span = in_wind;
      }
    }
  }
  for (Wire& wire : wires) {
    for (Vector3& point : wire.points_m) point = context.chunk_from_world * point;
    wire.span.begin_m = context.chunk_from_world * wire.span.begin_m;
    wire.span.end_m = context.chunk_from_world * wire.span.end_m;
  }
  return wires;
}

void AddCatenary(const ChunkContext& context,
                 const CatenaryPlan& plan,
                 const std::shared_ptr<const Model>& mast_model,
                 Chunk& chunk) {
  const SupportRange around = SupportsAround(context, plan);
  for (std::size_t i = around.first; i < around.end; ++i) {
    const CatenarySupport& support = plan.supports()[i];
    // The last support stands at the very end of the line, which no half-open chunk contains.
    const bool is_last_of_line = i + 1 == plan.supports().size() && support.s_m == context.end_s_m;
    if (support.s_m < context.begin_s_m || (support.s_m >= context.end_s_m && !is_last_of_line)) {
      continue;
    }
    AddSupport(context, plan, mast_model, i, chunk);
  }
  chunk.wires = WiresInChunk(context, plan);
  for (const Wire& wire : chunk.wires) {
    const int num_sides = wire.radius_m == kDropperRadius_m ? kDropperSides : kWireSides;
    Part& part = PartOf({wire.material, wire.label}, chunk.ground);
    part.is_wire = true;
    part.mesh.Append(MakeTube(wire.points_m, CornerRadius_m(wire.radius_m, num_sides), num_sides));
  }
}

}  // namespace railcast
