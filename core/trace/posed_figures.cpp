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

// Whether a ray with a direction of length 1 comes into a sphere before its end.
bool MayMeetSphere(const Eigen::Vector3f& to_center_m,
                   const Eigen::Vector3f& direction,
                   float radius_m,
                   float range_m) {
  const float along_m = to_center_m.dot(direction);
  if (along_m < -radius_m || along_m - radius_m > range_m) return false;
  return (to_center_m - along_m * direction).squaredNorm() <= radius_m * radius_m;
}

// Whether a ray comes into a box before its end. Embree asks whether any ray of a packet does.
bool MayMeetBox(const RTCRay& ray, const Eigen::AlignedBox3f& box_m) {
  const Eigen::Array3f origin_m(ray.org_x, ray.org_y, ray.org_z);
  const Eigen::Array3f direction(ray.dir_x, ray.dir_y, ray.dir_z);
  const Eigen::Array3f to_min = (box_m.min().array() - origin_m) / direction;
  const Eigen::Array3f to_max = (box_m.max().array() - origin_m) / direction;
  const float begin_m = to_min.min(to_max).maxCoeff();
  const float end_m = to_min.max(to_max).minCoeff();
  return !(begin_m > end_m || end_m < 0.0F || begin_m > ray.tfar);
}

}  // namespace

PosedFigures::PosedFigures(TraceFigures figures)
    : figures_(std::move(figures)), poses_(NumPoses(figures_)) {
  std::size_t first = 0;
  for (const TraceFigure& figure : figures_.figures) {
    Check(figure.num_steps >= 2, "a figure moves between two poses");
    first_poses_.push_back(first);
    first += figure.num_steps;
  }
}

const std::vector<PosedFigures::PlacedPiece>& PosedFigures::PoseAt(std::size_t figure,
                                                                   std::uint32_t step) const {
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
      const Eigen::Vector3f& center_m = pieces[i].model->handle().sphere.center_m;
      pose.pieces.push_back({matrix, matrix.leftCols<3>() * center_m + matrix.col(3)});
    }
  });
  return pose.pieces;
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
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    RTCRayHit ray = rtcGetRayHitFromRayHitN(args->rayhit, args->N, i);
    if (!MayMeetBox(ray.ray, self.figures()[args->primID].window_box_m)) continue;
    if (!self.Intersect(args->primID, static_cast<RayQueryContext&>(*args->context), ray)) continue;
    RTCRayN_tfar(rays, args->N, i) = ray.ray.tfar;
    rtcCopyHitToHitN(hits, &ray.hit, args->N, i);
  }
}

bool PosedFigures::Intersect(std::size_t figure, RayQueryContext& context, RTCRayHit& ray) const {
  const TraceFigure& its = figures()[figure];
  const float time = ray.ray.time * static_cast<float>(its.num_steps - 1);
  const auto step = std::min(static_cast<std::uint32_t>(time), its.num_steps - 2);
  const float share = time - static_cast<float>(step);
  const std::vector<PlacedPiece>& begin = PoseAt(figure, step);
  const std::vector<PlacedPiece>& end = PoseAt(figure, step + 1);
  const Eigen::Vector3f origin_m(ray.ray.org_x, ray.ray.org_y, ray.ray.org_z);
  const Eigen::Vector3f direction(ray.ray.dir_x, ray.ray.dir_y, ray.ray.dir_z);
  bool is_hit = false;
  for (std::size_t i = 0; i < begin.size(); ++i) {
    const TracePiece& piece = (*its.pieces)[i];
    const TraceModel::Handle& model = piece.model->handle();
    const Eigen::Vector3f center_m =
        begin[i].center_m + share * (end[i].center_m - begin[i].center_m);
    if (!MayMeetSphere(center_m - origin_m, direction, model.sphere.radius_m, ray.ray.tfar))
      continue;
    const Matrix34 window_from_piece =
        (1.0F - share) * begin[i].window_from_piece + share * end[i].window_from_piece;
    const Eigen::Matrix3f piece_from_window = window_from_piece.leftCols<3>().inverse();
    RTCRayHit local = ray;
    local.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    Eigen::Map<Eigen::Vector3f>(&local.ray.org_x) =
        piece_from_window * (origin_m - window_from_piece.col(3));
    Eigen::Map<Eigen::Vector3f>(&local.ray.dir_x) = piece_from_window * direction;
    context.instID[0] = static_cast<unsigned>(figure);
    RayQuery(context).Intersect1(model.scene, local);
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
