#include "core/detect/facet_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/detect/beam_optics.h"

namespace railcast {
namespace {

// Facets of one surface are one plane if their normals differ by less than 2.5 degrees and the
// centre of one is as close to the plane of the other as this: the roughness of ballast near the
// sensor, float32 rounding, and chords of curved surfaces.
constexpr float kLeastCosine2 = 0.998F;
constexpr float kStep_m = 0.01F;
constexpr float kStepPerRange = 3e-4F;
// Beams with more facets than this are not worth the search for planes.
constexpr std::size_t kMostPlanes = 8;
constexpr std::size_t kMostPlanesOfCloserLook = 40;
// In place of the index of a surface.
constexpr std::uint32_t kSeveralPlanes = 0xFFFFFFFFU;

// A share of the beam is known to about this many sub-rays.
constexpr float kShareError = 3.0F;
// Shares of more sub-rays than this are known well enough.
constexpr float kFewSubRays = 16.0F;
// What sends less than this share of the threshold is as good as undetected, and what sends more
// than this multiple of it as good as certain.
constexpr float kHardlyDetected = 0.7F;
constexpr float kSurelyDetected = 1.3F;
// Where each sub-ray is as strong as this, it does not matter how many they are.
constexpr float kStrongSubRay = 10.0F;
// Beams of more parts meet rough surfaces that fill them: four fifths of all beams with a cause for
// a closer look, which would cost four times as much and find nothing more of thin things.
constexpr std::size_t kMostParts = 4;

float Dot(const Facet& a, const Facet& b) {
  return a.normal_x * b.normal_x + a.normal_y * b.normal_y + a.normal_z * b.normal_z;
}

}  // namespace

FacetParts::FacetParts(const DetectorSpec& spec, const Kernels& kernels)
    : spec_(spec), kernels_(kernels) {}

void FacetParts::Aim(const WideBeams& beams,
                     const DetectTile& first,
                     std::size_t lane,
                     const BeamSubRays& pattern) {
  kernels_.aim_sub_rays(beams.rays, lane, beams.frame,
                        AimOfFiring(pattern, spec_.seed, first.frame, first.firing[lane]), beam_);
  std::fill_n(beam_.range_m, kNumSubRays, static_cast<float>(spec_.range_max_m));
  std::fill_n(beam_.facet, kNumSubRays, 0U);
  beam_.num_rays = static_cast<std::size_t>(spec_.beam.footprint_rays);
  beam_.num_met = 0;
  beam_.missed_m = std::numeric_limits<float>::infinity();
  beam_.num_facets = 1;
  beam_.facets[0] = {};
}

bool FacetParts::IsOneFacet() const {
  const std::uint32_t last = beam_.num_facets - 1;
  return last <= 1 && std::all_of(beam_.facet, beam_.facet + beam_.num_rays,
                                  [=](std::uint32_t facet) { return facet == last; });
}

void FacetParts::SumUp() {
  const std::size_t begin = sums_.size();
  sums_.resize(begin + beam_.num_facets, Sums{});
  for (std::size_t i = 0; i < beam_.num_rays; ++i) {
    Sums& sums = sums_[begin + beam_.facet[i]];
    if (sums.num++ == 0) {
      sums.facet = beam_.facets[beam_.facet[i]];
      sums.base_m = beam_.range_m[i];
    }
    const float range_m = beam_.range_m[i] - sums.base_m;
    sums.range_m += range_m;
    sums.range2_m2 += range_m * range_m;
    sums.x += beam_.direction_x[i];
    sums.y += beam_.direction_y[i];
    sums.z += beam_.direction_z[i];
  }
  std::erase_if(sums_, [](const Sums& sums) { return sums.num == 0; });
}

void FacetParts::JoinPlanes(std::size_t most_planes) {
  if (sums_.size() > most_planes) return;
  const auto are_one_plane = [&](const Sums& a, const Sums& b) {
    const Facet& plane = a.facet;
    const Facet& other = b.facet;
    if (plane.surface != other.surface) return false;
    const float cosine = Dot(plane, other);
    const float length2 = Dot(plane, plane);
    if (cosine * cosine < kLeastCosine2 * length2 * Dot(other, other)) return false;
    const float range_a =
        (a.base_m + a.range_m / static_cast<float>(a.num)) / static_cast<float>(a.num);
    const float range_b =
        (b.base_m + b.range_m / static_cast<float>(b.num)) / static_cast<float>(b.num);
    const float off = plane.normal_x * (range_b * b.x - range_a * a.x) +
                      plane.normal_y * (range_b * b.y - range_a * a.y) +
                      plane.normal_z * (range_b * b.z - range_a * a.z);
    const float step_m = kStep_m + kStepPerRange * a.base_m;
    return off * off <= step_m * step_m * length2;
  };
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    for (std::size_t k = sums_.size(); --k > i;) {
      if (!are_one_plane(sums_[i], sums_[k])) continue;
      Sums& a = sums_[i];
      const Sums& b = sums_[k];
      const float shift_m = b.base_m - a.base_m;
      const auto num = static_cast<float>(b.num);
      a.range2_m2 += b.range2_m2 + 2.0F * shift_m * b.range_m + num * shift_m * shift_m;
      a.range_m += b.range_m + num * shift_m;
      a.x += b.x;
      a.y += b.y;
      a.z += b.z;
      a.num += b.num;
      sums_.erase(sums_.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }
}

void FacetParts::AddParts(const WideBeams& beams, std::size_t lane, std::size_t num_rays) {
  const float per_ray = 1.0F / static_cast<float>(num_rays);
  RayTile& rays = batch_.rays;
  first_part_[lane] = found_.size() + num_in_batch_;
  for (const Sums& sums : sums_) {
    const auto num = static_cast<float>(sums.num);
    if (sums.facet.surface == 0) {
      share_on_nothing_[lane] += num * per_ray;
      continue;
    }
    const std::size_t i = num_in_batch_;
    const float mean_m = sums.range_m / num;
    const float variance_m2 = std::max(sums.range2_m2 / num - mean_m * mean_m, 0.0F);
    const float inverse_norm =
        1.0F / std::sqrt(sums.x * sums.x + sums.y * sums.y + sums.z * sums.z);
    const Facet& facet = sums.facet;
    rays.origin_x[i] = beam_.origin[0];
    rays.origin_y[i] = beam_.origin[1];
    rays.origin_z[i] = beam_.origin[2];
    rays.direction_x[i] = sums.x * inverse_norm;
    rays.direction_y[i] = sums.y * inverse_norm;
    rays.direction_z[i] = sums.z * inverse_norm;
    rays.shutter[i] = beam_.shutter;
    rays.range_m[i] = sums.base_m + mean_m;
    rays.surface[i] = facet.surface;
    rays.normal_x[i] = facet.normal_x;
    rays.normal_y[i] = facet.normal_y;
    rays.normal_z[i] = facet.normal_z;
    batch_.Describe(i, num * per_ray, per_ray, variance_m2);
    ++num_parts_[lane];
    if (++num_in_batch_ == kTileSize) Flush(beams);
  }
}

void FacetParts::Flush(const WideBeams& beams) {
  if (num_in_batch_ == 0) return;
  const std::size_t num = batch_.Pad(num_in_batch_);
  batch_.Respond(beams, kernels_, num, num_in_batch_, found_);
  num_in_batch_ = 0;
}

void FacetParts::StoreLists(std::size_t num_lanes, PartLists& lists) const {
  lists.parts.clear();
  for (std::size_t lane = 0; lane < num_lanes; ++lane) {
    lists.begin[lane] = lists.parts.size();
    const auto part = found_.begin() + static_cast<std::ptrdiff_t>(first_part_[lane]);
    lists.parts.insert(lists.parts.end(), part, part + num_parts_[lane]);
    const float share = share_on_nothing_[lane];
    if (share > 0.0F) lists.parts.push_back({.share = share});
  }
  lists.begin[num_lanes] = lists.parts.size();
}

// Notes the greatest power that something may send that the sub-rays have missed: a white one that
// fills the cell of a sub-ray.
void FacetParts::NoteMissed(const WideBeams& beams, std::size_t lane) {
  missed_ratio_[lane] = 0.0F;
  const bool is_crowd = beam_.num_rays < static_cast<std::size_t>(spec_.beam.footprint_rays);
  if (is_crowd || !(beam_.missed_m < static_cast<float>(spec_.range_max_m))) return;
  const float cell = 1.0F / static_cast<float>(beam_.num_rays);
  const float range_m = std::max(beam_.missed_m, static_cast<float>(spec_.range_min_m));
  missed_m_[lane] = range_m;
  missed_ratio_[lane] = beams.detector.PowerRatio(cell, range_m, 0.0F);
}

// Notes that a beam lies on one plane, and how much power that sends if something may be before it.
void FacetParts::NotePlane(const WideBeams& beams, std::size_t lane, const Facet& plane) {
  plane_surface_[lane] = plane.surface;
  plane_ratio_[lane] = 0.0F;
  if (plane.surface == 0 || !(missed_ratio_[lane] > 0.0F)) return;
  // Triangles of the plane itself that no sub-ray meets are as far away as it is.
  constexpr float kBefore = 0.9F;
  if (beam_.missed_m > kBefore * beam_.range_m[0]) {
    missed_ratio_[lane] = 0.0F;
    return;
  }
  const float along = plane.normal_x * beam_.axis[0] + plane.normal_y * beam_.axis[1] +
                      plane.normal_z * beam_.axis[2];
  const float cosine = std::min(std::fabs(along) / std::sqrt(Dot(plane, plane)), 1.0F);
  const LaneOptics& optics = beams.table.optics[beams.table.surfaces[plane.surface].material];
  plane_ratio_[lane] =
      beams.detector.PowerRatio(beams.detector.Reflectance(optics, cosine), beam_.range_m[0], 0.0F);
}

bool FacetParts::NeedsCloserLook(const WideBeams& beams, std::size_t lane) const {
  // A receiver of one return takes the strongest echo.
  const bool is_single = spec_.receiver.return_mode == ReturnMode::kStrongest;
  const auto num_rays = static_cast<float>(spec_.beam.footprint_rays);
  const auto merge_m = 2.0F * static_cast<float>(PulseSigma_m(spec_.beam));
  const Component* const parts = found_.data() + first_part_[lane];
  const std::size_t num_parts = num_parts_[lane];
  if (num_parts > kMostParts) return false;
  float strongest = plane_surface_[lane] == kSeveralPlanes ? 0.0F : plane_ratio_[lane];
  float nearest_m = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < num_parts; ++i) {
    nearest_m = std::min(nearest_m, parts[i].range_m);
    if (!SendsLight(parts[i], beams.table.surfaces, spec_)) continue;
    strongest = std::max(strongest, parts[i].power_ratio);
  }
  const float least = is_single ? 0.5F * strongest : 0.0F;
  const bool is_before = missed_m_[lane] < nearest_m - merge_m;
  if (is_before && missed_ratio_[lane] > std::max(least, kHardlyDetected)) return true;
  for (std::size_t i = 0; i < num_parts; ++i) {
    float num = 0.0F;
    float ratio = 0.0F;
    for (std::size_t k = 0; k < num_parts; ++k) {
      if (std::fabs(parts[k].range_m - parts[i].range_m) > merge_m) continue;
      num += num_rays * parts[k].share;
      ratio += parts[k].power_ratio;
    }
    const float of_one = ratio / num;
    if (ratio < least || num > kFewSubRays || of_one > kStrongSubRay) continue;
    if (ratio - kShareError * of_one < kSurelyDetected &&
        ratio + kShareError * of_one > kHardlyDetected) {
      return true;
    }
  }
  return false;
}

void FacetParts::LookCloser(const WideBeams& beams, const DetectTile& first, std::size_t lane) {
  sums_.clear();
  for (const BeamSubRays& set : SubRaysOfCloserLook()) {
    Aim(beams, first, lane, set);
    beam_.num_rays = kNumSubRays;
    beams.caster.CastBeam(beam_);
    if (beam_.num_rays < kNumSubRays) return;  // A crowd, after all.
    SumUp();
  }
  JoinPlanes(kMostPlanesOfCloserLook);
  if (sums_.size() == 1) return;
  plane_surface_[lane] = kSeveralPlanes;
  num_parts_[lane] = 0;
  share_on_nothing_[lane] = 0.0F;
  AddParts(beams, lane, kNumCloserSets * kNumSubRays);
}

void FacetParts::Trace(const WideBeams& beams, const DetectTile& first) {
  found_.clear();
  first_part_.fill(0);
  num_parts_.fill(0);
  share_on_nothing_.fill(0.0F);
  plane_surface_.fill(kSeveralPlanes);
  for (std::size_t lane = 0; lane < first.num_rays; ++lane) {
    Aim(beams, first, lane, SubRaysOfBeam());
    beams.caster.CastBeam(beam_);
    NoteMissed(beams, lane);
    // So are half of all beams, most of them in the sky; sums would tell no more.
    if (IsOneFacet()) {
      NotePlane(beams, lane, beam_.facets[beam_.num_facets - 1]);
      continue;
    }
    sums_.clear();
    SumUp();
    JoinPlanes(kMostPlanes);
    if (sums_.size() == 1) {
      NotePlane(beams, lane, sums_[0].facet);
    } else {
      AddParts(beams, lane, beam_.num_rays);
    }
  }
  Flush(beams);
  for (std::size_t lane = 0; lane < first.num_rays; ++lane) {
    if (NeedsCloserLook(beams, lane)) LookCloser(beams, first, lane);
  }
  Flush(beams);
}

bool FacetParts::NeedsCenter(const WideBeams& beams, std::size_t lane) const {
  if (plane_surface_[lane] != kSeveralPlanes) return true;
  const auto begin = found_.begin() + static_cast<std::ptrdiff_t>(first_part_[lane]);
  return std::none_of(begin, begin + num_parts_[lane], [&](const Component& part) {
    return part.power_ratio > 0.0F && SendsLight(part, beams.table.surfaces, spec_);
  });
}

void FacetParts::Find(const WideBeams& beams, const DetectTile& first, PartLists& lists) {
  for (std::size_t lane = 0; lane < first.num_rays; ++lane) {
    const std::uint32_t surface = plane_surface_[lane];
    if (surface == kSeveralPlanes || surface == beams.rays.surface[lane]) continue;
    // The central ray meets something else, which is thin. That is rare, so that nothing was kept.
    Aim(beams, first, lane, SubRaysOfBeam());
    beams.caster.CastBeam(beam_);
    sums_.clear();
    SumUp();
    JoinPlanes(kMostPlanes);
    AddParts(beams, lane, beam_.num_rays);
  }
  Flush(beams);
  StoreLists(first.num_rays, lists);
}

}  // namespace railcast
