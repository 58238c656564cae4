#include "core/detect/beam/footprint.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "core/detect/base/beam_axes.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/beam/wire_in_beam.h"
#include "railcast/lidar.h"
#include "railcast/outcome.h"

namespace railcast {
namespace {

// Parts of a beam with a larger gap in range belong to different surfaces.
constexpr float kSurfaceGap_m = 0.5F;

// The share of a beam that does not meet the largest of its surfaces. Sorts the parts by range;
// parts that meet the sky come last.
float MixedShare(std::vector<Component>& parts) {
  std::sort(parts.begin(), parts.end(), [](const Component& a, const Component& b) {
    const bool a_hits = a.surface != 0;
    const bool b_hits = b.surface != 0;
    return a_hits != b_hits ? a_hits : a_hits && a.range_m < b.range_m;
  });
  float total = 0.0F;
  float largest = 0.0F;
  float share = 0.0F;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool begins = i == 0 || (parts[i].surface == 0) != (parts[i - 1].surface == 0) ||
                        parts[i].range_m - parts[i - 1].range_m > kSurfaceGap_m;
    share = begins ? parts[i].share : share + parts[i].share;
    total += parts[i].share;
    largest = std::max(largest, share);
  }
  return std::max(total - largest, 0.0F);
}

// Echoes weaker than this are detected in at most one case of 1000.
constexpr float kLeastRatio = 0.3F;

}  // namespace

SubRayParts::SubRayParts(const DetectorSpec& spec, const Kernels& kernels)
    : spec_(spec),
      kernels_(kernels),
      pattern_(DenseSubRays(static_cast<std::size_t>(spec.beam.reference_rays))) {}

void SubRayParts::Flush(const WideBeams& beams, std::size_t num_rays) {
  if (num_rays == 0) return;
  RayTile& rays = batch_.rays;
  std::fill_n(rays.range_m, num_rays, static_cast<float>(spec_.range_max_m));
  std::fill_n(rays.surface, num_rays, 0U);
  for (float* values : {rays.normal_x, rays.normal_y, rays.normal_z}) {
    std::fill_n(values, num_rays, 0.0F);
  }
  rays.mask = beams.rays.mask;
  const std::size_t num = batch_.Pad(num_rays);
  beams.caster.Cast(rays);
  if (beams.besides != nullptr) beams.besides->Meet(firing_.data(), num_rays, rays);
  batch_.Respond(beams, kernels_, num, num_rays, found_);
}

void SubRayParts::Find(const WideBeams& beams, const DetectTile& first, PartLists& lists) {
  found_.clear();
  RayTile& rays = batch_.rays;
  const BeamFrame& frame = beams.frame;
  std::size_t num_rays = 0;
  for (std::size_t lane = 0; lane < first.num_rays; ++lane) {
    const baseline::Direction d{beams.rays.direction_x[lane], beams.rays.direction_y[lane],
                                beams.rays.direction_z[lane]};
    const baseline::BeamAxes axes = baseline::AxesOf(d, frame);
    const float per_unit = 1.0F / baseline::LengthOf(axes);
    const float sigma_h = frame.sigma_h_rad * per_unit;
    const float sigma_v = frame.sigma_v_rad * per_unit;
    for (const SubRay& sub_ray : pattern_.sub_rays) {
      const SubRay turned = Turned(sub_ray, beams.turns.cosine[lane], beams.turns.sine[lane]);
      const baseline::Direction aim =
          baseline::Beside(d, axes, sigma_h * turned.h, sigma_v * turned.v);
      rays.origin_x[num_rays] = beams.rays.origin_x[lane];
      rays.origin_y[num_rays] = beams.rays.origin_y[lane];
      rays.origin_z[num_rays] = beams.rays.origin_z[lane];
      rays.direction_x[num_rays] = aim.x;
      rays.direction_y[num_rays] = aim.y;
      rays.direction_z[num_rays] = aim.z;
      rays.shutter[num_rays] = beams.rays.shutter[lane];
      firing_[num_rays] = first.firing[lane];
      batch_.Describe(num_rays, sub_ray.share, sub_ray.share, 0.0F);
      if (++num_rays < kTileSize) continue;
      Flush(beams, num_rays);
      num_rays = 0;
    }
  }
  Flush(beams, num_rays);
  lists.parts.clear();
  const auto num = static_cast<std::ptrdiff_t>(pattern_.sub_rays.size());
  auto part = found_.begin();
  for (std::size_t lane = 0; lane < first.num_rays; ++lane) {
    lists.begin[lane] = lists.parts.size();
    lists.parts.insert(lists.parts.end(), part, part + num);
    lists.parts.push_back(CellOf(ComponentOf(first, lane), pattern_.central_share, spec_));
    part += num;
  }
  lists.begin[first.num_rays] = lists.parts.size();
}

bool HasFootprint(const DetectorSpec& spec) {
  return spec.effects.footprint && IsWide(spec.beam);
}

Footprint::Footprint(const DetectorSpec& spec, const Kernels& kernels)
    : spec_(spec),
      facet_parts_(spec, kernels),
      sub_ray_parts_(spec, kernels),
      finder_(spec, spec.effects.detection ? kLeastRatio : 0.0F, kernels) {}

void Footprint::StoreEchoes(std::size_t lane, EchoTiles& echoes) const {
  std::uint32_t number = 0;
  for (const Echo& echo : found_) {
    const EchoTiles::Place place =
        number == 0 ? EchoTiles::Place{echoes.first, lane} : echoes.Add(lane, number);
    const auto [tile, i] = place;
    tile.surface[i] = echo.surface;
    tile.true_range_m[i] = echo.true_range_m;
    tile.peak_shift_m[i] = echo.peak_range_m - echo.true_range_m;
    tile.cos_incidence[i] = echo.cos_incidence;
    tile.spread_m[i] = 0.0F;
    tile.share[i] = echo.share;
    tile.reflectivity[i] = background_[lane];
    tile.outcome[i] = static_cast<std::uint32_t>(Outcome::kReturned);
    tile.clutter[i] = kNoClutter;
    tile.intensity[i] = echo.intensity;
    tile.power_ratio[i] = echo.power_ratio;
    ++number;
  }
}

void Footprint::AddWires(const WideBeams& beams, const WireCapture* begin, const WireCapture* end) {
  // Captures are sorted by range. Each one reduces the share of what lies behind it, but for those
  // that are too near to be seen.
  while (begin != end && begin->range_m < static_cast<float>(spec_.range_min_m)) ++begin;
  for (const WireCapture* capture = begin; capture != end; ++capture) {
    if (!(capture->range_m < static_cast<float>(spec_.range_max_m))) continue;
    float visible = 1.0F;
    for (const Component& part : beam_parts_) {
      if (part.surface != 0 && part.range_m < capture->range_m) visible -= part.share;
    }
    // The shares of the rays add up to 1 except for rounding, so that `visible` may be negative.
    // What nearer wires hide of it takes nothing more from what lies behind.
    const float seen = capture->share * (1.0F - HiddenShare(*capture, {begin, capture}));
    const float share = seen * std::max(visible, 0.0F);
    for (std::vector<Component>* parts : {&components_, &beam_parts_}) {
      for (Component& part : *parts) {
        if (part.surface != 0 && part.range_m < capture->range_m) continue;
        part.share *= 1.0F - seen;
        part.power_ratio *= 1.0F - seen;
        part.intensity *= 1.0F - seen;
      }
    }
    const LaneOptics& optics = beams.table.optics[beams.table.surfaces[capture->surface].material];
    const double reflectance =
        CylinderMean(static_cast<double>(capture->sin_axis), [&](double cosine) {
          return static_cast<double>(
              beams.detector.Reflectance(optics, static_cast<float>(cosine)));
        });
    const float intensity = share * static_cast<float>(reflectance);
    wires_.push_back(
        {.range_m = capture->range_m,
         .spread_m = capture->spread_m,
         .power_ratio = beams.detector.PowerRatio(intensity, capture->range_m, capture->spread_m),
         .share = share,
         .intensity = intensity,
         .cos_incidence = capture->sin_axis,
         .reflectivity = optics.diffuse,
         .surface = capture->surface});
  }
}

void Footprint::FindParts(const WideBeams& beams, const DetectTile& first) {
  if (!HasFootprint(spec_)) {
    lists_.parts.clear();
    lists_.begin.fill(0);
  } else if (spec_.effects.dense_footprint) {
    sub_ray_parts_.Find(beams, first, lists_);
  } else {
    facet_parts_.Find(beams, first, lists_);
  }
}

void Footprint::Trace(const WideBeams& beams, const WireSet* wires, const DetectTile& first) {
  captures_.clear();
  if (wires != nullptr) {
    const BeamFrame& frame = beams.frame;
    CaptureWires(beams.rays,
                 {.up_window = {frame.up[0], frame.up[1], frame.up[2]},
                  .sigma_horizontal_rad = static_cast<double>(frame.sigma_h_rad),
                  .sigma_vertical_rad = static_cast<double>(frame.sigma_v_rad)},
                 *wires, captures_);
  }
  has_wire_.fill(false);
  for (const WireCapture& capture : captures_) has_wire_[capture.lane] = true;
  if (!CastsBeams(spec_)) return;
  ChooseWide(beams, first.num_rays);
  facet_parts_.Trace(beams, first, is_wide_);
}

void Footprint::ChooseWide(const WideBeams& beams, std::size_t num_lanes) {
  const std::vector<std::uint32_t>& labels = spec_.footprint_labels;
  is_wide_.fill(labels.empty());
  if (labels.empty()) return;
  for (const WireCapture& capture : captures_) {
    const std::uint32_t label = beams.table.surfaces[capture.surface].label;
    if (std::ranges::binary_search(labels, label)) is_wide_[capture.lane] = true;
  }
  for (std::size_t lane = 0; lane < num_lanes; ++lane) {
    is_wide_[lane] = is_wide_[lane] || facet_parts_.NeedsWidth(beams, lane);
  }
}

bool Footprint::NeedsCenter(const WideBeams& beams, std::size_t lane) const {
  // What wires hide may be all that sends light.
  return !CastsBeams(spec_) || has_wire_[lane] || facet_parts_.NeedsCenter(beams, lane);
}

void Footprint::Resolve(const WideBeams& beams, EchoTiles& echoes) {
  FindParts(beams, echoes.first);
  const WireCapture* capture = captures_.data();
  const WireCapture* const last_capture = capture + captures_.size();
  finder_.Clear();
  lanes_.clear();
  for (std::size_t lane = 0; lane < echoes.first.num_rays; ++lane) {
    const WireCapture* const first_capture = capture;
    while (capture != last_capture && capture->lane == lane) ++capture;
    const std::span<const Component> parts = lists_.of(lane);
    const bool is_wide = !parts.empty();
    if (!is_wide && first_capture == capture) continue;
    beam_parts_.assign(parts.begin(), parts.end());
    if (!is_wide) beam_parts_.push_back(ComponentOf(echoes.first, lane));
    components_.clear();
    std::copy_if(
        beam_parts_.begin(), beam_parts_.end(), std::back_inserter(components_),
        [&](const Component& part) { return SendsLight(part, beams.table.surfaces, spec_); });
    if (is_wide && components_.empty() &&
        echoes.first.outcome[lane] == static_cast<std::uint32_t>(Outcome::kReturned)) {
      // A surface that only the central ray meets is thin: it fills no more than a sub-ray's cell.
      const float share = 1.0F / static_cast<float>(spec_.beam.footprint_rays + 1);
      components_.push_back(CellOf(ComponentOf(echoes.first, lane), share, spec_));
    }
    wires_.clear();
    AddWires(beams, first_capture, capture);
    components_.insert(components_.end(), wires_.begin(), wires_.end());
    beam_parts_.insert(beam_parts_.end(), wires_.begin(), wires_.end());
    echoes.mixed_share[lane] = MixedShare(beam_parts_);
    background_[lane] = 0.0F;
    for (const Component& part : beam_parts_) {
      if (part.surface != 0) background_[lane] += part.share * part.reflectivity;
    }
    if (components_.empty()) continue;  // The outcome of the central ray explains why.
    finder_.Add(components_);
    lanes_.push_back(lane);
  }
  finder_.FindPeaks();
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    finder_.EchoesOf(i, found_);
    StoreEchoes(lanes_[i], echoes);
  }
}

}  // namespace railcast
