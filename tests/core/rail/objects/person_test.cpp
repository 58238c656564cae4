#include "core/rail/objects/person.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/rail/objects/person_body.h"
#include "tests/core/rail/model_checks.h"
#include "tests/core/rail/test_tables.h"

namespace railcast {
namespace {

constexpr Physique kPhysiques[] = {Physique::kMan, Physique::kWoman, Physique::kChild};
constexpr Luggage kAllLuggage[] = {Luggage::kNone, Luggage::kSuitcase, Luggage::kPram,
                                   Luggage::kBicycle};
constexpr Posture kPostures[] = {Posture::kWalking, Posture::kStanding, Posture::kCrouching,
                                 Posture::kSitting, Posture::kLying};

/// With those of hi-vis clothes and luggage.
PersonSurfaces AllSurfaces() {
  return FindPersonSurfaces({.clothing = Clothing::kHiVis, .luggage = Luggage::kPram}, RailLabels(),
                            RailMaterials());
}

PersonBuild BuildOf(const PersonSpec& look, double height_m) {
  return {look, height_m, NaturalPace_mps(height_m)};
}

PersonBuild BuildOf(const PersonSpec& look) {
  return BuildOf(look, StandardHeight_m(look.physique));
}

Model Standing(Physique physique, Clothing clothing = Clothing::kPlain) {
  return MakePerson(
      AllSurfaces(),
      BuildOf({.posture = Posture::kStanding, .physique = physique, .clothing = clothing}));
}

std::vector<Vector3> AllVertices(const Model& model) {
  std::vector<Vector3> vertices;
  for (const Part& part : model.parts) {
    for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
      vertices.push_back(vertex.cast<double>());
    }
  }
  return vertices;
}

/// Width of what a condition selects of the model.
template <class Condition>
double Width_m(const Model& model, const Condition& is_of_it) {
  Eigen::AlignedBox3d box;
  for (const Vector3& vertex : AllVertices(model)) {
    if (is_of_it(vertex)) box.extend(vertex);
  }
  return box.sizes().y();
}

double Area_m2(const Model& model, const SurfaceClass& surface, double above_z_m) {
  double area_m2 = 0.0;
  for (const Part& part : model.parts) {
    if (part.material != surface.material) continue;
    for (const auto& [a, b, c] : part.mesh.triangles) {
      const Vector3 pa = part.mesh.vertices[a].cast<double>();
      const Vector3 pb = part.mesh.vertices[b].cast<double>();
      const Vector3 pc = part.mesh.vertices[c].cast<double>();
      if (pa.z() > above_z_m) area_m2 += 0.5 * (pb - pa).cross(pc - pa).norm();
    }
  }
  return area_m2;
}

TEST(MakePerson, StandsOnTheGroundAtTheGivenHeight) {
  for (const Physique physique : kPhysiques) {
    for (const Posture posture : {Posture::kStanding, Posture::kWalking}) {
      for (const Clothing clothing : {Clothing::kPlain, Clothing::kHiVis}) {
        for (const double height_m : {1.75, 1.20, 2.0}) {
          const PersonSpec look{posture, physique, clothing};
          const Eigen::AlignedBox3d box =
              MakePerson(AllSurfaces(), BuildOf(look, height_m)).Bounds();
          EXPECT_NEAR(box.min().z(), 0.0, 1e-6);
          EXPECT_NEAR(box.max().z(), height_m, 1e-6);
        }
      }
    }
  }
}

TEST(MakePerson, IsMadeOfFewClosedAndSoundSurfaces) {
  const PersonSurfaces surfaces = AllSurfaces();
  for (const Physique physique : kPhysiques) {
    for (const Posture posture : kPostures) {
      for (const Luggage luggage : kAllLuggage) {
        for (const Clothing clothing : {Clothing::kPlain, Clothing::kHiVis}) {
          const Model person =
              MakePerson(surfaces, BuildOf({posture, physique, clothing, luggage}));
          EXPECT_LT(person.num_triangles(), 9000U);
          EXPECT_EQ(CountBadTriangles(person), 0U);
          EXPECT_EQ(CountOpenEdges(person), 0U);
          for (const Part& part : person.parts) EXPECT_EQ(part.label, surfaces.skin.label);
        }
      }
    }
  }
}

TEST(MakePerson, HasTheProportionsOfAnAdult) {
  // Drillis and Contini (1966): chin 0.870, fingertips 0.377, foot length 0.152 (a shoe is one or
  // two centimetres longer); breadths by DIN 33402-2 as in person_body.h. The arms are slightly
  // bent and spread, which lifts the fingertips by up to 1 %.
  const Model man = Standing(Physique::kMan);
  constexpr double kHeight_m = 1.75;
  double chin_m = kHeight_m;
  double fingertips_m = kHeight_m;
  for (const Vector3& p : VerticesOf(man, AllSurfaces().skin)) {
    if (p.z() > 0.7 * kHeight_m && p.x() > 0.07) chin_m = std::min(chin_m, p.z());
    fingertips_m = std::min(fingertips_m, p.z());
  }
  EXPECT_NEAR(chin_m / kHeight_m, 0.870, 0.006);
  EXPECT_NEAR(fingertips_m / kHeight_m, 0.377, 0.012);
  Eigen::AlignedBox3d shoes;
  for (const Vector3& p : AllVertices(man)) {
    if (p.z() < 0.05) shoes.extend(p);
  }
  EXPECT_NEAR(shoes.sizes().x() / kHeight_m, 0.152 + 0.008, 0.006);
  EXPECT_NEAR(Width_m(man, [](const Vector3& p) { return p.z() > 1.65 && p.z() < 1.69; }), 0.155,
              0.01);
  EXPECT_NEAR(Width_m(man, [](const Vector3& p) { return p.z() > 1.3 && p.z() < 1.4; }), 0.47,
              0.02);
}

TEST(MakePerson, GivesAChildALargerHeadAndShorterLegs) {
  const auto head_share = [](Physique physique, double below) {
    const double height_m = StandardHeight_m(physique);
    double chin_m = height_m;
    for (const Vector3& p : VerticesOf(Standing(physique), AllSurfaces().skin)) {
      if (p.z() > below * height_m && p.x() > 0.05 * height_m) chin_m = std::min(chin_m, p.z());
    }
    return 1.0 - chin_m / height_m;
  };
  // Snyder et al. (1977): a child of 6 to 7 years is 6 heads tall, an adult 7.7.
  EXPECT_NEAR(head_share(Physique::kChild, 0.75), 1.0 / 6.0, 0.006);
  EXPECT_NEAR(head_share(Physique::kWoman, 0.80), 1.0 / 7.7, 0.006);
  EXPECT_LT(MeasuresOf(Physique::kChild, 1.0).hip_m, MeasuresOf(Physique::kMan, 1.0).hip_m);
}

TEST(MakePerson, WearsBandsAsLargeAndAllAroundAsTheStandardWants) {
  // EN ISO 20471: at least 0.13 m2 of band on clothes of class 2, such as a waistcoat, and 0.20 m2
  // in class 3, here with the bands of the trousers.
  const PersonSurfaces surfaces = AllSurfaces();
  const SurfaceClass band = surfaces.hi_vis_band;
  const Model worker = Standing(Physique::kMan, Clothing::kHiVis);
  EXPECT_GT(Area_m2(worker, band, 0.8), 0.13);
  EXPECT_GT(Area_m2(worker, band, 0.0), 0.20);
  EXPECT_LT(Area_m2(worker, band, 0.0), 0.40);
  EXPECT_EQ(Area_m2(Standing(Physique::kMan), band, 0.0), 0.0);
  EXPECT_NE(band.material, surfaces.hi_vis_fabric.material);
  // The lower band round the torso, 50 mm wide at least, is seen from everywhere.
  Eigen::AlignedBox3d ring;
  for (const Vector3& p : VerticesOf(worker, band)) {
    if (p.z() > 1.0 && p.z() < 1.16) ring.extend(p);
  }
  EXPECT_GT(ring.sizes().z(), 0.05);
  EXPECT_GT(ring.sizes().x(), 0.18);
  EXPECT_GT(ring.sizes().y(), 0.28);
}

TEST(MakePerson, HasABareHeadAndHandsAndClothesElsewhere) {
  const PersonSurfaces surfaces = AllSurfaces();
  const Model person = Standing(Physique::kMan);
  bool has_hands = false;
  for (const Vector3& p : VerticesOf(person, surfaces.skin)) {
    EXPECT_TRUE(p.z() > 1.43 || (p.z() < 0.95 && std::abs(p.y()) > 0.2)) << p.transpose();
    has_hands = has_hands || p.z() < 0.95;
  }
  EXPECT_TRUE(has_hands);
}

TEST(MakePerson, TakesThePostureOfItsName) {
  for (const Physique physique : kPhysiques) {
    const double height_m = StandardHeight_m(physique);
    const auto box = [&](Posture posture) {
      return MakePerson(AllSurfaces(), BuildOf({.posture = posture, .physique = physique}))
          .Bounds();
    };
    for (const Posture posture : {Posture::kCrouching, Posture::kSitting, Posture::kLying}) {
      EXPECT_NEAR(box(posture).min().z(), 0.0, 1e-6);
      EXPECT_NEAR(box(posture).center().x(), 0.0, 1e-6);
    }
    // Sitting height is 0.52 of the height (Drillis and Contini; 0.55 of a child's), which a bent
    // back takes from; a trunk is 0.15 deep.
    EXPECT_NEAR(box(Posture::kSitting).max().z() / height_m, 0.52, 0.04);
    EXPECT_NEAR(box(Posture::kCrouching).max().z() / height_m, 0.60, 0.05);
    EXPECT_NEAR(box(Posture::kLying).max().z() / height_m, 0.16, 0.02);
    EXPECT_GT(box(Posture::kLying).sizes().x(), height_m);
    EXPECT_LT(box(Posture::kLying).sizes().x(), 1.08 * height_m);
  }
}

TEST(MakePerson, LiesOnItsBackWithTheHeadBehind) {
  const Model person = MakePerson(AllSurfaces(), BuildOf({.posture = Posture::kLying}));
  const std::vector<Vector3> skin = VerticesOf(person, AllSurfaces().skin);
  const Vector3 nose =
      *std::max_element(skin.begin(), skin.end(), [](const Vector3& a, const Vector3& b) {
        return (a.x() < -0.5 ? a.z() : 0.0) < (b.x() < -0.5 ? b.z() : 0.0);
      });
  EXPECT_LT(nose.x(), -0.6);
  EXPECT_GT(nose.z(), 0.17) << "the face looks up";
}

TEST(MakePerson, PullsASuitcaseOfTheSizeThatItsTypeSays) {
  const PersonSurfaces surfaces = AllSurfaces();
  const Model person =
      MakePerson(surfaces, BuildOf({.posture = Posture::kStanding, .luggage = Luggage::kSuitcase}));
  Eigen::AlignedBox3d box;
  for (const Vector3& p : VerticesOf(person, surfaces.suitcase)) box.extend(p);
  EXPECT_TRUE(box.sizes().isApprox(Vector3(0.30, 0.45, 0.75), 1e-3)) << box.sizes().transpose();
  EXPECT_LT(box.max().y(), -0.3) << "at its right";
}

}  // namespace
}  // namespace railcast
