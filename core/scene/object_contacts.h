#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/scene/convex_body.h"
#include "railcast/scene.h"

namespace railcast {

/// Objects touch if the gap between them, or the depth to which they are in each other, is at most
/// this. Coupled wagons touch: in curves, their rigid buffers are some millimetres in each other.
inline constexpr double kTouch_m = 0.02;

/// Two objects that touch or overlap, as indices into World::objects(); `one` < `other`.
struct ObjectContact {
  std::size_t one{};
  std::size_t other{};
  /// The gap between them. Negative where they are in each other: then its amount is the shortest
  /// move that parts the two pieces that are deepest in each other.
  double gap_m{};

  [[nodiscard]] bool is_overlap() const { return gap_m < -kTouch_m; }
  bool operator==(const ObjectContact&) const = default;
};

/// Finds the objects of a world, including the sensor's own vehicle, that touch or overlap.
///
/// Objects are taken as the pieces that their triangles form (PiecesOf). Objects whose boxes lie
/// apart cost one comparison. Pieces are compared only where the boxes of both objects meet, and
/// only after the two have moved against each other.
class ContactFinder {
 public:
  /// @param world Must outlive the finder.
  explicit ContactFinder(const World& world);

  /// All contacts at one moment, by `one` and `other`.
  [[nodiscard]] std::vector<ObjectContact> FindAll(std::int64_t time_ns);
  /// The contacts of the sensor's own vehicles with all else.
  [[nodiscard]] std::vector<ObjectContact> FindOfVehicle(std::int64_t time_ns);

 private:
  using Pair = std::pair<std::size_t, std::size_t>;
  /// What was found for a pair the latest time.
  struct Measured {
    Eigen::Matrix4d one_from_other = Eigen::Matrix4d::Zero();
    std::optional<double> gap_m;  ///< Nothing if they are apart.
  };

  void MoveTo(std::int64_t time_ns);
  void Place(std::size_t object, std::int64_t time_ns);
  [[nodiscard]] std::vector<Pair> PairsNearby() const;
  [[nodiscard]] std::vector<ObjectContact> Measure(const std::vector<Pair>& pairs);
  [[nodiscard]] std::optional<double> GapOf_m(const Pair& pair, const Transform& one_from_other);
  [[nodiscard]] std::optional<double> GapOfPieces_m(const Pair& pair,
                                                    const Transform& one_from_other);
  // Whether `outer` encloses a corner of `inner` on all sides.
  [[nodiscard]] bool Surrounds(std::size_t outer,
                               const Transform& outer_from_inner,
                               std::size_t inner) const;
  [[nodiscard]] const std::vector<Piece>& PiecesOfObject(std::size_t object);

  const World& world_;
  std::vector<Eigen::AlignedBox3d> bounds_m_;  ///< Bounds of the models, in their own frames.
  std::vector<Transform> world_from_object_;
  std::vector<Eigen::AlignedBox3d> boxes_world_;  ///< Widened, so that those that touch meet.
  std::map<const Model*, std::vector<Piece>> pieces_;
  std::map<Pair, Measured> measured_;
};

/// Whether no object changes its place between two moments. Objects never return to a place that
/// they have left.
[[nodiscard]] bool AreStillBetween(const World& world, std::int64_t from_ns, std::int64_t to_ns);

}  // namespace railcast
