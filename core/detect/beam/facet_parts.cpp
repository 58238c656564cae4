#include "core/detect/beam/facet_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/detect/base/beam_optics.h"

namespace railcast {
namespace {

// Beams with more facets than this are not worth the search for planes.
constexpr std::size_t kMostPlanes = 8;
constexpr std::size_t kMostPlanesOfCloserLook = 40;
// Surfaces that more sub-rays of a closer look meet are known well enough.
constexpr std::size_t kMostRaysOnThin = 64;
// In place of the index of a surface.
constexpr std::uint32_t kSeveralPlanes = 0xFFFFFFFFU;
constexpr std::uint32_t kNotTraced = 0xFFFFFFFEU;

// A share of the beam is known to about this many sub-rays.
constexpr float kShareError = 3.0F;
// Shares of more sub-rays than this are known well enough.
constexpr float kFewSubRays = 16.0F;
// What sends less than this share of the threshold is as good as undetected, and what sends more
// than this multiple of it as good as certain.
constexpr float kHardlyDetected = 0.7F;
constexpr float kSurelyDetected = 1.3F;
// With so few hits on a surface, none may have met the part of it that faces the sensor.
constexpr float kNumOfAnyStrength = 3.0F;
// So many cells of sub-rays may be filled with something that none of them meets. With twice as
// many, a closer look would be taken at two and a half times as many beams of the open line.
constexpr float kMissedCells = 1.0F;
// Where each sub-ray is as strong as this, it does not matter how many they are.
constexpr float kStrongSubRay = 10.0F;
// Beams of more parts meet rough surfaces that fill them: four fifths of all beams with a cause for
// a closer look, which would cost four times as much and find nothing more of thin things.
constexpr std::size_t kMostParts = 4;
constexpr std::size_t kMostFacets = 8;

}  // namespace

FacetParts::FacetParts(const DetectorSpec& spec, const Kernels& kernels)
    : spec_(spec), kernels_(kernels) {}

const BeamSubRays& FacetParts::Pattern() const {
  const bool is_sparse = spec_.beam.footprint_rays < static_cast<int>(kNumSubRays);
  return is_sparse ? SubRaysOfCrowd() : SubRaysOfBeam();
}

void FacetParts::Aim(const WideBeams& beams, std::size_t lane, const BeamSubRays& pattern) {
  kernels_.aim_sub_rays(beams.rays, lane, beams.frame, AimOfFiring(pattern, beams.turns, lane),
                        beam_);
  std::fill_n(beam_.range_m, pattern.num, static_cast<float>(spec_.range_max_m));
  std::fill_n(beam_.facet, pattern.num, 0U);
  beam_.num_rays = pattern.num;
  beam_.num_met = 0;
  beam_.missed_m = std::numeric_limits<float>::infinity();
  beam_.num_facets = 1;
  beam_.facets[0] = {};
}

bool FacetParts::NeedsWidth(const WideBeams& beams, std::size_t lane) {
  // The ellipse of the pattern that reaches farthest.
  const bool is_sparse = spec_.beam.footprint_rays < static_cast<int>(kNumSubRays);
  const BeamSubRays& widest = is_sparse ? SubRaysOfCrowd() : SubRaysOfCloserLook();
  SubRayAim aim = AimOfFiring(widest, beams.turns, lane);
  aim.num = 0;
  kernels_.aim_sub_rays(beams.rays, lane, beams.frame, aim, beam_);
  beam_.range_m[0] = static_cast<float>(spec_.range_max_m);
  return beams.caster.NeedsWidth(beam_);
}

void FacetParts::Cast(const WideBeams& beams, std::uint32_t firing) {
  beams.caster.CastBeam(beam_);
  if (beams.besides != nullptr) beams.besides->Meet(firing, beam_);
}

bool FacetParts::IsOneFacet() const {
  const std::uint32_t last = beam_.num_facets - 1;
  return last <= 1 && std::all_of(beam_.facet, beam_.facet + beam_.num_rays,
                                  [=](std::uint32_t facet) { return facet == last; });
}

void FacetParts::BeginParts(std::size_t lane) {
  first_part_[lane] = found_.size() + num_in_batch_;
  num_parts_[lane] = 0;
  share_on_nothing_[lane] = 0.0F;
}

void FacetParts::AddParts(const WideBeams& beams,
                          std::size_t lane,
                          const FacetSums& all,
                          float per_ray) {
  RayTile& rays = batch_.rays;
  for (const FacetSum& sums : all.all()) {
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

// Notes the greatest power that something may send that the sub-rays have missed: a white one.
void FacetParts::NoteMissed(const WideBeams& beams, std::size_t lane) {
  missed_ratio_[lane] = 0.0F;
  const bool is_crowd = beam_.num_rays < static_cast<std::size_t>(spec_.beam.footprint_rays);
  if (is_crowd) return;
  if (!(beam_.missed_m < static_cast<float>(spec_.range_max_m))) return;
  const float share = kMissedCells / static_cast<float>(beam_.num_rays);
  missed_m_[lane] = std::max(beam_.missed_m, static_cast<float>(spec_.range_min_m));
  missed_ratio_[lane] = beams.detector.PowerRatio(share, missed_m_[lane], 0.0F);
}

// Notes that a beam lies on one plane, and how much power that sends if something may be before it.
void FacetParts::NotePlane(const WideBeams& beams, std::size_t lane, const Facet& plane) {
  plane_surface_[lane] = plane.surface;
  plane_ratio_[lane] = 0.0F;
  if (plane.surface == 0 || !(missed_ratio_[lane] > 0.0F)) return;
  // Triangles of the plane itself that no sub-ray meets are as far away as it is.
  constexpr float kBefore = 0.9F;
  if (missed_m_[lane] > kBefore * beam_.range_m[0]) {
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

// The power of a part if it faced the sensor and filled the beam.
float FacetParts::RatioOfFacing(const WideBeams& beams, const Component& part) {
  if (part.surface == 0) return 0.0F;
  const LaneOptics& optics = beams.table.optics[beams.table.surfaces[part.surface].material];
  return beams.detector.PowerRatio(beams.detector.Reflectance(optics, 1.0F), part.range_m, 0.0F);
}

bool FacetParts::NeedsCloserLook(const WideBeams& beams, std::size_t lane) const {
  // Fewer sub-rays are for those who can do without: looks would cost more than the others save.
  if (spec_.beam.footprint_rays < static_cast<int>(kNumSubRays)) return false;
  // A receiver of one return takes the strongest echo.
  const bool is_single = spec_.receiver.return_mode == ReturnMode::kStrongest;
  const auto num_rays = static_cast<float>(spec_.beam.footprint_rays);
  const auto merge_m = 2.0F * static_cast<float>(PulseSigma_m(spec_.beam));
  const Component* const parts = found_.data() + first_part_[lane];
  const std::size_t num_parts = num_parts_[lane];
  if (num_parts > kMostFacets) return false;
  float strongest = plane_surface_[lane] == kSeveralPlanes ? 0.0F : plane_ratio_[lane];
  float nearest_m = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < num_parts; ++i) {
    nearest_m = std::min(nearest_m, parts[i].range_m);
    if (!SendsLight(parts[i], beams.table.surfaces, spec_)) continue;
    strongest = std::max(strongest, parts[i].power_ratio);
  }
  const float least = is_single ? 0.5F * strongest : 0.0F;
  const bool is_before = missed_m_[lane] < nearest_m - merge_m;
  if (is_before && num_parts <= kMostParts &&
      missed_ratio_[lane] > std::max(least, kHardlyDetected)) {
    return true;
  }
  for (std::size_t i = 0; i < num_parts; ++i) {
    float num = 0.0F;
    float ratio = 0.0F;
    std::size_t num_others = 0;
    for (std::size_t k = 0; k < num_parts; ++k) {
      if (std::fabs(parts[k].range_m - parts[i].range_m) > merge_m) {
        ++num_others;
        continue;
      }
      num += num_rays * parts[k].share;
      ratio += parts[k].power_ratio;
    }
    const float of_one = ratio / num;
    if (num_others > kMostParts / 2 || num > kFewSubRays || of_one > kStrongSubRay) continue;
    const float most_of_one =
        num > kNumOfAnyStrength ? of_one : RatioOfFacing(beams, parts[i]) / num_rays;
    const float most = ratio + kShareError * most_of_one;
    if (most > std::max(least, kHardlyDetected) && ratio - kShareError * of_one < kSurelyDetected) {
      return true;
    }
  }
  return false;
}

bool FacetParts::TraceAll(const WideBeams& beams,
                          const DetectTile& first,
                          std::size_t lane,
                          const BeamSubRays& sub_rays) {
  Aim(beams, lane, sub_rays);
  Cast(beams, first.firing[lane]);
  return beam_.num_rays == sub_rays.num;  // Else a crowd, after all.
}

void FacetParts::LookCloser(const WideBeams& beams, const DetectTile& first, std::size_t lane) {
  const BeamSubRays& sub_rays = SubRaysOfCloserLook();
  if (!TraceAll(beams, first, lane, sub_rays)) return;
  sums_.Clear();
  sums_.Add(beam_);
  met_.clear();
  for (std::size_t i = 0; i < sub_rays.num; ++i) {
    const std::uint32_t surface = beam_.facets[beam_.facet[i]].surface;
    if (surface != 0) met_[surface].push_back({sub_rays.h[i], sub_rays.v[i]});
  }
  thin_.clear();
  float share = 1.0F;
  std::size_t num_rays = sub_rays.num;
  for (const auto& [surface, places] : met_) {
    if (places.size() > kMostRaysOnThin || num_rays < 2 * kMostRaysOnThin) continue;
    ThinSurface thin{.surface = surface};
    if (!LookAcross(beams, first, lane, places, thin)) continue;
    sums_.Remove(surface);
    num_rays -= places.size();
    share -= thin.share;
    thin_.push_back(std::move(thin));
  }
  sums_.JoinPlanes(kMostPlanesOfCloserLook);
  if (thin_.empty() && sums_.all().size() == 1) {
    NotePlane(beams, lane, sums_.all()[0].facet);
    BeginParts(lane);
    return;
  }
  plane_surface_[lane] = kSeveralPlanes;
  BeginParts(lane);
  AddParts(beams, lane, sums_, share / static_cast<float>(num_rays));
  for (const ThinSurface& thin : thin_) {
    AddParts(beams, lane, thin.sums, thin.share / static_cast<float>(thin.num_rays));
  }
}

bool FacetParts::LookAcross(const WideBeams& beams,
                            const DetectTile& first,
                            std::size_t lane,
                            std::vector<BeamPlace> places,
                            ThinSurface& thin) {
  // The first set shows where in the strip the surface lies, the others how much of it.
  std::optional<ThinStrip> strip;
  float share_of_one = 1.0F / static_cast<float>(kNumCloserSubRays);
  for (const std::size_t first_set : {0U, 1U}) {
    strip = FitStrip(places, share_of_one * static_cast<float>(places.size()));
    if (!strip) return false;
    const BeamSubRays rays = SubRaysIn(*strip, first_set, first_set == 0 ? 1 : kNumStripSets - 1);
    if (!TraceAll(beams, first, lane, rays)) return false;
    share_of_one = strip->Share() / static_cast<float>(rays.num);
    places.clear();
    for (std::size_t i = 0; i < rays.num; ++i) {
      if (beam_.facets[beam_.facet[i]].surface != thin.surface) continue;
      places.push_back({rays.h[i], rays.v[i]});
    }
  }
  thin.sums.Add(beam_);
  const auto is_at_side = [&](const BeamPlace& place) { return strip->IsAtSide(place); };
  if (places.empty() || std::ranges::any_of(places, is_at_side)) return false;
  thin.sums.RemoveOthers(thin.surface);
  thin.num_rays = places.size();
  thin.share = share_of_one * static_cast<float>(places.size());
  return true;
}

void FacetParts::Trace(const WideBeams& beams,
                       const DetectTile& first,
                       const std::array<bool, kTileSize>& is_wide) {
  found_.clear();
  first_part_.fill(0);
  num_parts_.fill(0);
  share_on_nothing_.fill(0.0F);
  plane_surface_.fill(kSeveralPlanes);
  for (std::size_t lane = 0; lane < first.num_rays; ++lane) {
    if (!is_wide[lane]) {
      plane_surface_[lane] = kNotTraced;
      continue;
    }
    Aim(beams, lane, Pattern());
    Cast(beams, first.firing[lane]);
    NoteMissed(beams, lane);
    // So are half of all beams, most of them in the sky; sums would tell no more.
    if (IsOneFacet()) {
      NotePlane(beams, lane, beam_.facets[beam_.num_facets - 1]);
      continue;
    }
    sums_.Clear();
    sums_.Add(beam_);
    sums_.JoinPlanes(kMostPlanes);
    if (sums_.all().size() == 1) {
      NotePlane(beams, lane, sums_.all()[0].facet);
    } else {
      BeginParts(lane);
      AddParts(beams, lane, sums_, 1.0F / static_cast<float>(beam_.num_rays));
    }
  }
  Flush(beams);
  for (std::size_t lane = 0; lane < first.num_rays; ++lane) {
    if (is_wide[lane] && NeedsCloserLook(beams, lane)) LookCloser(beams, first, lane);
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
    if (surface == kSeveralPlanes || surface == kNotTraced || surface == beams.rays.surface[lane]) {
      continue;
    }
    // The central ray meets something else, which is thin. That is rare, so that nothing was kept.
    Aim(beams, lane, Pattern());
    Cast(beams, first.firing[lane]);
    sums_.Clear();
    sums_.Add(beam_);
    sums_.JoinPlanes(kMostPlanes);
    BeginParts(lane);
    AddParts(beams, lane, sums_, 1.0F / static_cast<float>(beam_.num_rays));
  }
  Flush(beams);
  StoreLists(first.num_rays, lists);
}

}  // namespace railcast
