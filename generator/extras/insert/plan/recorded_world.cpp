#include "generator/extras/insert/plan/recorded_world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/scene/rotation_between.h"

namespace railcast {
namespace {

GroundAtTime GroundAt(const std::vector<GroundAtTime>& ground, std::int64_t time_ns) {
  const auto after = std::ranges::upper_bound(ground, time_ns, {}, &GroundAtTime::time_ns);
  if (after == ground.begin()) return ground.front();
  if (after == ground.end()) return ground.back();
  const GroundAtTime& from = *(after - 1);
  const double share = static_cast<double>(time_ns - from.time_ns) /
                       static_cast<double>(after->time_ns - from.time_ns);
  return {time_ns, std::lerp(from.height_m, after->height_m, share),
          ((1.0 - share) * from.up + share * after->up).normalized()};
}

}  // namespace

RecordedWorld::RecordedWorld(RecordedWay way,
                             std::shared_ptr<const RailWorld> things,
                             std::vector<StandOnRecording> stands)
    : way_(std::move(way)),
      things_(std::move(things)),
      stands_(std::move(stands)),
      objects_(things_->objects()) {
  for (SceneObject& object : objects_) object.instance += way_.last_instance;
  for (std::size_t i = 0; i < way_.at_frames.size(); ++i) {
    const Transform& vehicle = way_.at_frames[i];
    if (!chunks_.empty()) {
      const Vector3 from_begin_m =
          vehicle.translation() - chunks_.back().world_from_chunk.translation();
      if (from_begin_m.norm() < RailWorld::kChunkLength_m) continue;
    }
    const Vector3 facing = vehicle.linear().col(0);
    chunks_.push_back(
        {way_.frame_times_ns[i],
         MakeTransform(RotationFromYawPitchRoll(std::atan2(facing.y(), facing.x()), 0.0, 0.0),
                       vehicle.translation())});
  }
}

Transform RecordedWorld::WorldFromVehicle(std::int64_t time_ns) const {
  return way_.WorldFromVehicle(time_ns);
}

int RecordedWorld::HomeChunk(std::int64_t time_ns) const {
  const auto after = std::ranges::upper_bound(chunks_, time_ns, {}, &ChunkBegin::time_ns);
  return std::max(0, static_cast<int>(after - chunks_.begin()) - 1);
}

Transform RecordedWorld::WorldFromChunk(int chunk) const {
  return chunks_.at(static_cast<std::size_t>(chunk)).world_from_chunk;
}

Transform RecordedWorld::WorldFromObject(std::size_t object, std::int64_t time_ns) const {
  Transform world_from_object = things_->WorldFromObject(object, time_ns);
  if (object >= stands_.size() || !stands_[object].is_on_ground) return world_from_object;
  const GroundAtTime ground = GroundAt(stands_[object].ground, time_ns);
  world_from_object.translation().z() = ground.height_m;
  if (!stands_[object].follows_slope) return world_from_object;
  // The world of objects has it upright.
  const Eigen::Matrix3d upright = world_from_object.linear();
  world_from_object.linear() =
      RotationBetween(Vector3::UnitZ(), ground.up).toRotationMatrix() * upright;
  return world_from_object;
}

std::vector<Transform> RecordedWorld::WorldFromPieces(std::size_t object,
                                                      std::int64_t time_ns) const {
  std::vector<Transform> pieces = things_->WorldFromPieces(object, time_ns);
  const Transform was = things_->WorldFromObject(object, time_ns);
  const Transform now = WorldFromObject(object, time_ns);
  if (now.isApprox(was, 0.0)) return pieces;
  const Transform now_from_was = now * was.inverse();
  for (Transform& piece : pieces) piece = now_from_was * piece;
  return pieces;
}

}  // namespace railcast
