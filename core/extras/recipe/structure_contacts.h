#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "railcast/frame.h"
#include "railcast/rail_world.h"

namespace railcast {

/// Finds out whether objects are in what stands on the line: masts, platforms, walls, signals,
/// buildings. Track, ground and roads, on which they stand or lie, plants and wires do not count.
class StructureContacts {
 public:
  /// @param world The line; objects may be added to it.
  StructureContacts(std::shared_ptr<const RailWorld> world, const LabelTable& labels);

  /// Returns the label of something on the line that is inside an object's box: farther in than
  /// 5 cm, and 15 cm above its foot, so that it may stand on sloping floors.
  /// @param world The same line with the object.
  [[nodiscard]] std::optional<std::string> Find(const RailWorld& world,
                                                std::size_t object,
                                                std::int64_t time_ns);

 private:
  struct Triangle {
    std::array<Vector3, 3> corners_world;
    Eigen::AlignedBox3d box_world;
    std::uint32_t label{};
  };
  void AddTriangles(const Model& model,
                    const Eigen::Affine3d& world_from_model,
                    std::vector<Triangle>& triangles) const;
  [[nodiscard]] const std::vector<Triangle>& TrianglesOf(int chunk);
  [[nodiscard]] std::vector<const Triangle*> TrianglesNear(const Eigen::AlignedBox3d& box_world,
                                                           double near_s_m);

  std::shared_ptr<const RailWorld> world_;
  std::map<std::uint32_t, std::string> labels_;  ///< The labels that count.
  std::map<int, std::vector<Triangle>> chunks_;
};

}  // namespace railcast
