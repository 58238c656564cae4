#include "core/scene/object_contacts.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "core/scene/convex_body.h"

namespace railcast {
namespace {

// A value just above the tolerance stands for "apart".
constexpr double kApart_m = 1.01 * kTouch_m;

Eigen::AlignedBox3d Widened(const Eigen::AlignedBox3d& box_m, double by_m) {
  return {box_m.min() - Vector3::Constant(by_m), box_m.max() + Vector3::Constant(by_m)};
}

/// A body with its box in the frame in which two objects are compared.
struct NearBody {
  const ConvexBody* body{};
  Eigen::AlignedBox3d box_m;
};

/// Returns the bodies whose boxes meet an area, placed in the area's frame.
std::vector<NearBody> BodiesWithin(const Eigen::AlignedBox3d& area_m,
                                   const std::vector<Piece>& pieces,
                                   const Transform& area_from_pieces) {
  // Most bodies lie apart from the area in their own frame, too, where they need not be placed.
  const Eigen::AlignedBox3d among_pieces_m = area_m.transformed(area_from_pieces.inverse());
  std::vector<NearBody> near;
  for (const Piece& piece : pieces) {
    if (!among_pieces_m.intersects(piece.box_m)) continue;
    for (const ConvexBody& body : piece.bodies) {
      if (!among_pieces_m.intersects(body.box_m)) continue;
      const Eigen::AlignedBox3d box_m = body.box_m.transformed(area_from_pieces);
      if (area_m.intersects(box_m)) near.push_back({&body, box_m});
    }
  }
  return near;
}

/// Leaves only those bodies whose boxes come near the box around others.
void KeepNear(const std::vector<NearBody>& others, std::vector<NearBody>& bodies) {
  Eigen::AlignedBox3d around_m;
  for (const NearBody& other : others) around_m.extend(other.box_m);
  around_m = Widened(around_m, kTouch_m);
  std::erase_if(bodies, [&](const NearBody& body) { return !around_m.intersects(body.box_m); });
}

/// The shortest move that parts two boxes that meet, along their common axes: an upper limit of the
/// depth of what they contain.
double DepthOfBoxes_m(const Eigen::AlignedBox3d& one, const Eigen::AlignedBox3d& other) {
  return (one.max() - other.min()).cwiseMin(other.max() - one.min()).minCoeff();
}

/// Bodies of two objects whose boxes come near each other.
struct NearPair {
  const ConvexBody* one{};
  const ConvexBody* other{};
  double most_depth_m{};
};

/// The smallest gap between bodies of two objects, at most kApart_m; negative where they are in
/// each other.
double LeastGap_m(const std::vector<NearBody>& of_one,
                  const Transform& one_from_other,
                  std::vector<NearBody> of_other) {
  // Sorted along an axis, so that pieces with thousands of triangles need not all be compared.
  const auto begin_m = [](const NearBody& body) { return body.box_m.min().x(); };
  std::ranges::sort(of_other, {}, begin_m);
  std::vector<double> end_m;  // Farthest end of each body and of those before it.
  for (const NearBody& other : of_other) {
    const double own_m = other.box_m.max().x();
    end_m.push_back(end_m.empty() ? own_m : std::max(end_m.back(), own_m));
  }
  std::vector<NearPair> pairs;
  for (const NearBody& one : of_one) {
    const Eigen::AlignedBox3d reach_m = Widened(one.box_m, kTouch_m);
    auto other =
        of_other.begin() + (std::ranges::lower_bound(end_m, reach_m.min().x()) - end_m.begin());
    for (; other != of_other.end() && begin_m(*other) <= reach_m.max().x(); ++other) {
      if (!reach_m.intersects(other->box_m)) continue;
      pairs.push_back({one.body, other->body, DepthOfBoxes_m(one.box_m, other->box_m)});
    }
  }
  // The deepest boxes first: what is found there rules out most of the others.
  std::ranges::sort(pairs, std::ranges::greater(), &NearPair::most_depth_m);
  double least_m = kApart_m;
  for (const auto& [one, other, most_depth_m] : pairs) {
    if (-most_depth_m >= least_m) break;
    const double gap_m = Gap_m(*one, one_from_other, *other, kApart_m);
    least_m = gap_m > 0.0 ? std::min(least_m, gap_m)
                          : -Depth_m(*one, one_from_other, *other, std::max(0.0, -least_m));
  }
  return least_m;
}

/// Rounds a pose to steps in which two coupled wagons of a running train keep theirs: what is found
/// for one moment then holds for others, and does not depend on which of them came first.
Transform RoundedPose(const Transform& pose) {
  constexpr double kSteps = 1e8;  // Per metre, or per unit of a direction.
  Transform rounded = pose;
  rounded.matrix() = (pose.matrix() * kSteps).array().round() / kSteps;
  return rounded;
}

ConvexBody BodyOf(const Eigen::AlignedBox3d& box_m) {
  std::vector<Vector3> corners;
  constexpr int kNumCorners = 8;
  for (int i = 0; i < kNumCorners; ++i) {
    corners.push_back(box_m.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  }
  return MakeConvexBody(std::move(corners));
}

}  // namespace

ContactFinder::ContactFinder(const World& world)
    : world_(world),
      world_from_object_(world.objects().size()),
      boxes_world_(world.objects().size()) {
  std::map<const Model*, Eigen::AlignedBox3d> bounds_m;  // Many objects share a model.
  for (std::size_t i = 0; i < world.objects().size(); ++i) {
    const Model* const model = world.objects()[i].model.get();
    if (!bounds_m.contains(model)) bounds_m[model] = model->Bounds();
    bounds_m_.push_back(bounds_m[model]);
    Place(i, 0);
  }
}

void ContactFinder::Place(std::size_t object, std::int64_t time_ns) {
  world_from_object_[object] = world_.WorldFromObject(object, time_ns);
  const Eigen::AlignedBox3d& box_m = bounds_m_[object];
  if (box_m.isEmpty()) return;
  boxes_world_[object] = Widened(box_m.transformed(world_from_object_[object]), kTouch_m / 2.0);
}

void ContactFinder::MoveTo(std::int64_t time_ns) {
  for (std::size_t i = 0; i < world_.objects().size(); ++i) {
    if (world_.objects()[i].moves) Place(i, time_ns);
  }
}

std::vector<ObjectContact> ContactFinder::FindAll(std::int64_t time_ns) {
  MoveTo(time_ns);
  std::vector<Pair> pairs = PairsNearby();
  // The vehicles of the sensor's own train are coupled, and their springs give.
  const std::vector<SceneObject>& objects = world_.objects();
  std::erase_if(pairs, [&](const Pair& pair) {
    return objects[pair.first].is_ego && objects[pair.second].is_ego;
  });
  return Measure(pairs);
}

std::vector<ObjectContact> ContactFinder::FindOfVehicle(std::int64_t time_ns) {
  const std::vector<SceneObject>& objects = world_.objects();
  if (std::ranges::none_of(objects, &SceneObject::is_ego)) return {};
  MoveTo(time_ns);
  std::vector<Pair> pairs;
  for (std::size_t own = 0; own < objects.size(); ++own) {
    if (!objects[own].is_ego) continue;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      if (objects[i].is_ego || !boxes_world_[own].intersects(boxes_world_[i])) continue;
      pairs.emplace_back(std::min(own, i), std::max(own, i));
    }
  }
  return Measure(pairs);
}

// The boxes are sorted along the axis over which they are spread the widest, so that a thousand
// wagons do not need a million comparisons.
std::vector<ContactFinder::Pair> ContactFinder::PairsNearby() const {
  std::vector<std::size_t> order;
  Eigen::AlignedBox3d all_m;
  for (std::size_t i = 0; i < boxes_world_.size(); ++i) {
    if (boxes_world_[i].isEmpty()) continue;
    order.push_back(i);
    all_m.extend(boxes_world_[i]);
  }
  if (order.empty()) return {};
  Eigen::Index axis = 0;
  all_m.sizes().maxCoeff(&axis);
  std::ranges::sort(order, {}, [&](std::size_t i) { return boxes_world_[i].min()[axis]; });
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < order.size(); ++a) {
    for (std::size_t b = a + 1; b < order.size(); ++b) {
      if (boxes_world_[order[b]].min()[axis] > boxes_world_[order[a]].max()[axis]) break;
      if (boxes_world_[order[a]].intersects(boxes_world_[order[b]])) {
        pairs.emplace_back(std::min(order[a], order[b]), std::max(order[a], order[b]));
      }
    }
  }
  std::ranges::sort(pairs);
  return pairs;
}

std::vector<ObjectContact> ContactFinder::Measure(const std::vector<Pair>& pairs) {
  std::vector<ObjectContact> contacts;
  for (const Pair& pair : pairs) {
    const Transform one_from_other =
        RoundedPose(world_from_object_[pair.first].inverse() * world_from_object_[pair.second]);
    Measured& latest = measured_[pair];
    if (latest.one_from_other != one_from_other.matrix()) {
      latest = {one_from_other.matrix(), GapOf_m(pair, one_from_other)};
    }
    if (latest.gap_m) contacts.push_back({pair.first, pair.second, *latest.gap_m});
  }
  return contacts;
}

std::optional<double> ContactFinder::GapOf_m(const Pair& pair, const Transform& one_from_other) {
  const auto [one, other] = pair;
  const std::optional<double> gap_m = GapOfPieces_m(pair, one_from_other);
  if (gap_m && *gap_m < -kTouch_m) return gap_m;
  // What stands on the floor inside a hall touches it, and is inside it all the same.
  if (Surrounds(one, one_from_other, other) || Surrounds(other, one_from_other.inverse(), one)) {
    return -Depth_m(BodyOf(bounds_m_[one]), one_from_other, BodyOf(bounds_m_[other]));
  }
  return gap_m;
}

// Vertices are moved inwards a little, so that a face of the one that lies on a face of the other
// counts by the side on which the body is.
bool ContactFinder::Surrounds(std::size_t outer,
                              const Transform& outer_from_inner,
                              std::size_t inner) const {
  constexpr std::size_t kMostVertices = 16;
  const Vector3 middle_m = bounds_m_[inner].center();
  for (const Part& part : world_.objects()[inner].model->parts) {
    const auto& vertices = part.mesh.vertices;
    const std::size_t stride = vertices.size() / kMostVertices + 1;
    for (std::size_t i = 0; i < vertices.size(); i += stride) {
      const Vector3 vertex_m = vertices[i].cast<double>();
      const double share = std::min(1.0, 2.0 * kTouch_m / (middle_m - vertex_m).norm());
      const Vector3 moved_m = outer_from_inner * (vertex_m + share * (middle_m - vertex_m));
      if (!bounds_m_[outer].contains(moved_m) ||
          !Encloses(*world_.objects()[outer].model, moved_m)) {
        return false;
      }
    }
    if (!vertices.empty()) return true;
  }
  return false;
}

std::optional<double> ContactFinder::GapOfPieces_m(const Pair& pair,
                                                   const Transform& one_from_other) {
  const Eigen::AlignedBox3d area_m =
      Widened(bounds_m_[pair.first], kTouch_m)
          .intersection(Widened(bounds_m_[pair.second], kTouch_m).transformed(one_from_other));
  if (area_m.isEmpty()) return std::nullopt;
  auto of_one = BodiesWithin(area_m, PiecesOfObject(pair.first), Transform::Identity());
  auto of_other = BodiesWithin(area_m, PiecesOfObject(pair.second), one_from_other);
  KeepNear(of_one, of_other);
  KeepNear(of_other, of_one);
  const double least_m = LeastGap_m(of_one, one_from_other, std::move(of_other));
  return least_m <= kTouch_m ? std::optional(least_m) : std::nullopt;
}

const std::vector<Piece>& ContactFinder::PiecesOfObject(std::size_t object) {
  const Model* const model = world_.objects()[object].model.get();
  const auto found = pieces_.find(model);
  return found != pieces_.end() ? found->second
                                : pieces_.emplace(model, PiecesOf(*model)).first->second;
}

bool AreStillBetween(const World& world, std::int64_t from_ns, std::int64_t to_ns) {
  // Something may return to where it was, but nothing goes and comes back within half a second.
  constexpr std::int64_t kStep_ns = 500'000'000;
  for (std::size_t i = 0; i < world.objects().size(); ++i) {
    if (!world.objects()[i].moves) continue;
    const Transform begin = world.WorldFromObject(i, from_ns);
    for (std::int64_t time_ns = to_ns; time_ns > from_ns; time_ns -= kStep_ns) {
      if (begin.matrix() != world.WorldFromObject(i, time_ns).matrix()) return false;
    }
  }
  return true;
}

}  // namespace railcast
