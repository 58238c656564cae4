#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "core/trace/trace_scene.h"
#include "railcast/world_spec.h"
#include "tests/core/rail/test_line.h"

namespace railcast {

/// Looks at the built chunks of a line with structures.
class StructureProbe {
 public:
  explicit StructureProbe(WorldSpec spec) : line_(std::move(spec)) {}

  [[nodiscard]] const TestLine& line() const { return line_; }
  /// Points (y, z) where the edges of the surface's triangles cross the plane across the line at
  /// `s_m`, in the upright frame there whose origin is on the line's axis at top of rail.
  [[nodiscard]] std::vector<Eigen::Vector2d> SectionOf(const SurfaceClass& surface,
                                                       double s_m) const;
  /// As SectionOf(), in the canted frame of the line.
  [[nodiscard]] std::vector<Eigen::Vector2d> CantedSectionOf(const SurfaceClass& surface,
                                                             double s_m) const;

  /// The label of the first surface from one point to another, both at (s, d, h) with h vertical
  /// above the line's top of rail at s; 0 if there is none up to a metre beyond the second. Both
  /// points are in the chunk of the second.
  [[nodiscard]] std::uint32_t LabelSeen(const Vector3& from, const Vector3& to) const;
  /// As above, with the distance from the first point; a metre beyond the second if nothing is
  /// seen.
  struct Seen {
    std::uint32_t label{};
    double distance_m{};
  };
  [[nodiscard]] Seen Look(const Vector3& from, const Vector3& to) const;

  /// Height above the line's top of rail at s of the highest part of a surface straight below a
  /// place (s, d, h); nothing if there is none.
  [[nodiscard]] std::optional<double> HeightBelow_m(const SurfaceClass& surface,
                                                    const Vector3& place,
                                                    bool is_coarse = false) const;

 private:
  /// As Look(), at all or at one surface of a chunk's ground.
  [[nodiscard]] Seen Look(const Vector3& from,
                          const Vector3& to,
                          const std::optional<SurfaceClass>& surface,
                          bool is_coarse) const;
  [[nodiscard]] Vector3 WorldAt(const Vector3& place) const;
  [[nodiscard]] std::vector<Eigen::Vector2d> CutAt(const SurfaceClass& surface,
                                                   double s_m,
                                                   const Transform& world_from_plane) const;

  struct Built {
    Model model;
    std::unique_ptr<const TraceScene> scene;
  };
  TestLine line_;
  /// By chunk, form, label and material; 0 = all of it.
  mutable std::map<std::tuple<int, bool, std::uint32_t, std::uint16_t>, Built> built_;
};

/// The largest or smallest y or z of the points.
[[nodiscard]] double LeastOf(const std::vector<Eigen::Vector2d>& points, int axis);
[[nodiscard]] double MostOf(const std::vector<Eigen::Vector2d>& points, int axis);

}  // namespace railcast
