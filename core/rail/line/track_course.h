#pragma once

#include <memory>
#include <vector>

#include "railcast/alignment.h"
#include "railcast/transform.h"

namespace railcast {

/// A section of the line.
struct ChainageRange {
  double begin_s_m{};
  double end_s_m{};
};

class PlanCourse;
struct SharedPlane;

/// The lateral offset of a track from the alignment, left positive, as a function of chainage: its
/// value and its first two derivatives.
struct TrackOffset {
  double d_m{};
  double slope{};
  double bend_per_m{};

  /// Curvature in the plane of chainage and offset, left positive.
  [[nodiscard]] double curvature_per_m() const;
};

/// Curvature in plan, left positive, of a track beside an axis of some curvature. The change of the
/// latter along the axis is neglected, which contributes less than offset x slope x that change.
[[nodiscard]] double CurvatureBeside_per_m(double axis_per_m, const TrackOffset& offset);

/// Angle of a track to the alignment at the point `axis` of the latter, left positive:
/// atan(slope / (1 - curvature d)).
[[nodiscard]] double TurnFromAlignment_rad(const AxisPoint& axis, const TrackOffset& offset);

/// How much higher than the alignment a track lies at the same chainage.
struct TrackLift {
  double h_m{};
  double slope{};  ///< Slope of h_m against the chainage.
};

/// A section of a course.
struct CoursePiece {
  enum class Kind {
    kLevel,   ///< The offset is constant.
    kSCurve,  ///< From one offset to another, with neither slope nor curvature at its ends.
    kPlan,    ///< Follows a plan course.
  };
  Kind kind{};
  double begin_s_m{};
  double end_s_m{};    ///< Where the next piece begins.
  double begin_d_m{};  ///< Level: the offset.
  double end_d_m{};    ///< S-curves only.
  /// Plan pieces only: its x is the chainage, or minus the chainage if it is mirrored; its y is the
  /// offset. It may extend beyond the piece.
  std::shared_ptr<const PlanCourse> plan;
  double plan_begin_x_m{};
  double plan_length_m{};
  bool is_mirrored{};
  /// Planes of the tracks that turnouts join to this one; null if there are none.
  std::shared_ptr<const std::vector<SharedPlane>> planes{};
};

/// The course of a track: its lateral offset from the alignment as a function of chainage. Cant is
/// that of the alignment at the same chainage, and so is the height but for the planes that it
/// shares with other tracks. Immutable, thread-safe, cheap to copy.
class TrackCourse {
 public:
  /// A track parallel to the alignment. `end_s_m` may be infinite.
  TrackCourse(double begin_s_m, double end_s_m, double offset_m);
  /// @pre `pieces` is not empty, and each begins where the one before ends. The track may begin
  ///   within the first and end within the last one.
  TrackCourse(double begin_s_m, double end_s_m, std::vector<CoursePiece> pieces);

  [[nodiscard]] double begin_s_m() const { return begin_s_m_; }
  [[nodiscard]] double end_s_m() const { return end_s_m_; }
  [[nodiscard]] const std::vector<CoursePiece>& pieces() const { return *pieces_; }
  /// The offsets farthest to the right and to the left, sampled every metre where they change.
  [[nodiscard]] double least_d_m() const { return least_d_m_; }
  [[nodiscard]] double most_d_m() const { return most_d_m_; }
  /// Whether the offset is the same everywhere.
  [[nodiscard]] bool is_parallel() const;

  /// Whether the offset is the same all over a section, its ends included.
  [[nodiscard]] bool IsLevelIn(double from_s_m, double to_s_m) const;

  /// Beyond either end, the track continues straight on.
  [[nodiscard]] TrackOffset OffsetAt(double s_m) const;
  /// The offset at the chainage of the track that is nearest to `s_m`.
  [[nodiscard]] double OffsetWithin_m(double s_m) const;
  /// Curvature of the track's axis in plan, left positive (CurvatureBeside_per_m).
  [[nodiscard]] double CurvatureAt(const Alignment& alignment, double s_m) const;

  /// Counterclockwise from east, towards rising chainage.
  [[nodiscard]] double Heading_rad(const Alignment& alignment, double s_m) const;

  /// How much higher than the alignment the track lies. The changes of cant and of the other
  /// tracks' headings along the line are neglected in its slope.
  [[nodiscard]] TrackLift LiftAt(const Alignment& alignment, double s_m) const;

  /// The same course, which shares the planes of other tracks.
  [[nodiscard]] TrackCourse InPlanes(std::vector<SharedPlane> planes) const;

  /// The track frame at chainage `s_m`: x along the track's own heading, y left, z up, with the
  /// track's gradient and the cant of the alignment there. The origin is `h_m` above top of rail
  /// and `d_m` left of the track's axis, measured horizontally.
  [[nodiscard]] Transform WorldFromTrack(const Alignment& alignment,
                                         double s_m,
                                         double d_m = 0.0,
                                         double h_m = 0.0) const;

 private:
  [[nodiscard]] const CoursePiece& PieceAt(double s_m) const;

  double begin_s_m_{};
  double end_s_m_{};
  std::shared_ptr<const std::vector<CoursePiece>> pieces_;
  TrackOffset at_begin_;  ///< Not of parallel tracks.
  TrackOffset at_end_;    ///< Not of parallel tracks, either.
  double least_d_m_{};
  double most_d_m_{};
};

/// A turnout lies in the canted plane of the track in which it was built: so does its branch, which
/// then returns to its own height, or passes to the plane of the turnout at its other end.
struct SharedPlane {
  TrackCourse track;
  double whole_s_m{};  ///< Up to this chainage, from its turnout on, the course lies in the plane.
  double none_s_m{};   ///< From this chainage on, the plane does not matter.
};

/// Follows one course up to `s_m` and another from there on.
[[nodiscard]] TrackCourse Joined(const TrackCourse& before, const TrackCourse& after, double s_m);

/// The length of a track's axis in space as a function of chainage. The two differ because chainage
/// is that of the alignment, in plan: beside a curve of radius R they do by offset / R, over a
/// gradient of 40 permil by 0.8 permil.
///
/// Between its samples every metre, the length is that of the chord: too short by 1 / (24 R^2) of
/// itself, 0.04 mm over 20 m at R = 150 m. Beyond the ends of the track, chainage is length.
class TrackLength {
 public:
  /// @pre The course has an end.
  TrackLength(const Alignment& alignment, const TrackCourse& course);
  /// For a stretch of the course, whose ends take the place of the track's.
  TrackLength(const Alignment& alignment,
              const TrackCourse& course,
              double begin_s_m,
              double end_s_m);

  /// The chainage that lies `length_m` of track from another one, towards rising chainage if it is
  /// positive.
  [[nodiscard]] double MovedFrom(double s_m, double length_m) const;
  /// The length of the track between its beginning and a chainage.
  [[nodiscard]] double UpTo(double s_m) const;
  [[nodiscard]] double total_m() const { return lengths_m_.back(); }

 private:
  double begin_s_m_{};
  double step_m_{};
  std::vector<double> lengths_m_;  ///< Up to each sample; strictly ascending.
};

}  // namespace railcast
