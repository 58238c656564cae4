// The product's own trace (core/trace/trace_beam.h), compiled once more with the options of its
// fastest kernel, and variations of it.
#define RAILCAST_ISA beam_ways
#include "tests/bench/beam_ways.h"

#include <algorithm>
#include <vector>

#include "core/trace/trace_beam.h"

namespace railcast {
namespace beam_ways {
namespace {

void Skip(const BeamScene& /*scene*/, BeamRays* /*beams*/, std::size_t /*num*/) {}

void OneByOne(const BeamScene& scene, BeamRays* beams, std::size_t num) {
  for (std::size_t i = 0; i < num; ++i) TraceBeam(scene, beams[i]);
}

/// Traces every beam once more, with its number of sub-rays and their ranges known from the first
/// time. That is as if things were met in the best order from the start.
void OnceMoreWithRanges(const BeamScene& scene, BeamRays* beams, std::size_t num) {
  for (std::size_t i = 0; i < num; ++i) {
    TraceBeam(scene, beams[i]);
    beams[i].num_met = 0;
    TraceBeam(scene, beams[i]);
  }
}

void With16(const BeamScene& scene, BeamRays* beams, std::size_t num) {
  for (std::size_t i = 0; i < num; ++i) {
    beams[i].num_rays = kNumCrowdedSubRays;
    TraceBeam(scene, beams[i]);
  }
}

/// 16 sub-rays, and all only in beams that these do not find on one facet.
void InStages(const BeamScene& scene, BeamRays* beams, std::size_t num) {
  for (std::size_t i = 0; i < num; ++i) {
    BeamRays& beam = beams[i];
    beam.num_rays = kNumCrowdedSubRays;
    const float range_max_m = beam.range_m[0];
    TraceBeam(scene, beam);
    const bool is_one_facet =
        std::all_of(beam.facet, beam.facet + kNumCrowdedSubRays,
                    [&](std::uint32_t facet) { return facet == beam.facet[0]; });
    if (is_one_facet || beam.num_met > kCrowd) continue;
    std::fill_n(beam.range_m, kNumSubRays, range_max_m);
    std::fill_n(beam.facet, kNumSubRays, 0U);
    beam.num_rays = kNumSubRays;
    beam.num_met = 0;
    beam.num_facets = 1;
    TraceBeam(scene, beam);
  }
}

/// A cone around all beams, which start within `shift_m` of its origin.
Cone ConeAround(const BeamRays* beams, std::size_t num, float& shift_m) {
  Cone cone = ConeOf(beams[num / 2]);
  float widest[3] = {};
  shift_m = 0.0F;
  for (std::size_t k = 0; k < num; ++k) {
    const Cone one = ConeOf(beams[k]);
    for (int i = 0; i < 3; ++i) {
      widest[i] = Most(widest[i], std::fabs(one.axis[i] - cone.axis[i]) + one.spread[i]);
      shift_m = Most(shift_m, std::fabs(one.origin[i] - cone.origin[i]));
    }
  }
  // FinishCone() takes the extent along each axis from the directions below.
  constexpr float kMargin = 1.01F;
  for (int i = 0; i < 3; ++i) {
    cone.half_h[i] = kMargin * widest[i];
    cone.half_v[i] = 0.0F;
  }
  FinishCone(cone);
  return cone;
}

/// A node whose boxes are larger on all sides, for a cone around several origins.
BeamNode Enlarged(const BeamNode& node, float by_m) {
  BeamNode larger = node;
  for (int i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < kTreeWidth; ++k) {
      larger.lower[i][k] -= by_m;
      larger.upper[i][k] += by_m;
    }
  }
  return larger;
}

/// The tree of places that one cone meets, flattened: its leaves, in nodes of kTreeWidth.
struct PlacesMet {
  std::vector<BeamNode> nodes;
  std::size_t num = 0;  ///< Of all leaves.

  /// The places in use of a node.
  [[nodiscard]] std::uint32_t InUse(std::size_t node) const {
    return (2U << (std::min(num - node * kTreeWidth, kTreeWidth) - 1)) - 1U;
  }
  void Add(const BeamNode& from, std::size_t child) {
    const std::size_t k = num++ % kTreeWidth;
    if (k == 0) nodes.emplace_back();
    BeamNode& to = nodes.back();
    for (int i = 0; i < 3; ++i) {
      to.lower[i][k] = from.lower[i][child];
      to.upper[i][k] = from.upper[i][child];
    }
    to.child[k] = from.child[child];
  }
};

void FindPlaces(const BeamScene& scene, const Cone& cone, float shift_m, PlacesMet& met) {
  met.nodes.clear();
  met.num = 0;
  constexpr float kFar_m = 1e9F;
  ChildDistances distances;
  std::vector<TreePointer> left{scene.root};
  while (!left.empty()) {
    const TreePointer pointer = left.back();
    const BeamNode& node = NodeAt(pointer);
    left.pop_back();
    std::uint32_t children =
        ChildrenMet(Enlarged(node, shift_m), cone, kFar_m, distances) & PlacesInUse(pointer);
    for (; children != 0; children &= children - 1) {
      const auto k = static_cast<std::size_t>(__builtin_ctz(children));
      if (IsLeaf(node.child[k])) {
        met.Add(node, k);
      } else {
        left.push_back(node.child[k]);
      }
    }
  }
}

/// The places that a tile's cone meets are found once, and then tested with every beam.
void PlacesOnce(const BeamScene& scene, BeamRays* beams, std::size_t num) {
  static thread_local PlacesMet met;
  float shift_m = 0.0F;
  const Cone around = ConeAround(beams, num, shift_m);
  FindPlaces(scene, around, shift_m, met);
  if (met.nodes.empty()) return;
  for (std::size_t b = 0; b < num; ++b) {
    BeamRays& beam = beams[b];
    const Cone cone = ConeOf(beam);
    SubRayPlaces places;
    float far = FindFarthest(beam, places);
    ChildDistances distances;
    static thread_local std::vector<Stack::Entry> entries;
    entries.clear();
    for (std::size_t n = 0; n < met.nodes.size(); ++n) {
      const BeamNode& node = met.nodes[n];
      std::uint32_t children = ChildrenMet(node, cone, far, distances) & met.InUse(n);
      for (; children != 0; children &= children - 1) {
        const auto k = static_cast<std::size_t>(__builtin_ctz(children));
        entries.push_back({node.child[k], distances.entry[k]});
      }
    }
    std::sort(entries.begin(), entries.end(),
              [](const auto& x, const auto& y) { return x.entry < y.entry; });
    for (const Stack::Entry& entry : entries) {
      if (entry.entry > far) break;
      TraceInstance(scene.instances[entry.pointer >> kNumShift], places, beam, far);
    }
    if (beam.num_facets > 1) DropHiddenFacets(beam);
  }
}

}  // namespace
}  // namespace beam_ways

std::vector<BeamWay> BeamWays() {
  return {{"aiming alone", &beam_ways::Skip},
          {"as it is: beam by beam", &beam_ways::OneByOne},
          {"each beam twice, then with known ranges", &beam_ways::OnceMoreWithRanges},
          {"16 sub-rays", &beam_ways::With16},
          {"16 sub-rays, then 64 unless on one facet", &beam_ways::InStages},
          {"tree of places once for 16 beams", &beam_ways::PlacesOnce}};
}

}  // namespace railcast
