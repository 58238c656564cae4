#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/text.h"
#include "tests/mutants/made_scan_points.h"
#include "tests/mutants/mutants.h"

namespace railcast {
namespace {

constexpr std::array<const char*, 6> kScanNames = {"x", "y", "z", "intensity", "ring", "time"};

constexpr const char* kLastDigits = "only digits of the last number are missing";
constexpr const char* kDigitsLost = "digits of a number are lost, and what is left is a number";

std::string TextRows(const std::vector<ScanPoint>& points) {
  std::string text;
  for (const ScanPoint& point : points) {
    for (std::size_t i = 0; i < point.size(); ++i) {
      text += (i == 0 ? "" : " ") + ShortText(point.at(i));
    }
    text += "\n";
  }
  return text;
}

/// The numbers of a column turned, in place.
std::string Swapped(std::string rows, std::size_t column) {
  for (std::size_t row = 0; row < rows.size(); row += kRow_bytes) {
    const auto first = rows.begin() + static_cast<std::ptrdiff_t>(row + kPlaces.at(column));
    std::reverse(first, first + static_cast<std::ptrdiff_t>(kSizes.at(column)));
  }
  return rows;
}

std::vector<ScanPoint> Scaled(std::vector<ScanPoint> points, double scale) {
  for (ScanPoint& point : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) point.at(axis) *= scale;
  }
  return points;
}

/// What happens to binary points behind a header of any format.
void TryBinary(Mutants& mutants, const std::string& header) {
  const std::vector<ScanPoint> points = MakeScanPoints();
  const std::string rows = BinaryRows(points);
  std::string all = rows;
  for (std::size_t column = 0; column < 6; ++column) {
    const std::string one = Swapped(rows, column);
    all = Swapped(all, column);
    const bool is_place = column < 3;
    mutants.Try(
        is_place ? "byte order of a coordinate exchanged" : "byte order of another field exchanged",
        kScanNames.at(column), header + one);
  }
  mutants.Try("byte order exchanged", "all", header + all);
  mutants.Try("positions in millimetres", "", header + BinaryRows(Scaled(points, 1000.0)));
  mutants.Try("positions in kilometres", "", header + BinaryRows(Scaled(points, 0.001)));
  for (std::size_t place = 7; place < rows.size(); place += 97) {
    mutants.Try("bytes put in", NumberText(place),
                header + std::string(rows).insert(place, place % 5 + 1, '\n'));
    mutants.Try("bytes lost", NumberText(place),
                header + std::string(rows).erase(place, place % 5 + 1));
    const std::size_t row = place / kRow_bytes * kRow_bytes;
    mutants.Try("points doubled", NumberText(place),
                header + std::string(rows).insert(row, rows.substr(row, 3 * kRow_bytes)));
    mutants.Try("points lost", NumberText(place),
                header + std::string(rows).erase(row, (1 + place % 4) * kRow_bytes));
  }
  for (std::size_t num = 1; num < 40; ++num) {
    mutants.Try("bytes behind the data", NumberText(num), mutants.good() + std::string(num, 'e'));
    mutants.Try("zeros behind the data", NumberText(num), mutants.good() + std::string(num, '\0'));
  }
}

void TryText(Mutants& mutants, const std::string& header) {
  const std::vector<ScanPoint> points = MakeScanPoints();
  const std::string rows = TextRows(points);
  const std::vector<std::string_view> lines = [&] {
    std::vector<std::string_view> found;
    std::string_view rest = rows;
    while (const auto line = TakeLine(rest)) found.push_back(*line);
    return found;
  }();
  mutants.Try("positions in millimetres", "", header + TextRows(Scaled(points, 1000.0)));
  mutants.Try("decimal commas", "", header + AllReplaced(rows, ".", ","));
  mutants.Try("commas for blanks", "", header + AllReplaced(rows, " ", ","));
  mutants.Try("tabs for blanks", "", header + AllReplaced(rows, " ", "\t"));
  for (std::size_t i = 0; i < lines.size(); i += 7) {
    const std::string line(lines[i]);
    const std::string detail = "line " + NumberText(i);
    const auto with = [&](const std::string& other) {
      return header + Replaced(rows, line + "\n", other);
    };
    mutants.Try("a line lost", detail, with(""));
    mutants.Try("a line doubled", detail, with(line + "\n" + line + "\n"));
    mutants.Try("two lines joined", detail, with(line + " "));
    mutants.Try("a word lost", detail, with(line.substr(line.find(' ') + 1) + "\n"));
    mutants.Try("a word too many", detail, with(line + " 7\n"));
    mutants.Try("a word that is no number", detail,
                with("abc" + line.substr(line.find(' ')) + "\n"));
    mutants.Try("a number beyond its type", detail,
                with("1e60" + line.substr(line.find(' ')) + "\n"));
    mutants.Try("digits behind a number", detail,
                with(line.substr(0, line.find(' ')) + "x" + line.substr(line.find(' ')) + "\n"));
    mutants.Try("a comment among lines", detail, with("# " + line + "\n" + line + "\n"));
    mutants.Try("an empty line", detail, with("\n" + line + "\n"));
  }
}

/// A PCD file's header, by lines of words.
struct PcdHead {
  std::array<std::string, 6> sizes = {"4", "4", "4", "4", "2", "8"};
  std::array<std::string, 6> types = {"F", "F", "F", "F", "U", "F"};
  std::array<std::string, 6> counts = {"1", "1", "1", "1", "1", "1"};
  std::string width = NumberText(kScanRings * kScanColumns);
  std::string height = "1";
  std::string points = NumberText(kScanRings * kScanColumns);
  std::string data = "binary";

  [[nodiscard]] std::string Text() const {
    const auto line = [](const std::string& key, const auto& words) {
      std::string text = key;
      for (const auto& word : words) text += " " + std::string(word);
      return text + "\n";
    };
    return "VERSION 0.7\n" + line("FIELDS", kScanNames) + line("SIZE", sizes) +
           line("TYPE", types) + line("COUNT", counts) + "WIDTH " + width + "\nHEIGHT " + height +
           "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data + "\n";
  }
};

void TryPcdHead(Mutants& mutants, const PcdHead& good, const std::string& body) {
  for (std::size_t i = 0; i < 6; ++i) {
    const auto try_word = [&](const char* what, auto member, const std::string& word) {
      PcdHead head = good;
      (head.*member).at(i) = word;
      mutants.Try(what, std::string(kScanNames.at(i)) + " " + word, head.Text() + body);
    };
    for (const char* size : {"1", "2", "3", "4", "8", "16", "0", "-4"}) {
      try_word("SIZE of a field changed", &PcdHead::sizes, size);
    }
    for (const char* type : {"I", "U", "F", "f", "D", "float"}) {
      try_word("TYPE of a field changed", &PcdHead::types, type);
    }
    for (const char* count : {"0", "2", "3", "-1", "4000000000"}) {
      try_word("COUNT of a field changed", &PcdHead::counts, count);
    }
  }
  for (const char* num :
       {"0", "1", "2", "8", "60", "479", "481", "960", "240", "4294967295", "-1", "480.0", ""}) {
    for (const auto member : {&PcdHead::width, &PcdHead::height, &PcdHead::points}) {
      PcdHead head = good;
      head.*member = num;
      mutants.Try("WIDTH, HEIGHT or POINTS changed", num, head.Text() + body);
    }
    PcdHead head = good;
    head.width = head.points = num;
    mutants.Try("WIDTH and POINTS changed", num, head.Text() + body);
  }
  for (const char* data : {"ascii", "binary", "binary_compressed", "BINARY", "ASCII", "bin", ""}) {
    PcdHead head = good;
    head.data = data;
    mutants.Try("DATA changed", data, head.Text() + body);
  }
  const std::string text = good.Text();
  std::string_view rest = text;
  while (const auto found = TakeLine(rest)) {
    const std::string line(*found);
    const auto with = [&](const std::string& other) {
      return Replaced(text, line + "\n", other) + body;
    };
    mutants.Try("a line of the header lost", line, with(""));
    mutants.Try("a line of the header doubled", line, with(line + "\n" + line + "\n"));
    mutants.Try("a line of the header as a comment", line, with("# " + line + "\n"));
    mutants.Try("a word of the header lost", line, with(line.substr(0, line.rfind(' ')) + "\n"));
    mutants.Try("a word of the header too many", line, with(line + " 1\n"));
    mutants.Try("an unknown line in the header", line, with("UNIT mm\n" + line + "\n"));
  }
  mutants.Try("VIEWPOINT moved", "", Replaced(text, "0 0 0 1", "1 2 3 1") + body);
  mutants.Try("VIEWPOINT turned", "", Replaced(text, "0 0 0 1 0 0 0", "0 0 0 0.7 0 0 0.7") + body);
}

TEST(CloudMutants, OfPcdAreNeverReadWrongWithoutAWord) {
  const std::string rows = BinaryRows(MakeScanPoints());
  const PcdHead binary;
  Mutants of_binary("PCD, binary", "a.pcd", binary.Text() + rows, ReadRecordingWhole);
  TryPcdHead(of_binary, binary, rows);
  TryBinary(of_binary, binary.Text());
  TryCuts(of_binary, 101);
  PcdHead ascii;
  ascii.data = "ascii";
  const std::string text = TextRows(MakeScanPoints());
  Mutants of_text("PCD, ascii", "a.pcd", ascii.Text() + text, ReadRecordingWhole);
  TryPcdHead(of_text, ascii, text);
  TryText(of_text, ascii.Text());
  TryCuts(of_text, 211);
  of_text.Excuse("cut off", kLastDigits);
  of_text.Excuse("a byte lost", kDigitsLost);
  CheckSection("PCD", {&of_binary, &of_text});
}

std::string PlyHead(const std::string& format, const std::string& more = {}) {
  return "ply\nformat " + format +
         " 1.0\ncomment made\nelement vertex 480\nproperty float x\n"
         "property float y\nproperty float z\nproperty float intensity\nproperty ushort ring\n"
         "property double time\n" +
         more + "end_header\n";
}

void TryPlyHead(Mutants& mutants, const std::string& head, const std::string& body) {
  for (const char* type : {"char", "uchar", "short", "ushort", "int", "uint", "float", "double",
                           "float32", "float64", "uint16", "half"}) {
    for (const char* name :
         {"float x", "float y", "float z", "float intensity", "ushort ring", "double time"}) {
      const std::string field(std::string_view(name).substr(std::string_view(name).find(' ')));
      mutants.Try("type of a property changed", type + field,
                  Replaced(head, name, type + field) + body);
      mutants.Try("a property too many", name,
                  Replaced(head, std::string("property ") + name,
                           std::string("property ") + type + " w\nproperty " + name) +
                      body);
      mutants.Try("a property as a list", type + field,
                  Replaced(head, name, std::string("list uchar ") + type + field) + body);
    }
  }
  for (const char* num :
       {"0", "1", "240", "479", "481", "500", "960", "4294967295", "-1", "480.5"}) {
    mutants.Try("number of vertices changed", num,
                Replaced(head, "vertex 480", std::string("vertex ") + num) + body);
  }
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian", "binary"}) {
    const std::size_t begin = head.find("format ") + 7;
    mutants.Try("format changed", format,
                std::string(head).replace(begin, head.find(' ', begin) - begin, format) + body);
  }
  std::string_view rest = head;
  while (const auto found = TakeLine(rest)) {
    const std::string line(*found);
    mutants.Try("a line of the header lost", line, Replaced(head, line + "\n", "") + body);
    mutants.Try("a line of the header doubled", line,
                Replaced(head, line + "\n", line + "\n" + line + "\n") + body);
    mutants.Try("an unknown line in the header", line,
                Replaced(head, line + "\n", "unit mm\n" + line + "\n") + body);
    mutants.Try(
        "an element that has no data", line,
        Replaced(head, line + "\n", "element camera 1\nproperty float f\n" + line + "\n") + body);
  }
}

TEST(CloudMutants, OfPlyAreNeverReadWrongWithoutAWord) {
  const std::string rows = BinaryRows(MakeScanPoints());
  const std::string head = PlyHead("binary_little_endian");
  Mutants of_binary("PLY, binary", "a.ply", head + rows, ReadRecordingWhole);
  TryPlyHead(of_binary, head, rows);
  TryBinary(of_binary, head);
  TryCuts(of_binary, 101);
  const std::string text = TextRows(MakeScanPoints());
  const std::string text_head = PlyHead("ascii");
  Mutants of_text("PLY, ascii", "a.ply", text_head + text, ReadRecordingWhole);
  TryPlyHead(of_text, text_head, text);
  TryText(of_text, text_head);
  TryCuts(of_text, 211);
  of_text.Excuse("cut off", kLastDigits);
  of_text.Excuse("a byte lost", kDigitsLost);
  CheckSection("PLY", {&of_binary, &of_text});
}

/// What happens to text without a header of a format, behind its first line.
void TryFirstLine(Mutants& mutants, const std::string& first) {
  const std::string& good = mutants.good();
  const std::string rows = good.substr(first.size());
  mutants.Try("the first line lost", "", rows);
  mutants.Try("the first line doubled", "", first + good);
  mutants.Try("the first line as a comment", "", "# " + good);
  mutants.Try("two clouds in one file", "", good + good);
  mutants.TryHarmless("a comment in front", "// made by hand\n" + good);
  mutants.TryHarmless("semicolons for blanks", AllReplaced(good, " ", ";"));
  mutants.TryHarmless("commas and blanks for blanks", AllReplaced(good, " ", ", "));
  mutants.TryHarmless("a separator at the end of lines",
                      AllReplaced(AllReplaced(good, " ", ","), "\n", ",\n"));
  mutants.TryHarmless("a byte order mark", "\xEF\xBB\xBF" + good);
  std::string wide = "\xFF\xFE";
  for (const char letter : good) wide += {letter, '\0'};
  mutants.TryHarmless("UTF-16", wide);
  for (const char* unit : {"units: mm", "units: ft", "unit of length: cm"}) {
    mutants.Try("another unit in a comment", unit, std::string("# ") + unit + "\n" + good);
  }
}

void TryNames(Mutants& mutants, const std::string& names) {
  const std::string rows = mutants.good().substr(names.size());
  const auto with = [&](const std::string& what, const std::string& other) {
    mutants.Try(what, other, other + rows);
  };
  for (const std::string name : kScanNames) {
    const std::string behind = name == "time" ? name : name + " ";
    with("a name lost", Replaced(names, behind, ""));
    with("a name doubled", Replaced(names, behind, name + " " + behind));
  }
  for (const std::string axis : {"x", "y", "z"}) {
    with("an axis by another name", Replaced(names, axis + " ", "a "));
    with("an axis by the name of another", Replaced(names, axis + " ", axis == "x" ? "y " : "x "));
    for (const char* unit : {"mm", "cm", "ft", "deg", "rad", "km"}) {
      with("an axis in another unit", Replaced(names, axis + " ", axis + " [" + unit + "] "));
      with("an axis in another unit", Replaced(names, axis + " ", axis + "(" + unit + ") "));
    }
  }
  mutants.TryHarmless("names in capitals", Replaced(names, "x y z", "X Y Z") + rows);
  mutants.TryHarmless("names in quotes", Replaced(names, "x y z", R"("x" "y" "z")") + rows);
  mutants.TryHarmless("names with the unit", Replaced(names, "x y z", "x [m] y [m] z[m]") + rows);
  mutants.TryHarmless("names as CloudCompare writes them", "//" + names + rows);
}

TEST(CloudMutants, OfTextAreNeverReadWrongWithoutAWord) {
  constexpr const char* kNoNumber = "nothing says how many points there are";
  const std::string rows = TextRows(MakeScanPoints());
  const std::string number = NumberText(kScanRings * kScanColumns) + "\n";
  Mutants counted("text, number of points", "a.pts", number + rows, ReadRecordingWhole);
  TryFirstLine(counted, number);
  for (const char* num : {"", "0", "1", "479", "481", "960", "480.0", "480.5", "-480", "480 1"}) {
    counted.Try("number of points changed", num, num + ("\n" + rows));
  }
  TryText(counted, number);
  TryCuts(counted, 211);
  counted.Excuse("a byte lost", kDigitsLost);
  const std::string names = "x y z intensity ring time\n";
  Mutants named("text, names of columns", "a.xyz", names + rows, ReadRecordingWhole);
  TryFirstLine(named, names);
  TryNames(named, names);
  TryText(named, names);
  TryCuts(named, 211);
  for (const char* change : {"a line lost", "a line doubled", "cut off"}) {
    named.Excuse(change, kNoNumber);
  }
  named.Excuse("a byte lost", kDigitsLost);
  CheckSection("Text", {&counted, &named});
}

/// float32 numbers of the points.
template <typename Number = float>
std::string Numbers(const std::vector<ScanPoint>& points, const std::vector<std::size_t>& columns) {
  std::string bytes;
  for (const ScanPoint& point : points) {
    for (const std::size_t column : columns)
      bytes += BytesOf(static_cast<Number>(point.at(column)));
  }
  return bytes;
}

TEST(CloudMutants, OfKittiAreNeverReadWrongWithoutAWord) {
  const std::vector<ScanPoint> points = MakeScanPoints();
  const std::string good = Numbers(points, {0, 1, 2, 3});
  Mutants mutants("KITTI .bin", "a.bin", good, ReadRecordingWhole);
  const std::vector<std::vector<std::size_t>> others = {
      {0, 1, 2},       {0, 1, 2, 3, 4},    {0, 1, 2, 3, 4, 5},
      {0, 1, 2, 3, 5}, {0, 1, 2, 3, 3, 5}, {3, 0, 1, 2},
      {4, 0, 1, 2},    {4, 0, 1, 2, 3},    {0, 1, 2, 4, 3, 5, 5},
      {5, 0, 1, 2, 3}, {0, 1, 2, 5, 4},    {0, 1, 2, 3, 4, 5, 5, 5}};
  // Files end after any number of points.
  for (std::size_t num = points.size() / 2; num <= points.size(); ++num) {
    const std::vector<ScanPoint> part(points.begin(),
                                      points.begin() + static_cast<std::ptrdiff_t>(num));
    for (const auto& columns : others) {
      std::string detail = NumberText(num) + " points of";
      for (const std::size_t column : columns) detail += std::string(" ") + kScanNames.at(column);
      mutants.Try("other columns of float32", detail, Numbers(part, columns));
    }
    mutants.Try("float64", NumberText(num), Numbers<double>(part, {0, 1, 2, 3}));
    mutants.Try("float64", NumberText(num) + " x y z", Numbers<double>(part, {0, 1, 2}));
    mutants.Try("positions in millimetres", NumberText(num),
                Numbers(Scaled(part, 1000.0), {0, 1, 2, 3}));
    mutants.Try("whole numbers of millimetres", NumberText(num),
                Numbers<std::int32_t>(Scaled(part, 1000.0), {0, 1, 2, 3}));
    mutants.Try("whole numbers of centimetres", NumberText(num),
                Numbers<std::int16_t>(Scaled(part, 100.0), {0, 1, 2, 3}));
    std::string turned = Numbers(part, {0, 1, 2, 3});
    for (std::size_t i = 0; i + 4 <= turned.size(); i += 4) {
      std::reverse(turned.begin() + static_cast<std::ptrdiff_t>(i),
                   turned.begin() + static_cast<std::ptrdiff_t>(i + 4));
    }
    mutants.Try("byte order exchanged", NumberText(num), turned);
  }
  for (std::size_t place = 5; place < good.size(); place += 31) {
    for (std::size_t num = 1; num < 16; num += 1 + place % 3) {
      mutants.Try("bytes put in", NumberText(place), std::string(good).insert(place, num, 'a'));
      mutants.Try("bytes lost", NumberText(place), std::string(good).erase(place, num));
    }
    mutants.Try("16 bytes put in within a point", NumberText(place / 16 * 16 + 4),
                std::string(good).insert(place / 16 * 16 + 4, "abcdefghijklmnop"));
  }
  mutants.Try("text", "", TextRows(points));
  mutants.Try("a header of PCD", "", PcdHead().Text() + good);
  CheckSection("KITTI", {&mutants});
}

}  // namespace
}  // namespace railcast
