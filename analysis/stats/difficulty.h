#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>

#include "analysis/report/report.h"
#include "analysis/stats/bins.h"
#include "core/io/recording/scan_table.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Share of an object's box outside the field of view in which a sensor fires: of its volume, at
/// 5 x 5 x 5 places. What lies beyond the sensor's range does not count.
[[nodiscard]] double TruncationOf(const RecordedObject& object, const ScanTable& scan);

/// The grades of KITTI's object benchmark (Geiger, Lenz and Urtasun 2012, CVPR; thresholds of its
/// evaluate_object.cpp), each without those of the grades before it, of objects with points.
///
///               height in the image   occluded   truncated
///   easy        >= 40 px              level 0    <= 0.15
///   moderate    >= 25 px              up to 1    <= 0.30
///   hard        >= 25 px              up to 2    <= 0.50
///
/// A lidar has no image: the height is that in an image of KITTI's camera (focal length 721.5 px)
/// that looks at the object; the levels of occlusion begin at hidden shares of 0.1 and 0.5, as in
/// scripts/export_kitti_objects.py; and an object is truncated by the sensor's field of view.
enum class KittiGrade : std::uint8_t { kEasy, kModerate, kHard, kHarder, kNoPoints };
[[nodiscard]] KittiGrade KittiGradeOf(const RecordedObject& object, double truncation);

/// How hard the objects are to detect, as data sets grade them: objects in frames, and the points
/// on them, by grade. Only objects that some beam would meet if nothing hid them count.
class Difficulty {
 public:
  /// How objects are divided into grades.
  enum class Scale : std::uint8_t { kKitti, kOcclusion, kTruncation, kPoints };
  static constexpr std::size_t kNumScales = 4;
  static constexpr std::size_t kMostGrades = 5;

  struct Count {
    std::uint64_t objects{};
    std::uint64_t points{};
    RangeCounts by_distance{};  ///< Objects.

    static auto Sums(auto& of) { return std::tie(of.objects, of.points, of.by_distance); }
  };
  /// The grades of each scale, the first ones easiest.
  using Counts = std::array<std::array<Count, kMostGrades>, kNumScales>;

  /// @param scan Of the frame; null if it is not a grid: then truncation is not known, and grades
  ///   that ask for it take it as 0.
  void Add(const RecordedFrame& recorded, const ScanTable* scan);
  static auto Sums(auto& of) { return std::tie(of.by_label_); }

  [[nodiscard]] bool is_empty() const { return by_label_.empty(); }
  [[nodiscard]] const std::map<std::string, Counts>& by_label() const { return by_label_; }
  [[nodiscard]] Section MakeSection() const;

 private:
  std::map<std::string, Counts> by_label_;
};

/// Shares of the classes among objects with points, by OSDaR23's names, beside those among
/// OSDaR23's own cuboids (osdar23_cuboids.json). Defined in osdar_balance.cpp.
[[nodiscard]] Section MakeOsdarBalanceSection(const Difficulty& objects, const LabelTable& labels);

}  // namespace railcast
