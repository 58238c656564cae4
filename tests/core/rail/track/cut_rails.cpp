#include "tests/core/rail/track/cut_rails.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/rail/track/track_structure.h"

namespace railcast {
namespace {

int ChunkIndexAt(double s_m) {
  return static_cast<int>(s_m / TestLine::kChunkLength_m);
}

}  // namespace

const Chunk& BuiltTracks::At(double s_m) const {
  const auto [it, is_new] = chunks_.try_emplace(ChunkIndexAt(s_m));
  if (is_new) AddTracks(line_.Context(it->first), line_.models(), it->second);
  return it->second;
}

CutRails::CutRails(const BuiltTracks& tracks, std::size_t track, double s_m) {
  const TestLine& line = tracks.line();
  const int chunk_index = ChunkIndexAt(s_m);
  const Transform track_from_chunk =
      line.Context(chunk_index).tracks[track].WorldFromTrack(line.alignment(), s_m).inverse() *
      line.WorldFromChunk(chunk_index);
  const RailSurfaces& surfaces = line.surfaces();
  for (const SurfaceClass& surface : {surfaces.rail_head, surfaces.rail_side,
                                      surfaces.turnouts.running_band, surfaces.turnouts.rail}) {
    Cut(MeshOfSurface(tracks.At(s_m), surface), track_from_chunk);
  }
}

bool CutRails::IsFree(const Eigen::AlignedBox2d& area_m) const {
  return std::none_of(cuts_.begin(), cuts_.end(), [&](const auto& cut) {
    constexpr int kNumSteps = 50;
    for (int i = 0; i <= kNumSteps; ++i) {
      const double t = 1.0 * i / kNumSteps;
      if (area_m.contains(Eigen::Vector2d((1.0 - t) * cut.first + t * cut.second))) return true;
    }
    return false;
  });
}

std::vector<double> CutRails::At(double z_m) const {
  std::vector<double> places_m;
  for (const auto& [a, b] : cuts_) {
    if ((a.y() < z_m) == (b.y() < z_m)) continue;
    places_m.push_back(std::lerp(a.x(), b.x(), (z_m - a.y()) / (b.y() - a.y())));
  }
  std::sort(places_m.begin(), places_m.end());
  return places_m;
}

void CutRails::Cut(const Mesh& mesh, const Transform& track_from_chunk) {
  std::vector<Vector3> places;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    places.push_back(track_from_chunk * vertex.cast<double>());
  }
  for (const auto& triangle : mesh.triangles) {
    std::vector<Eigen::Vector2d> points;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3& a = places[triangle[i]];
      const Vector3& b = places[triangle[(i + 1) % 3]];
      if ((a.x() < 0.0) == (b.x() < 0.0)) continue;
      const Vector3 point = a + a.x() / (a.x() - b.x()) * (b - a);
      points.emplace_back(point.y(), point.z());
    }
    if (points.size() == 2) cuts_.emplace_back(points[0], points[1]);
  }
}

void ExpectFlangesFindAWay(const TestLine& line, const WayOfWheels& way, const std::string& what) {
  const BuiltTracks tracks(line);
  for (double s_m = way.begin_s_m; s_m <= way.end_s_m; s_m += 0.37) {
    const CutRails rails(tracks, way.track, s_m);
    for (const double side : {-1.0, 1.0}) {
      const Eigen::AlignedBox2d flange(
          Eigen::Vector2d(std::min(side * (kHalf_m - 0.033), side * (kHalf_m - 0.002)), -0.028),
          Eigen::Vector2d(std::max(side * (kHalf_m - 0.033), side * (kHalf_m - 0.002)), -0.008));
      EXPECT_TRUE(rails.IsFree(flange)) << what << " at " << s_m << ", side " << side;
    }
  }
}

}  // namespace railcast
