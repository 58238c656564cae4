#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/recording/cloud_fields.h"

namespace railcast {

/// A point while its table is being made.
struct TablePoint {
  std::uint32_t index{};  ///< Index in the file.
  std::uint32_t row{};
  double turns{};  ///< Azimuth in the sense of rotation, in turns, in [0, 1).
  double range_m{};
  double from_axis_m{};
  std::int64_t column{};
};

/// Calls `visit` with the points of each row.
/// @pre Sorted by row.
template <typename Points, typename Visitor>
void ForEachRow(Points& points, Visitor&& visit) {
  for (std::size_t begin = 0; begin < points.size();) {
    std::size_t end = begin;
    while (end < points.size() && points[end].row == points[begin].row) ++end;
    visit(std::span(points).subspan(begin, end - begin));
    begin = end;
  }
}

/// How the rows of a table fire.
struct AzimuthSteps {
  double column{};  ///< From column to column, in turns; 0 if no row has neighbours.
  /// For each row, how often it fires within a column: 2 where a sensor fires some of its lasers
  /// twice as often as the others.
  std::vector<std::uint32_t> firings;

  [[nodiscard]] double OfRow(std::uint32_t row) const { return column / firings[row]; }
};

/// Finds the usual step between neighbours of each row. The columns' is the longest that rows with
/// a twentieth of the points have, refined over ever longer distances along the rows; a row fires
/// several times within a column if its own step is a half, a third or a quarter of that.
/// @pre Sorted by row and azimuth; rows are numbered up to `num_rows`.
[[nodiscard]] AzimuthSteps AzimuthStepsOf(const std::vector<TablePoint>& points,
                                          std::size_t num_rows);

/// Gives every point its column, counted in steps of its row: azimuth / step, rounded so that no
/// two firings of a row share one. For firing number i of a row, azimuth / step - i must not fall
/// from firing to firing; it is fitted by least squares under that constraint and rounded. Points
/// of nearly the same azimuth belong to one firing.
/// @pre Sorted by row and azimuth; steps.column > 0.
void AssignColumns(std::vector<TablePoint>& points, const AzimuthSteps& steps);

/// Turns each row's points to where its beam goes, if beams leave `outwards_m` from the axis: a
/// laser that looks aside sees near points at another azimuth than far ones. How far aside each
/// looks is what makes its azimuths lie at the same part of the step.
/// @pre Sorted by row; steps.column > 0.
void RemoveParallax(std::vector<TablePoint>& points, const AzimuthSteps& steps, double outwards_m);

/// Whether places without a point between two others are firings that returned nothing. They are
/// not if neighbours are often not a whole number of steps apart, nor if most gaps of one place
/// follow each other: then the row does not fire where it seems to have lost a point.
/// @pre AssignColumns().
[[nodiscard]] bool AreFiringsCertain(const std::vector<TablePoint>& points,
                                     const AzimuthSteps& steps);

/// Moves the points of each row from the columns that AssignColumns() gave it to those of the
/// rotor's turn, so that a column is a firing cycle: lasers look up to 16 deg beside each other,
/// which shows in what they have in common, the unevenness of the rotor. Rows stay as they are
/// where the rotor is even, or where two firings would share a column.
/// @pre AssignColumns(); every row fires once in a column.
void AlignCycles(std::vector<TablePoint>& points, double step, bool is_full_turn);

/// Positions of points, in arrays of equal length. Entries that are not finite, or all 0, are not
/// points.
struct PointPositions {
  std::vector<float> x, y, z;  ///< In m, with z up.

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] bool IsPoint(std::size_t i) const;
};

/// Finds the axis about which the sensor of a turn spins, wherever it points: seen from where the
/// beams leave, which may be some centimetres beside the origin, all points of a ring lie on one
/// cone about it. Of an axis, that end is taken which points up or, of one within 30 deg of level,
/// about which the sensor turns clockwise in the order of the points.
/// @returns Frame::sensor_from_spin; nothing if no axis is likely. Whether there are rings about it
///   is left to see.
[[nodiscard]] std::optional<Eigen::Matrix3d> FindSpinAxis(const PointPositions& positions);

/// The positions in axes about whose z the sensor spins.
[[nodiscard]] PointPositions InSpinAxes(PointPositions positions,
                                        const Eigen::Matrix3d& sensor_from_spin);

/// Puts the points of a spinning sensor into a ring/azimuth table where no file states their
/// firings.
///
/// Elevations and azimuths are those about z or, where that gives no table, about FindSpinAxis().
/// Rows are the rings by rising median elevation, each with a step of its own (AzimuthStepsOf()). A
/// ring that fires several times within a column makes as many rows, of one elevation and a part of
/// a column apart. A point's column is azimuth / step, rounded so that no two firings of a ring
/// share one (AssignColumns()).
/// Plain rounding would leave holes that are not dropouts, because the rotor's speed varies and
/// decoders interpolate the azimuth differently. Columns rise with time, in the sense in which most
/// neighbours of a ring follow each other in the file, or clockwise if neither sense prevails. They
/// start behind the widest gap in azimuth, or at the file's first point if the turn is full.
///
/// Firings that returned nothing to any ring are not part of the table: columns without any point
/// are left out, so that the table covers just the azimuths seen, and so are rings without points.
/// Where lasers have azimuth offsets of their own (VLP-32C, up to 4.2 deg), rings begin and end at
/// different azimuths in a partial turn.
///
/// A cell with several points has as many returns, the nearest first.
///
/// @param rings Ring of each point, as any numbers. If empty, rings are found from the elevations
///   (FindRings()).
/// @param why_not If there is no table, says why: RecordedFrame::why_no_grid.
/// @returns Nothing if there are no such clusters, if a cell has more than four points, if the
/// table
///   would be nearly empty, or if it is not certain where the sensor fired (AreFiringsCertain()).
[[nodiscard]] std::optional<SlotPlan> MakeRingTable(const PointPositions& positions,
                                                    std::span<const std::uint32_t> rings,
                                                    std::string* why_not = nullptr);

}  // namespace railcast
