#include "core/base/ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_number.h"

namespace railcast {
namespace {

using PlyWords = std::vector<std::string_view>;

PlyEncoding ReadPlyFormat(const PlyWalk& ply, const PlyWords& words, std::string_view line) {
  constexpr auto kNames = std::to_array<std::string_view>(
      {"ascii", "binary_little_endian", "binary_big_endian"});  // In the order of PlyEncoding.
  const std::string_view name = words.size() > 1 ? words[1] : std::string_view();
  const auto* const named = std::ranges::find(kNames, name);
  if (named == kNames.end()) {
    ply.Fail("format: must be ascii, binary_little_endian or binary_big_endian (got " +
             (words.size() > 1 ? ShownText(name) : "nothing") + ")");
  }
  if (words.size() != 3) {
    ply.Fail("format: must have a version and nothing behind it (got " + Quoted(line) + ")");
  }
  return PlyEncoding(named - kNames.begin());
}

PlyElement ReadPlyElement(const PlyWalk& ply, const PlyWords& words) {
  const auto count = words.size() == 3 ? ParseNumber<std::uint32_t>(words[2]) : std::nullopt;
  if (!count) {
    ply.Fail("element " + ShownText(words.size() > 1 ? words[1] : "") +
             ": must be a whole number below 2^32 (got " +
             (words.size() > 2 ? ShownText(words[2]) : "nothing") + ")");
  }
  return {std::string(words[1]), *count, {}};
}

PlyProperty ReadPlyProperty(const PlyWalk& ply, const PlyWords& words) {
  const auto type_of = [&](std::string_view name) {
    const auto type = PlyTypeNamed(name);
    if (!type)
      ply.Fail("property " + ShownText(words.back()) + ": unknown type " + ShownText(name));
    return *type;
  };
  if (words.size() == 5 && words[1] == "list") {
    return {std::string(words[4]), type_of(words[3]), type_of(words[2])};
  }
  if (words.size() != 3) ply.Fail("is no PLY file: a property must have a type and a name");
  return {std::string(words[2]), type_of(words[1]), {}};
}

}  // namespace

PlyWalk::PlyWalk(std::string shown,
                 std::string_view bytes,
                 const std::function<void(std::string_view line)>& on_comment)
    : shown_(std::move(shown)), rest_(bytes) {
  ReadHeader(on_comment);
}

void PlyWalk::ReadHeader(const std::function<void(std::string_view line)>& on_comment) {
  if (TakeLine(rest_) != "ply") Fail("is no PLY file: its first line must be \"ply\"");
  bool has_format = false;
  while (true) {
    const auto line = TakeLine(rest_);
    if (!line) Fail("is no PLY file: its header has no end_header line");
    const auto words = Words(*line);
    if (words.empty()) continue;
    if (words[0] == "end_header") break;
    if (words[0] == "comment" || words[0] == "obj_info") {
      on_comment(*line);
    } else if (words[0] == "format") {
      encoding_ = ReadPlyFormat(*this, words, *line);
      has_format = true;
    } else if (words[0] == "element") {
      elements_.push_back(ReadPlyElement(*this, words));
    } else if (words[0] == "property" && !elements_.empty()) {
      elements_.back().properties.push_back(ReadPlyProperty(*this, words));
    } else {
      Fail("is no PLY file: a header line begins with " + ShownText(words[0]));
    }
  }
  if (!has_format) Fail("format: missing");
}

void PlyWalk::Fail(const std::string& rule) const {
  throw InputError(shown_ + ": " + rule);
}

void PlyWalk::FailShort(const PlyElement& element) const {
  Fail("ends within its " + NumberText(element.count) + " elements " + ShownText(element.name));
}

bool PlyWalk::Skip(const PlyElement& element) {
  if (element.properties.empty()) return true;
  for (std::uint32_t i = 0; i < element.count; ++i) {
    if (encoding_ == PlyEncoding::kAscii) {
      if (!TakeLine(rest_)) return false;
      continue;
    }
    for (const PlyProperty& property : element.properties) {
      if (property.length && rest_.size() < SizeOf(*property.length)) return false;
      const double num = property.length ? Next(element, *property.length) : 1.0;
      const double size = num * SizeOf(property.type);
      if (!(size >= 0.0 && size <= static_cast<double>(rest_.size()))) return false;
      rest_.remove_prefix(static_cast<std::size_t>(size));
    }
  }
  return true;
}

std::size_t PlyWalk::Length(const PlyElement& element, NumberType type) {
  const double length = Next(element, type);
  if (!(length >= 0.0 && length == std::floor(length))) {
    Fail("element " + ShownText(element.name) + ": a list's length must be a whole number" +
         Got(length));
  }
  if (length > static_cast<double>(rest_.size())) FailShort(element);
  return static_cast<std::size_t>(length);
}

double PlyWalk::Next(const PlyElement& element, NumberType type) {
  if (encoding_ == PlyEncoding::kAscii) return NextWord(element);
  return VisitNumberType(type, [&](auto zero) {
    std::array<char, sizeof zero> bytes{};
    if (rest_.size() < bytes.size()) FailShort(element);
    std::copy_n(rest_.begin(), bytes.size(), bytes.begin());
    rest_.remove_prefix(bytes.size());
    if (encoding_ == PlyEncoding::kBigEndian) std::ranges::reverse(bytes);
    return static_cast<double>(std::bit_cast<decltype(zero)>(bytes));
  });
}

double PlyWalk::NextWord(const PlyElement& element) {
  rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\v\f"), rest_.size()));
  const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\v\f\n"));
  if (rest_.empty()) FailShort(element);
  if (word.empty()) {
    Fail("element " + ShownText(element.name) + ": must have all of its numbers in its line");
  }
  rest_.remove_prefix(word.size());
  const auto number = ParseTextNumber<double>(word);
  if (!number) {
    Fail("element " + ShownText(element.name) + ": must consist of numbers (got " + Quoted(word) +
         ")");
  }
  return *number;
}

/// In text, an element does not go on in the next line.
void PlyWalk::BeginLine() {
  if (encoding_ != PlyEncoding::kAscii) return;
  rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\v\f\n"), rest_.size()));
}

}  // namespace railcast
