#include "generator/check/object_overlaps.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <numeric>
#include <optional>

#include "core/trace/trace_scene.h"

namespace railcast {
namespace {

// Objects that stand on each other touch only to within the rounding of float32 and of the
// scenario's decimals.
constexpr double kTouch_m = 0.005;

/// Collects line segments and traces them against one object in its own frame.
class Segments {
 public:
  explicit Segments(const TraceScene& scene) : scene_(scene) {}

  void Add(const Vector3& from, const Vector3& to) {
    const double length_m = (to - from).norm();
    if (!(length_m > 0.0)) return;
    const Vector3 direction = (to - from) / length_m;
    const std::size_t i = rays_.num_rays++;
    rays_.origin_x[i] = static_cast<float>(from.x());
    rays_.origin_y[i] = static_cast<float>(from.y());
    rays_.origin_z[i] = static_cast<float>(from.z());
    rays_.direction_x[i] = static_cast<float>(direction.x());
    rays_.direction_y[i] = static_cast<float>(direction.y());
    rays_.direction_z[i] = static_cast<float>(direction.z());
    rays_.range_m[i] = static_cast<float>(length_m);
    rays_.surface[i] = 0;
    if (rays_.num_rays == kTileSize) Cast();
  }

  /// Returns how many of all segments met the object.
  [[nodiscard]] std::size_t CountHits() {
    Cast();
    return num_hits_;
  }

 private:
  void Cast() {
    const std::size_t num_rays = rays_.num_rays;
    if (num_rays == 0) return;
    // Fill up the packet by repeating the last ray.
    for (std::size_t i = num_rays; i < kTileSize; ++i) {
      rays_.origin_x[i] = rays_.origin_x[num_rays - 1];
      rays_.origin_y[i] = rays_.origin_y[num_rays - 1];
      rays_.origin_z[i] = rays_.origin_z[num_rays - 1];
      rays_.direction_x[i] = rays_.direction_x[num_rays - 1];
      rays_.direction_y[i] = rays_.direction_y[num_rays - 1];
      rays_.direction_z[i] = rays_.direction_z[num_rays - 1];
      rays_.range_m[i] = rays_.range_m[num_rays - 1];
    }
    rays_.num_rays = kTileSize;
    scene_.Cast(rays_);
    num_hits_ +=
        static_cast<std::size_t>(std::count_if(rays_.surface, rays_.surface + num_rays,
                                               [](std::uint32_t surface) { return surface != 0; }));
    rays_.num_rays = 0;
  }

  const TraceScene& scene_;
  RayTile rays_{};
  std::size_t num_hits_ = 0;
};

/// Shrinks the model by kTouch_m from all sides of its box, so that objects that only touch no
/// longer meet.
Eigen::Affine3d DrawnIn(const Eigen::AlignedBox3d& box) {
  const Vector3 size_m = box.sizes();
  const Vector3 scale =
      (size_m.array() > 0.0)
          .select((size_m.array() - 2.0 * kTouch_m).max(0.5 * size_m.array()) / size_m.array(),
                  1.0);
  return Eigen::Translation3d(box.center()) * Eigen::Scaling(scale) *
         Eigen::Translation3d(-box.center());
}

/// The objects at one moment, prepared for intersection with segments.
class Objects {
 public:
  Objects(const World& world, std::int64_t time_ns) : world_(world) {
    for (std::size_t i = 0; i < world.objects().size(); ++i) {
      world_from_object_.emplace_back(world.WorldFromObject(i, time_ns).matrix());
      const Eigen::AlignedBox3d box = world.objects()[i].model->Bounds();
      boxes_world_.push_back(box.isEmpty() ? box : box.transformed(world_from_object_.back()));
    }
  }

  [[nodiscard]] const std::vector<Eigen::AlignedBox3d>& boxes_world() const { return boxes_world_; }

  /// Whether the surfaces of two objects cut each other. The smaller one is shrunk: shrinking a
  /// wagon would lift its floor into its load.
  [[nodiscard]] bool SurfacesMeet(std::size_t one, std::size_t other) {
    const auto size_m = [&](std::size_t object) {
      return ModelOf(object).Bounds().diagonal().norm();
    };
    const bool is_one_smaller = size_m(one) < size_m(other);
    const std::size_t small = is_one_smaller ? one : other;
    const std::size_t large = is_one_smaller ? other : one;
    return EdgesMeet(large, small, true) || EdgesMeet(small, large, false);
  }

  /// Whether `outer` surrounds a corner of `inner` on all sides.
  [[nodiscard]] bool Encloses(std::size_t outer, std::size_t inner) {
    const std::optional<Vector3> corner = FirstCorner(ModelOf(inner));
    if (!corner) return false;
    const Vector3 from = FixedFromMoved(outer, inner, true) * *corner;
    const double reach_m = ModelOf(outer).Bounds().diagonal().norm();
    Segments segments(SceneOf(outer));
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 aside_m = reach_m * Vector3::Unit(axis);
      segments.Add(from, from + aside_m);
      segments.Add(from, from - aside_m);
    }
    constexpr std::size_t kNumSides = 6;
    return segments.CountHits() == kNumSides;
  }

 private:
  // Whether an edge of `moved` meets a surface of `fixed`; one of the two is shrunk.
  [[nodiscard]] bool EdgesMeet(std::size_t fixed, std::size_t moved, bool draws_in_moved) {
    const Eigen::Affine3d fixed_from_moved = FixedFromMoved(fixed, moved, draws_in_moved);
    const Eigen::AlignedBox3d box = ModelOf(fixed).Bounds();
    Segments segments(SceneOf(fixed));
    for (const Part& part : ModelOf(moved).parts) {
      for (const auto& triangle : part.mesh.triangles) {
        std::array<Vector3, 3> corners;
        Eigen::AlignedBox3d corners_box;
        for (std::size_t k = 0; k < 3; ++k) {
          corners[k] = fixed_from_moved * part.mesh.vertices[triangle[k]].cast<double>();
          corners_box.extend(corners[k]);
        }
        if (!box.intersects(corners_box)) continue;
        for (std::size_t k = 0; k < 3; ++k) segments.Add(corners[k], corners[(k + 1) % 3]);
      }
    }
    return segments.CountHits() > 0;
  }

  [[nodiscard]] const Model& ModelOf(std::size_t object) const {
    return *world_.objects()[object].model;
  }

  [[nodiscard]] static std::optional<Vector3> FirstCorner(const Model& model) {
    for (const Part& part : model.parts) {
      if (!part.mesh.vertices.empty()) return part.mesh.vertices.front().cast<double>();
    }
    return std::nullopt;
  }

  [[nodiscard]] Eigen::Affine3d FixedFromMoved(std::size_t fixed,
                                               std::size_t moved,
                                               bool draws_in_moved) const {
    const Eigen::Affine3d plain = world_from_object_[fixed].inverse() * world_from_object_[moved];
    if (draws_in_moved) return plain * DrawnIn(ModelOf(moved).Bounds());
    // Shrinking the traced model is equivalent to enlarging the segments.
    return DrawnIn(ModelOf(fixed).Bounds()).inverse() * plain;
  }

  [[nodiscard]] const TraceScene& SceneOf(std::size_t object) {
    std::unique_ptr<const TraceScene>& scene = scenes_[&ModelOf(object)];
    if (scene == nullptr) {
      const auto model = std::make_shared<const TraceModel>(device_, ModelOf(object));
      scene = std::make_unique<const TraceScene>(
          device_, std::vector<TracePlacement>{{model, {Eigen::Affine3d::Identity()}, 1}});
    }
    return *scene;
  }

  const World& world_;
  TraceDevice device_;
  std::vector<Eigen::Affine3d> world_from_object_;
  std::vector<Eigen::AlignedBox3d> boxes_world_;
  std::map<const Model*, std::unique_ptr<const TraceScene>> scenes_;
};

/// Returns pairs whose boxes meet. The boxes are sorted along x, so that a thousand wagons do not
/// need a million comparisons.
std::vector<std::pair<std::size_t, std::size_t>> PairsNearby(
    const std::vector<Eigen::AlignedBox3d>& boxes) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!boxes[i].isEmpty()) order.push_back(i);
  }
  std::ranges::sort(order, {}, [&](std::size_t i) { return boxes[i].min().x(); });
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < order.size(); ++a) {
    for (std::size_t b = a + 1; b < order.size(); ++b) {
      if (boxes[order[b]].min().x() > boxes[order[a]].max().x()) break;
      if (boxes[order[a]].intersects(boxes[order[b]])) {
        pairs.emplace_back(std::min(order[a], order[b]), std::max(order[a], order[b]));
      }
    }
  }
  std::ranges::sort(pairs);
  return pairs;
}

}  // namespace

std::vector<ObjectOverlap> FindOverlaps(const World& world, std::int64_t time_ns) {
  Objects objects(world, time_ns);
  std::vector<ObjectOverlap> overlaps;
  for (const auto& [one, other] : PairsNearby(objects.boxes_world())) {
    if (objects.SurfacesMeet(one, other)) {
      overlaps.push_back({one, other, false});
    } else if (objects.Encloses(other, one)) {
      overlaps.push_back({one, other, true});
    } else if (objects.Encloses(one, other)) {
      overlaps.push_back({other, one, true});
    }
  }
  return overlaps;
}

}  // namespace railcast
