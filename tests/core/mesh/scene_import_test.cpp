// What scenes of modelling programs say, which assimp alone would not give.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/mesh/assimp_reader.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/mesh/imported_meshes.h"
#include "tests/core/mesh/made_scenes.h"

namespace railcast {
namespace {

using Box = Eigen::AlignedBox3d;

/// In the file's axes, z up.
Box BoxOf(const ImportedMesh& mesh) {
  return Bounds(Merged(mesh)).translated(mesh.origin_m);
}

class SceneImport : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasAssimp()) GTEST_SKIP() << "built without assimp";
  }
};

// The triangle lies in y up, so that it stands.
const Box kStanding{Vector3(0, 0, 0), Vector3(1, 0, 1)};
const Box kLying{Vector3(0, 0, 0), Vector3(1, 1, 0)};

std::string Number(std::size_t number) {
  const auto word = static_cast<std::uint32_t>(number);
  std::string bytes(sizeof(word), '\0');
  std::memcpy(bytes.data(), &word, sizeof(word));
  return bytes;
}

// Of version 1, whose header says how long the JSON is and that it is JSON; the rest is the buffer.
std::string BinaryGltfOfVersion1(std::size_t num_blanks) {
  std::string json =
      R"({"asset": {"version": "1.0"}, "scene": "s", "scenes": {"s": {"nodes": ["n"]}},
      "nodes": {"n": {"meshes": ["m"]}},
      "meshes": {"m": {"primitives": [{"attributes": {"POSITION": "a"}, "material": "t"}]}},
      "materials": {"t": {"name": "Paint"}},
      "accessors": {"a": {"bufferView": "b", "byteOffset": 0, "byteStride": 0,
                          "componentType": 5126, "count": 3, "type": "VEC3"}},
      "bufferViews": {"b": {"buffer": "binary_glTF", "byteOffset": 0, "byteLength": 36}},
      "buffers": {"binary_glTF": {"byteLength": 36, "type": "arraybuffer", "uri": "data:,"}},
      "extensionsUsed": ["KHR_binary_glTF"]})";
  json.resize((json.size() + 3) / 4 * 4 + num_blanks, ' ');
  const std::string buffer = BytesOfFloats({0, 0, 0, 1, 0, 0, 0, 1, 0});
  return "glTF" + Number(1) + Number(20 + json.size() + buffer.size()) + Number(json.size()) +
         Number(0) + json + buffer;
}

TEST_F(SceneImport, ReadsBinaryGltfOfVersion1) {
  const ImportedMesh mesh = ParseMesh(BinaryGltfOfVersion1(0), "a.glb");
  EXPECT_EQ(mesh.num_triangles(), 1U);
  EXPECT_TRUE(BoxOf(mesh).isApprox(kStanding, 1e-6));
}

// Its buffer begins elsewhere than assimp looks for it.
TEST_F(SceneImport, RefusesBinaryGltfOfWhichTheFirstChunkIsNotPadded) {
  EXPECT_THAT(MessageOf([] { (void)ParseMesh(BinaryGltfOfVersion1(1), "a.glb"); }),
              testing::ContainsRegex("^a.glb: its first chunk must have a multiple of 4 bytes .got "
                                     "[0-9]+.$"));
}

// Of a skinned mesh, "the transform of the node is ignored" (glTF 2.0, 3.7.3.3): exporters scale it
// by 100. One vertex hangs on the first joint, one on the second, one on both.
TEST_F(SceneImport, PutsASkinWhereItsBonesAre) {
  const TemporaryDirectory folder;
  const std::string joints(
      "\0\0\0\0"
      "\1\0\0\0"
      "\0\1\0\0",
      12);
  std::string buffer = BytesOfFloats({0, 0, 0, 1, 0, 0, 0, 1, 0}) + joints;
  buffer += BytesOfFloats({1, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0});
  for (int i = 0; i < 2; ++i) {
    // Half as large, for the joints are twice as large as the mesh.
    buffer += BytesOfFloats({0.5F, 0, 0, 0, 0, 0.5F, 0, 0, 0, 0, 0.5F, 0, 0, 0, 0, 1});
  }
  std::ofstream(folder.path() / "skin.bin", std::ios::binary) << buffer;
  std::ofstream(folder.path() / "skin.gltf", std::ios::binary)
      << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
    "nodes": [{"mesh": 0, "skin": 0, "name": "body", "scale": [100, 100, 100]},
              {"name": "low", "scale": [2, 2, 2]},
              {"name": "high", "scale": [2, 2, 2], "translation": [0, 4, 0]}],
    "skins": [{"joints": [1, 2], "inverseBindMatrices": 3}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [0, 0, 0], "max": [1, 1, 0]},
                  {"bufferView": 1, "componentType": 5121, "count": 3, "type": "VEC4"},
                  {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC4"},
                  {"bufferView": 3, "componentType": 5126, "count": 2, "type": "MAT4"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36},
                    {"buffer": 0, "byteOffset": 36, "byteLength": 12},
                    {"buffer": 0, "byteOffset": 48, "byteLength": 48},
                    {"buffer": 0, "byteOffset": 96, "byteLength": 128}],
    "buffers": [{"byteLength": 224, "uri": "skin.bin"}]})";
  const ImportedMesh mesh = ReadMesh(folder.path() / "skin.gltf");
  // (0, 0, 0), (1, 4, 0) and (0, 1 + 4/2, 0), with y up.
  EXPECT_TRUE(BoxOf(mesh).isApprox(Box(Vector3(0, 0, 0), Vector3(1, 0, 4)), 1e-6));
  EXPECT_NEAR(mesh.area_m2, 1.5, 1e-6);
}

/// A part of a 3DS file: its kind, its length and what it holds.
std::string ChunkOf3ds(std::uint16_t kind, const std::string& content) {
  std::string bytes(sizeof(kind), '\0');
  std::memcpy(bytes.data(), &kind, sizeof(kind));
  return bytes + Number(sizeof(kind) + 4 + content.size()) + content;
}

// A 3DS file does not say what its unit and its upward axis are.
TEST_F(SceneImport, ScalesAndTurns3dsAsTold) {
  using std::string_literals::operator""s;
  const std::string vertices = "\3\0"s + BytesOfFloats({10, 20, 30, 11, 20, 30, 10, 22, 30});
  const std::string faces = "\1\0\0\0\1\0\2\0\7\0"s;
  const std::string bytes = ChunkOf3ds(
      0x4D4D,
      ChunkOf3ds(0x3D3D,
                 ChunkOf3ds(0x4000, "it\0"s + ChunkOf3ds(0x4100, ChunkOf3ds(0x4110, vertices) +
                                                                     ChunkOf3ds(0x4120, faces)))));
  const ImportedMesh plain = ParseMesh(bytes, "a.3ds");
  EXPECT_TRUE(BoxOf(plain).isApprox(Box(Vector3(10, 20, 30), Vector3(11, 22, 30)), 1e-6));
  EXPECT_FALSE(plain.has_own_up);
  const Box scaled = BoxOf(ParseMesh(bytes, "a.3ds", {.unit_m = 0.01, .y_up = {}}));
  EXPECT_TRUE(scaled.isApprox(Box(Vector3(0.1, 0.2, 0.3), Vector3(0.11, 0.22, 0.3)), 1e-6));
  const Box turned = BoxOf(ParseMesh(bytes, "a.3ds", {.unit_m = {}, .y_up = true}));
  EXPECT_TRUE(turned.isApprox(Box(Vector3(10, -30, 20), Vector3(11, -30, 22)), 1e-6));
}

const std::string kTriangleDae = TriangleDae("<node><instance_geometry url=\"#g\"/></node>");

std::string Replaced(std::string text, const std::string& part, const std::string& by) {
  EXPECT_NE(text.find(part), std::string::npos) << part;
  return text.replace(text.find(part), part.size(), by);
}

TEST_F(SceneImport, ReadsDaeWithBlanksRoundItsValues) {
  EXPECT_TRUE(BoxOf(ParseMesh(kTriangleDae, "a.dae")).isApprox(kLying, 1e-6));
  for (const auto& [part, by] : {std::pair{">Z_UP<", ">\n  Z_UP\n<"},
                                 {"meter=\"1\"", "meter=\" 1 \""},
                                 {">0 0 0 1 0 0 0 1 0<", ">\t0 0 0 1 0 0 0 1 0\r\n<"},
                                 {"<p>0 1 2<", "<p> 0 1 2 <"},
                                 {"source=\"#p\"", "source=\" #p \""},
                                 {"semantic=\"VERTEX\"", "semantic=' VERTEX '"},
                                 {"count=\"9\"", "count=\" 9 \""}}) {
    const ImportedMesh mesh = ParseMesh(Replaced(kTriangleDae, part, by), "a.dae");
    EXPECT_TRUE(BoxOf(mesh).isApprox(kLying, 1e-6)) << by;
  }
  const std::string centimetres = Replaced(kTriangleDae, "meter=\"1\"", "meter=\" 0.01 \"");
  EXPECT_NEAR(BoxOf(ParseMesh(centimetres, "a.dae")).max().x(), 0.01, 1e-8);
}

TEST_F(SceneImport, LeavesCommentsOfDaeAlone) {
  const std::string text = Replaced(kTriangleDae, "<library_geometries>",
                                    "<!-- it's > \" here --><library_geometries><!-- -->");
  EXPECT_EQ(ParseMesh(text, "a.dae").num_triangles(), 1U);
}

std::string AsUtf16(std::string_view ascii, bool is_big) {
  std::string bytes;
  for (const char letter : ascii) {
    if (is_big) bytes += '\0';
    bytes += letter;
    if (!is_big) bytes += '\0';
  }
  return bytes;
}

TEST_F(SceneImport, ReadsDaeInUtf16) {
  const std::string text = Replaced(kTriangleDae, "utf-8", "utf-16");
  for (const std::string& bytes : {"\xFF\xFE" + AsUtf16(text, false),
                                   "\xFE\xFF" + AsUtf16(text, true), AsUtf16(text, false)}) {
    EXPECT_TRUE(BoxOf(ParseMesh(bytes, "a.dae")).isApprox(kLying, 1e-6));
  }
}

/// An axis of an FBX file: which coordinate, and its sign.
struct AxisOfFile {
  int axis = 0;
  int sign = 1;
};

/// A triangle that reaches 2 to the right, 3 away from the front and 4 up, as FBX in metres with
/// these axes to the right, to the front and up.
std::string TriangleFbx(const std::array<AxisOfFile, 3>& axes) {
  constexpr std::array<const char*, 3> kNames = {"CoordAxis", "FrontAxis", "UpAxis"};
  constexpr std::array<int, 3> kReach = {2, -3, 4};
  std::string settings;
  std::string vertices;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::string name = kNames[i];
    settings += "P: \"" + name + "\", \"int\", \"Integer\", \"\"," + std::to_string(axes[i].axis) +
                "\n" + "P: \"" + name + "Sign\", \"int\", \"Integer\", \"\"," +
                std::to_string(axes[i].sign) + "\n";
    for (int axis = 0; axis < 3; ++axis) {
      const int place = axis == axes[i].axis ? axes[i].sign * kReach[i] : 0;
      vertices += (vertices.empty() ? "" : ",") + std::to_string(place);
    }
  }
  return "; FBX 7.4.0 project file\nFBXHeaderExtension: {\nFBXHeaderVersion: 1003\n"
         "FBXVersion: 7400\n}\nGlobalSettings: {\nVersion: 1000\nProperties70: {\n" +
         settings +
         "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",100\n}\n}\nObjects: {\n"
         "Geometry: 1000, \"Geometry::t\", \"Mesh\" {\nVertices: *9 {\na: " +
         vertices +
         "\n}\nPolygonVertexIndex: *3 {\na: 0,1,-3\n}\n}\nModel: 2000, \"Model::t\", \"Mesh\" {\n"
         "Version: 232\n}\n}\nConnections: {\nC: \"OO\",1000,2000\nC: \"OO\",2000,0\n}\n";
}

// There are 24 right-handed systems. What is left-handed is mirrored, and that is told.
TEST_F(SceneImport, TurnsFbxAsItsAxesSay) {
  const Box box(Vector3(0, 0, 0), Vector3(2, 3, 4));
  int num_right_handed = 0;
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      std::array<AxisOfFile, 3> axes;
      Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
      for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(i);
        axes[at] = {order[at], (signs >> i & 1) == 0 ? 1 : -1};
        matrix(i, axes[at].axis) = i == 1 ? -axes[at].sign : axes[at].sign;
      }
      const ImportedMesh mesh = ParseMesh(TriangleFbx(axes), "a.fbx");
      EXPECT_TRUE(BoxOf(mesh).isApprox(box, 1e-6)) << TriangleFbx(axes);
      const bool is_right_handed = matrix.determinant() > 0.0;
      if (is_right_handed) ++num_right_handed;
      std::vector<Remark> remarks;
      if (!is_right_handed) remarks.push_back({RemarkKind::kAxesMirrored, "a.fbx"});
      EXPECT_EQ(mesh.remarks, remarks);
    }
  } while (std::ranges::next_permutation(order).found);
  EXPECT_EQ(num_right_handed, 24);
}

TEST_F(SceneImport, TurnsFbxAsToldInsteadIfTold) {
  const std::string bytes = TriangleFbx({{{0, 1}, {1, 1}, {2, -1}}});
  const Box plain = BoxOf(ParseMesh(bytes, "a.fbx", {.unit_m = {}, .y_up = false}));
  EXPECT_TRUE(plain.isApprox(Box(Vector3(0, -3, -4), Vector3(2, 0, 0)), 1e-6));
}

TEST_F(SceneImport, RefusesAxesOfFbxThatAreNoSystem) {
  EXPECT_EQ(MessageOf([] {
              (void)ParseMesh(TriangleFbx({{{0, 1}, {2, 1}, {2, 1}}}), "a.fbx");
            }),
            "a.fbx: its axes must be three of 0, 1 and 2 with signs 1 or -1 (got CoordAxis 1 * 0, "
            "FrontAxis 1 * 2, UpAxis 1 * 2)");
}

std::string GltfWith(const std::string& members) {
  return TriangleGltf("{\"mesh\": 0}", R"(, "materials": [{"name": "a"}], )" + members);
}

TEST_F(SceneImport, RefusesWhatGltfNeedsAndIsNotRead) {
  const auto complaint = [](const std::string& extension) {
    return MessageOf([&] {
      (void)ParseMesh(GltfWith("\"extensionsRequired\": [\"" + extension + "\"]"), "a.gltf");
    });
  };
  const std::string rule = "a.gltf: extensionsRequired: must be extensions that are read; ";
  EXPECT_EQ(complaint("ACME_shrinks_everything"),
            rule + "railcast reads files without it only (got \"ACME_shrinks_everything\")");
  EXPECT_EQ(complaint("EXT_meshopt_compression"),
            rule +
                "gltfpack -noq -i IN.glb -o OUT.glb writes it without (got "
                "\"EXT_meshopt_compression\")");
  EXPECT_EQ(complaint("KHR_texture_transform"), "no error");
  EXPECT_EQ(complaint("KHR_mesh_quantization"), "no error") << "its positions are floats";
}

// A box of 2 x 3 x 4, encoded with Google's library for 14 bits.
TEST_F(SceneImport, ReadsGltfCompressedWithDraco) {
  const std::string data =
      "RFJBQ08CAgEBAAAACAwACwAAA19LFQEBEAH/AAABAAkDAAACAQEBAA8DARAvATADACSX/"
      "z8AAAAAAAFgAAAACIAAwP8vAAIA+P//PwEA/z8AAAAAAAAAAP8/AAAAAAAAAAAAAAAAAAAAAIBADg==";
  const std::string extension = R"("extensionsUsed": ["KHR_draco_mesh_compression"],
    "extensionsRequired": ["KHR_draco_mesh_compression"])";
  const ImportedMesh mesh = ParseMesh(R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{
      "attributes": {"POSITION": 0}, "indices": 1, "extensions": {"KHR_draco_mesh_compression":
        {"bufferView": 0, "attributes": {"POSITION": 0}}}}]}],
    "accessors": [{"componentType": 5126, "count": 8, "type": "VEC3", "min": [0, 0, 0],
                   "max": [2, 3, 4]}, {"componentType": 5123, "count": 36, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 109}], "buffers": [{"byteLength": 109,
      "uri": "data:application/octet-stream;base64,)" +
                                          data + "\"}], " + extension + "}",
                                      "a.gltf");
  EXPECT_EQ(mesh.num_triangles(), 12U);
  EXPECT_TRUE(BoxOf(mesh).isApprox(Box(Vector3(0, -4, 0), Vector3(2, 0, 3)), 1e-3));
}

TEST_F(SceneImport, TellsWhatGltfUsesAndIsNotRead) {
  const ImportedMesh mesh =
      ParseMesh(GltfWith(R"("extensionsUsed": ["KHR_materials_unlit", "EXT_mesh_gpu_instancing",
                "KHR_materials_pbrSpecularGlossiness"])"),
                "a.gltf");
  EXPECT_EQ(mesh.remarks, (std::vector<Remark>{{RemarkKind::kExtensionUnread, "a.gltf", 2,
                                                "\"EXT_mesh_gpu_instancing\""}}));
}

/// glTF 2, text or binary, of nodes, meshes, accessors and views; its buffer holds what it is
/// given.
std::string GltfOf(const std::string& members, const std::string& buffer) {
  std::string json = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "extensionsRequired": ["KHR_mesh_quantization"], )" +
                     members + R"(, "buffers": [{"byteLength": )" + std::to_string(buffer.size()) +
                     "}]}";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  return "glTF" + Number(2) + Number(28 + json.size() + buffer.size()) + Number(json.size()) +
         "JSON" + json + Number(buffer.size()) + std::string("BIN\0", 4) + buffer;
}

/// Three corners, each coordinate of so many bytes, two elements apart from each other by `stride`.
std::string CornersOf(const std::array<std::array<int, 3>, 3>& corners,
                      std::size_t size,
                      std::size_t stride) {
  std::string bytes(3 * stride, '\x55');
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      std::memcpy(bytes.data() + i * stride + k * size, &corners[i][k], size);
  }
  return bytes;
}

// "Normalised" divides by the largest number of the type, and -128 stands for -1, too (glTF 2.0,
// 3.6.2.2). The boxes are x, -z, y of the corners.
TEST_F(SceneImport, ReadsQuantisedPositionsOfGltf) {
  struct Case {
    int type;
    bool is_normalised;
    std::size_t size;
    std::array<int, 3> far;
    Vector3 expected;
  };
  for (const Case& one : {Case{5120, false, 1, {-128, 100, 7}, {-128, 100, 7}},
                          Case{5120, true, 1, {-128, 127, -127}, {-1, 1, -1}},
                          Case{5121, false, 1, {255, 1, 200}, {255, 1, 200}},
                          Case{5121, true, 1, {255, 51, 102}, {1, 0.2, 0.4}},
                          Case{5122, false, 2, {-30000, 1, 5}, {-30000, 1, 5}},
                          Case{5122, true, 2, {-32768, 32767, -32767}, {-1, 1, -1}},
                          Case{5123, false, 2, {60000, 1, 5}, {60000, 1, 5}},
                          Case{5123, true, 2, {65535, 13107, 26214}, {1, 0.2, 0.4}}}) {
    const std::string bytes = GltfOf(
        R"("nodes": [{"mesh": 0, "scale": [0.125, 0.125, 0.125]}, {}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "count": 3, "type": "VEC3", "componentType": )" +
            std::to_string(one.type) + R"(, "normalized": )" +
            (one.is_normalised ? "true" : "false") + R"(}],
        "bufferViews": [{"buffer": 0, "byteStride": )" +
            std::to_string(4 * one.size) + R"(, "byteLength": )" + std::to_string(12 * one.size) +
            "}]",
        CornersOf({{{0, 0, 0}, {one.far[0], 0, 0}, one.far}}, one.size, 4 * one.size));
    const ImportedMesh mesh = ParseMesh(bytes, "a.glb");
    Box box(Vector3(0, 0, 0));
    box.extend(0.125 * Vector3(one.expected.x(), -one.expected.z(), one.expected.y()));
    EXPECT_TRUE(BoxOf(mesh).isApprox(box, 1e-6)) << one.type << " " << one.is_normalised;
    EXPECT_TRUE(mesh.remarks.empty());
  }
}

/// A triangle of legs 1 with a target that moves its corners by (0, 0, 8), as floats, and one that
/// moves the third alone by (0, 4, 0), sparse and as bytes.
std::string MorphedGltf(const std::string& nodes, const std::string& weights) {
  return GltfOf("\"nodes\": " + nodes + R"(, "meshes": [{"weights": )" + weights +
                    R"(, "primitives": [{"attributes": {"POSITION": 0},
                         "targets": [{"POSITION": 1}, {"POSITION": 2}]}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                  {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"},
                  {"componentType": 5120, "count": 3, "type": "VEC3", "sparse": {"count": 1,
                   "indices": {"bufferView": 2, "componentType": 5121},
                   "values": {"bufferView": 2, "byteOffset": 4}}}],
    "bufferViews": [{"buffer": 0, "byteLength": 36},
                    {"buffer": 0, "byteOffset": 36, "byteLength": 36},
                    {"buffer": 0, "byteOffset": 72, "byteLength": 8}])",
                BytesOfFloats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 8, 0, 0, 8, 0, 0, 8}) +
                    std::string("\2\0\0\0\0\4\0\0", 8));
}

// z up: what the first target moves goes to -y, what the second one moves up.
TEST_F(SceneImport, MovesVerticesOfGltfByTheWeightsOfTheNodeOrElseOfTheMesh) {
  const auto box = [](const std::string& nodes, const std::string& weights) {
    const ImportedMesh mesh = ParseMesh(MorphedGltf(nodes, weights), "a.glb");
    EXPECT_TRUE(mesh.remarks.empty());
    return BoxOf(mesh);
  };
  const std::string plain = "[{\"mesh\": 0}, {}]";
  EXPECT_TRUE(box(plain, "[0, 0]").isApprox(kStanding, 1e-6));
  EXPECT_TRUE(box(plain, "[0.5, 0.25]").isApprox(Box(Vector3(0, -4, 0), Vector3(1, -4, 2)), 1e-6));
  EXPECT_TRUE(box(R"([{"mesh": 0, "weights": [0, 0]}, {}])", "[1, 1]").isApprox(kStanding, 1e-6));
  EXPECT_TRUE(box(R"([{"mesh": 0}, {"mesh": 0, "weights": [1, 0]}])", "[0, 1]")
                  .isApprox(Box(Vector3(0, -8, 0), Vector3(1, 0, 5)), 1e-6));
  const auto message = [](const std::string& weights) {
    return MessageOf(
        [&] { (void)ParseMesh(MorphedGltf("[{\"mesh\": 0}, {}]", weights), "a.glb"); });
  };
  EXPECT_EQ(message("[1]"), "a.glb: weights: must be one for each morph target (got 1 for 2)");
  EXPECT_EQ(message("[1, \"0\"]"), "a.glb: weights: must be numbers (got \"0\")");
}

TEST_F(SceneImport, RefusesPositionsOfGltfThatAreNoFloatsUnlessTheFileSaysSo) {
  const std::string bytes = Replaced(GltfWith("\"extensionsUsed\": []"), "5126", "5123");
  EXPECT_EQ(MessageOf([&] { (void)ParseMesh(bytes, "a.gltf"); }),
            "a.gltf: accessors/0/componentType: of POSITION must be 5126, float, unless "
            "KHR_mesh_quantization is required (got 5123)");
}

TEST_F(SceneImport, RefusesQuantisedPositionsBeyondTheirBuffer) {
  const std::string bytes = Replaced(
      Replaced(GltfWith("\"extensionsRequired\": [\"KHR_mesh_quantization\"]"), "5126", "5123"),
      "\"count\": 3", "\"count\": 9");
  EXPECT_EQ(MessageOf([&] { (void)ParseMesh(bytes, "a.gltf"); }),
            "a.gltf: accessors/0: must lie within its bufferView, which holds 6 elements (got 9)");
}

std::string GltfWithMaterials(const std::string& materials) {
  return TriangleGltf("{\"mesh\": 0}", ", \"materials\": [" + materials + "]");
}

TEST_F(SceneImport, TakesTheLuminanceOfBaseColours) {
  const auto luminance = [](const std::string& materials) {
    return ParseMesh(GltfWithMaterials(materials), "a.gltf").parts.at(0).luminance;
  };
  const auto colour =
      luminance(R"({"name": "a", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1]}})");
  ASSERT_TRUE(colour.has_value());
  EXPECT_NEAR(*colour, 0.2126 * 0.5 + 0.7152 * 0.25 + 0.0722, 1e-6);
  EXPECT_EQ(luminance(R"({"name": "white by default"})"), 1.0);
  EXPECT_EQ(luminance(R"({"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}})"), 0.0);
  const std::string picture =
      R"({"name": "a", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], "textures":
         [{"source": 0}], "images": [{"uri": "a.png"})";
  EXPECT_EQ(luminance(picture), std::nullopt);
  std::string none = GltfWithMaterials("{\"name\": \"a\"}");
  none = Replaced(none, R"(, "material": 0)", "");
  EXPECT_EQ(ParseMesh(none, "a.gltf").parts.at(0).luminance, std::nullopt);
}

TEST_F(SceneImport, RefusesBaseColoursThatAreNone) {
  const std::string bytes = GltfWithMaterials(
      R"({"name": "a", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 2.5, 1, 1]}})");
  EXPECT_EQ(MessageOf([&] { (void)ParseMesh(bytes, "a.gltf"); }),
            "a.gltf: the base colour of \"a\" must have parts from 0 to 1 (got 2.5)");
}

}  // namespace
}  // namespace railcast
