#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/simulate/beam_tracer.h"
#include "core/simulate/firing_tiles.h"
#include "core/simulate/frame_scene.h"
#include "railcast/lidar.h"
#include "railcast/ray_caster.h"
#include "railcast/scene.h"
#include "railcast/simulator.h"

namespace railcast {

/// Counts the rays of a frame that meet each object: alone, and before everything else.
///
/// The second are sought among the first only, so that no object is seen by more rays than it would
/// be alone, however the two casts round.
class ViewCounter {
 public:
  /// @param frame Its caster shows the whole scene. Must outlive the counter, as must `world`.
  /// @param alone Each object is part of one entry at most.
  ViewCounter(const CastFrame& frame, const World& world, std::vector<LoneObjects> alone);

  /// Adds what the firings of a tile see. Thread-safe.
  void Add(const BeamTracer& tracer,
           const FiringTiles& tiles,
           std::size_t tile,
           BeamTracer::Work& work);
  /// The same in less time, of a tile whose echoes MakeEchoes() has made last with this `work`.
  void AddTraced(const BeamTracer& tracer,
                 const FiringTiles& tiles,
                 std::size_t tile,
                 BeamTracer::Work& work);

  /// By index into World::objects().
  [[nodiscard]] std::vector<ObjectView> Total() const;

 private:
  /// A packet of rays, and which objects they hit.
  struct Packet {
    RayTile rays;
    std::array<std::uint32_t, kPacketSize> firings;
    std::uint32_t lanes;  ///< Bit i: ray i counts; others only fill the packet.
    bool is_one_beam;     ///< Whether they sample one beam; otherwise each is a firing of its own.
    std::vector<ObjectHits> hits;
  };
  struct Counts {
    std::atomic<std::uint32_t> firings_alone, firings_visible, rays_alone, rays_visible;
  };

  /// Adds what central rays see, whose first surfaces are known or are yet to be sought.
  void AddCenters(const BeamTracer::Work& work,
                  float range_max_m,
                  std::size_t num_firings,
                  bool are_known);
  /// Finds the objects that rays hit alone.
  /// @return Whether there are any.
  [[nodiscard]] bool FindAlone(Packet& packet) const;
  void Cast(Packet& packet) const;
  void Count(const Packet& packet);

  const CastFrame& frame_;
  const std::vector<SceneObject>& objects_;
  std::vector<LoneObjects> alone_;
  std::vector<Counts> counts_;
};

}  // namespace railcast
