#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/rail/line/rail_section.h"
#include "tests/core/rail/test_line.h"

namespace railcast {

inline constexpr double kHalf_m = 0.5 * kGauge_m;

/// The tracks of a line in its chunks, each built once.
class BuiltTracks {
 public:
  explicit BuiltTracks(const TestLine& line) : line_(line) {}

  [[nodiscard]] const TestLine& line() const { return line_; }
  [[nodiscard]] const Chunk& At(double s_m) const;

 private:
  const TestLine& line_;
  mutable std::map<int, Chunk> chunks_;
};

/// Rails and parts of turnouts and crossings near a place, cut by the plane across a track.
class CutRails {
 public:
  CutRails(const BuiltTracks& tracks, std::size_t track, double s_m);
  CutRails(const TestLine& line, std::size_t track, double s_m)
      : CutRails(BuiltTracks(line), track, s_m) {}

  /// Whether nothing lies in the rectangle of y and z.
  [[nodiscard]] bool IsFree(const Eigen::AlignedBox2d& area_m) const;
  /// The y of all points of the cut at a height, ascending.
  [[nodiscard]] std::vector<double> At(double z_m) const;

 private:
  void Cut(const Mesh& mesh, const Transform& track_from_chunk);

  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> cuts_;
};

/// A part of a track on which wheels are to find their way.
struct WayOfWheels {
  std::size_t track{};
  double begin_s_m{};
  double end_s_m{};
};

/// Expects that every 0.37 m, at both gauge faces, there is room for flanges, which are at most 33
/// mm thick (EN 13715) and run with play.
void ExpectFlangesFindAWay(const TestLine& line, const WayOfWheels& way, const std::string& what);

}  // namespace railcast
