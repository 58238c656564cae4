#include "core/scene/obj_sieve.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <istream>
#include <optional>
#include <unordered_set>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

std::string_view NextToken(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  const std::string_view token = rest.substr(0, rest.find_first_of(kBlanks));
  rest.remove_prefix(token.size());
  return token;
}

/// The token without a leading plus sign, which from_chars() rejects. Only one sign is allowed, so
/// "+-1" is left unchanged (and rejected).
std::string_view WithoutPlus(std::string_view token) {
  if (token.starts_with('+') && !token.starts_with("+-")) token.remove_prefix(1);
  return token;
}

template <typename Number>
std::optional<Number> Parse(std::string_view token) {
  token = WithoutPlus(token);
  Number number{};
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), number);
  if (error != std::errc{} || end != token.data() + token.size()) return std::nullopt;
  return number;
}

}  // namespace

ObjSieve::ObjSieve(std::string shown, double largest)
    : shown_(std::move(shown)), largest_(largest) {}

std::string ObjSieve::Sift(std::istream& in) {
  std::string line;
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  while (ReadLogicalLine(in, line)) {
    std::string_view rest = line;
    if (line_ == 1 && rest.starts_with(kByteOrderMark)) {
      rest.remove_prefix(kByteOrderMark.size());
    }
    const std::string_view keyword = NextToken(rest);
    if (keyword == "v") SiftVertex(rest);
    if (keyword == "f") SiftFace(rest);
  }
  // Forward references are valid, because OpenMesh reads all vertices before any face. The highest
  // index can therefore be checked only here.
  if (highest_index_ > num_vertices_) {
    line_ = highest_index_line_;
    FailIndex(std::to_string(highest_index_));
  }
  return std::move(sifted_);
}

/// Reads a line, joined with the next if it ends with a backslash.
bool ObjSieve::ReadLogicalLine(std::istream& in, std::string& line) {
  line_ = next_line_;
  line.clear();
  std::string piece;
  bool any = false;
  while (std::getline(in, piece)) {
    any = true;
    ++next_line_;
    if (piece.ends_with('\r')) piece.pop_back();
    line += piece;
    if (!line.ends_with('\\')) return true;
    line.back() = ' ';
  }
  return any;
}

void ObjSieve::SiftVertex(std::string_view rest) {
  sifted_ += 'v';
  for (int axis = 0; axis < 3; ++axis) {
    const std::string_view token = NextToken(rest);
    const std::optional<double> number = Parse<double>(token);
    if (!number || !(std::abs(*number) <= largest_)) {
      Fail("a vertex must have three finite coordinates", token);
    }
    sifted_ += ' ';
    sifted_ += WithoutPlus(token);
  }
  sifted_ += '\n';
  ++num_vertices_;
}

void ObjSieve::SiftFace(std::string_view rest) {
  std::string corners;
  std::unordered_set<int> vertices;
  for (std::string_view token = NextToken(rest); !token.empty() && token.front() != '#';
       token = NextToken(rest)) {
    const int vertex = VertexOf(token);
    if (vertices.insert(vertex).second) corners += ' ' + std::to_string(vertex);
  }
  if (vertices.size() < 3) return;
  sifted_ += 'f' + corners + '\n';
  ++num_faces_;
}

/// The vertex index of a face corner: 1 is the first vertex, and -1 is the last one read so far.
int ObjSieve::VertexOf(std::string_view corner) {
  const std::string_view index = corner.substr(0, corner.find('/'));
  const std::optional<int> number = Parse<int>(index);
  if (!number) Fail("a face must name vertices by number", corner);
  if (*number == 0 || *number < -num_vertices_) FailIndex(index);
  if (*number > highest_index_) {
    highest_index_ = *number;
    highest_index_line_ = line_;
  }
  return *number > 0 ? *number : num_vertices_ + 1 + *number;
}

void ObjSieve::FailIndex(std::string_view index) const {
  Fail("a face must name one of the " + std::to_string(num_vertices_) + " vertices", index);
}

void ObjSieve::Fail(const std::string& rule, std::string_view got) const {
  throw InputError(shown_ + ": line " + std::to_string(line_) + ": " + rule + " (got \"" +
                   ShownText(got) + "\")");
}

}  // namespace railcast
