#include "core/trace/trace_handles.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

using Matrix34 = Eigen::Matrix<float, 3, 4>;

std::size_t NumPoses(const TraceFigures& figures) {
  std::size_t count = 0;
  for (const TraceFigure& figure : figures.figures) count += figure.num_steps;
  return count;
}

// The box around a box that is moved, with a margin for the rounding of both.
Eigen::AlignedBox3f BoxAround(const Eigen::AlignedBox3f& box_m, const Matrix34& moved) {
  constexpr float kRounding_m = 1e-3F;  // float32 is ten times as exact at 1 km.
  const Eigen::Vector3f center_m = moved.leftCols<3>() * box_m.center() + moved.col(3);
  const Eigen::Vector3f half_m = moved.leftCols<3>().cwiseAbs() * (0.5F * box_m.sizes()) +
                                 Eigen::Vector3f::Constant(kRounding_m);
  return {center_m - half_m, center_m + half_m};
}

}  // namespace

/// A ray, as boxes are tested against it.
struct PosedFigures::Probe {
  explicit Probe(const RTCRay& ray)
      : origin_m(ray.org_x, ray.org_y, ray.org_z, 0.0F),
        per_m(Eigen::Array4f(ray.dir_x, ray.dir_y, ray.dir_z, 1.0F).inverse()) {}

  /// Whether the ray comes into a box before its end.
  [[nodiscard]] bool MayMeet(const SlabBox& box, float range_m) const {
    const Eigen::Array4f to_min = (box.min_m - origin_m) * per_m;
    const Eigen::Array4f to_max = (box.max_m - origin_m) * per_m;
    const Eigen::Array4f begin_m = to_min.min(to_max);
    const Eigen::Array4f end_m = to_min.max(to_max);
    for (int i = 0; i < 3; ++i) {
      const float begin = begin_m[i];
      if (begin > range_m || begin > end_m[0] || begin > end_m[1] || begin > end_m[2]) return false;
    }
    return !(end_m[0] < 0.0F || end_m[1] < 0.0F || end_m[2] < 0.0F);
  }

  Eigen::Array4f origin_m, per_m;
};

PosedFigures::PosedFigures(TraceFigures figures)
    : figures_(std::move(figures)), poses_(NumPoses(figures_)) {
  std::size_t first = 0;
  for (const TraceFigure& figure : figures_.figures) {
    Check(figure.num_steps >= 2, "a figure moves between two poses");
    first_poses_.push_back(first);
    first += figure.num_steps;
  }
}

const PosedFigures::Pose& PosedFigures::PoseAt(std::size_t figure, std::uint32_t step) const {
  Pose& pose = poses_[first_poses_[figure] + step];
  std::call_once(pose.once, [&] {
    const TraceFigure& its = figures_.figures[figure];
    const std::vector<TracePiece>& pieces = *its.pieces;
    // Isolated, so that a thread that waits for tasks of a world does not take up a tile of the
    // frame that needs this pose.
    const std::vector<Eigen::Affine3d> places = tbb::this_task_arena::isolate(
        [&] { return figures_.window_from_pieces(figure, step, its.num_steps); });
    Check(places.size() == pieces.size(), "every piece of a figure has a place");
    pose.pieces.reserve(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const Matrix34 matrix = places[i].matrix().topRows<3>().cast<float>();
      const SlabBox box(BoxAround(pieces[i].model->handle().box_m, matrix));
      pose.pieces.push_back({matrix, box});
      pose.window_box_m = pose.window_box_m.Merged(box);
    }
  });
  return pose;
}

void PosedFigures::AttachTo(RTCDevice device, RTCScene scene) const {
  const OwnedGeometry owned = NewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  RTCGeometry geometry = owned.get();
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(figures().size()));
  rtcSetGeometryUserData(geometry, const_cast<PosedFigures*>(this));
  rtcSetGeometryBoundsFunction(geometry, &ReportBox, nullptr);
  rtcSetGeometryIntersectFunction(geometry, &IntersectRays);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, 0);
}

void PosedFigures::ReportBox(const RTCBoundsFunctionArguments* args) {
  const auto& self = *static_cast<const PosedFigures*>(args->geometryUserPtr);
  const Eigen::AlignedBox3f& box_m = self.figures()[args->primID].window_box_m;
  RTCBounds& bounds = *args->bounds_o;
  bounds.lower_x = box_m.min().x();
  bounds.lower_y = box_m.min().y();
  bounds.lower_z = box_m.min().z();
  bounds.upper_x = box_m.max().x();
  bounds.upper_y = box_m.max().y();
  bounds.upper_z = box_m.max().z();
}

void PosedFigures::IntersectRays(const RTCIntersectFunctionNArguments* args) {
  const auto& self = *static_cast<const PosedFigures*>(args->geometryUserPtr);
  RTCRayN* const rays = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* const hits = RTCRayHitN_HitN(args->rayhit, args->N);
  const SlabBox box(self.figures()[args->primID].window_box_m);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    RTCRayHit ray = rtcGetRayHitFromRayHitN(args->rayhit, args->N, i);
    const Probe probe(ray.ray);
    // Embree asks whether any ray of a packet comes into the box.
    if (!probe.MayMeet(box, ray.ray.tfar)) continue;
    if (!self.Intersect(args->primID, probe, static_cast<RayQueryContext&>(*args->context), ray)) {
      continue;
    }
    RTCRayN_tfar(rays, args->N, i) = ray.ray.tfar;
    rtcCopyHitToHitN(hits, &ray.hit, args->N, i);
  }
}

bool PosedFigures::Intersect(std::size_t figure,
                             const Probe& probe,
                             RayQueryContext& context,
                             RTCRayHit& ray) const {
  const TraceFigure& its = figures()[figure];
  const float time = ray.ray.time * static_cast<float>(its.num_steps - 1);
  const auto step = std::min(static_cast<std::uint32_t>(time), its.num_steps - 2);
  const float share = time - static_cast<float>(step);
  // Between two poses, every point stays on the straight line between its ends.
  const Pose& first = PoseAt(figure, step);
  const Pose& second = PoseAt(figure, step + 1);
  if (!probe.MayMeet(first.window_box_m.Merged(second.window_box_m), ray.ray.tfar)) return false;
  const Eigen::Vector3f origin_m(ray.ray.org_x, ray.ray.org_y, ray.ray.org_z);
  const Eigen::Vector3f direction(ray.ray.dir_x, ray.ray.dir_y, ray.ray.dir_z);
  bool is_hit = false;
  for (std::size_t i = 0; i < first.pieces.size(); ++i) {
    const PlacedPiece& begin = first.pieces[i];
    const PlacedPiece& end = second.pieces[i];
    if (!probe.MayMeet(begin.window_box_m.Merged(end.window_box_m), ray.ray.tfar)) continue;
    const TracePiece& piece = (*its.pieces)[i];
    const Matrix34 window_from_piece =
        (1.0F - share) * begin.window_from_piece + share * end.window_from_piece;
    const Eigen::Matrix3f piece_from_window = window_from_piece.leftCols<3>().inverse();
    RTCRayHit local = ray;
    local.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    Eigen::Map<Eigen::Vector3f>(&local.ray.org_x) =
        piece_from_window * (origin_m - window_from_piece.col(3));
    Eigen::Map<Eigen::Vector3f>(&local.ray.dir_x) = piece_from_window * direction;
    context.instID[0] = static_cast<unsigned>(figure);
    RayQuery(context).Intersect1(piece.model->handle().scene, local);
    context.instID[0] = RTC_INVALID_GEOMETRY_ID;
    if (local.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
    is_hit = true;
    ray.ray.tfar = local.ray.tfar;
    ray.hit = local.hit;
    ray.hit.geomID += piece.first_surface;
    ray.hit.instID[0] = static_cast<unsigned>(figure);
    Eigen::Map<Eigen::Vector3f>(&ray.hit.Ng_x) =
        piece_from_window.transpose() * Eigen::Map<const Eigen::Vector3f>(&local.hit.Ng_x);
  }
  return is_hit;
}

}  // namespace railcast
