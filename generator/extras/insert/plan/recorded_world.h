#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "generator/extras/insert/plan/recorded_way.h"
#include "railcast/rail_world.h"
#include "railcast/scene.h"

namespace railcast {

/// The ground on which an object stands at a time.
struct GroundAtTime {
  std::int64_t time_ns{};
  double height_m{};    ///< In the world.
  Vector3 up{0, 0, 1};  ///< Normal of the ground.
};

/// The ground on which an object stands in a recording.
struct StandOnRecording {
  bool is_on_ground = false;  ///< Otherwise it is where the world of objects has it.
  /// By time; between them height and normal change linearly. Not empty if it is on the ground.
  std::vector<GroundAtTime> ground;
  bool follows_slope = false;  ///< Whether the object's z axis is the ground's normal.
};

/// The objects of a plan and nothing else, seen from a vehicle that moves as it was recorded.
class RecordedWorld final : public World {
 public:
  /// @param stands One for each of the first objects; the others, vehicles of trains, are on rails.
  RecordedWorld(RecordedWay way,
                std::shared_ptr<const RailWorld> things,
                std::vector<StandOnRecording> stands);

  [[nodiscard]] Transform WorldFromVehicle(std::int64_t time_ns) const override;
  [[nodiscard]] int HomeChunk(std::int64_t time_ns) const override;
  [[nodiscard]] std::vector<int> ChunksInReach(int, double) const override { return {}; }
  [[nodiscard]] Transform WorldFromChunk(int chunk) const override;
  [[nodiscard]] Chunk BuildChunk(int) const override { return {}; }
  /// Numbered from behind the recording's own on.
  [[nodiscard]] const std::vector<SceneObject>& objects() const override { return objects_; }
  [[nodiscard]] Transform WorldFromObject(std::size_t object, std::int64_t time_ns) const override;
  [[nodiscard]] std::vector<Transform> WorldFromPieces(std::size_t object,
                                                       std::int64_t time_ns) const override;

 private:
  /// Where the vehicle enters a chunk, whose frame is upright there.
  struct ChunkBegin {
    std::int64_t time_ns{};
    Transform world_from_chunk;
  };

  RecordedWay way_;
  std::shared_ptr<const RailWorld> things_;
  std::vector<StandOnRecording> stands_;
  std::vector<SceneObject> objects_;
  std::vector<ChunkBegin> chunks_;  ///< By time; at least one.
};

}  // namespace railcast
