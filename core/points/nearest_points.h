#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace railcast {

/// For every point of one cloud, the nearest point of another cloud.
struct NearestPoints {
  std::vector<float> distance_m;
  std::vector<std::uint32_t> index;  ///< Index of the nearest point in the other cloud.
};

/// Finds the exact nearest points of a cloud with PCL's kd-tree (FLANN). Several threads may search
/// one cloud at a time.
///
/// @code
/// const NearestSearch search(points_m);
/// std::vector<std::uint32_t> five;
/// search.FindNearest(points_m[0], 5, five);  // five[0] == 0
/// @endcode
class NearestSearch {
 public:
  /// @pre `points_m` is not empty, and all its coordinates are finite.
  explicit NearestSearch(std::vector<Eigen::Vector3f> points_m);
  ~NearestSearch();
  NearestSearch(NearestSearch&&) noexcept;
  NearestSearch& operator=(NearestSearch&&) noexcept;

  [[nodiscard]] const std::vector<Eigen::Vector3f>& points_m() const;

  /// Searches in parallel; the result does not depend on the number of threads.
  [[nodiscard]] NearestPoints Of(const std::vector<Eigen::Vector3f>& queries_m) const;
  /// Replaces `found` by the indices of the `num` points nearest to `place_m`, the nearest first;
  /// by all of them where there are fewer.
  void FindNearest(const Eigen::Vector3f& place_m,
                   std::size_t num,
                   std::vector<std::uint32_t>& found) const;
  /// Replaces `found` by the indices of all points less than `radius_m` from `place_m`, the nearest
  /// first.
  void FindWithin(const Eigen::Vector3f& place_m,
                  float radius_m,
                  std::vector<std::uint32_t>& found) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace railcast
