#include "core/detect/footprint.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "core/base/random.h"
#include "core/detect/beam_axes.h"
#include "core/detect/beam_optics.h"
#include "core/detect/cylinder_mean.h"
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

Component ComponentOf(const DetectTile& hits, std::size_t lane) {
  return {.range_m = hits.true_range_m[lane],
          .spread_m = hits.spread_m[lane],
          .power_ratio = hits.power_ratio[lane],
          .share = hits.share[lane],
          .intensity = hits.intensity[lane],
          .cos_incidence = hits.cos_incidence[lane],
          .reflectivity = hits.reflectivity[lane],
          .surface = hits.surface[lane]};
}

}  // namespace

Footprint::Footprint(const DetectorSpec& spec, const Kernels& kernels)
    : spec_(spec),
      pulse_variance_m2_(static_cast<float>(PulseSigma_m(spec.beam) * PulseSigma_m(spec.beam))),
      pattern_(spec.effects.dense_footprint
                   ? DenseSubRays(static_cast<std::size_t>(spec.beam.reference_rays))
                   : RingSubRays()),
      kernels_(kernels),
      finder_(spec.beam,
              spec.effects.pulse_stretch,
              spec.effects.sampled_waveform,
              spec.effects.detection ? kLeastRatio : 0.0F,
              kernels) {}

// Scales the central ray's response from the whole beam to one cell, which has less spread.
Component Footprint::CentralCell(const DetectTile& first, std::size_t lane, float share) const {
  Component cell = ComponentOf(first, lane);
  const float whole_spread2 = cell.spread_m * cell.spread_m;
  cell.share *= share;
  cell.intensity *= share;
  cell.power_ratio *= share;
  cell.spread_m *= std::sqrt(share);
  if (spec_.effects.pulse_stretch) {
    cell.power_ratio *= std::sqrt((pulse_variance_m2_ + whole_spread2) /
                                  (pulse_variance_m2_ + share * whole_spread2));
  }
  return cell;
}

void Footprint::FlushBatch(const WideBeams& beams, std::size_t num_rays) {
  if (num_rays == 0) return;
  RayTile& rays = batch_.rays;
  DetectTile& hits = batch_.hits;
  // Pad the last packet with its last ray.
  while (num_rays % kPacketSize != 0) {
    const std::size_t last = num_rays - 1;
    for (float* values : {rays.origin_x, rays.origin_y, rays.origin_z, rays.direction_x,
                          rays.direction_y, rays.direction_z, rays.shutter}) {
      values[num_rays] = values[last];
    }
    batch_.share[num_rays] = batch_.share[last];
    batch_.cell_size[num_rays] = batch_.cell_size[last];
    ++num_rays;
  }
  rays.num_rays = num_rays;
  rays.mask = beams.rays.mask;
  std::fill_n(rays.range_m, num_rays, static_cast<float>(spec_.range_max_m));
  std::fill_n(rays.surface, num_rays, 0U);
  for (float* values : {rays.normal_x, rays.normal_y, rays.normal_z}) {
    std::fill_n(values, num_rays, 0.0F);
  }
  beams.caster.Cast(rays);

  hits.num_rays = num_rays;
  ResolveHits(rays, beams.table, hits);
  kernels_.incidence(rays, hits);
  kernels_.spread(rays, beams.frame, hits);
  for (std::size_t i = 0; i < num_rays; ++i) {
    hits.share[i] = batch_.share[i];
    hits.spread_m[i] *= batch_.cell_size[i];
  }
  beams.detector.Respond(hits);
}

void Footprint::TraceSubRays(const WideBeams& beams, const EchoTiles& echoes) {
  sub_components_.clear();
  RayTile& rays = batch_.rays;
  std::size_t num_rays = 0;
  const auto flush = [&] {
    FlushBatch(beams, num_rays);
    const DetectTile& hits = batch_.hits;
    for (std::size_t i = 0; i < num_rays; ++i) sub_components_.push_back(ComponentOf(hits, i));
    num_rays = 0;
  };
  const BeamFrame& frame = beams.frame;
  for (const std::uint32_t lane : wide_lanes_) {
    const baseline::Direction d{beams.rays.direction_x[lane], beams.rays.direction_y[lane],
                                beams.rays.direction_z[lane]};
    const baseline::BeamAxes axes = baseline::AxesOf(d, frame);
    const float per_unit = 1.0F / baseline::LengthOf(axes);
    const float sigma_h = frame.sigma_h_rad * per_unit;
    const float sigma_v = frame.sigma_v_rad * per_unit;
    const auto words = RandomWords(spec_.seed, RandomUse::kFootprint, echoes.first.frame,
                                   echoes.first.firing[lane]);
    const float turn_rad = 2.0F * std::numbers::pi_v<float> * UnitFloat(words[0]);
    const float cosine = std::cos(turn_rad);
    const float sine = std::sin(turn_rad);
    for (const SubRay& sub_ray : pattern_.sub_rays) {
      const SubRay turned = Turned(sub_ray, cosine, sine);
      const baseline::Direction aim =
          baseline::Beside(d, axes, sigma_h * turned.h, sigma_v * turned.v);
      rays.origin_x[num_rays] = beams.rays.origin_x[lane];
      rays.origin_y[num_rays] = beams.rays.origin_y[lane];
      rays.origin_z[num_rays] = beams.rays.origin_z[lane];
      rays.direction_x[num_rays] = aim.x;
      rays.direction_y[num_rays] = aim.y;
      rays.direction_z[num_rays] = aim.z;
      rays.shutter[num_rays] = beams.rays.shutter[lane];
      batch_.share[num_rays] = sub_ray.share;
      batch_.cell_size[num_rays] = std::sqrt(sub_ray.share);
      if (++num_rays == kTileSize) flush();
    }
  }
  flush();
}

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
    tile.reflectivity[i] = echo.reflectivity;
    tile.outcome[i] = static_cast<std::uint32_t>(Outcome::kReturned);
    tile.clutter[i] = kNoClutter;
    tile.intensity[i] = echo.intensity;
    tile.power_ratio[i] = echo.power_ratio;
    ++number;
  }
}

void Footprint::GatherParts(const EchoTiles& echoes,
                            std::size_t lane,
                            const Component* sub_components) {
  beam_parts_.clear();
  if (sub_components == nullptr) {
    beam_parts_.push_back(ComponentOf(echoes.first, lane));
    return;
  }
  beam_parts_.assign(sub_components, sub_components + pattern_.sub_rays.size());
  if (pattern_.central_share > 0.0F) {
    beam_parts_.push_back(CentralCell(echoes.first, lane, pattern_.central_share));
  }
}

void Footprint::AddWires(const WideBeams& beams, const WireCapture* begin, const WireCapture* end) {
  // Captures are sorted by range. Each one reduces the share of what lies behind it.
  for (const WireCapture* capture = begin; capture != end; ++capture) {
    if (!(capture->range_m >= static_cast<float>(spec_.range_min_m) &&
          capture->range_m < static_cast<float>(spec_.range_max_m))) {
      continue;
    }
    float visible = 1.0F;
    for (const Component& part : beam_parts_) {
      if (part.surface != 0 && part.range_m < capture->range_m) visible -= part.share;
    }
    // The shares of the rays add up to 1 except for rounding, so that `visible` may be negative.
    const float share = capture->share * std::max(visible, 0.0F);
    for (std::vector<Component>* parts : {&components_, &beam_parts_}) {
      for (Component& part : *parts) {
        if (part.surface != 0 && part.range_m < capture->range_m) continue;
        part.share *= 1.0F - capture->share;
        part.power_ratio *= 1.0F - capture->share;
        part.intensity *= 1.0F - capture->share;
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

void Footprint::Resolve(const WideBeams& beams, EchoTiles& echoes) {
  wide_lanes_.clear();
  for (std::size_t lane = 0; beams.needs_sub_rays != nullptr && lane < echoes.first.num_rays;
       ++lane) {
    if (beams.needs_sub_rays[lane] != 0) wide_lanes_.push_back(static_cast<std::uint32_t>(lane));
  }
  TraceSubRays(beams, echoes);
  captures_.clear();
  if (beams.wires != nullptr) {
    const BeamFrame& frame = beams.frame;
    CaptureWires(beams.rays,
                 {.up_window = {frame.up[0], frame.up[1], frame.up[2]},
                  .sigma_horizontal_rad = static_cast<double>(frame.sigma_h_rad),
                  .sigma_vertical_rad = static_cast<double>(frame.sigma_v_rad)},
                 *beams.wires, captures_);
  }
  std::size_t wide = 0;
  const WireCapture* capture = captures_.data();
  const WireCapture* const last_capture = capture + captures_.size();
  for (std::size_t lane = 0; lane < echoes.first.num_rays; ++lane) {
    const WireCapture* const first_capture = capture;
    while (capture != last_capture && capture->lane == lane) ++capture;
    const bool is_wide = wide < wide_lanes_.size() && wide_lanes_[wide] == lane;
    if (!is_wide && first_capture == capture) continue;
    GatherParts(echoes, lane,
                is_wide ? sub_components_.data() + wide++ * pattern_.sub_rays.size() : nullptr);
    // Parts nearer than range_min or on the vehicle block their share of the beam and send nothing.
    components_.clear();
    std::copy_if(beam_parts_.begin(), beam_parts_.end(), std::back_inserter(components_),
                 [&](const Component& part) {
                   return part.surface != 0 &&
                          part.range_m >= static_cast<float>(spec_.range_min_m) &&
                          !beams.table.surfaces[part.surface].is_ego;
                 });
    if (is_wide && components_.empty() &&
        echoes.first.outcome[lane] == static_cast<std::uint32_t>(Outcome::kReturned)) {
      // A surface that only the central ray meets is thin: it fills no more than a sub-ray's cell.
      const float share = 1.0F / static_cast<float>(pattern_.sub_rays.size() + 1);
      components_.push_back(CentralCell(echoes.first, lane, share));
    }
    wires_.clear();
    AddWires(beams, first_capture, capture);
    components_.insert(components_.end(), wires_.begin(), wires_.end());
    beam_parts_.insert(beam_parts_.end(), wires_.begin(), wires_.end());
    echoes.mixed_share[lane] = MixedShare(beam_parts_);
    if (components_.empty()) continue;  // The outcome of the central ray explains why.
    finder_.Find(components_, found_);
    StoreEchoes(lane, echoes);
  }
}

}  // namespace railcast
