#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/rail/catenary/catenary.h"
#include "core/rail/catenary/support_layout.h"
#include "core/rail/clearance/tunnel_shape.h"
#include "core/rail/network/world_tracks.h"

namespace railcast {
namespace {

constexpr double kContactWireRadius_m = 0.006;
constexpr double kMessengerWireRadius_m = 0.0045;

/// 0 at the supports, 1 in the middle of the span.
double SagParabola(double fraction) {
  return 4.0 * fraction * (1.0 - fraction);
}

WireEnd HeldEnd(const ChunkContext& context, const CatenarySupport& at, const HungWire& wire) {
  const WorldSpec& world = context.spec;
  const double lift_m = wire.is_lifted ? kRunInLift_m : 0.0;
  const double above_m = wire.is_lifted ? kMessengerLift_m - kRunInLift_m : 0.0;
  const Vector3 held_m(0.0, wire.stagger_m, world.catenary.contact_height_m + lift_m);
  return {.s_m = at.s_m,
          .contact_m = WorldFromSupport(context.alignment, world, {wire.axis_d_m, wire.axis_lift_m},
                                        at.s_m) *
                       held_m,
          .system_height_m = SystemHeightAt_m(world, at.s_m) + above_m};
}

/// A wire that must be led from where a support holds it to a mast at another.
struct LooseWire {
  const HungWire& held;
  std::size_t held_at{};
  std::size_t anchored_at{};
};

/// How many other wires one passes above on its way to a mast at `mast_d_m`.
std::size_t NumCrossed(const ChunkContext& context,
                       const CatenaryPlan& plan,
                       const LooseWire& wire,
                       double mast_d_m) {
  const std::vector<HungWire> there = plan.WiresAt(TracksOf(context), wire.anchored_at);
  std::size_t num = 0;
  for (const HungWire& other : plan.WiresAt(TracksOf(context), wire.held_at)) {
    const auto same = std::ranges::find(there, other.track, &HungWire::track);
    if (same == there.end() || other.track == wire.held.track) continue;
    if ((wire.held.d_m() - other.d_m()) * (mast_d_m - same->d_m()) < 0.0) ++num;
  }
  return num;
}

std::optional<WireEnd> AnchoredEnd(const ChunkContext& context,
                                   const CatenaryPlan& plan,
                                   const LooseWire& wire) {
  const WorldSpec& world = context.spec;
  const double s_m = plan.supports()[wire.anchored_at].s_m;
  const SupportLayout layout =
      LayOutSupport(world, context.tracks, s_m, plan.WiresAt(TracksOf(context), wire.anchored_at));
  const MastSite* best = nullptr;
  std::pair<std::size_t, double> least(0, std::numeric_limits<double>::infinity());
  for (const MastSite& mast : layout.masts) {
    const std::pair<std::size_t, double> cost(NumCrossed(context, plan, wire, mast.d_m()),
                                              std::abs(mast.d_m() - wire.held.d_m()));
    if (best != nullptr && cost >= least) continue;
    best = &mast;
    least = cost;
  }
  if (best == nullptr) return std::nullopt;
  const double shift_m = PantographShift_m(world.catenary, context.alignment.At(s_m));
  const double lift_m =
      WireAxis(TracksOf(context), wire.held.track).LiftAt_m(context.alignment, s_m);
  const Vector3 end_m(0.0, best->from_axis_m - shift_m,
                      world.catenary.contact_height_m + kAnchoredContact_m);
  return WireEnd{
      .s_m = s_m,
      .contact_m =
          WorldFromSupport(context.alignment, world, {best->axis_d_m, lift_m}, s_m) * end_m,
      .system_height_m = SystemHeightAt_m(world, s_m) + kAnchoredMessenger_m - kAnchoredContact_m};
}

/// The span in which the wires of a branch are led to their mast: before their first support or
/// behind their last one.
std::optional<SpanOfTrack> AnchoredSpan(const ChunkContext& context,
                                        const CatenaryPlan& plan,
                                        std::size_t track,
                                        std::size_t support) {
  const IndependentWire& own = plan.IndependentWireOf(track);
  const auto& supports = plan.supports();
  const TrackSpec& spec = context.spec.tracks[track];
  const WireAxis axis(TracksOf(context), track);
  if (spec.begin && support + 1 == own.first_support) {
    const auto end = AnchoredEnd(context, plan, {own.at.front(), support + 1, support});
    if (!end) return std::nullopt;
    const WireEnd held = HeldEnd(context, supports[support + 1], own.at.front());
    return SpanOfTrack{track, {context.alignment, axis, *end, held}, true};
  }
  if (spec.end && support == own.last_support()) {
    const auto end = AnchoredEnd(context, plan, {own.at.back(), support, support + 1});
    if (!end) return std::nullopt;
    const WireEnd held = HeldEnd(context, supports[support], own.at.back());
    return SpanOfTrack{track, {context.alignment, axis, held, *end}, true};
  }
  return std::nullopt;
}

}  // namespace

Vector3 WireSpanShape::Contact(double fraction) const {
  const auto axis_height_m = [&](double at) {
    const double s_m = first_.s_m + at * length_m_;
    return alignment_->At(s_m).position_m.z() + axis_.LiftAt_m(*alignment_, s_m);
  };
  const double along_track_m =
      axis_height_m(fraction) - std::lerp(axis_height_m(0.0), axis_height_m(1.0), fraction);
  return Chord(fraction) +
         Vector3(0.0, 0.0, along_track_m - SagParabola(fraction) * kContactPresag * length_m_);
}

Vector3 WireSpanShape::Messenger(double fraction) const {
  const double sag_m = kWireWeight_n_per_m * length_m_ * length_m_ / (8.0 * kMessengerTension_n);
  const double system_height_m = std::lerp(first_.system_height_m, last_.system_height_m, fraction);
  return Chord(fraction) + Vector3(0.0, 0.0, system_height_m - SagParabola(fraction) * sag_m);
}

bool WireSpanShape::IsLifted(double step_m) const {
  for (double s_m = first_.s_m; s_m < last_.s_m; s_m += step_m) {
    if (axis_.LiftAt_m(*alignment_, s_m) != 0.0) return true;
  }
  return axis_.LiftAt_m(*alignment_, last_.s_m) != 0.0;
}

WireSpan WireSpanShape::InWind(std::uint32_t number) const {
  constexpr double kGravity_mps2 = 9.80665;
  return {.number = number,
          .begin_m = first_.contact_m,
          .end_m = last_.contact_m,
          .tension_n = kContactTension_n + kMessengerTension_n,
          .mass_kg_per_m = kWireWeight_n_per_m / kGravity_mps2,
          .width_m = 2.0 * (kContactWireRadius_m + kMessengerWireRadius_m)};
}

double WireSpanShape::LeftOf_m(const WireSpanShape& other, double fraction) const {
  const Vector3 way = other.last_.contact_m - other.first_.contact_m;
  const Vector3 left = Vector3::UnitZ().cross(way).normalized();
  return (Chord(fraction) - other.Chord(fraction)).dot(left);
}

std::vector<SpanOfTrack> SpansBehind(const ChunkContext& context,
                                     const CatenaryPlan& plan,
                                     std::size_t support) {
  const CatenarySupport& first = plan.supports()[support];
  const CatenarySupport& last = plan.supports()[support + 1];
  const std::vector<HungWire> lasts = plan.WiresAt(TracksOf(context), support + 1);
  std::vector<SpanOfTrack> spans;
  for (const HungWire& wire : plan.WiresAt(TracksOf(context), support)) {
    const auto same = std::ranges::find(lasts, wire.track, &HungWire::track);
    if (same == lasts.end()) continue;
    spans.push_back({wire.track,
                     {context.alignment, WireAxis(TracksOf(context), wire.track),
                      HeldEnd(context, first, wire), HeldEnd(context, last, *same)},
                     false});
  }
  for (std::size_t track = 0; track < context.tracks.size(); ++track) {
    if (plan.IndependentWireOf(track).at.empty()) continue;
    if (auto anchored = AnchoredSpan(context, plan, track, support)) spans.push_back(*anchored);
  }
  return spans;
}

std::vector<double> CrossingsOf(const std::vector<SpanOfTrack>& spans, std::size_t index) {
  std::vector<double> crossings;
  for (std::size_t other = 0; other < spans.size(); ++other) {
    if (other == index || !(spans[other].is_anchored || spans[index].is_anchored)) continue;
    const double first_m = spans[index].shape.LeftOf_m(spans[other].shape, 0.0);
    const double last_m = spans[index].shape.LeftOf_m(spans[other].shape, 1.0);
    if (first_m * last_m < 0.0) crossings.push_back(first_m / (first_m - last_m));
  }
  return crossings;
}

}  // namespace railcast
