// See core/detect/base/vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_TRACE_TRACE_BEAM_H_
#define RAILCAST_TRACE_TRACE_BEAM_H_

#include <cstddef>
#include <cstdint>

#include "core/trace/beam_cone.h"
#include "core/trace/beam_tree.h"
#include "core/trace/instance_place.h"
#include "core/trace/sub_ray_hits.h"
#include "railcast/ray_caster.h"

#ifndef RAILCAST_ISA
#define RAILCAST_ISA baseline
#endif

/// The trace of a beam: the beam descends the trees as a cone, and only what the cone meets is
/// intersected with its sub-rays, all at once. Boxes are inflated by the cone's extent at their
/// farthest corner, so that no box is missed that a sub-ray meets.
namespace railcast::RAILCAST_ISA {

[[nodiscard]] inline bool IsLeaf(TreePointer pointer) {
  return (pointer & kIsLeafBit) != 0;
}
template <class T>
[[nodiscard]] inline const T* AddressIn(TreePointer pointer) {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): the other bits of the address say what is there
  return reinterpret_cast<const T*>(pointer & kAddressBits);
}
[[nodiscard]] inline const BeamNode& NodeAt(TreePointer pointer) {
  return *AddressIn<BeamNode>(pointer);
}
[[nodiscard]] inline const BeamLeaf& LeafAt(TreePointer pointer) {
  return *AddressIn<BeamLeaf>(pointer);
}
/// The places of a node or leaf that are in use, a bit each.
[[nodiscard]] inline std::uint32_t PlacesInUse(TreePointer pointer) {
  const auto last = static_cast<std::uint32_t>((pointer & ~kAddressBits) >> kNumShift);
  return (2U << last) - 1U;
}

/// Entries of a tree that are still to be visited.
class Stack {
 public:
  struct Entry {
    TreePointer pointer;
    float entry;  ///< Where the cone enters it.
  };

  explicit Stack(TreePointer root) { entries_[size_++] = {root, 0.0F}; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] Entry Pop() { return entries_[--size_]; }

  /// Pushes children so that the nearest is popped first.
  void PushSorted(const BeamNode& node, std::uint32_t children, const float* entry) {
    if (children == 0) return;
    const std::size_t first = size_;
    const auto nearest = static_cast<std::size_t>(__builtin_ctz(children));
    entries_[size_++] = {node.child[nearest], entry[nearest]};
    while ((children &= children - 1) != 0) {
      const auto k = static_cast<std::size_t>(__builtin_ctz(children));
      std::size_t place = size_++;
      for (; place > first && entries_[place - 1].entry < entry[k]; --place) {
        entries_[place] = entries_[place - 1];
      }
      entries_[place] = {node.child[k], entry[k]};
    }
  }

 private:
  Entry entries_[kTreeDepth * kTreeWidth];
  std::size_t size_ = 0;
};

/// What facets of an instance need.
struct InstanceSurface {
  const Rows& window_from_model;
  std::uint32_t first;  ///< BeamInstance::first_surface.
};

/// Adds the facet of the triangle in a lane of a leaf.
inline void AddFacet(const Rows& window_from_model,
                     std::uint32_t surface,
                     const LeafProducts& products,
                     std::size_t lane,
                     BeamRays& beam) {
  const float normal[3] = {products.normal[0][lane], products.normal[1][lane],
                           products.normal[2][lane]};
  float turned[3];
  Turn(window_from_model, normal, turned);
  beam.facets[beam.num_facets++] = {surface, turned[0], turned[1], turned[2]};
}

/// Has the first lines of a node or leaf fetched, which is visited after its nearer siblings.
inline void Prefetch(TreePointer pointer) {
  const char* const bytes = AddressIn<char>(pointer);
  constexpr std::size_t kNumBytes = 384;
  for (std::size_t at = 0; at < kNumBytes; at += 64) __builtin_prefetch(bytes + at);
}

/// A beam in the frame of a model.
struct ModelBeam {
  Cone cone;
  ConeLanes lanes;
  Probes probes;
  bool has_probes = false;  ///< Whether `probes` are aimed, which only crowds need.
};

/// Takes those children out that no sub-ray of a crowd meets.
[[nodiscard]] inline std::uint32_t MetByCrowd(const BeamNode& node,
                                              std::uint32_t children,
                                              const float* farthest,
                                              const BeamRays& beam,
                                              ModelBeam& model) {
  std::uint32_t met = 0;
  for (; children != 0; children &= children - 1) {
    const auto k = static_cast<std::size_t>(__builtin_ctz(children));
    const float margin_m = kRoundingMargin * model.cone.widening * farthest[k];
    const bool is_met = IsBoxMet(node, k, model.cone.origin, margin_m, model.probes, beam.range_m);
    met |= (is_met ? 1U : 0U) << k;
  }
  return met;
}

/// Pushes those children of a node that the cone and, in a crowd, at least one sub-ray meets.
// NOLINTNEXTLINE(readability-function-size): its values stay in registers
inline void PushChildren(TreePointer pointer,
                         float far,
                         SubRayPlaces& places,
                         const BeamRays& beam,
                         ModelBeam& model,
                         Stack& stack) {
  const BeamNode& node = NodeAt(pointer);
  ChildDistances distances;
  std::uint32_t children = ChildrenMet(node, model.lanes, far, distances) & PlacesInUse(pointer);
  if (children == 0) return;
  // 64 sub-rays meet nine tenths of the children that the cone meets, but 16 only one half.
  if (beam.num_rays == kNumCrowdedSubRays) {
    if (!places.are_known) PlaceSubRays(beam, places);
    if (!model.has_probes) AimProbes(model.cone, places, model.probes);
    model.has_probes = true;
    children = MetByCrowd(node, children, distances.farthest, beam, model);
  }
  for (std::uint32_t left = children; left != 0; left &= left - 1) {
    Prefetch(node.child[__builtin_ctz(left)]);
  }
  stack.PushSorted(node, children, distances.entry);
}

/// A beam that meets more triangles than this is sampled by kNumCrowdedSubRays. Leaves and blades
/// of grass are that many; this saves a quarter of the trace on scenarios/open_line.json, and with
/// 64 it would save but 3 % more.
constexpr std::uint32_t kCrowd = 96;

/// Intersects the triangles of a leaf with the sub-rays. Returns whether any hit is nearer than
/// what was hit before, or the number of sub-rays was lowered.
// NOLINTNEXTLINE(readability-function-size): its values stay in registers
[[nodiscard]] inline bool TraceLeaf(TreePointer pointer,
                                    const ConeLanes& cone,
                                    float far,
                                    const InstanceSurface& surface,
                                    SubRayPlaces& places,
                                    BeamRays& beam) {
  const BeamLeaf& leaf = LeafAt(pointer);
  LeafProducts products;
  const std::uint32_t lanes = TrianglesMet(leaf, cone, far, products) & PlacesInUse(pointer);
  if (lanes == 0) return false;
  if (!places.are_known) PlaceSubRays(beam, places);
  beam.num_met += static_cast<std::uint32_t>(__builtin_popcount(lanes));
  bool is_changed = beam.num_met > kCrowd && beam.num_rays > kNumCrowdedSubRays;
  if (is_changed) beam.num_rays = kNumCrowdedSubRays;
  // The first of two passes branches little.
  const bool is_crowd = beam.num_rays == kNumCrowdedSubRays;
  const std::size_t num_blocks = is_crowd ? 1 : beam.num_rays / kNumSubRays;
  std::uint64_t rays[kLeafWidth][kNumCloserSubRays / kNumSubRays];
  std::uint64_t is_inside[kLeafWidth];
  for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(__builtin_ctz(left));
    is_inside[lane] = 0;
    for (std::size_t block = 0; block < num_blocks; ++block) {
      const std::size_t begin = block * kNumSubRays;
      rays[lane][block] = is_crowd ? RaysInside<kNumCrowdedSubRays>(products, lane, places, begin)
                                   : RaysInside<kNumSubRays>(products, lane, places, begin);
      is_inside[lane] |= rays[lane][block];
    }
  }
  for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(__builtin_ctz(left));
    if (is_inside[lane] == 0) {
      beam.missed_m = Least(beam.missed_m, products.nearest[lane]);
      continue;
    }
    if (beam.num_facets == BeamRays::kMaxFacets) DropHiddenFacets(beam);
    bool is_hit = false;
    for (std::size_t block = 0; block < num_blocks; ++block) {
      const std::size_t begin = block * kNumSubRays;
      is_hit |= HitTriangle(products, lane, rays[lane][block], begin, places, beam);
    }
    if (!is_hit) continue;
    AddFacet(surface.window_from_model, surface.first + leaf.part[lane], products, lane, beam);
    is_changed = true;
  }
  return is_changed;
}

// Calls of the next two, which have two users, would cost 1 % of all instructions of `footprint`.

/// Places an instance at the time of a beam, unless it moves and the beam's cone in the window
/// frame does not come near it before `far`. Returns whether it may be met.
[[nodiscard, gnu::always_inline]] inline bool PlaceInstance(const BeamInstance& instance,
                                                            const Cone& window_cone,
                                                            float shutter,
                                                            float far,
                                                            InstancePlace& place) {
  if (instance.num_steps == 1) {
    place = {instance.window_from_model[0], instance.model_from_window};
    return true;
  }
  const BetweenSteps steps = StepsAt(instance, shutter);
  if (!MayMeetMoving(instance, steps, window_cone, far)) return false;
  place = PlaceAt(instance, steps);
  return true;
}

/// The beam's cone in the frame of a placed model, with so much of its semi-axes.
[[gnu::always_inline]] inline void TurnIntoModel(const BeamInstance& instance,
                                                 const Rows& model_from_window,
                                                 const BeamRays& beam,
                                                 float part,
                                                 ModelBeam& model) {
  Cone& cone = model.cone;
  Turn(model_from_window, beam.origin, cone.origin);
  for (int i = 0; i < 3; ++i) cone.origin[i] += model_from_window.m[4 * i + 3];
  Turn(model_from_window, beam.axis, cone.axis);
  Turn(model_from_window, beam.half_h, cone.half_h);
  Turn(model_from_window, beam.half_v, cone.half_v);
  for (int i = 0; i < 3; ++i) {
    cone.half_h[i] *= part;
    cone.half_v[i] *= part;
  }
  FinishCone(cone);
  if (instance.is_stretched) WidenStretchedCone(cone);
  FillLanes(cone, model.lanes);
}

/// Traces the beam through one instance.
/// @param window_cone The beam's in the window frame.
/// @param far The farthest range among the sub-rays; lowered where they hit.
inline void TraceInstance(const BeamInstance& instance,
                          const Cone& window_cone,
                          SubRayPlaces& places,
                          BeamRays& beam,
                          float& far) {
  InstancePlace place;
  if (!PlaceInstance(instance, window_cone, beam.shutter, far, place)) return;
  ModelBeam model;
  TurnIntoModel(instance, place.model_from_window, beam, places.part, model);
  const InstanceSurface surface{place.window_from_model, instance.first_surface};
  for (Stack stack(instance.root); !stack.empty();) {
    const Stack::Entry top = stack.Pop();
    if (top.entry > far) continue;
    if (IsLeaf(top.pointer)) {
      if (TraceLeaf(top.pointer, model.lanes, far, surface, places, beam)) {
        far = FindFarthest(beam);
      }
    } else {
      PushChildren(top.pointer, far, places, beam, model, stack);
    }
  }
}

/// The beam's cone in the window frame, with so much of its semi-axes.
inline Cone ConeOf(const BeamRays& beam, float part) {
  Cone cone;
  for (int i = 0; i < 3; ++i) {
    cone.origin[i] = beam.origin[i];
    cone.axis[i] = beam.axis[i];
    cone.half_h[i] = part * beam.half_h[i];
    cone.half_v[i] = part * beam.half_v[i];
  }
  FinishCone(cone);
  return cone;
}

/// Traces the sub-rays of a beam through a scene, as RayCaster::CastBeam() says.
inline void TraceBeam(const BeamScene& scene, BeamRays& beam) {
  if (scene.root == 0) return;
  Cone cone = ConeOf(beam, 1.0F);
  ConeLanes lanes;
  FillLanes(cone, lanes);
  SubRayPlaces places;
  const std::size_t num_rays = beam.num_rays;
  float far = FindFarthest(beam);
  const std::uint32_t num_facets = beam.num_facets;
  ChildDistances distances;
  for (Stack stack(scene.root); !stack.empty();) {
    const Stack::Entry top = stack.Pop();
    if (top.entry > far) continue;
    if (IsLeaf(top.pointer)) {
      TraceInstance(scene.instances[top.pointer >> kNumShift], cone, places, beam, far);
      if (beam.num_rays != num_rays && places.part == 1.0F) {
        NarrowToCrowd(places);
        cone = ConeOf(beam, places.part);
        FillLanes(cone, lanes);
      }
      continue;
    }
    const BeamNode& node = NodeAt(top.pointer);
    const std::uint32_t children =
        ChildrenMet(node, lanes, far, distances) & PlacesInUse(top.pointer);
    stack.PushSorted(node, children, distances.entry);
  }
  if (beam.num_facets > num_facets) DropHiddenFacets(beam);
}

/// Whether the beam's cone may meet a triangle of an instance nearer than `far`.
[[nodiscard]] inline bool MayMeetInstance(const BeamInstance& instance,
                                          const Cone& window_cone,
                                          const BeamRays& beam,
                                          float far) {
  InstancePlace place;
  if (!PlaceInstance(instance, window_cone, beam.shutter, far, place)) return false;
  ModelBeam model;
  TurnIntoModel(instance, place.model_from_window, beam, 1.0F, model);
  ChildDistances distances;
  LeafProducts products;
  for (Stack stack(instance.root); !stack.empty();) {
    const TreePointer top = stack.Pop().pointer;
    if (IsLeaf(top)) {
      if ((TrianglesMet(LeafAt(top), model.lanes, far, products) & PlacesInUse(top)) != 0) {
        return true;
      }
      continue;
    }
    const BeamNode& node = NodeAt(top);
    stack.PushSorted(node, ChildrenMet(node, model.lanes, far, distances) & PlacesInUse(top),
                     distances.entry);
  }
  return false;
}

/// As BeamKernel::may_meet says.
[[nodiscard]] inline bool MayMeetBeam(const BeamScene& scene, const BeamRays& beam) {
  if (scene.root == 0) return false;
  const float far = beam.range_m[0];
  const Cone cone = ConeOf(beam, 1.0F);
  ConeLanes lanes;
  FillLanes(cone, lanes);
  ChildDistances distances;
  for (Stack stack(scene.root); !stack.empty();) {
    const TreePointer top = stack.Pop().pointer;
    if (IsLeaf(top)) {
      if (MayMeetInstance(scene.instances[top >> kNumShift], cone, beam, far)) return true;
      continue;
    }
    const BeamNode& node = NodeAt(top);
    stack.PushSorted(node, ChildrenMet(node, lanes, far, distances) & PlacesInUse(top),
                     distances.entry);
  }
  return false;
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_TRACE_TRACE_BEAM_H_
