#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/mesh/mesh_import.h"
#include "tests/mutants/mutants.h"

namespace railcast {
namespace {

Reading ReadMeshWhole(const std::filesystem::path& file) {
  const ImportedMesh mesh = ReadMesh(file);
  Reading reading{.remarks = mesh.remarks};
  // `check` has their number in a line of its own.
  if (mesh.num_cornerless > 0) {
    reading.remarks.push_back({RemarkKind::kExtensionUnread, "", mesh.num_cornerless});
  }
  std::vector<double>& values = reading.values;
  for (const NamedMesh& part : mesh.parts) {
    values.push_back(static_cast<double>(
        std::hash<std::string>{}(part.material + "/" + part.group) % 1'000'003));
    values.push_back(part.luminance.value_or(-1.0));
    for (const auto& triangle : part.mesh.triangles) {
      for (const std::uint32_t corner : triangle) {
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
          values.push_back(static_cast<double>(part.mesh.vertices.at(corner)[axis]) +
                           mesh.origin_m[axis]);
        }
      }
    }
  }
  return reading;
}

using Corner = std::array<float, 3>;

/// A box with a roof: 10 points.
constexpr std::array<Corner, 10> kPoints = {{{0, 0, 0},
                                             {4, 0, 0},
                                             {4, 3, 0},
                                             {0, 3, 0},
                                             {0, 0, 2.5F},
                                             {4, 0, 2.5F},
                                             {4, 3, 2.5F},
                                             {0, 3, 2.5F},
                                             {0, 1.5F, 3.5F},
                                             {4, 1.5F, 3.5F}}};
constexpr std::array<std::array<std::uint32_t, 3>, 16> kFaces = {{{0, 2, 1},
                                                                  {0, 3, 2},
                                                                  {0, 1, 5},
                                                                  {0, 5, 4},
                                                                  {1, 2, 6},
                                                                  {1, 6, 5},
                                                                  {2, 3, 7},
                                                                  {2, 7, 6},
                                                                  {3, 0, 4},
                                                                  {3, 4, 7},
                                                                  {4, 5, 9},
                                                                  {4, 9, 8},
                                                                  {6, 7, 8},
                                                                  {6, 8, 9},
                                                                  {7, 4, 8},
                                                                  {5, 6, 9}}};

std::string PointsText(const std::string& begin) {
  std::string text;
  for (const Corner& point : kPoints) {
    text += begin + NumberText(point[0]) + " " + NumberText(point[1]) + " " + NumberText(point[2]) +
            "\n";
  }
  return text;
}
std::string FacesText(const std::string& begin, std::uint32_t first) {
  std::string text;
  for (const auto& [a, b, c] : kFaces) {
    text += begin + NumberText(a + first) + " " + NumberText(b + first) + " " +
            NumberText(c + first) + "\n";
  }
  return text;
}

/// Changes of the lines of a text behind the first ones.
/// @param is_face Whether a line has indices behind its word or number.
void TryMeshLines(Mutants& mutants,
                  std::size_t num_head,
                  const std::function<bool(const std::string&)>& is_face) {
  const std::string& good = mutants.good();
  std::string_view rest = good;
  for (std::size_t i = 0;; ++i) {
    const std::size_t place = good.size() - rest.size();
    const auto found = TakeLine(rest);
    if (!found) break;
    const std::string line(*found);
    const auto with = [&](const std::string& what, const std::string& other) {
      mutants.Try(what, "line " + NumberText(i) + ": " + other,
                  std::string(good).replace(place, line.size() + 1, other));
    };
    if (line.empty()) continue;
    with("a line doubled within its words", line + " " + line + "\n");
    if (line.find(' ') != std::string::npos)
      with("a word lost", line.substr(0, line.rfind(' ')) + "\n");
    if (i < num_head) {
      with("a line of the header lost", "");
      continue;
    }
    const std::size_t blank = line.rfind(' ');
    if (blank == std::string::npos) continue;
    for (const char* word : {"x", "1,5", "nan", "inf", "1e39", "1e400", "0x1", "", "1.5.2",
                             is_face(line) ? "99" : "x"}) {
      with(std::string("a number as ") + (*word == 0 ? "nothing" : word),
           line.substr(0, blank + 1) + word + "\n");
    }
  }
}

TEST(MeshMutants, OfTextAreNeverReadWrongWithoutAWord) {
  Mutants of_obj("OBJ", "a.obj", PointsText("v ") + FacesText("f ", 1), ReadMeshWhole);
  TryMeshLines(of_obj, 0, [](const std::string& line) { return line.starts_with("f "); });
  for (std::size_t i = 0; i < kFaces.size(); ++i) {
    const std::string face = "f ";
    for (const char* other : {"F ", "fo ", "curv ", "face "}) {
      of_obj.Try("the word of a face changed", other + NumberText(i),
                 Replaced(of_obj.good(), "\n" + face, std::string("\n") + other, i));
    }
    for (const char* other : {"V ", "vp ", "v  ", "vertex "}) {
      of_obj.Try("the word of a vertex changed", other + NumberText(i),
                 Replaced(of_obj.good(), "\nv ", std::string("\n") + other, i));
    }
  }
  for (const char* words : {"mtllib gone.mtl\n", "s off\n", "bevel on\n", "curv2 1 2\n",
                            "surf 0 1 0 1 1 2 3 4\n", "call other.obj\n", "# units mm\n"}) {
    of_obj.Try("a line more", words, words + of_obj.good());
  }
  of_obj.TryHarmless("a face of two corners", of_obj.good() + "f 1 2\n");
  TryCuts(of_obj, 3);
  const std::string counts = NumberText(kPoints.size()) + " " + NumberText(kFaces.size());
  Mutants of_off("OFF", "a.off", "OFF\n" + counts + " 0\n" + PointsText("") + FacesText("3 ", 0),
                 ReadMeshWhole);
  TryMeshLines(of_off, 2,
               [](const std::string& line) { return std::ranges::count(line, ' ') == 3; });
  for (const char* other : {"9 16", "11 16", "10 15", "10 17", "16 10", "0 16", "10 0", "-10 16"}) {
    of_off.Try("numbers of points and faces changed", other,
               Replaced(of_off.good(), counts, other));
  }
  for (const char* other : {"NOFF", "COFF", "STOFF", "4OFF", "nOFF", "OFF BINARY", "off"}) {
    of_off.Try("the first word changed", other, Replaced(of_off.good(), "OFF", other));
  }
  of_off.TryHarmless("a face of two corners", Replaced(of_off.good(), counts, "10 17") + "2 0 1\n");
  TryCuts(of_off, 3);
  std::string stl = "solid box\n";
  for (const auto& face : kFaces) {
    stl += "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t corner : face) {
      const Corner& point = kPoints.at(corner);
      stl += "vertex " + NumberText(point[0]) + " " + NumberText(point[1]) + " " +
             NumberText(point[2]) + "\n";
    }
    stl += "endloop\nendfacet\n";
  }
  Mutants of_stl("STL, ascii", "a.stl", stl + "endsolid box\n", ReadMeshWhole);
  TryMeshLines(of_stl, 1, [](const std::string&) { return false; });
  for (std::size_t i = 0; i < 48; ++i) {
    for (const auto& [part, other] :
         std::vector<std::array<const char*, 2>>{{"vertex ", "Vertex "},
                                                 {"vertex ", "vertx "},
                                                 {"vertex ", ""},
                                                 {"endfacet\n", ""},
                                                 {"endloop\n", ""},
                                                 {"outer loop\n", ""},
                                                 {"facet normal 0 0 0\n", ""},
                                                 {"facet normal", "facet"}}) {
      of_stl.Try("a word changed or lost", std::string(part) + other + NumberText(i),
                 Replaced(of_stl.good(), part, other, i));
    }
  }
  of_stl.TryHarmless("another end", Replaced(of_stl.good(), "endsolid", "end solid"));
  of_stl.TryHarmless("words behind the end", of_stl.good() + "made by hand\n");
  TryCuts(of_stl, 17);
  constexpr const char* kDigits = "digits of a number are lost, and what is left is a number";
  of_obj.Excuse("cut off", "OBJ says nowhere how much it holds");
  of_obj.Excuse("a line more", "a comment that names the unit is obeyed");
  for (Mutants* mutants : {&of_obj, &of_off, &of_stl}) {
    mutants->TryHarmless("line ends of Windows", AllReplaced(mutants->good(), "\n", "\r\n"));
    mutants->Excuse("a byte lost", kDigits);
  }
  CheckSection("Meshes in text", {&of_obj, &of_off, &of_stl});
}

std::string PlyMesh(bool is_text) {
  std::string text = "ply\nformat " + std::string(is_text ? "ascii" : "binary_little_endian") +
                     " 1.0\nelement vertex 10\nproperty float x\nproperty float y\nproperty float "
                     "z\nelement face 16\nproperty list uchar int vertex_indices\nend_header\n";
  if (is_text) return text + PointsText("") + FacesText("3 ", 0);
  for (const Corner& point : kPoints)
    for (const float number : point) text += BytesOf(number);
  for (const auto& face : kFaces) {
    text += '\3';
    for (const std::uint32_t corner : face) text += BytesOf(corner);
  }
  return text;
}

TEST(MeshMutants, OfPlyAndStlAreNeverReadWrongWithoutAWord) {
  Mutants of_text("PLY mesh, ascii", "a.ply", PlyMesh(true), ReadMeshWhole);
  TryMeshLines(of_text, 9,
               [](const std::string& line) { return std::ranges::count(line, ' ') == 3; });
  of_text.TryHarmless("line ends of Windows", AllReplaced(of_text.good(), "\n", "\r\n"));
  of_text.TryHarmless("a face of two corners",
                      Replaced(of_text.good(), "face 16", "face 17") + "2 0 1\n");
  of_text.TryHarmless("an element without properties",
                      Replaced(of_text.good(), "element face", "element edge 3\nelement face"));
  TryCuts(of_text, 3);
  Mutants of_binary("PLY mesh, binary", "a.ply", PlyMesh(false), ReadMeshWhole);
  TryCuts(of_binary, 3);
  for (Mutants* mutants : {&of_text, &of_binary}) {
    for (const char* type :
         {"char", "uchar", "short", "ushort", "int", "uint", "float", "double", "half"}) {
      for (const char* property : {"float x", "float y", "float z"}) {
        mutants->Try("type of a property changed", std::string(type) + property,
                     Replaced(mutants->good(), property, type + std::string(property).substr(5)));
        mutants->Try("a property too many", std::string(type) + property,
                     Replaced(mutants->good(), property,
                              std::string(property) + "\nproperty " + type + " w"));
      }
      mutants->Try("type of a list changed", type,
                   Replaced(mutants->good(), "list uchar int", std::string("list uchar ") + type));
      mutants->Try(
          "type of a list changed", type,
          Replaced(mutants->good(), "list uchar int", std::string("list ") + type + " int"));
    }
    for (const char* num : {"0", "1", "9", "11", "15", "17", "100", "-1", "4294967295"}) {
      mutants->Try("number of vertices or faces changed", num,
                   Replaced(mutants->good(), "vertex 10", std::string("vertex ") + num));
      mutants->Try("number of vertices or faces changed", num,
                   Replaced(mutants->good(), "face 16", std::string("face ") + num));
    }
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian", "binary"}) {
      const std::size_t begin = mutants->good().find("format ") + 7;
      mutants->Try("format changed", format,
                   std::string(mutants->good())
                       .replace(begin, mutants->good().find(' ', begin) - begin, format));
    }
    for (const char* name : {"vertex_index", "indices", "vertices", "corners"}) {
      mutants->Try("name of the list changed", name,
                   Replaced(mutants->good(), "vertex_indices", name));
    }
    mutants->Try(
        "an element more in the header", "",
        Replaced(mutants->good(), "element face", "element edge 3\nproperty int a\nelement face"));
    mutants->Try("the name of an element changed", "",
                 Replaced(mutants->good(), "element face", "element faces"));
    mutants->Try("the name of an element changed", "",
                 Replaced(mutants->good(), "element vertex", "element vertices"));
    for (std::size_t num = 1; num < 30; ++num) {
      mutants->Try("bytes behind the data", NumberText(num),
                   mutants->good() + std::string(num, '7'));
    }
  }
  std::string stl(80, ' ');
  stl += BytesOf(static_cast<std::uint32_t>(kFaces.size()));
  for (const auto& face : kFaces) {
    stl += std::string(12, '\0');
    for (const std::uint32_t corner : face)
      for (const float number : kPoints.at(corner)) stl += BytesOf(number);
    stl += std::string(2, '\0');
  }
  Mutants of_stl("STL, binary", "a.stl", stl, ReadMeshWhole);
  for (const std::uint32_t num : {0U, 1U, 15U, 17U, 32U, 1'000'000U, 4'000'000'000U, 0x10000000U}) {
    of_stl.Try("number of triangles changed", NumberText(num), With(stl, 80, BytesOf(num)));
  }
  for (std::size_t num = 1; num < 60; ++num)
    of_stl.Try("bytes behind the data", NumberText(num), stl + std::string(num, '7'));
  TryCuts(of_stl, 7);
  of_text.Excuse("a byte lost", "digits of a number are lost, and what is left is a number");
  CheckSection("Meshes in PLY and STL", {&of_text, &of_binary, &of_stl});
}

/// RFC 4648, of whole groups of three bytes.
std::string Base64Of(const std::string& bytes) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i + 2 < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j)
      group = group << 8U | static_cast<std::uint8_t>(bytes[i + j]);
    for (const std::uint32_t shift : {18U, 12U, 6U, 0U}) text += kLetters[group >> shift & 63U];
  }
  return text;
}

std::string GltfBuffer() {
  std::string buffer;
  for (const Corner& point : kPoints)
    for (const float number : point) buffer += BytesOf(number);
  for (const auto& face : kFaces)
    for (const std::uint32_t corner : face) buffer += BytesOf(static_cast<std::uint16_t>(corner));
  return buffer;
}

/// @param source Member of the buffer that says where its bytes are.
std::string GltfJson(const std::string& source) {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"mesh": 0, "translation": [1, 2, 3]}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 4}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 10, "type": "VEC3", "min": [0, 0, 0], "max": [4, 3, 3.5]},
{"bufferView": 1, "componentType": 5123, "count": 48, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 120}, {"buffer": 0, "byteOffset": 120, "byteLength": 96}],
"buffers": [{"byteLength": 216)" +
         source + "}]}\n";
}

std::string Gltf() {
  return GltfJson(", \"uri\": \"data:application/octet-stream;base64," + Base64Of(GltfBuffer()) +
                  "\"");
}

std::string GlbChunk(const char* type, const std::string& content) {
  return BytesOf(static_cast<std::uint32_t>(content.size())) + std::string(type, 4) + content;
}

TEST(MeshMutants, OfGlbAreNeverReadWrongWithoutAWord) {
  std::string json = GltfJson("");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string chunks = GlbChunk("JSON", json) + GlbChunk("BIN\0", GltfBuffer());
  const auto head = [&](std::uint32_t version, std::size_t size) {
    return "glTF" + BytesOf(version) + BytesOf(static_cast<std::uint32_t>(size));
  };
  const std::size_t size = 12 + chunks.size();
  Mutants mutants("GLB", "a.glb", head(2, size) + chunks, ReadMeshWhole);
  const std::size_t binary = 12 + 8 + json.size();
  for (const std::size_t num : {0U, 1U, 12U, 20U, 100U, 216U, 5000U, 4'000'000'000U}) {
    mutants.Try("length of the file changed", NumberText(num), head(2, num) + chunks);
    for (const std::size_t place : {std::size_t{12}, binary}) {
      mutants.Try("length of a chunk changed", NumberText(num) + " at " + NumberText(place),
                  With(mutants.good(), place, BytesOf(static_cast<std::uint32_t>(num))));
    }
  }
  for (const std::uint32_t version : {0U, 1U, 3U})
    mutants.Try("another version", NumberText(version), head(version, size) + chunks);
  for (const std::size_t place : {std::size_t{16}, binary + 4})
    mutants.Try("type of a chunk changed", NumberText(place), With(mutants.good(), place, "ABCD"));
  mutants.Try("chunks exchanged", "",
              head(2, size) + GlbChunk("BIN\0", GltfBuffer()) + GlbChunk("JSON", json));
  mutants.Try("a chunk put in", "",
              head(2, size + 12) + GlbChunk("JSON", json) + GlbChunk("ABCD", "abcd") +
                  GlbChunk("BIN\0", GltfBuffer()));
  mutants.TryHarmless("a chunk behind the others",
                      head(2, size + 12) + chunks + GlbChunk("ABCD", "abcd"));
  for (std::size_t num = 1; num < 40; ++num)
    mutants.Try("bytes behind the end", NumberText(num), mutants.good() + std::string(num, '7'));
  TryCuts(mutants, 11);
  CheckSection("GLB", {&mutants});
}

TEST(MeshMutants, OfGltfAreNeverReadWrongWithoutAWord) {
  Mutants mutants("glTF", "a.gltf", Gltf(), ReadMeshWhole);
  const auto with = [&](const std::string& what, const std::string& part,
                        const std::string& other) {
    mutants.Try(what, part + " as " + other, Replaced(mutants.good(), part, other));
  };
  for (const char* type : {"5120", "5121", "5122", "5123", "5124", "5125", "5126", "5130", "0"}) {
    with("type of an accessor changed", "5126", type);
    with("type of an accessor changed", "5123", type);
  }
  for (const char* num : {"0", "1", "9", "11", "47", "49", "1000", "-1", "10.5"}) {
    with("count of an accessor changed", "\"count\": 10", std::string("\"count\": ") + num);
    with("count of an accessor changed", "\"count\": 48", std::string("\"count\": ") + num);
    with("index of an object changed", "\"POSITION\": 0", std::string("\"POSITION\": ") + num);
    with("index of an object changed", "\"indices\": 1", std::string("\"indices\": ") + num);
    with("index of an object changed", "\"bufferView\": 1", std::string("\"bufferView\": ") + num);
    with("index of an object changed", "\"mesh\": 0", std::string("\"mesh\": ") + num);
    with("index of an object changed", "\"scene\": 0", std::string("\"scene\": ") + num);
    with("index of an object changed", "\"nodes\": [0]", std::string("\"nodes\": [") + num + "]");
    with("offset or length changed", "\"byteOffset\": 120", std::string("\"byteOffset\": ") + num);
    with("offset or length changed", "\"byteLength\": 120", std::string("\"byteLength\": ") + num);
    with("offset or length changed", "\"byteLength\": 96", std::string("\"byteLength\": ") + num);
    with("offset or length changed", "\"byteLength\": 216", std::string("\"byteLength\": ") + num);
    with("a stride put in", "\"byteLength\": 120",
         std::string("\"byteLength\": 120, \"byteStride\": ") + num);
    with("mode of a primitive changed", "\"mode\": 4", std::string("\"mode\": ") + num);
  }
  for (const char* type : {"VEC2", "VEC4", "SCALAR", "MAT4", "vec3"})
    with("shape of an accessor changed", "\"VEC3\"", "\"" + std::string(type) + "\"");
  for (const char* mode : {"2", "3", "7"})
    with("mode of a primitive changed", "\"mode\": 4", std::string("\"mode\": ") + mode);
  for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                           "KHR_mesh_quantization", "KHR_texture_basisu", "VENDOR_x"}) {
    with("an extension that is required", "\"scene\": 0",
         "\"extensionsUsed\": [\"" + std::string(name) + "\"], \"extensionsRequired\": [\"" + name +
             "\"], \"scene\": 0");
    with("an extension of a primitive", "\"mode\": 4",
         "\"mode\": 4, \"extensions\": {\"" + std::string(name) + "\": {\"bufferView\": 1}}");
  }
  with("a sparse accessor", "\"count\": 10",
       "\"sparse\": {\"count\": 1, \"indices\": {\"bufferView\": 1, \"componentType\": 5123}, "
       "\"values\": {\"bufferView\": 0}}, \"count\": 10");
  with("morph targets", "\"mode\": 4", "\"mode\": 4, \"targets\": [{\"POSITION\": 0}]");
  with("weights of other morph targets", "\"mode\": 4}]",
       "\"mode\": 4, \"targets\": [{\"POSITION\": 0}]}], \"weights\": [1, 0]");
  with("weights of other morph targets", "\"mesh\": 0,", "\"mesh\": 0, \"weights\": [0, 1],");
  with("a skin", "\"mesh\": 0,", "\"mesh\": 0, \"skin\": 0,");
  for (const char* other :
       {"\"scale\": [0, 0, 0]", "\"rotation\": [0, 0, 0, 0]", "\"rotation\": [0, 0, 0, 5]",
        "\"matrix\": [1, 0, 0]", "\"translation\": [1, 2]", "\"translation\": [1, 2, \"3\"]",
        "\"scale\": [1, 1, null]"}) {
    with("a transform that is none", "\"translation\": [1, 2, 3]",
         std::string(other).starts_with("\"t")
             ? other
             : "\"translation\": [1, 2, 3], " + std::string(other));
  }
  for (const char* version : {"1.0", "2.1", "3.0", "0", ""})
    with("another version", "\"2.0\"", "\"" + std::string(version) + "\"");
  for (const char* member :
       {"\"asset\"", "\"scene\"", "\"scenes\"", "\"nodes\"", "\"meshes\"", "\"primitives\"",
        "\"attributes\"", "\"POSITION\"", "\"accessors\"", "\"bufferViews\"", "\"buffers\"",
        "\"uri\"", "\"componentType\"", "\"type\"", "\"byteOffset\": 120", "\"buffer\""}) {
    with("the name of a member changed", member,
         "\"old\"" + std::string(std::string(member).ends_with("120") ? ": 120" : ""));
  }
  with("a buffer that is not there", "data:application/octet-stream;base64,", "gone.bin?");
  const std::size_t data = mutants.good().find("base64,") + 7;
  for (std::size_t place = data; place + 4 < mutants.good().size(); place += 7) {
    mutants.Try("data cut", NumberText(place), std::string(mutants.good()).erase(place, 4));
    mutants.Try("a letter of the data that is none", NumberText(place),
                With(mutants.good(), place, "!"));
  }
  for (std::size_t size = 1; size + 3 < mutants.good().size(); size += 31)
    mutants.Try("cut off", NumberText(size), mutants.good().substr(0, size));
  mutants.Excuse("count of an accessor changed", "fewer triangles are as good as all");
  const std::string first =
      "{\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"indices\": 1, "
      "\"mode\": 4}]}";
  const std::string second = Replaced(first, "\"indices\": 1", "\"indices\": 2");
  std::string two = Replaced(mutants.good(), first, first + ", " + second);
  two = Replaced(two, "\"type\": \"SCALAR\"}",
                 "\"type\": \"SCALAR\"}, {\"bufferView\": 1, \"componentType\": 5123, \"count\": "
                 "24, \"type\": \"SCALAR\"}");
  const std::string nodes = R"("nodes": [{"mesh": 0, "children": [1]}, {"mesh": 1}])";
  two = Replaced(two, R"("nodes": [{"mesh": 0, "translation": [1, 2, 3]}])", nodes);
  Mutants of_two("glTF, two meshes", "a.gltf", two, ReadMeshWhole);
  of_two.TryHarmless("meshes in another order",
                     Replaced(Replaced(two, first + ", " + second, second + ", " + first), nodes,
                              R"("nodes": [{"mesh": 1, "children": [1]}, {"mesh": 0}])"));
  CheckSection("glTF", {&mutants, &of_two});
}

}  // namespace
}  // namespace railcast
