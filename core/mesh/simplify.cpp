#include "core/mesh/simplify.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "core/base/joined_sets.h"
#include "core/mesh/mesh_deviation.h"
#include "core/scene/polygon.h"

namespace railcast {
namespace {

using PlaceTriangle = std::array<std::uint32_t, 3>;

struct PlaceHash {
  std::size_t operator()(const std::array<std::uint32_t, 3>& bits) const {
    std::size_t hash = 0;
    for (const std::uint32_t word : bits) hash = (hash ^ word) * 0x9E3779B97F4A7C15ULL;
    return hash ^ (hash >> 32U);
  }
};

/// Points that are numbered by their place, so that triangles share those that are in one place.
class Places {
 public:
  std::uint32_t Of(const Eigen::Vector3f& point) {
    std::array<std::uint32_t, 3> bits{};
    const Eigen::Vector3f without_minus_zero = point + Eigen::Vector3f::Zero();
    std::memcpy(bits.data(), without_minus_zero.data(), sizeof(bits));
    const auto [it, is_new] =
        number_of_.try_emplace(bits, static_cast<std::uint32_t>(points_.size()));
    if (is_new) points_.push_back(point);
    return it->second;
  }
  [[nodiscard]] const std::vector<Eigen::Vector3f>& points() const { return points_; }

 private:
  std::vector<Eigen::Vector3f> points_;
  std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, PlaceHash> number_of_;
};

/// What hangs together in a part.
struct ConnectedPiece {
  std::size_t part{};
  Mesh mesh;                  ///< Each place is one vertex.
  std::vector<bool> is_held;  ///< By vertex.
  double deviation_m = 0.0;   ///< Deviation of the simplified mesh from the piece.
  bool is_changed = false;
};

/// Cuts parts into what hangs together.
class PieceCutter {
 public:
  explicit PieceCutter(const std::vector<Mesh>& parts) {
    std::vector<std::vector<PlaceTriangle>> triangles_of;
    for (const Mesh& part : parts) {
      std::vector<PlaceTriangle>& triangles = triangles_of.emplace_back();
      for (const PlaceTriangle& corners : part.triangles) {
        PlaceTriangle& triangle = triangles.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) triangle[i] = places_.Of(part.vertices[corners[i]]);
      }
    }
    FindSeams(triangles_of);
    number_in_piece_.resize(places_.points().size());
    for (std::size_t p = 0; p < parts.size(); ++p) Cut(triangles_of[p], p);
  }

  [[nodiscard]] std::vector<ConnectedPiece> Take() { return std::move(pieces_); }

 private:
  void FindSeams(const std::vector<std::vector<PlaceTriangle>>& triangles_of) {
    constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> part_of(places_.points().size(), kNone);
    is_seam_.resize(part_of.size());
    for (std::size_t p = 0; p < triangles_of.size(); ++p) {
      for (const PlaceTriangle& triangle : triangles_of[p]) {
        for (const std::uint32_t place : triangle) {
          if (part_of[place] != kNone && part_of[place] != p) is_seam_[place] = true;
          part_of[place] = p;
        }
      }
    }
  }

  void Cut(const std::vector<PlaceTriangle>& triangles, std::size_t part) {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    JoinedSets joined(places_.points().size());
    for (const auto& [a, b, c] : triangles) {
      joined.Join(a, b);
      joined.Join(a, c);
    }
    std::unordered_map<std::size_t, std::size_t> piece_of_set;
    std::fill(number_in_piece_.begin(), number_in_piece_.end(), kNone);
    for (PlaceTriangle triangle : triangles) {
      const auto [it, is_new] = piece_of_set.try_emplace(joined.SetOf(triangle[0]), pieces_.size());
      if (is_new) pieces_.emplace_back().part = part;
      ConnectedPiece& piece = pieces_[it->second];
      for (std::uint32_t& corner : triangle) {
        std::uint32_t& number = number_in_piece_[corner];
        if (number == kNone) {
          number = static_cast<std::uint32_t>(piece.mesh.vertices.size());
          piece.mesh.vertices.push_back(places_.points()[corner]);
          piece.is_held.push_back(is_seam_[corner]);
        }
        corner = number;
      }
      piece.mesh.triangles.push_back(triangle);
    }
  }

  Places places_;
  std::vector<bool> is_seam_;                   // By place.
  std::vector<std::uint32_t> number_in_piece_;  // By place.
  std::vector<ConnectedPiece> pieces_;
};

/// Whether a triangle has no more area than rounding may give it.
bool HasFlatTriangle(const Mesh& mesh) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const PlaceTriangle& triangle) {
                       const Vector3 a = mesh.vertices[triangle[0]].cast<double>();
                       const Vector3 ab = mesh.vertices[triangle[1]].cast<double>() - a;
                       const Vector3 ac = mesh.vertices[triangle[2]].cast<double>() - a;
                       const double extent_m = std::max(ab.norm(), ac.norm());
                       return ab.cross(ac).norm() <= TwiceFlatArea(extent_m);
                     });
}

/// The deviation of one mesh from the other and back, unless it is beyond the limit.
std::optional<double> DeviationBothWays_m(const Mesh& one, const Mesh& other, double limit_m) {
  const auto there_m = MeshSurface(one).DeviationWithin_m(other, limit_m);
  if (!there_m) return std::nullopt;
  const auto back_m = MeshSurface(other).DeviationWithin_m(one, limit_m);
  if (!back_m) return std::nullopt;
  return std::max(*there_m, *back_m);
}

void SimplifyPiece(const SimplifyLimits& limits, ConnectedPiece& piece) {
  SimplifyLimits tried = limits;
  // Edges are collapsed with a look at points alone, between which the surfaces may be somewhat
  // further apart.
  tried.deviation_m *= 0.7;
  constexpr int kMostTries = 4;
  for (int i = 0; i < kMostTries; ++i, tried.deviation_m /= 2.0) {
    Mesh made = CollapseEdges(piece.mesh, piece.is_held, tried);
    if (made.triangles.size() >= piece.mesh.triangles.size()) return;
    if (made.triangles.empty() || HasFlatTriangle(made)) continue;
    const auto deviation_m = DeviationBothWays_m(made, piece.mesh, limits.deviation_m);
    if (!deviation_m) continue;
    piece.mesh = std::move(made);
    piece.deviation_m = *deviation_m;
    piece.is_changed = true;
    return;
  }
}

/// The bytes of a list, for a hash.
template <class T>
std::string_view BytesOf(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// What tells the results of SimplifiedOnce() apart.
struct SimplifyKey {
  std::vector<std::size_t> hashes_and_sizes;
  double deviation_m{};
  double normal_deg{};

  SimplifyKey(const std::vector<Mesh>& parts, const SimplifyLimits& limits)
      : deviation_m(limits.deviation_m), normal_deg(limits.normal_deg) {
    const std::hash<std::string_view> hash;
    for (const Mesh& part : parts) {
      hashes_and_sizes.insert(hashes_and_sizes.end(),
                              {hash(BytesOf(part.vertices)), part.vertices.size(),
                               hash(BytesOf(part.triangles)), part.triangles.size()});
    }
  }
  bool operator==(const SimplifyKey&) const = default;
};

/// What SimplifiedOnce() has made, newest first.
class MadeMeshes {
 public:
  std::shared_ptr<const SimplifiedParts> Of(const std::vector<Mesh>& parts,
                                            const SimplifyLimits& limits) {
    const SimplifyKey key(parts, limits);
    // Others wait, who may want the same.
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(made_.begin(), made_.end(),
                                    [&](const auto& entry) { return entry.first == key; });
    if (found != made_.end()) return found->second;
    std::shared_ptr<const SimplifiedParts> made;
    // This thread must not begin other work while it has the lock: that may want a mesh, too.
    tbb::this_task_arena::isolate(
        [&] { made = std::make_shared<const SimplifiedParts>(Simplified(parts, limits)); });
    made_.emplace_front(key, made);
    constexpr std::size_t kMostKept = 64;
    if (made_.size() > kMostKept) made_.pop_back();
    return made;
  }

 private:
  std::mutex mutex_;
  std::deque<std::pair<SimplifyKey, std::shared_ptr<const SimplifiedParts>>> made_;
};

}  // namespace

SimplifiedParts Simplified(const std::vector<Mesh>& parts, const SimplifyLimits& limits) {
  std::vector<ConnectedPiece> pieces = PieceCutter(parts).Take();
  tbb::parallel_for(std::size_t{0}, pieces.size(),
                    [&](std::size_t i) { SimplifyPiece(limits, pieces[i]); });
  std::vector<bool> is_changed(parts.size());
  for (const ConnectedPiece& piece : pieces) {
    if (piece.is_changed) is_changed[piece.part] = true;
  }
  SimplifiedParts simplified{.parts = std::vector<Mesh>(parts.size())};
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!is_changed[p]) simplified.parts[p] = parts[p];
  }
  for (const ConnectedPiece& piece : pieces) {
    if (is_changed[piece.part]) simplified.parts[piece.part].Append(piece.mesh);
    simplified.deviation_m = std::max(simplified.deviation_m, piece.deviation_m);
  }
  return simplified;
}

std::shared_ptr<const SimplifiedParts> SimplifiedOnce(const std::vector<Mesh>& parts,
                                                      const SimplifyLimits& limits) {
  static MadeMeshes made;
  return made.Of(parts, limits);
}

}  // namespace railcast
