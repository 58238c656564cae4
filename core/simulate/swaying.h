#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/detect/beam/wire_set.h"
#include "core/simulate/frame_motion.h"
#include "core/simulate/wind.h"
#include "core/trace/trace_scene.h"
#include "railcast/scene.h"

namespace railcast {

/// What of a window moves in the wind, at rest. It is not part of the window's scene; every frame
/// places it anew.
struct SwayingThings {
  struct Tree {
    TracePlacement at_rest;
    std::uint32_t num_surfaces{};
    TreeInWind in_wind;
  };
  struct Wire {
    std::vector<Vector3> points_m;  ///< In the window frame.
    std::vector<double> shares;     ///< BlowOffShare() of each point.
    double radius_m{};
    std::uint32_t surface{};
    std::size_t span{};  ///< Index into `spans`.
  };

  std::vector<Tree> trees;
  std::vector<Wire> wires;
  std::vector<WireSpan> spans;             ///< In the world frame.
  std::shared_ptr<const TraceModel> tube;  ///< UnitTube(); null without wires.

  /// Adds a wire of a chunk, whose surface in the window is `surface`.
  void AddWire(const railcast::Wire& wire,
               const Transform& world_from_chunk,
               const Transform& window_from_world,
               std::uint32_t surface);

 private:
  // By whether it moves, and its number: wires without a span have number 0, too.
  std::map<std::pair<bool, std::uint32_t>, std::size_t> span_of_number_;
};

/// The tube about the x axis from 0 to 1 whose faces and corners are equally far from a radius of
/// 1. Stretched and turned, it is any straight piece of a wire.
[[nodiscard]] Model UnitTube();

/// The time and place from which a frame sees what sways.
struct SwayView {
  double stamp_s{};
  double duration_s{};  ///< From the frame's first firing to its last.
  Transform window_from_world;
  Vector3 sensor_window_m = Vector3::Zero();  ///< At the stamp.
  double reach_m{};                           ///< Nothing farther from there is hit.
  /// Where velocities are measured: from here on, every tree and span gets surfaces of its own, by
  /// which motions are told apart. Otherwise they share those of the window.
  std::optional<std::uint32_t> first_own_surface{};
};

/// What sways, as one frame sees it.
struct SwayedThings {
  std::vector<TracePlacement> placements;   ///< Trees, and wires as tubes, within reach.
  WireSet wires;                            ///< All wires of the window.
  std::vector<std::uint32_t> own_surfaces;  ///< The window's surface that each own one copies.
  SurfaceMotions motions;                   ///< Motions of the own surfaces.
};

/// Moves everything to where it is during a frame. Between the time steps, all moves linearly:
/// trees have one every 100 ms at least, wires one at either end of the frame.
[[nodiscard]] SwayedThings Sway(const SwayingThings& things,
                                const Wind& wind,
                                const SwayView& view);

}  // namespace railcast
