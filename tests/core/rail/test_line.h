#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/catenary/catenary_plan.h"
#include "core/rail/chunk/chunk_context.h"
#include "core/rail/clearance/cleared.h"
#include "core/rail/landform/landform.h"
#include "core/rail/network/network.h"
#include "core/rail/track/track_structure.h"
#include "railcast/scene.h"

namespace railcast {

/// A line with everything that chunk builders need, in chunks of 50 m.
class TestLine {
 public:
  static constexpr double kChunkLength_m = 50.0;

  explicit TestLine(WorldSpec spec, std::uint64_t seed = 1);

  [[nodiscard]] const WorldSpec& spec() const { return spec_; }
  [[nodiscard]] const Alignment& alignment() const { return alignment_; }
  [[nodiscard]] const Network& network() const { return network_; }
  [[nodiscard]] const RailSurfaces& surfaces() const { return surfaces_; }
  [[nodiscard]] const CatenaryPlan& plan() const { return plan_; }
  [[nodiscard]] const TrackModels& models() const { return models_; }
  [[nodiscard]] const std::shared_ptr<const Model>& mast_model() const { return mast_model_; }

  [[nodiscard]] ChunkContext Context(int chunk) const;
  [[nodiscard]] Transform WorldFromChunk(int chunk) const;
  /// Builds tracks, contact line, ground and structures of a chunk.
  [[nodiscard]] Chunk Build(int chunk, std::size_t level = 0) const;

 private:
  WorldSpec spec_;
  Alignment alignment_;
  Network network_;
  std::vector<LaidTurnout> turnouts_;
  std::vector<LaidDiamond> diamonds_;
  RailSurfaces surfaces_;
  std::uint64_t seed_;
  CatenaryPlan plan_;
  TrackModels models_;
  std::shared_ptr<const Model> mast_model_;
  Landform land_;
};

/// All types of turnouts.
inline constexpr std::array kTurnoutTypes = {TurnoutType::k9_190, TurnoutType::k9_300,
                                             TurnoutType::k12_500, TurnoutType::k14_760};

/// A straight, level line with one track.
[[nodiscard]] WorldSpec StraightLine(double length_m);

/// A circular arc with one track and full cant over its whole length.
[[nodiscard]] WorldSpec CantedArc(double length_m, double radius_m);

/// Whether the structures of the world clear something at (s, d) (core/rail/clearance/cleared.h).
[[nodiscard]] bool IsCleared(const WorldSpec& spec, double s_m, double d_m, Clearing what);

/// The chunk's mesh with that surface; empty if it has none.
[[nodiscard]] Mesh MeshOfSurface(const Chunk& chunk, const SurfaceClass& surface);

}  // namespace railcast
