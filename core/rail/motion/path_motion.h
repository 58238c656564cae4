#pragma once

#include <vector>

#include "railcast/objects.h"

namespace railcast {

/// Progress along a path as a function of time, in closed form.
///
/// The object sets off from rest, travels each stretch at its speed and stops at points where it
/// waits and at the last one. It changes its speed at the path's constant acceleration: up after a
/// point, down before it. One that goes to and fro turns on the spot at either end, within
/// kTurn_s or while it waits there.
class PathMotion {
 public:
  static constexpr double kTurn_s = 1.0;

  struct State {
    double along_m{};     ///< From the start of the path.
    double speed_mps{};   ///< >= 0.
    double walked_m{};    ///< Distance covered so far, to and fro.
    double turned_rad{};  ///< By which it has turned round at ends: counterclockwise.
  };

  /// @param points_along_m Distances of the points from the start, which is the first (PathCourse).
  PathMotion(const PathSpec& path, const std::vector<double>& points_along_m);

  /// @param time_s Since the object set off; before, it stands at the start.
  [[nodiscard]] State At(double time_s) const;

 private:
  struct Phase {
    double begin_s{};
    double walked_m{};
    double speed_mps{};
    double acceleration_mps2{};
    double turn_radps{};  ///< Rate at which the object turns on the spot.
    double turned_rad{};  ///< At the beginning.
  };
  struct Stretch {
    double length_m{};
    double speed_mps{};  ///< Aspired to.
    double wait_s{};     ///< At its end.
    bool stops{};        ///< At its end.
    bool turns{};        ///< At its end.
  };
  void Append(const std::vector<Stretch>& stretches, double acceleration_mps2);
  void Append(double duration_s, double acceleration_mps2, double turn_radps);

  std::vector<Phase> phases_;
  double length_m_{};
  double period_s_{};  ///< 0 = it does not turn back.
};

}  // namespace railcast
