#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "generator/extras/survey/survey_beams.h"

namespace railcast {

/// How far the neighbours of each beam are from it, as angles: the greater of the distances along
/// and across the horizon. Where beams without a point lie between, at most kMostOfTypical times
/// the median of the frame. Empty if the beams' origins are not known.
[[nodiscard]] std::vector<float> SpacingsOf_rad(const SurveyFrame& frame);

inline constexpr float kMostOfTypical = 2.0F;

/// The points of a small cube, as their sums.
struct SurveyVoxel {
  Eigen::Vector3f sum_m = Eigen::Vector3f::Zero();  ///< From the cloud's origin plus `corner_m`.
  std::array<std::int32_t, 3> cell{};
  std::uint32_t num_points = 0;
  float reflectance_sum = 0.0F;
  std::uint32_t num_reflectances = 0;
  /// Sum of the unit vectors towards the sensor; 0 where it is not known.
  Eigen::Vector3f view_sum = Eigen::Vector3f::Zero();
  /// How far apart neighbouring beams are here, across them, of the frame in which they are nearest
  /// to each other; 0 where it is not known.
  float spacing_m = 0.0F;
  std::uint32_t first_frame = 0;  ///< Counted in the survey.
  std::uint32_t last_frame = 0;
  std::uint32_t num_frames = 0;
  std::uint16_t label = SurveyLabels::kUnknown;  ///< Label of the majority, where there is one.
  std::uint16_t label_lead = 0;
};

/// All frames' points, thinned to one in each cube of a grid: memory grows with what was seen, not
/// with how often.
class SurveyVoxels {
 public:
  explicit SurveyVoxels(double edge_m) : edge_m_(edge_m) {}

  /// @throws InputError if a point is too far from the first one.
  void Add(const SurveyFrame& frame, std::uint32_t frame_index);

  [[nodiscard]] const std::vector<SurveyVoxel>& voxels() const { return voxels_; }
  [[nodiscard]] double edge_m() const { return edge_m_; }
  /// The mean of the voxel's points, in the world.
  [[nodiscard]] Vector3 MeanOf(const SurveyVoxel& voxel) const;

 private:
  double edge_m_;
  Vector3 origin_m_ = Vector3::Zero();
  std::vector<SurveyVoxel> voxels_;
  std::unordered_map<std::uint64_t, std::uint32_t> index_of_cell_;
};

}  // namespace railcast
