#include "analysis/stats/plane_patches.h"

#include <pcl/features/normal_3d.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_plane.h>
#include <pcl/features/impl/normal_3d.hpp>
#include <pcl/sample_consensus/impl/ransac.hpp>
#include <pcl/sample_consensus/impl/sac_model_plane.hpp>

#include <algorithm>
#include <numbers>
#include <optional>
#include <utility>

#include "analysis/estimate/estimate.h"
#include "analysis/estimate/streams.h"
#include "core/io/recording/range_step.h"
#include "core/points/nearest_points.h"
#include "core/points/point_alignment.h"
#include "core/points/point_spread.h"

namespace railcast {
namespace {

constexpr std::size_t kLeastPoints = 12;
constexpr std::size_t kNearestPoints = 25;
constexpr double kMostIncidence_rad = std::numbers::pi / 3.0;

struct PatchPoint {
  Vector3 position_m = Vector3::Zero();
  double intensity{};
  std::size_t slot{};
};
using Points = std::vector<PatchPoint>;

/// A plane through `middle`.
struct Plane {
  Vector3 middle = Vector3::Zero();
  Vector3 normal = Vector3::UnitZ();
};

// Least squares: the normal is the direction in which the points vary least.
Plane FitPlane(const Points& points) {
  std::vector<Eigen::Vector3f> places_m;
  for (const PatchPoint& point : points) places_m.emplace_back(point.position_m.cast<float>());
  const PointSpread spread = SpreadOf(places_m);
  return {.middle = spread.mean_m, .normal = spread.axes.col(0)};
}

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

// Coordinates are relative to the middle, since PCL computes in float32.
PclCloud::Ptr CloudAbout(const Points& points, const Vector3& middle) {
  const auto cloud = std::make_shared<PclCloud>();
  for (const PatchPoint& point : points) {
    const Eigen::Vector3f near = (point.position_m - middle).cast<float>();
    cloud->emplace_back(near.x(), near.y(), near.z());
  }
  return cloud;
}

// If four points in five agree, half of all triples are free of outliers: 20 tries all fail once in
// a million times.
constexpr int kMaxTries = 20;

// Wide enough for the noise of any known sensor; the next step is stricter.
double AgreementThreshold_m(double range_m) {
  return 0.05 + 5e-4 * range_m;
}

// The plane that most points agree on.
std::optional<Plane> AgreedPlane(const Points& points, double range_m) {
  Plane plane;
  for (const PatchPoint& point : points) plane.middle += point.position_m;
  plane.middle /= static_cast<double>(points.size());
  DropPclMessages();
  const auto model = std::make_shared<pcl::SampleConsensusModelPlane<pcl::PointXYZ>>(
      CloudAbout(points, plane.middle));
  pcl::RandomSampleConsensus<pcl::PointXYZ> consensus(model, AgreementThreshold_m(range_m));
  consensus.setMaxIterations(kMaxTries);
  if (!consensus.computeModel()) return std::nullopt;
  Eigen::VectorXf found;
  consensus.getModelCoefficients(found);
  plane.normal = found.head<3>().cast<double>().normalized();
  plane.middle -= plane.normal * static_cast<double>(found[3]);
  return plane;
}

// The angle between a normal and an axis, neither of which has a sign.
double AngleBetween_rad(const Vector3& normal, const Vector3& other) {
  return std::atan2(normal.cross(other).norm(), std::abs(normal.dot(other)));
}

double NormalsSpread_rad(const PclCloud::Ptr& cloud, const Vector3& normal) {
  constexpr int kNeighbours = 12;
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setKSearch(kNeighbours);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  double squares = 0.0;
  for (const pcl::Normal& its : normals) {
    squares += std::pow(AngleBetween_rad(its.getNormalVector3fMap().cast<double>(), normal), 2);
  }
  return std::sqrt(squares / static_cast<double>(normals.size()));
}

PclPlane PclPlaneOf(const Points& points, const Plane& ours) {
  constexpr double kMostDeviations = 5.0;
  const PclCloud::Ptr cloud = CloudAbout(points, ours.middle);
  const auto model = std::make_shared<pcl::SampleConsensusModelPlane<pcl::PointXYZ>>(cloud);
  pcl::RandomSampleConsensus<pcl::PointXYZ> consensus(model,
                                                      AgreementThreshold_m(ours.middle.norm()));
  consensus.setMaxIterations(kMaxTries);
  PclPlane found;
  if (!consensus.computeModel()) return found;
  pcl::Indices inliers;
  Eigen::VectorXf plane;
  consensus.getInliers(inliers);
  consensus.getModelCoefficients(plane);
  // Not by refineModel(), which takes distances from planes for their squares.
  double variance_m2 = 0.0;
  for (int pass = 0; pass < 2; ++pass) {
    model->optimizeModelCoefficients(inliers, Eigen::VectorXf(plane), plane);
    std::vector<double> squares_m2;
    model->getDistancesToModel(plane, squares_m2);
    for (double& square_m2 : squares_m2) square_m2 *= square_m2;
    variance_m2 = model->computeVariance(squares_m2);
    model->selectWithinDistance(plane, kMostDeviations * std::sqrt(variance_m2), inliers);
    if (inliers.size() < kLeastPoints) return found;
  }
  const auto num = static_cast<double>(points.size());
  const Vector3 normal = plane.head<3>().cast<double>().normalized();
  found.sigma_m = std::sqrt(variance_m2 * num / (num - 3.0));
  found.num_outliers = points.size() - inliers.size();
  found.turn_rad = AngleBetween_rad(normal, ours.normal);
  found.normals_rad = NormalsSpread_rad(std::make_shared<PclCloud>(*cloud, inliers), normal);
  return found;
}

// The points within 5 robust standard deviations of the plane, of which rounding alone makes a
// part.
Points WithoutOutliers(const Points& points, const Plane& plane, double step_m) {
  constexpr double kMostDeviations = 5.0;
  constexpr double kPrecision_m = 1e-5;  // Precision of float32 coordinates at 100 m.
  const double least_m = std::max(kPrecision_m, step_m / std::sqrt(12.0));
  std::vector<double> distances_m;
  const auto distance_m = [&](const PatchPoint& point) {
    return plane.normal.dot(point.position_m - plane.middle);
  };
  for (const PatchPoint& point : points) distances_m.push_back(distance_m(point));
  const double most_m = kMostDeviations * std::max(PlainRobustScale(distances_m), least_m);
  Points kept;
  for (const PatchPoint& point : points) {
    if (std::abs(distance_m(point)) <= most_m) kept.push_back(point);
  }
  return kept;
}

// A plane can also be fitted through the crown of a tree, but no sensor has such large errors.
bool IsFlat(const Points& points, const Plane& plane) {
  const double most_m = 0.1 + 5e-4 * plane.middle.norm();
  double squares_m2 = 0.0;
  for (const PatchPoint& point : points) {
    const double distance_m = plane.normal.dot(point.position_m - plane.middle);
    squares_m2 += distance_m * distance_m;
  }
  return squares_m2 < most_m * most_m * static_cast<double>(points.size());
}

// @pre There are at least kLeastPoints points.
std::optional<FlatPiece> MakePiece(const Points& points, double step_m) {
  constexpr double kLeastShare = 0.8;
  const auto agreed = AgreedPlane(points, points[points.size() / 2].position_m.norm());
  if (!agreed) return std::nullopt;
  Plane plane = *agreed;
  Points kept;
  for (int pass = 0; pass < 2; ++pass) {
    kept = WithoutOutliers(points, plane, step_m);
    const auto num = static_cast<double>(kept.size());
    const bool is_enough =
        kept.size() >= kLeastPoints && num >= kLeastShare * static_cast<double>(points.size());
    if (!is_enough) return std::nullopt;
    plane = FitPlane(kept);
  }
  if (!IsFlat(kept, plane)) return std::nullopt;
  FlatPiece piece;
  for (const PatchPoint& point : points) piece.slots_about.push_back(point.slot);
  piece.middle_m = plane.middle;
  piece.normal = plane.normal;
  PlanePatch& patch = piece.patch;
  const double cosine = std::abs(plane.normal.dot(plane.middle.normalized()));
  patch.incidence_rad = std::acos(std::min(1.0, cosine));
  if (patch.incidence_rad >= kMostIncidence_rad) return std::nullopt;
  patch.range_m = plane.middle.norm();
  patch.step_m = step_m;
  patch.num_points = kept.size();
  patch.num_outliers = points.size() - kept.size();
  Moments intensities;
  for (const PatchPoint& point : kept) {
    const double square_m = plane.normal.dot(point.position_m - plane.middle);
    const double along_m = square_m / plane.normal.dot(point.position_m.normalized());
    intensities.Add(point.intensity);
    piece.slots.push_back(point.slot);
    patch.plane_squares_m2 += square_m * square_m;
    patch.range_squares_m2 += along_m * along_m;
  }
  patch.intensity = intensities.PlainMean();
  return piece;
}

Vector3 PointAt(const Frame& frame, std::size_t slot) {
  return {static_cast<double>(frame.x[slot]), static_cast<double>(frame.y[slot]),
          static_cast<double>(frame.z[slot])};
}

/// Half sizes of a neighbourhood in the grid.
struct Window {
  std::size_t rows{};
  std::size_t columns{};
};

// About 25 points, roughly as high as wide as far as the grid allows.
Window WindowOf(const ScanTable& scan) {
  constexpr double kFineRow_rad = 0.6 * std::numbers::pi / 180.0;
  constexpr double kHalfWidth_rad = kFineRow_rad;
  const bool is_fine = scan.row_step_rad < kFineRow_rad && scan.rows >= 5;
  const double columns = std::round(kHalfWidth_rad / scan.column_step_rad);
  return {is_fine ? 2U : 1U,
          static_cast<std::size_t>(std::clamp(columns, is_fine ? 2.0 : 4.0, 6.0))};
}

void Gather(const RecordedFrame& recorded, std::size_t slot, Points& points) {
  const Frame& frame = recorded.frame;
  if (!HasSurfacePoint(recorded, slot)) return;
  points.push_back({PointAt(frame, slot), static_cast<double>(frame.intensity[slot]), slot});
}

std::vector<FlatPiece> FindInGrid(const RecordedFrame& recorded, const ScanTable& scan) {
  const Frame& frame = recorded.frame;
  const Window half = WindowOf(scan);
  const std::size_t height = 2 * half.rows + 1;
  const std::size_t width = 2 * half.columns + 1;
  std::vector<FlatPiece> pieces;
  if (frame.rows < height || frame.columns < width) return pieces;
  const std::size_t num_rows = frame.rows - height + 1;
  const std::size_t num_columns = frame.columns - width + 1;
  // Steps of the golden ratio spread any number of places evenly over the grid.
  constexpr double kGolden = 0.6180339887498949;
  const std::size_t num_places = num_rows * num_columns;
  // Places without a flat neighbourhood cost little time, so more are tried than needed.
  constexpr std::size_t kTries = 6 * kMaxPatches;
  const double step_m = RangeStep_m(recorded);
  for (std::size_t i = 0; i < std::min(kTries, num_places) && pieces.size() < kMaxPatches; ++i) {
    const double turn = kGolden * static_cast<double>(i + 1 + kTries * (frame.index % 1024U));
    const auto place =
        static_cast<std::size_t>((turn - std::floor(turn)) * static_cast<double>(num_places));
    const std::size_t row = place / num_columns;
    const std::size_t column = place % num_columns;
    Points points;
    for (std::size_t r = row; r < row + height; ++r) {
      for (std::size_t c = column; c < column + width; ++c) {
        const auto beside = scan.ColumnBeside(row + half.rows, c, r);
        if (beside) Gather(recorded, r * frame.width() + *beside * frame.returns, points);
      }
    }
    if (points.size() * 4 < height * width * 3 || points.size() < kLeastPoints) continue;
    if (auto piece = MakePiece(points, step_m)) pieces.push_back(std::move(*piece));
  }
  return pieces;
}

std::vector<FlatPiece> FindInCloud(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  std::vector<Eigen::Vector3f> points_m;
  std::vector<std::size_t> slots;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!HasSurfacePoint(recorded, slot)) continue;
    points_m.emplace_back(frame.x[slot], frame.y[slot], frame.z[slot]);
    slots.push_back(slot);
  }
  std::vector<FlatPiece> pieces;
  if (slots.size() < kNearestPoints) return pieces;
  const NearestSearch search(points_m);
  const std::size_t stride = std::max<std::size_t>(1, slots.size() / kMaxPatches);
  std::vector<std::uint32_t> found;
  const double step_m = RangeStep_m(recorded);
  for (std::size_t i = frame.index % stride; i < slots.size(); i += stride) {
    search.FindNearest(points_m[i], kNearestPoints, found);
    Points points;
    for (const std::uint32_t k : found) Gather(recorded, slots[k], points);
    if (auto piece = MakePiece(points, step_m)) pieces.push_back(std::move(*piece));
  }
  return pieces;
}

}  // namespace

std::vector<FlatPiece> FindFlatPieces(const RecordedFrame& recorded, const ScanTable* scan) {
  if (!recorded.is_grid) return FindInCloud(recorded);
  if (scan == nullptr) return {};
  return FindInGrid(recorded, *scan);
}

std::vector<PlanePatch> FindPlanePatches(const RecordedFrame& recorded, const ScanTable* scan) {
  std::vector<PlanePatch> patches;
  for (const FlatPiece& piece : FindFlatPieces(recorded, scan)) {
    Points points;
    for (const std::size_t slot : piece.slots_about) Gather(recorded, slot, points);
    patches.push_back(piece.patch);
    patches.back().by_pcl = PclPlaneOf(points, {.middle = piece.middle_m, .normal = piece.normal});
  }
  return patches;
}

}  // namespace railcast
