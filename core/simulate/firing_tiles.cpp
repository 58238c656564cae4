#include "core/simulate/firing_tiles.h"

#include <algorithm>

#include "core/base/error.h"

namespace railcast {

FiringTiles::FiringTiles(const ScanPattern& pattern) : num_firings_(pattern.num_firings()) {
  Check(num_firings_ == std::size_t{pattern.rows} * pattern.columns, "every slot has a firing");
  slot_time_ns_.resize(num_firings_);
  slot_column_.resize(num_firings_);
  slot_row_.resize(num_firings_);
  for (std::size_t i = 0; i < num_firings_; ++i) {
    const std::size_t slot = std::size_t{pattern.row[i]} * pattern.columns + pattern.column[i];
    slot_time_ns_[slot] = pattern.time_ns[i];
    slot_column_[slot] = pattern.column[i];
    slot_row_[slot] = pattern.row[i];
    duration_ns_ = std::max(duration_ns_, pattern.time_ns[i]);
  }
  for (const std::uint32_t i : pattern.packet_order) Append(pattern, i);
  Check(firing_.size() % kPacketSize == 0, "packets are full");
}

FiringTiles::FiringTiles(const ScanPattern& pattern, std::vector<std::uint32_t> order)
    : num_firings_(order.size()) {
  while (order.size() % kPacketSize != 0) order.push_back(order.back());
  for (const std::uint32_t time_ns : pattern.time_ns) {
    duration_ns_ = std::max(duration_ns_, time_ns);
  }
  for (const std::uint32_t i : order) Append(pattern, i);
}

FiringTiles FiringTiles::OfCells(const ScanPattern& pattern, std::span<const std::uint32_t> cells) {
  std::vector<bool> is_wanted(pattern.num_firings());
  for (const std::uint32_t cell : cells) is_wanted[cell] = true;
  std::vector<std::uint32_t> order;
  std::vector<std::uint32_t> slots;
  for (std::uint32_t i = 0; i < pattern.num_firings(); ++i) {
    const std::uint32_t cell = pattern.row[i] * pattern.columns + pattern.column[i];
    if (!is_wanted[cell]) continue;
    order.push_back(i);
    const auto at = std::ranges::lower_bound(cells, cell);
    slots.push_back(static_cast<std::uint32_t>(at - cells.begin()));
  }
  FiringTiles tiles(pattern, std::move(order));
  std::ranges::copy(slots, tiles.slot_.begin());
  return tiles;
}

void FiringTiles::Append(const ScanPattern& pattern, std::uint32_t firing) {
  const std::uint32_t i = firing;
  firing_.push_back(i);
  slot_.push_back(pattern.row[i] * pattern.columns + pattern.column[i]);
  time_ns_.push_back(pattern.time_ns[i]);
  channel_.push_back(pattern.row[i]);
  x_.push_back(pattern.direction_x[i]);
  y_.push_back(pattern.direction_y[i]);
  z_.push_back(pattern.direction_z[i]);
  if (pattern.origin_x_m.empty()) return;
  origin_x_m_.push_back(pattern.origin_x_m[i]);
  origin_y_m_.push_back(pattern.origin_y_m[i]);
  origin_z_m_.push_back(pattern.origin_z_m[i]);
}

std::size_t FiringTiles::num_firings(std::size_t tile) const {
  return std::min(kTileSize, num_firings_ - std::min(num_firings_, tile * kTileSize));
}

namespace {

/// Firings of one packet: arrays of kPacketSize values.
struct PacketFirings {
  const float* direction_x;
  const float* direction_y;
  const float* direction_z;
  const float* since_pose_ns;
  const float* origin_x_m = nullptr;  ///< Null, as are the next two, if beams leave at the origin.
  const float* origin_y_m = nullptr;
  const float* origin_z_m = nullptr;
};

// Moves the rays of a packet from the sensor's origin to where their beams leave.
void MoveRays(const PacketFirings& firings,
              const PoseF& pose,
              const PoseF& change,
              RayTile& rays,
              std::size_t first) {
  for (std::size_t lane = 0; lane < kPacketSize; ++lane) {
    const float t = firings.since_pose_ns[lane];
    const float x = firings.origin_x_m[lane];
    const float y = firings.origin_y_m[lane];
    const float z = firings.origin_z_m[lane];
    const std::size_t ray = first + lane;
    rays.origin_x[ray] += (pose.r[0] + t * change.r[0]) * x + (pose.r[1] + t * change.r[1]) * y +
                          (pose.r[2] + t * change.r[2]) * z;
    rays.origin_y[ray] += (pose.r[3] + t * change.r[3]) * x + (pose.r[4] + t * change.r[4]) * y +
                          (pose.r[5] + t * change.r[5]) * z;
    rays.origin_z[ray] += (pose.r[6] + t * change.r[6]) * x + (pose.r[7] + t * change.r[7]) * y +
                          (pose.r[8] + t * change.r[8]) * z;
  }
}

// Aims a packet whose firings are close in time: all lanes share one pose and its rate of change.
void AimPacket(const PacketFirings& firings,
               const PoseF& pose,
               const PoseF& change,
               RayTile& rays,
               std::size_t first) {
  for (std::size_t lane = 0; lane < kPacketSize; ++lane) {
    const float t = firings.since_pose_ns[lane];
    const float x = firings.direction_x[lane];
    const float y = firings.direction_y[lane];
    const float z = firings.direction_z[lane];
    const std::size_t ray = first + lane;
    rays.direction_x[ray] = (pose.r[0] + t * change.r[0]) * x + (pose.r[1] + t * change.r[1]) * y +
                            (pose.r[2] + t * change.r[2]) * z;
    rays.direction_y[ray] = (pose.r[3] + t * change.r[3]) * x + (pose.r[4] + t * change.r[4]) * y +
                            (pose.r[5] + t * change.r[5]) * z;
    rays.direction_z[ray] = (pose.r[6] + t * change.r[6]) * x + (pose.r[7] + t * change.r[7]) * y +
                            (pose.r[8] + t * change.r[8]) * z;
    rays.origin_x[ray] = pose.t[0] + t * change.t[0];
    rays.origin_y[ray] = pose.t[1] + t * change.t[1];
    rays.origin_z[ray] = pose.t[2] + t * change.t[2];
  }
  if (firings.origin_x_m != nullptr) MoveRays(firings, pose, change, rays, first);
}

}  // namespace

void FiringTiles::Aim(std::size_t tile,
                      const FramePoses& poses,
                      float range_max_m,
                      RayTile& rays) const {
  const std::size_t begin = tile * kTileSize;
  rays.num_rays = std::min(kTileSize, firing_.size() - begin);
  const float per_duration = duration_ns_ == 0 ? 0.0F : 1.0F / static_cast<float>(duration_ns_);
  for (std::size_t first = 0; first < rays.num_rays; first += kPacketSize) {
    const std::uint32_t* time_ns = &time_ns_[begin + first];
    const auto [earliest, latest] = std::minmax_element(time_ns, time_ns + kPacketSize);
    PoseF change{};
    alignas(64) float since_pose_ns[kPacketSize];
    PacketFirings firings{&x_[begin + first], &y_[begin + first], &z_[begin + first],
                          since_pose_ns};
    if (!origin_x_m_.empty()) {
      firings.origin_x_m = &origin_x_m_[begin + first];
      firings.origin_y_m = &origin_y_m_[begin + first];
      firings.origin_z_m = &origin_z_m_[begin + first];
    }
    if (*latest - *earliest <= poses.knot_spacing_ns()) {
      const PoseF pose = poses.At(*earliest, change);
      for (std::size_t lane = 0; lane < kPacketSize; ++lane) {
        since_pose_ns[lane] =
            static_cast<float>(static_cast<std::int32_t>(time_ns[lane] - *earliest));
      }
      AimPacket(firings, pose, change, rays, first);
    } else {
      // Slow or scattered pattern: compute a pose for each lane.
      std::fill_n(since_pose_ns, kPacketSize, 0.0F);
      for (std::size_t lane = 0; lane < kPacketSize; ++lane) {
        RayTile one;
        const PoseF pose = poses.At(time_ns[lane], change);
        AimPacket(firings, pose, change, one, 0);
        rays.direction_x[first + lane] = one.direction_x[lane];
        rays.direction_y[first + lane] = one.direction_y[lane];
        rays.direction_z[first + lane] = one.direction_z[lane];
        rays.origin_x[first + lane] = one.origin_x[lane];
        rays.origin_y[first + lane] = one.origin_y[lane];
        rays.origin_z[first + lane] = one.origin_z[lane];
      }
    }
    for (std::size_t lane = 0; lane < kPacketSize; ++lane) {
      rays.shutter[first + lane] = static_cast<float>(time_ns[lane]) * per_duration;
      rays.range_m[first + lane] = range_max_m;
      rays.surface[first + lane] = 0;
      rays.normal_x[first + lane] = 0.0F;
      rays.normal_y[first + lane] = 0.0F;
      rays.normal_z[first + lane] = 0.0F;
    }
  }
}

void FiringTiles::Describe(std::size_t tile, DetectTile& detect) const {
  const std::size_t begin = tile * kTileSize;
  detect.num_rays = num_firings(tile);
  std::copy_n(&firing_[begin], detect.num_rays, detect.firing);
  std::copy_n(&x_[begin], detect.num_rays, detect.direction_x);
  std::copy_n(&y_[begin], detect.num_rays, detect.direction_y);
  std::copy_n(&z_[begin], detect.num_rays, detect.direction_z);
  std::copy_n(&channel_[begin], detect.num_rays, detect.channel);
}

void FiringTiles::MoveToOrigins(std::size_t tile, EchoTiles& echoes) const {
  if (origin_x_m_.empty()) return;
  const std::size_t begin = tile * kTileSize;
  const auto move = [&](DetectTile& echo, std::size_t lane, std::size_t beam) {
    echo.x[lane] += origin_x_m_[begin + beam];
    echo.y[lane] += origin_y_m_[begin + beam];
    echo.z[lane] += origin_z_m_[begin + beam];
  };
  for (std::size_t i = 0; i < echoes.first.num_rays; ++i) move(echoes.first, i, i);
  for (std::size_t i = 0; i < echoes.num_more(); ++i) {
    const auto [echo, lane] = echoes.more(i);
    move(echo, lane, echoes.beam_of(i));
  }
}

void FiringTiles::StoreConstants(Frame& frame) const {
  const std::uint32_t returns = frame.returns;
  if (returns == 1) {
    std::copy(slot_time_ns_.begin(), slot_time_ns_.end(), frame.time_ns.begin());
    std::copy(slot_row_.begin(), slot_row_.end(), frame.ring.begin());
    std::copy(slot_column_.begin(), slot_column_.end(), frame.column.begin());
    std::fill(frame.return_index.begin(), frame.return_index.end(), std::uint8_t{0});
    return;
  }
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const std::size_t firing = slot / returns;
    frame.time_ns[slot] = slot_time_ns_[firing];
    frame.ring[slot] = slot_row_[firing];
    frame.column[slot] = slot_column_[firing];
    frame.return_index[slot] = static_cast<std::uint8_t>(slot % returns);
  }
}

FiringTiles::Place FiringTiles::PlaceOf(std::uint32_t firing) const {
  const auto it = std::find(firing_.begin(), firing_.end(), firing);
  Check(it != firing_.end(), "every firing is traced");
  const auto index = static_cast<std::size_t>(it - firing_.begin());
  return {index / kTileSize, index % kTileSize};
}

}  // namespace railcast
