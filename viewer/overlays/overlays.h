#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/io/recording/scan_table.h"
#include "core/track/found_track.h"
#include "railcast/frame.h"
#include "railcast/io/recording.h"
#include "railcast/lidar.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "railcast/scene.h"
#include "railcast/transform.h"
#include "viewer/color/palette.h"

namespace railcast {

/// Lines and words over a cloud, in the sensor's axes at the frame's stamp, metres.
struct Overlay {
  struct Segment {
    Eigen::Vector3f from_m;
    Eigen::Vector3f to_m;
    Rgb rgb{};
    float opacity = 1.0F;
  };
  struct Word {
    Eigen::Vector3f at_m;
    std::string text;
    Rgb rgb{};
  };
  std::vector<Segment> segments;
  std::vector<Word> words;
};

/// The world about the sensor, from a scenario.
struct Surroundings {
  ScenarioSpec scenario;  ///< Scenario of one sensor.
  std::shared_ptr<const RailWorld> world;
};

/// Draws the sensor's axes, each 2 m long with its letter: x vermillion, y bluish green, z blue.
/// These pass for red, green and blue and can be told apart with any kind of colour vision.
[[nodiscard]] Overlay DrawAxes();

/// Draws circles of 10, 25, 50, 100, 150, 200 and 300 m radius about the sensor, up to `limit_m`,
/// as chords within 1 cm of the circle, with the radius ("50 m") straight ahead and behind.
/// @param mount Where the sensor sits on its vehicle, if that is known: the circles then lie in the
///   vehicle's plane at top of rail about the point below the sensor, and ahead is the vehicle's
///   heading. Otherwise they lie in the sensor's own plane z = 0.
[[nodiscard]] Overlay DrawRangeRings(double limit_m, const std::optional<MountSpec>& mount);

/// Boxes whose centre is farther than this from the sensor are left out.
inline constexpr double kMostBoxRange_m = 400.0;

/// Draws the boxes of a frame's objects where their points are shown (RecordedMotion::BoxOf), in
/// the order in which the frame lists them: twelve edges, a nose
/// of two more segments before the front face to show the heading, and the name at the middle of
/// the top. They have the colour of the object's label, or white where `labels` does not have it.
[[nodiscard]] Overlay DrawObjectBoxes(const RecordedFrame& recorded, const LabelTable& labels);

/// A longer frustum would reach out of sight and hide what is in it.
inline constexpr double kMostFrustumRange_m = 100.0;

/// Draws the outline of what a sensor scans, in its axes, out to `range_m` or 100 m, whichever is
/// less.
///
/// For a part of a turn: rays along the four corners, and at their ends the border made of the top
/// and bottom rows and the first and last columns. For a full turn: the circles of the top and
/// bottom rows with eight rays each. Chords go from beam to beam. A table made from a frame does
/// not know outer rows and columns without any return (the sky); the outermost known ones are used
/// instead.
/// @param table MakeScanTable() of the scenario's pattern, or of a frame where there is none.
[[nodiscard]] Overlay DrawSensorFrustum(const ScanTable& table, double range_m);

inline constexpr double kClearSpaceBehind_m = 10.0;
inline constexpr double kClearSpaceAhead_m = 150.0;

/// Draws ClearSpace() along the vehicle's track, as far as the track extends, from 10 m behind the
/// vehicle to 150 m ahead: rings at every 10 m of chainage and the edges of the corners between
/// them, within 5 mm of curves and leaning with the cant. Empty if the frame has no pose.
[[nodiscard]] Overlay DrawClearSpace(const Surroundings& surroundings,
                                     const RecordedFrame& recorded);

inline constexpr double kAxisBehind_m = 50.0;
inline constexpr double kAxisAhead_m = 400.0;

/// Draws the axis of the vehicle's track at top of rail, as far as the track extends, from 50 m
/// behind the vehicle to 400 m ahead of it: a line within 5 mm of the axis in all curves of 25 m
/// radius or more, with a cross tick at every 10 m of chainage and a longer one at every 50 m. At
/// the left end of the long ticks stands the chainage as railways write it, "km 12.350". Empty if
/// the frame has no pose.
[[nodiscard]] Overlay DrawTrackAxis(const Surroundings& surroundings,
                                    const RecordedFrame& recorded);

/// Draws the tracks that a frame itself shows, for recordings without a scenario: both heads and,
/// along the track that is nearest to the sensor, a cross tick every 5 m with the distance from the
/// sensor, as far as the heads are seen.
[[nodiscard]] Overlay DrawFoundTracks(const std::vector<FoundTrack>& tracks);

// The strokes that overlays are made of, from positions in double precision in the sensor's axes.

inline void AddSegment(const Vector3& from_m, const Vector3& to_m, Rgb rgb, Overlay& drawing) {
  drawing.segments.push_back(
      {.from_m = from_m.cast<float>(), .to_m = to_m.cast<float>(), .rgb = rgb});
}

/// Adds segments from each point to the next.
inline void AddPolyline(const std::vector<Vector3>& points_m, Rgb rgb, Overlay& drawing) {
  for (std::size_t i = 1; i < points_m.size(); ++i) {
    AddSegment(points_m[i - 1], points_m[i], rgb, drawing);
  }
}

inline void AddWord(const Vector3& at_m, std::string text, Rgb rgb, Overlay& drawing) {
  drawing.words.push_back({at_m.cast<float>(), std::move(text), rgb});
}

/// Returns a chainage as plans and track axes show it: "km 1.250".
[[nodiscard]] std::string ChainageText(double s_m);

/// Returns the multiples of `step_m` between two chainages.
[[nodiscard]] std::vector<double> WholeChainages_m(double from_s_m, double to_s_m, double step_m);

/// Direction and time of each firing of a grid, including those without a return, at row * columns
/// + column.
struct Beams {
  std::uint32_t rows{};
  std::uint32_t columns{};
  /// Unit vectors in the sensor's axes at the firing; NaN where unknown.
  std::vector<Eigen::Vector3f> directions;
  std::vector<std::uint32_t> times_ns;  ///< Time since the stamp.
};

/// Takes the beams exactly from the scenario's pattern.
[[nodiscard]] Beams BeamsOf(const ScanPattern& pattern);

/// Estimates the directions from the frame's own points (MakeScanTable()) and takes its times.
/// Empty if its slots are not firings, or not a grid of at least 2 x 2 with points.
[[nodiscard]] std::optional<Beams> BeamsOf(const RecordedFrame& recorded);

/// Range at which the segments of empty beams begin, away from the sensor, where all of them meet.
inline constexpr double kEmptyBeamStart_m = 2.0;
/// Range at which they end if it is not known what the beam hit.
inline constexpr double kEmptyBeamStub_m = 12.0;

/// Opacity of beams that hit something, and of beams that hit nothing, of which there are many.
inline constexpr float kLostBeamOpacity = 0.2F;
inline constexpr float kOpenBeamOpacity = 0.012F;

/// Draws the fan of a frame's firings without a return: one segment along each, in the order of
/// their slots, in the colour of its outcome (viewer/color/palette.h), or of `kUnknownOutcomeRgb`
/// where the recording has no outcomes. A segment goes from 2 m to the true range of what was hit
/// and not detected; where that is not known, or nothing was hit, it goes to 12 m: long enough to
/// show the fan, short enough to leave the scene clear. For hits nearer than 2 m (on the ego
/// vehicle, or below the minimum range of the sensor) the segment begins at the sensor.
///
/// Segments are turned from the sensor's axes at the firing into those at the stamp (ScanMotion),
/// as the points are. The overlay is empty if the frame's slots are not firings; firings of unknown
/// direction are left out.
/// @pre `beams` has the frame's rows and columns.
[[nodiscard]] Overlay DrawEmptyBeams(const RecordedFrame& recorded, const Beams& beams);

/// Surfaces of the scene are shown up to this distance from the sensor.
inline constexpr double kSceneRange_m = 150.0;
/// Sleepers and ballast have a shorter limit, because 150 m of them are half a million triangles.
inline constexpr double kTrackBedRange_m = 50.0;

/// The standing scene about a vehicle that is anywhere in one chunk of the line: the ground, rails,
/// sleepers and ballast, and the contact line with its masts.
///
/// Trees and grass are left out, because their leaves are nine tenths of all triangles (8 of 9
/// million in scenarios/st_gallen_approach.json), and so are the sleepers' fastenings, another
/// quarter of a million. Triangles beyond kSceneRange_m or kTrackBedRange_m of every such vehicle
/// are left out, too.
struct StandingScene {
  Transform world_from_home = Transform::Identity();  ///< Frame of the chunk.
  std::vector<Part> parts;  ///< In the chunk's frame, one per label and material.
};

/// The result depends only on the chunk (RailWorld::HomeChunk()), so it can be kept as long as the
/// vehicle is in it.
[[nodiscard]] StandingScene GatherStandingScene(const Surroundings& surroundings, int home_chunk);

/// Returns the scenario's objects where they are at the stamp, in the sensor's axes then, one part
/// per label and material. The sensor's own vehicle and objects whose origin is beyond
/// kSceneRange_m are left out. Empty if the frame has no pose.
[[nodiscard]] std::vector<Part> GatherSceneObjects(const Surroundings& surroundings,
                                                   const RecordedFrame& recorded);

}  // namespace railcast
