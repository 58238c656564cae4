#include "core/rail/objects/object_models.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "tests/core/rail/test_tables.h"

namespace railcast {
namespace {

std::shared_ptr<const Model> Make(const ObjectSpec& spec) {
  return MakeObjectModel(spec, TestSurfaces(), TestLabels(), TestMaterials());
}

ObjectSpec Object(const std::string& type) {
  ObjectSpec spec;
  spec.name = "it";
  spec.type = type;
  return spec;
}

std::string Complaint(const ObjectSpec& spec) {
  try {
    (void)Make(spec);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// A file with one tetrahedron, 2 x 3 x 4 units with y up, far from its origin.
class MakeObjectModelFromFile : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(file_) << "v 10 20 30\nv 12 20 30\nv 10 24 30\nv 10 20 33\n"
                            "f 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n";
    spec_.file = file_.string();
    spec_.up = std::string("y");
    spec_.unit_m = 0.1;
  }
  void TearDown() override { std::filesystem::remove(file_); }

  const std::filesystem::path file_ =
      std::filesystem::path(testing::TempDir()) / "railcast_object_models_test.obj";
  ObjectSpec spec_ = Object("mesh");
};

TEST(MakeObjectModel, StandsBoxesAndPolesOnTheOriginInTheirSize) {
  ObjectSpec box = Object("box");
  box.size_m = {2.0, 1.0, 0.5};
  EXPECT_TRUE(Make(box)->Bounds().isApprox(
      Eigen::AlignedBox3d(Vector3(-1.0, -0.5, 0.0), Vector3(1.0, 0.5, 0.5))));
  ObjectSpec pole = Object("pole");
  pole.size_m = {0.2, 0.2, 6.0};
  EXPECT_TRUE(Make(pole)->Bounds().isApprox(
      Eigen::AlignedBox3d(Vector3(-0.1, -0.1, 0.0), Vector3(0.1, 0.1, 6.0)), 1e-6));
}

TEST(MakeObjectModel, GivesEveryTypeItsLabelAndMaterials) {
  const RailSurfaces surfaces = TestSurfaces();
  const LabelTable labels = TestLabels();
  for (const auto& [type, label] :
       {std::pair("open_wagon", "wagon"), std::pair("flat_wagon", "wagon"),
        std::pair("tank_wagon", "wagon"), std::pair("person", "person")}) {
    EXPECT_EQ(ObjectLabel(Object(type), surfaces, labels), labels.Id(label));
    const auto model = Make(Object(type));
    EXPECT_EQ(model->name, "it");
    EXPECT_GE(model->parts.size(), 2U) << "more than one material";
    for (const Part& part : model->parts) EXPECT_EQ(part.label, labels.Id(label));
  }
}

TEST(MakeObjectModel, OverridesLabelAndMaterialOfAllParts) {
  ObjectSpec spec = Object("person");
  spec.label = "object";
  spec.material = "wood";
  EXPECT_EQ(ObjectLabel(spec, TestSurfaces(), TestLabels()), TestLabels().Id("object"));
  const auto model = Make(spec);
  for (const Part& part : model->parts) {
    EXPECT_EQ(part.label, TestLabels().Id("object"));
    EXPECT_EQ(part.material, TestMaterials().Index("wood"));
  }
}

TEST(MakeObjectModel, ScalesAPersonToTheHeight) {
  ObjectSpec spec = Object("person");
  spec.size_m = {0.5, 0.5, 1.10};
  EXPECT_NEAR(Make(spec)->Bounds().max().z(), 1.10, 1e-6);
}

TEST_F(MakeObjectModelFromFile, PutsTheMiddleOfTheFootprintOnTheOrigin) {
  const auto model = Make(spec_);
  EXPECT_TRUE(model->Bounds().isApprox(
      Eigen::AlignedBox3d(Vector3(-0.1, -0.15, 0.0), Vector3(0.1, 0.15, 0.4)), 1e-5))
      << model->Bounds().min().transpose() << " to " << model->Bounds().max().transpose();
  EXPECT_EQ(model->parts.front().label, TestLabels().Id("object"));
}

TEST_F(MakeObjectModelFromFile, StretchesTheMeshToTheSize) {
  spec_.size_m = {6.0, 2.0, 1.0};
  EXPECT_TRUE(Make(spec_)->Bounds().isApprox(
      Eigen::AlignedBox3d(Vector3(-3.0, -1.0, 0.0), Vector3(3.0, 1.0, 1.0)), 1e-5));
}

TEST_F(MakeObjectModelFromFile, RefusesToStretchAFlatMesh) {
  std::ofstream(file_) << "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n";
  EXPECT_EQ(Complaint(spec_), "");
  spec_.size_m = {1.0, 1.0, 1.0};
  EXPECT_EQ(Complaint(spec_), "size_m: cannot stretch a mesh that is flat");
}

TEST(MakeObjectModel, RefusesWhatItCannotMake) {
  EXPECT_EQ(Complaint(Object("cow")),
            "type: must be box, pole, person, open_wagon, flat_wagon, tank_wagon or mesh (got "
            "\"cow\")");
  EXPECT_EQ(Complaint(Object("box")), "size_m: required for type \"box\"");
  EXPECT_EQ(Complaint(Object("mesh")), "file: required for type \"mesh\"");
  ObjectSpec spec = Object("box");
  spec.size_m = {1.0, 0.0, 1.0};
  EXPECT_EQ(Complaint(spec), "size_m: must be > 0 (got 1, 0, 1)");
  spec = Object("pole");
  spec.size_m = {0.2, 0.25, 5.0};
  EXPECT_EQ(Complaint(spec), "size_m: a pole must have one diameter (got 0.2 and 0.25)");
  spec = Object("open_wagon");
  spec.size_m = {1.0, 1.0, 1.0};
  EXPECT_EQ(Complaint(spec), "size_m: a wagon has its own");
  spec = Object("mesh");
  spec.file = "/nowhere.obj";
  EXPECT_EQ(Complaint(spec), "/nowhere.obj: no such file or directory");
  spec.up = std::string("x");
  EXPECT_EQ(Complaint(spec), "up: must be \"y\" or \"z\" (got \"x\")");
  spec = Object("person");
  spec.label = "persn";
  EXPECT_EQ(Complaint(spec), "label: must be in the label table (got \"persn\")");
  spec = Object("person");
  spec.material = "gold";
  EXPECT_EQ(Complaint(spec), "material: must be in the material library (got \"gold\")");
}

}  // namespace
}  // namespace railcast
