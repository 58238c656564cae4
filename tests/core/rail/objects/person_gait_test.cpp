#include "core/rail/objects/person_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/rail/objects/person.h"
#include "tests/core/rail/test_tables.h"

namespace railcast {
namespace {

constexpr int kGaitPhases = 500;

struct SolePoint {
  double x_m{}, z_m{};
};

/// The corners of the sole in the person's frame.
std::vector<SolePoint> SolePoints(const BodyMeasures& body, const Transform& person_from_foot) {
  const Sole sole = SoleOf(body);
  std::vector<SolePoint> points;
  for (const Eigen::Vector2d& corner : {sole.heel_back_m, sole.heel_m, sole.ball_m, sole.tip_m}) {
    const Vector3 point_m = person_from_foot * Vector3(corner.x(), 0.0, corner.y());
    points.push_back({point_m.x(), point_m.z()});
  }
  return points;
}

std::size_t LowestOf(const std::vector<SolePoint>& points) {
  const auto lowest =
      std::min_element(points.begin(), points.end(),
                       [](const SolePoint& a, const SolePoint& b) { return a.z_m < b.z_m; });
  return static_cast<std::size_t>(lowest - points.begin());
}

/// Angle by which a bone leans forwards.
double Pitch_deg(const Transform& bone) {
  return std::atan2(-bone(0, 2), bone(2, 2)) * -180.0 / std::numbers::pi;
}

struct JointAngles {
  double hip_deg{}, knee_deg{}, ankle_deg{};
};

JointAngles LeftLeg(const PersonPose& pose) {
  const PersonPose::Limbs& limbs = pose.sides[0];
  const double thigh_deg = Pitch_deg(limbs.thigh);
  const double shank_deg = Pitch_deg(limbs.shank);
  const double foot_deg = Pitch_deg(limbs.foot);
  return {-thigh_deg, shank_deg - thigh_deg, shank_deg - foot_deg};
}

TEST(WalkingGait, DoesNotSlipOnTheStandingFoot) {
  // The corner of the sole about which it rolls stands still while the person moves on.
  const BodyMeasures body = MeasuresOf(Physique::kMan, 1.75);
  const WalkingGait gait(body, 1.3);
  const double step_m = gait.stride_length_m() / kGaitPhases;
  double most_slip = 0.0;
  for (int i = 0; i < kGaitPhases * 60 / 100; ++i) {
    const auto before = SolePoints(body, gait.PoseAt(i * step_m, 1.3).sides[0].foot);
    const auto after = SolePoints(body, gait.PoseAt((i + 1) * step_m, 1.3).sides[0].foot);
    const std::size_t corner = LowestOf(before);
    if (LowestOf(after) != corner) continue;
    most_slip = std::max(most_slip, std::abs(after[corner].x_m + step_m - before[corner].x_m));
  }
  EXPECT_LT(most_slip / step_m, 1e-9);
}

TEST(WalkingGait, TouchesTheGroundAtEveryPhaseAndSpeed) {
  for (const Physique physique : {Physique::kMan, Physique::kChild}) {
    const BodyMeasures body = MeasuresOf(physique, StandardHeight_m(physique));
    const WalkingGait gait(body, 1.2);
    for (const double speed_mps : {0.0, 0.2, 0.4, 1.2}) {
      for (int i = 0; i < kGaitPhases; ++i) {
        const PersonPose pose = gait.PoseAt(gait.stride_length_m() * i / kGaitPhases, speed_mps);
        double lowest_m = 1.0;
        for (const PersonPose::Limbs& limbs : pose.sides) {
          const auto points = SolePoints(body, limbs.foot);
          lowest_m = std::min(lowest_m, points[LowestOf(points)].z_m);
        }
        EXPECT_NEAR(lowest_m, 0.0, 1e-9) << i << " at " << speed_mps;
      }
    }
  }
}

TEST(WalkingGait, JoinsEveryShankToItsFoot) {
  const BodyMeasures body = MeasuresOf(Physique::kWoman, 1.65);
  const WalkingGait gait(body, 1.8);
  for (const double speed_mps : {0.0, 0.1, 0.3, 1.8}) {
    for (int i = 0; i < kGaitPhases; ++i) {
      const PersonPose pose = gait.PoseAt(gait.stride_length_m() * i / kGaitPhases, speed_mps);
      for (const PersonPose::Limbs& limbs : pose.sides) {
        const Vector3 ankle_m = limbs.shank * Vector3(0.0, 0.0, -body.shank_m());
        EXPECT_LT((ankle_m - limbs.foot.translation()).norm(), 1e-3) << i << " at " << speed_mps;
      }
    }
  }
}

TEST(WalkingGait, BendsItsJointsAsFarAsWinterMeasured) {
  // Winter (1991), natural cadence: hip from 11 deg of extension to 22 of flexion, knee up to 21 in
  // stance and 65 in swing, ankle up to 10 of dorsiflexion and 20 of plantarflexion. The model has
  // no toe joint and no pelvic rotation, which is why a standard deviation of 6 deg is no bound.
  const WalkingGait gait(MeasuresOf(Physique::kMan, 1.75), 1.3);
  JointAngles least{90.0, 90.0, 90.0};
  JointAngles most{-90.0, -90.0, -90.0};
  double stance_knee_deg = 0.0;
  for (int i = 0; i < kGaitPhases; ++i) {
    const double phase = static_cast<double>(i) / kGaitPhases;
    const JointAngles at = LeftLeg(gait.PoseAt(gait.stride_length_m() * phase, 1.3));
    least = {std::min(least.hip_deg, at.hip_deg), std::min(least.knee_deg, at.knee_deg),
             std::min(least.ankle_deg, at.ankle_deg)};
    most = {std::max(most.hip_deg, at.hip_deg), std::max(most.knee_deg, at.knee_deg),
            std::max(most.ankle_deg, at.ankle_deg)};
    if (phase < 0.3) stance_knee_deg = std::max(stance_knee_deg, at.knee_deg);
  }
  constexpr double kTolerance_deg = 15.0;
  EXPECT_NEAR(most.hip_deg, 22.0, kTolerance_deg);
  EXPECT_NEAR(least.hip_deg, -11.0, kTolerance_deg);
  EXPECT_NEAR(stance_knee_deg, 21.0, kTolerance_deg);
  EXPECT_NEAR(most.knee_deg, 65.0, kTolerance_deg);
  EXPECT_GE(least.knee_deg, 0.0);
  EXPECT_NEAR(most.ankle_deg, 10.0, kTolerance_deg);
  EXPECT_NEAR(least.ankle_deg, -20.0, kTolerance_deg);
}

TEST(WalkingGait, HasTheStrideOfTheWalkingRatio) {
  // Step over cadence is 0.0065 m min at 1.70 m: at 1.2 m/s, a step is sqrt(60 * 0.0065 * 1.2) m.
  const auto stride_m = [](double height_m, double speed_mps) {
    return WalkingGait(MeasuresOf(Physique::kMan, height_m), speed_mps).stride_length_m();
  };
  EXPECT_NEAR(stride_m(1.70, 1.2), 2.0 * 0.6841, 1e-4);
  // Dynamically similar at speeds as the root of the height, strides are as the height.
  EXPECT_NEAR(stride_m(0.85, 1.2 * std::sqrt(0.5)), 0.5 * stride_m(1.70, 1.2), 1e-9);
  EXPECT_NEAR(stride_m(1.70, 3.0), 0.9 * 1.70, 1e-9);
}

TEST(WalkingGait, SwingsArmsAgainstLegs) {
  const WalkingGait gait(MeasuresOf(Physique::kMan, 1.75), 1.3);
  const PersonPose pose = gait.PoseAt(0.0, 1.3);  // The left heel comes to the ground ahead.
  EXPECT_GT(pose.sides[0].foot.translation().x(), 0.25);
  EXPECT_LT(pose.sides[1].foot.translation().x(), -0.2);
  EXPECT_GT(Pitch_deg(pose.sides[0].upper_arm), 15.0) << "backwards";
  EXPECT_LT(Pitch_deg(pose.sides[1].upper_arm), -10.0) << "forwards";
  const PersonPose later = gait.PoseAt(0.5 * gait.stride_length_m(), 1.3);
  EXPECT_NEAR(later.sides[1].foot.translation().x(), pose.sides[0].foot.translation().x(), 1e-9);
}

TEST(WalkingGait, StandsWhereItWaits) {
  const BodyMeasures body = MeasuresOf(Physique::kMan, 1.75);
  const WalkingGait gait(body, 1.3);
  for (const double distance_m : {0.0, 0.3, 17.2}) {
    const PersonPose pose = gait.PoseAt(distance_m, 0.0);
    EXPECT_NEAR(pose.pelvis.translation().z(), body.hip_m, 1e-9);
    for (const PersonPose::Limbs& limbs : pose.sides) {
      EXPECT_NEAR(limbs.foot.translation().x(), 0.0, 1e-9);
      EXPECT_NEAR(limbs.foot.translation().z(), body.ankle_m, 1e-9);
    }
  }
}

TEST(WalkingPerson, MovesItsPiecesSmoothly) {
  // No foot is faster than five times the person, also where the cycle begins anew.
  const PersonBuild build{{}, 1.75, 1.3};
  const WalkingPerson person(build);
  constexpr double kStep_m = 1e-3;
  auto before = person.ObjectFromPieces(0.0, 1.3);
  for (double distance_m = kStep_m; distance_m < 1.5 * person.stride_length_m();
       distance_m += kStep_m) {
    auto now = person.ObjectFromPieces(distance_m, 1.3);
    for (std::size_t piece = 0; piece < now.size(); ++piece) {
      const Vector3 tip(0.15, 0.0, -0.3);
      EXPECT_LT((now[piece] * tip - before[piece] * tip).norm(), 5.0 * kStep_m)
          << piece << " at " << distance_m;
    }
    before = std::move(now);
  }
}

/// How far the corners of all pieces are off between poses so far apart in time, in a whole stride:
/// in ascending order.
std::vector<double> ErrorsBetweenPoses_m(Physique physique, double speed_mps, double step_s) {
  const PersonBuild build{{.physique = physique}, StandardHeight_m(physique), speed_mps};
  const WalkingPerson person(build);
  const PersonSurfaces surfaces = FindPersonSurfaces(build.look, RailLabels(), RailMaterials());
  const std::vector<Model> pieces = MakePersonPieces(surfaces, build);
  std::vector<double> errors_m;
  const double way_m = speed_mps * step_s;
  for (double begin_m = 0.0; begin_m < person.stride_length_m(); begin_m += 0.01) {
    const auto begin = person.ObjectFromPieces(begin_m, speed_mps);
    const auto middle = person.ObjectFromPieces(begin_m + 0.5 * way_m, speed_mps);
    const auto end = person.ObjectFromPieces(begin_m + way_m, speed_mps);
    for (std::size_t piece = 0; piece < begin.size(); ++piece) {
      const Eigen::AlignedBox3d box_m = pieces[piece].Bounds();
      for (int i = 0; i < 8; ++i) {
        const Vector3 corner_m = box_m.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
        const Vector3 between_m = 0.5 * (begin[piece] * corner_m + end[piece] * corner_m);
        errors_m.push_back((middle[piece] * corner_m - between_m).norm());
      }
    }
  }
  std::ranges::sort(errors_m);
  return errors_m;
}

// core/simulate/detail_choice.h chooses by it how far apart in time poses are. A knee that is
// nearly stretched is fast for an instant, which makes the greatest errors.
TEST(WalkingPerson, IsHardlyOffBetweenItsPoses) {
  constexpr double kFast_mps = 2.0;
  for (const Physique physique : {Physique::kMan, Physique::kWoman, Physique::kChild}) {
    for (const double step_s : {0.01, 0.02, 0.05, 0.1}) {
      const std::vector<double> errors_m = ErrorsBetweenPoses_m(physique, kFast_mps, step_s);
      const double steps = step_s / 0.01;
      EXPECT_LT(errors_m[errors_m.size() * 98 / 100], 2e-3 * steps * steps)
          << NameOf(physique) << " with poses " << step_s << " s apart";
      EXPECT_LT(errors_m.back(), 14e-3 * steps)
          << NameOf(physique) << " with poses " << step_s << " s apart";
    }
  }
}

/// Expects that the model at rest contains the pieces at 24 phases and three speeds.
void ExpectWithinBoundsAtRest(const PersonSpec& look, double steady_mps) {
  const PersonBuild build{look, StandardHeight_m(look.physique), steady_mps};
  const WalkingPerson person(build);
  const PersonSurfaces surfaces = FindPersonSurfaces(look, RailLabels(), RailMaterials());
  const std::vector<Model> pieces = MakePersonPieces(surfaces, build);
  const Eigen::AlignedBox3d rest = MakePerson(surfaces, build).Bounds();
  Eigen::AlignedBox3d reached;
  constexpr int kNumPhases = 24;
  for (int i = 0; i < kNumPhases; ++i) {
    for (const double speed_mps : {0.0, 0.3 * steady_mps, steady_mps}) {
      const auto poses =
          person.ObjectFromPieces(person.stride_length_m() * i / kNumPhases, speed_mps);
      ASSERT_EQ(poses.size(), pieces.size());
      for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
        for (const Part& part : pieces[piece].parts) {
          for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
            reached.extend(poses[piece] * vertex.cast<double>());
          }
        }
      }
    }
  }
  const auto margin = (reached.min() - rest.min()).cwiseMin(rest.max() - reached.max()).eval();
  EXPECT_GT(margin.minCoeff(), -1e-6)
      << NameOf(look.physique) << " with " << NameOf(look.luggage) << " at " << steady_mps << "\n"
      << reached.min().transpose() << " to " << reached.max().transpose() << "\n"
      << rest.min().transpose() << " to " << rest.max().transpose();
}

TEST(WalkingPerson, StaysWithinTheBoundsOfItsModelAtRest) {
  for (const double steady_mps : {0.6, 1.3, 2.5}) {
    ExpectWithinBoundsAtRest({.physique = Physique::kMan}, steady_mps);
    ExpectWithinBoundsAtRest({.physique = Physique::kChild}, steady_mps);
  }
  ExpectWithinBoundsAtRest({.physique = Physique::kWoman, .clothing = Clothing::kHiVis}, 1.3);
  for (const Luggage luggage : {Luggage::kSuitcase, Luggage::kPram, Luggage::kBicycle}) {
    ExpectWithinBoundsAtRest({.luggage = luggage}, 1.3);
  }
}

}  // namespace
}  // namespace railcast
