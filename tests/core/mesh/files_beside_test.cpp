// What a mesh is read with besides its own file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/mesh/gltf_buffers.h"
#include "core/mesh/mesh_readers.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/mesh/imported_meshes.h"
#include "tests/core/mesh/made_scenes.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

class FilesBeside : public testing::Test {
 protected:
  fs::path Write(const std::string& name, const std::string& bytes) const {
    fs::create_directories((folder_.path() / name).parent_path());
    std::ofstream(folder_.path() / name, std::ios::binary) << bytes;
    return folder_.path() / name;
  }
  [[nodiscard]] static std::string Read(const fs::path& file) {
    std::ifstream in = OpenInput(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] std::vector<std::string> NamesBeside(const fs::path& file) const {
    std::vector<std::string> names;
    for (const FileBeside& beside : FilesBesideMesh(Read(file), file)) {
      names.push_back(beside.name);
      EXPECT_EQ(beside.bytes, Read(folder_.path() / beside.name));
    }
    return names;
  }

  const TemporaryDirectory folder_;
  const std::string triangle_ = BytesOfFloats({0, 0, 0, 1, 0, 0, 0, 1, 0});
};

TEST_F(FilesBeside, AreTheBuffersOfAGltf) {
  Write("rock 1.bin", triangle_);
  for (const char* uri : {"rock 1.bin", "rock%201.bin", "./rock%201.bin"}) {
    const fs::path file = Write("rock.gltf", GltfNaming(uri));
    EXPECT_EQ(NamesBeside(file), std::vector<std::string>{"rock 1.bin"}) << uri;
    if (!HasAssimp()) continue;
    EXPECT_EQ(ReadMesh(file).num_triangles(), 1U) << uri;
  }
}

TEST_F(FilesBeside, AreNotTheBufferThatABinaryGltf1Holds) {
  Write("rock.bin", triangle_);
  const fs::path file = Write("rock.gltf", R"({"asset": {"version": "1.0"}, "buffers": {
    "binary_glTF": {"byteLength": 36, "uri": ""}, "other": {"byteLength": 36, "uri": "rock.bin"}}})");
  EXPECT_EQ(NamesBeside(file), std::vector<std::string>{"rock.bin"});
}

TEST_F(FilesBeside, MustLieInTheFolderOfTheGltf) {
  Write("rock.bin", triangle_);
  Write("below/rock.bin", triangle_);
  const std::string absolute = (folder_.path() / "rock.bin").string();
  for (const std::string& uri : {std::string("../rock.bin"), std::string("%2E%2E%2Frock.bin"),
                                 absolute, "file://" + absolute, std::string("..")}) {
    const fs::path file = Write("below/rock.gltf", GltfNaming(uri));
    const std::string message = file.string() + ": must name files beside it only (got " + "\"" +
                                uri.substr(0, 60) + (uri.size() > 60 ? "..." : "") + "\")";
    EXPECT_EQ(MessageOf([&] { (void)ReadMesh(file); }), message);
  }
}

TEST_F(FilesBeside, MustBeThere) {
  const fs::path file = Write("rock.gltf", GltfNaming("rock.bin"));
  EXPECT_EQ(MessageOf([&] { (void)ReadMesh(file); }),
            file.string() + ": names \"rock.bin\", which must be a file beside it");
}

// The buffer of a glTF that comes as bytes alone is no file of the folder that the program is in.
TEST_F(FilesBeside, AreNotReadWithBytesAlone) {
  if (!HasAssimp()) GTEST_SKIP() << "built without assimp";
  Write("rock.bin", triangle_);
  const fs::path before = fs::current_path();
  fs::current_path(folder_.path());
  const std::string message =
      MessageOf([&] { (void)ParseMesh(GltfNaming("rock.bin"), "rock.gltf"); });
  fs::current_path(before);
  EXPECT_THAT(message, testing::StartsWith("rock.gltf: cannot be read as gltf: "));
}

TEST_F(FilesBeside, AreTheMaterialsOfAnObjWhereTheyAreThere) {
  Write("two words.mtl", "newmtl a\n");
  Write("b.mtl", "newmtl b\n");
  const fs::path file = Write("rock.obj",
                              "mtllib two words.mtl\r\nmtllib ./b.mtl nonexistent.mtl b.mtl\n"
                              "mtllib ../up.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(NamesBeside(file), (std::vector<std::string>{"two words.mtl", "b.mtl"}));
  EXPECT_EQ(ReadMesh(file).num_triangles(), 1U);
}

TEST_F(FilesBeside, OfAnObjMayHaveBlanksInTheirNames) {
  Write("my paints.mtl", "newmtl red\nKd 0.8 0.1 0.1\n");
  const std::string shape = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
  for (const char* name : {"my paints.mtl", "my\\ paints.mtl", "\"my paints.mtl\"",
                           "my\\ paints.mtl my\\ paints.mtl"}) {
    const fs::path file = Write("rock.obj", "mtllib " + std::string(name) + "\n" + shape);
    const ImportedMesh mesh = ReadMesh(file);
    EXPECT_EQ(NamesBeside(file), std::vector<std::string>{"my paints.mtl"}) << name;
    EXPECT_TRUE(mesh.parts.at(0).luminance.has_value()) << name;
    EXPECT_TRUE(mesh.remarks.empty()) << name;
  }
}

TEST_F(FilesBeside, OfAnObjThatAreNotThereAreTold) {
  Write("b.mtl", "\xEF\xBB\xBFnewmtl red\nKd 0.8 0.1 0.1\n");
  const auto missing = [&](const std::string& names) -> std::vector<Remark> {
    return ReadMesh(Write("rock.obj",
                          "mtllib " + names + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"))
        .remarks;
  };
  const std::string place = (folder_.path() / "rock.obj").string();
  const auto told = [&](std::uint64_t number, const std::string& first) {
    return std::vector<Remark>{{RemarkKind::kMaterialFileMissing, place, number, first}};
  };
  EXPECT_EQ(missing("gone.mtl"), told(1, "\"gone.mtl\""));
  EXPECT_EQ(missing("two words.mtl"), told(1, "\"two words.mtl\""));
  EXPECT_EQ(missing("b.mtl gone.mtl lost.mtl"), told(2, "\"gone.mtl\""));
  EXPECT_EQ(missing("b.mtl # by hand"), std::vector<Remark>{});
}

TEST_F(FilesBeside, OfAnObjDescribeItsMaterialsOrThatIsTold) {
  Write("b.mtl", "newmtl red\n");
  const auto told = [&](const std::string& library, const std::string& material) {
    return ReadMesh(Write("rock.obj", library + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl " + material +
                                          "\nf 1 2 3\n"))
        .remarks;
  };
  const std::string place = (folder_.path() / "rock.obj").string();
  EXPECT_EQ(told("mtllib b.mtl", "blue"),
            (std::vector<Remark>{{RemarkKind::kMaterialFileMissing, place, 1, "\"blue\""}}));
  EXPECT_TRUE(told("mtllib b.mtl", "red").empty());
  EXPECT_TRUE(told("mtllib b.mtl", "None").empty());
  EXPECT_TRUE(told("", "blue").empty()) << "many come without a library";
}

TEST_F(FilesBeside, AreNoPictures) {
  Write("rock.png", "a picture");
  const std::string picture =
      R"(, "images": [{"uri": "rock.png"}], "textures": [{"source": 0}], "materials": [
         {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])";
  const fs::path file = Write("rock.gltf", TriangleGltf("{\"mesh\": 0}", picture));
  EXPECT_TRUE(NamesBeside(file).empty());
  if (!HasAssimp()) GTEST_SKIP() << "built without assimp";
  EXPECT_EQ(ReadMesh(file).num_triangles(), 1U);
}

TEST_F(FilesBeside, OfOtherFormatsThereAreNone) {
  EXPECT_TRUE(NamesBeside(Write("a.dae", TriangleDae("<node/>"))).empty());
  EXPECT_TRUE(NamesBeside(Write("a.csv", "azimuth_deg,elevation_deg\n")).empty());
}

TEST(ReadMtl, TakesTheLuminanceOfColoursThatNoPictureChanges) {
  std::map<std::string, std::optional<double>> found;
  ReadMtl("a.mtl",
          "# made by hand\nnewmtl red\nKd 1 0 0\nnewmtl dark grey \n\tKd .1 0.1 +1e-1\r\n"
          "newmtl pictured\nKd 1 1 1\nmap_Kd wall.png\nnewmtl none\nKa 1 1 1\n"
          "newmtl spectrum\nKd spectral a.rfl 1\nnewmtl one\nKd 0.5\n",
          found);
  ASSERT_EQ(found.size(), 6U);
  EXPECT_DOUBLE_EQ(found.at("red").value(), 0.2126);  // IEC 61966-2-1.
  EXPECT_NEAR(found.at("dark grey").value(), 0.1, 1e-15);
  EXPECT_NEAR(found.at("one").value(), 0.5, 1e-15);
  for (const char* name : {"pictured", "none", "spectrum"}) EXPECT_FALSE(found.at(name)) << name;
}

TEST(ReadMtl, RefusesColoursThatAreNone) {
  std::map<std::string, std::optional<double>> found;
  EXPECT_EQ(MessageOf([&] { ReadMtl("a.mtl", "newmtl a\nKd 1 0\nKd 1 0 2\nKd 1 0 nan\n", found); }),
            "a.mtl: line 2: Kd must be three numbers from 0 to 1 (got \"Kd 1 0\")\n"
            "a.mtl: line 3: Kd must be three numbers from 0 to 1 (got \"Kd 1 0 2\")\n"
            "a.mtl: line 4: Kd must be three numbers from 0 to 1 (got \"Kd 1 0 nan\")");
}

}  // namespace
}  // namespace railcast
