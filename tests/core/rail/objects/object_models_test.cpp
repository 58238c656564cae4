#include "core/rail/objects/object_models.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/rail/test_tables.h"

namespace railcast {
namespace {

std::shared_ptr<const Model> MakeModel(const ObjectSpec& spec) {
  return MakeObjectModel(spec, TestSurfaces(), RailLabels(), RailMaterials());
}

ObjectSpec ObjectOfType(ObjectType type) {
  ObjectSpec spec;
  spec.name = "it";
  spec.type = type;
  return spec;
}

std::string Complaint(const ObjectSpec& spec) {
  return MessageOf([&] { (void)MakeModel(spec); });
}

/// A file with a tetrahedron of 2 x 3 x 4 units, y up, far from the file's origin.
class MakeObjectModelFromFile : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(file_) << "v 10 20 30\nv 12 20 30\nv 10 24 30\nv 10 20 33\n"
                            "f 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n";
    spec_.file = file_.string();
    spec_.up = UpAxis::kY;
    spec_.unit_m = 0.1;
  }

  const TemporaryDirectory folder_;
  const std::filesystem::path file_ = folder_.path() / "tetrahedron.obj";
  ObjectSpec spec_ = ObjectOfType(ObjectType::kMesh);
};

TEST(MakeObjectModel, StandsBoxesAndPolesOnTheOriginInTheirSize) {
  ObjectSpec box = ObjectOfType(ObjectType::kBox);
  box.size_m = {2.0, 1.0, 0.5};
  EXPECT_TRUE(MakeModel(box)->Bounds().isApprox(
      Eigen::AlignedBox3d(Vector3(-1.0, -0.5, 0.0), Vector3(1.0, 0.5, 0.5))));
  ObjectSpec pole = ObjectOfType(ObjectType::kPole);
  pole.size_m = {0.2, 0.2, 6.0};
  EXPECT_TRUE(MakeModel(pole)->Bounds().isApprox(
      Eigen::AlignedBox3d(Vector3(-0.1, -0.1, 0.0), Vector3(0.1, 0.1, 6.0)), 1e-6));
}

TEST(MakeObjectModel, GivesEveryTypeItsLabelAndMaterials) {
  const RailSurfaces surfaces = TestSurfaces();
  const LabelTable labels = RailLabels();
  for (const auto& [type, label] :
       {std::pair(TypeNamed("open_wagon"), "wagon"), std::pair(TypeNamed("flat_wagon"), "wagon"),
        std::pair(TypeNamed("tank_wagon"), "wagon"), std::pair(ObjectType::kPerson, "person"),
        std::pair(TypeNamed("car"), "road_vehicle"),
        std::pair(TypeNamed("bicycle"), "road_vehicle"), std::pair(TypeNamed("deer"), "animal"),
        std::pair(TypeNamed("fallen_tree"), "tree"), std::pair(TypeNamed("landslide"), "object"),
        std::pair(TypeNamed("drag_shoe"), "object")}) {
    EXPECT_EQ(ObjectLabel(ObjectOfType(type), surfaces, labels), labels.Id(label));
    const auto model = MakeModel(ObjectOfType(type));
    EXPECT_GE(model->parts.size(), 2U) << "more than one material";
    for (const Part& part : model->parts) EXPECT_EQ(part.label, labels.Id(label));
  }
}

TEST(ObjectModels, ShareTheModelOfObjectsThatDifferOnlyInNameAndPlace) {
  const LabelTable labels = RailLabels();
  const MaterialLibrary materials = RailMaterials();
  ObjectModels models(TestSurfaces(), labels, materials);
  ObjectSpec person = ObjectOfType(ObjectType::kPerson);
  const auto first = models.Of(person);
  person.name = "another";
  person.s_m = 12.0;
  person.heading_deg = 90.0;
  EXPECT_EQ(models.Of(person), first);
  person.size_m = {0.5, 0.5, 1.2};
  const auto child = models.Of(person);
  EXPECT_NE(child, first);
  EXPECT_NEAR(child->Bounds().sizes().z(), 1.2, 1e-6);
}

TEST(ObjectModels, GivePiecesToPersonsWhoWalkAndToNobodyElse) {
  const LabelTable labels = RailLabels();
  const MaterialLibrary materials = RailMaterials();
  ObjectModels models(TestSurfaces(), labels, materials);
  ObjectSpec person = ObjectOfType(ObjectType::kPerson);
  EXPECT_TRUE(models.WalkingPiecesOf(person).empty()) << "without motion";
  person.motion = MotionSpec{.profile = {{.time_s = 0.0, .s_m = {}, .speed_mps = 1.2}}};
  const auto pieces = models.WalkingPiecesOf(person);
  EXPECT_EQ(pieces.size(), 11U);
  EXPECT_EQ(models.WalkingPiecesOf(person), pieces) << "shared";
  person.person = PersonSpec{.luggage = Luggage::kPram};
  EXPECT_EQ(models.WalkingPiecesOf(person).size(), 12U);
  EXPECT_NE(models.WalkingPiecesOf(person).front(), pieces.front());
  person.person->posture = Posture::kStanding;
  EXPECT_TRUE(models.WalkingPiecesOf(person).empty());
  ObjectSpec box = ObjectOfType(ObjectType::kBox);
  box.motion = person.motion;
  EXPECT_TRUE(models.WalkingPiecesOf(box).empty());
}

TEST(MakeObjectModel, NeedsTheMaterialsOfHiVisClothesOnlyForWhoWearsThem) {
  const MaterialLibrary plain({{"skin", 0.5}, {"clothing", 0.3}});
  ObjectSpec person = ObjectOfType(ObjectType::kPerson);
  const auto complaint = [&] {
    return MessageOf([&] { (void)MakeObjectModel(person, TestSurfaces(), RailLabels(), plain); });
  };
  EXPECT_EQ(complaint(), "no error");
  person.person = PersonSpec{.clothing = Clothing::kHiVis};
  EXPECT_NE(complaint().find("hi_vis_fabric"), std::string::npos) << complaint();
  EXPECT_NE(complaint().find("hi_vis_band"), std::string::npos) << complaint();
}

TEST(MakeObjectModel, OverridesLabelAndMaterialOfAllParts) {
  ObjectSpec spec = ObjectOfType(ObjectType::kPerson);
  spec.label = "object";
  spec.material = "wood";
  EXPECT_EQ(ObjectLabel(spec, TestSurfaces(), RailLabels()), RailLabels().Id("object"));
  const auto model = MakeModel(spec);
  for (const Part& part : model->parts) {
    EXPECT_EQ(part.label, RailLabels().Id("object"));
    EXPECT_EQ(part.material, RailMaterials().Index("wood"));
  }
}

TEST(MakeObjectModel, ScalesAPersonToTheHeight) {
  ObjectSpec spec = ObjectOfType(ObjectType::kPerson);
  spec.size_m = {0.5, 0.5, 1.10};
  EXPECT_NEAR(MakeModel(spec)->Bounds().max().z(), 1.10, 1e-6);
}

TEST_F(MakeObjectModelFromFile, PutsTheMiddleOfTheFootprintOnTheOrigin) {
  const auto model = MakeModel(spec_);
  EXPECT_TRUE(model->Bounds().isApprox(
      Eigen::AlignedBox3d(Vector3(-0.1, -0.15, 0.0), Vector3(0.1, 0.15, 0.4)), 1e-5))
      << model->Bounds().min().transpose() << " to " << model->Bounds().max().transpose();
  EXPECT_EQ(model->parts.front().label, RailLabels().Id("object"));
}

TEST_F(MakeObjectModelFromFile, IsSharedByObjectsOfTheSameOriginAndParts) {
  const LabelTable labels = RailLabels();
  const MaterialLibrary materials = RailMaterials();
  std::ofstream(file_) << "v 10 20 30\nv 12 20 30\nv 10 24 31\ng roof\nf 1 2 3\n";
  ObjectModels models(TestSurfaces(), labels, materials);
  const auto plain = models.Of(spec_);
  spec_.parts = {{.of = "roof", .material = "wood", .label = {}}};
  const auto wooden = models.Of(spec_);
  EXPECT_NE(wooden, plain);
  EXPECT_EQ(models.Of(spec_), wooden);
  EXPECT_EQ(wooden->parts.front().material, materials.Index("wood"));
  spec_.origin = MeshOrigin::kFile;
  EXPECT_NE(models.Of(spec_), wooden);
}

TEST_F(MakeObjectModelFromFile, StretchesTheMeshToTheSize) {
  spec_.size_m = {6.0, 2.0, 1.0};
  EXPECT_TRUE(MakeModel(spec_)->Bounds().isApprox(
      Eigen::AlignedBox3d(Vector3(-3.0, -1.0, 0.0), Vector3(3.0, 1.0, 1.0)), 1e-5));
}

TEST_F(MakeObjectModelFromFile, RefusesToStretchAFlatMesh) {
  std::ofstream(file_) << "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n";
  EXPECT_EQ(Complaint(spec_), "no error");
  spec_.size_m = {1.0, 1.0, 1.0};
  EXPECT_EQ(Complaint(spec_), "size_m: cannot stretch a mesh that is flat");
}

TEST(MakeObjectModel, RefusesWhatItCannotMake) {
  EXPECT_EQ(Complaint(ObjectOfType(ObjectType::kBox)), "size_m: required for type \"box\"");
  EXPECT_EQ(Complaint(ObjectOfType(ObjectType::kMesh)), "file: required for type \"mesh\"");
  ObjectSpec spec = ObjectOfType(ObjectType::kBox);
  spec.size_m = {1.0, 0.0, 1.0};
  EXPECT_EQ(Complaint(spec), "size_m: must be > 0 (got 1, 0, 1)");
  spec = ObjectOfType(ObjectType::kPole);
  spec.size_m = {0.2, 0.25, 5.0};
  EXPECT_EQ(Complaint(spec), "size_m: a pole must have one diameter (got 0.2 and 0.25)");
  spec = ObjectOfType(TypeNamed("open_wagon"));
  spec.size_m = {1.0, 1.0, 1.0};
  EXPECT_EQ(Complaint(spec), "size_m: type \"open_wagon\" has its own");
  spec = ObjectOfType(TypeNamed("cow"));
  spec.size_m = {1.0, 1.0, 1.0};
  EXPECT_EQ(Complaint(spec), "size_m: type \"cow\" has its own");
  spec = ObjectOfType(ObjectType::kMesh);
  spec.file = "/nowhere.obj";
  EXPECT_EQ(Complaint(spec), "/nowhere.obj: no such file or directory");
  spec = ObjectOfType(ObjectType::kPerson);
  spec.label = "persn";
  EXPECT_EQ(Complaint(spec), "label: must be in the label table (got \"persn\")");
  spec = ObjectOfType(ObjectType::kPerson);
  spec.material = "gold";
  EXPECT_EQ(Complaint(spec), "material: must be in the material library (got \"gold\")");
}

TEST(MakeObjectModel, LeansToTheRightAndThenForwardsOnItsLowestPoint) {
  ObjectSpec spec = ObjectOfType(ObjectType::kBox);
  spec.size_m = {1.0, 0.2, 2.0};
  spec.roll_deg = 30.0;
  Eigen::AlignedBox3d bounds_m = MakeModel(spec)->Bounds();
  EXPECT_NEAR(bounds_m.sizes().y(), 0.2 * std::cos(0.5236) + 2.0 * std::sin(0.5236), 1e-4);
  EXPECT_NEAR(bounds_m.sizes().z(), 0.2 * std::sin(0.5236) + 2.0 * std::cos(0.5236), 1e-4);
  EXPECT_NEAR(bounds_m.min().z(), 0.0, 1e-6);
  EXPECT_NEAR(bounds_m.center().y(), 0.0, 1e-6);
  // The lowest edge is the right one, so the highest vertex is to the right, too.
  Eigen::Vector3f highest_m = Eigen::Vector3f::Zero();
  const std::shared_ptr<const Model> leaning = MakeModel(spec);
  for (const Eigen::Vector3f& vertex : leaning->parts.front().mesh.vertices) {
    if (vertex.z() > highest_m.z()) highest_m = vertex;
  }
  EXPECT_LT(highest_m.y(), 0.0F);
  spec.roll_deg = 0.0;
  spec.pitch_deg = 90.0;  // It lies on its front.
  bounds_m = MakeModel(spec)->Bounds();
  EXPECT_NEAR(bounds_m.sizes().x(), 2.0, 1e-6);
  EXPECT_NEAR(bounds_m.sizes().z(), 1.0, 1e-6);
  EXPECT_NEAR(bounds_m.min().z(), 0.0, 1e-6);
}

TEST(MakeObjectModel, NeedsMaterialsAndLabelsOfThingsOnlyWhereTheyAre) {
  const MaterialLibrary library = RailMaterials();
  std::vector<Material> materials(library.materials().begin() + 1, library.materials().end());
  std::erase_if(materials, [](const Material& material) { return material.name == "fur"; });
  std::vector<Label> labels = RailLabels().labels();
  std::erase_if(labels, [](const Label& label) { return label.name == "animal"; });
  const auto make = [&](const ObjectType& type) {
    return MakeObjectModel(ObjectOfType(type), TestSurfaces(), LabelTable(labels),
                           MaterialLibrary(materials));
  };
  EXPECT_NE(make(TypeNamed("car")), nullptr);
  EXPECT_EQ(MessageOf([&] { (void)make(TypeNamed("cow")); }),
            "type: requires the label \"animal\"\ntype: requires the material \"fur\"");
}

}  // namespace
}  // namespace railcast
