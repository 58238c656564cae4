#include "core/scenario/json_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <iterator>
#include <unordered_map>

#include "core/base/text.h"

namespace railcast {
namespace {

constexpr std::size_t kMaxDepth = 64;

// The place of the last byte read, as "line 3, column 7".
std::string LineAndColumn(const std::string& text, std::size_t num_read) {
  const std::size_t num_whole = std::min(num_read, text.size());
  const std::string_view before =
      std::string_view(text).substr(0, num_whole == 0 ? 0 : num_whole - 1);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_break = before.rfind('\n');
  const std::size_t line_begin = line_break == std::string_view::npos ? 0 : line_break + 1;
  return "line " + std::to_string(line) + ", column " +
         std::to_string(before.size() - line_begin + 1);
}

// The word that contains the last byte read, for example NaN, -Infinity or True; else that byte.
std::string_view WordAt(std::string_view text, std::size_t num_read) {
  const auto is_of_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '+' ||
           c == '.';
  };
  if (num_read == 0 || num_read > text.size()) return {};
  std::size_t begin = num_read - 1;
  std::size_t end = num_read;
  if (!is_of_word(text[begin])) return text.substr(begin, 1);
  while (begin > 0 && is_of_word(text[begin - 1])) --begin;
  while (end < text.size() && is_of_word(text[end])) ++end;
  return text.substr(begin, end - begin);
}

// Extracts the reason from a message of nlohmann's parser: "[json.exception...] parse error at
// line 1, column 2: <what> - <why>; last read: '<raw text>'; expected <token>". The place is given
// elsewhere. The raw text is left out, since it may be invalid UTF-8 and may look like any part of
// a message.
std::string Reason(const std::string& what) {
  constexpr std::array<std::string_view, 6> kTokens = {
      "end of input", "string literal", "':'", "']'", "'}'", "'[', '{', or a literal"};
  const std::size_t last_read = what.find("; last read: '");
  std::string reason = what.substr(0, last_read);
  if (reason.find("ill-formed UTF-8") != std::string::npos) return "not UTF-8";
  if (reason.find("number overflow") != std::string::npos) return "number too large for a double";
  const std::size_t begin = reason.find("syntax error");
  if (begin != std::string::npos) reason.erase(0, begin);
  for (const std::string_view token : kTokens) {
    const std::string expected = "; expected " + std::string(token);
    if (last_read != std::string::npos && what.ends_with("'" + expected)) reason += expected;
  }
  return reason;
}

bool LooksLikeUtf16(std::string_view text) {
  using std::string_view_literals::operator""sv;
  if (text.starts_with("\xFF\xFE"sv) || text.starts_with("\xFE\xFF"sv)) return true;
  // JSON begins with ASCII characters. In UTF-16 one of the two bytes of each is 0.
  return text.size() >= 2 && text.size() % 2 == 0 && ((text[0] == '\0') != (text[1] == '\0'));
}

// Builds the tree as nlohmann's own handler does, but records duplicate keys, which that handler
// accepts silently. It finds keys in hash tables, because nlohmann's ordered objects search
// linearly.
class TreeBuilder {
 public:
  explicit TreeBuilder(const std::string& text) : text_(text) {}

  bool null() { return Leaf(nullptr); }
  bool boolean(bool value) { return Leaf(value); }
  bool number_integer(Json::number_integer_t value) { return Leaf(value); }
  bool number_unsigned(Json::number_unsigned_t value) { return Leaf(value); }
  bool number_float(Json::number_float_t value, const std::string&) { return Leaf(value); }
  bool string(std::string& value) { return Leaf(std::move(value)); }
  bool binary(Json::binary_t&) { return false; }

  bool start_object(std::size_t) {
    places_.emplace_back();
    return Push(Json::object());
  }
  bool start_array(std::size_t) { return Push(Json::array()); }
  bool end_object() {
    places_.pop_back();
    return Pop();
  }
  bool end_array() { return Pop(); }

  bool key(std::string& name) {
    key_ = name;
    auto& members = open_.back()->get_ref<Json::object_t&>();
    const auto [known, is_new] = places_.back().try_emplace(name, std::ssize(members));
    place_ = known->second;
    if (is_new) {
      members.emplace_back(name, nullptr);
    } else {
      result_.duplicate_keys.push_back(pointer_ + PointerStep(name));
    }
    return true;
  }

  bool parse_error(std::size_t num_read, const std::string&, const std::exception& error) {
    const std::string reason = Reason(error.what());
    result_.syntax_error = LineAndColumn(text_, num_read) + ": " + reason;
    const bool is_about_word =
        reason.ends_with("invalid literal") || reason.find("invalid number") != std::string::npos;
    if (!is_about_word) return false;
    const std::string_view word = WordAt(text_, num_read);
    if (!word.empty()) result_.syntax_error += " (got " + ShownText(word) + ")";
    return false;
  }

  JsonText Result() {
    if (result_.syntax_error.empty()) result_.json = std::move(root_);
    return std::move(result_);
  }

 private:
  Json* Insert(Json value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Json& parent = *open_.back();
    if (parent.is_array()) {
      parent.push_back(std::move(value));
      return &parent.back();
    }
    auto& members = parent.get_ref<Json::object_t&>();
    Json& member = std::next(members.begin(), place_)->second;
    member = std::move(value);
    return &member;
  }

  bool Leaf(Json value) {
    Insert(std::move(value));
    return true;
  }

  bool Push(Json value) {
    if (open_.size() == kMaxDepth) {
      result_.syntax_error = "nested deeper than " + std::to_string(kMaxDepth) + " levels";
      return false;
    }
    lengths_.push_back(pointer_.size());
    if (!open_.empty()) {
      const Json& parent = *open_.back();
      pointer_ += PointerStep(parent.is_array() ? std::to_string(parent.size()) : key_);
    }
    open_.push_back(Insert(std::move(value)));
    return true;
  }

  bool Pop() {
    open_.pop_back();
    pointer_.resize(lengths_.back());
    lengths_.pop_back();
    return true;
  }

  const std::string& text_;
  JsonText result_;
  Json root_;
  std::vector<Json*> open_;  // A parent does not grow while a child is open, so these stay valid.
  std::vector<std::size_t> lengths_;
  std::string pointer_;
  std::string key_;
  std::ptrdiff_t place_{};  // Index of that key in its object.
  // Index of each key, for each open object.
  std::vector<std::unordered_map<std::string, std::ptrdiff_t>> places_;
};

}  // namespace

std::string PointerStep(std::string_view key) {
  // Nearly all keys are words, which are shown as they are; there are many in every scenario.
  constexpr std::size_t kMostOfWord = 60;
  const auto is_of_word = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (key.size() <= kMostOfWord && std::ranges::all_of(key, is_of_word)) {
    return "/" + std::string(key);
  }
  std::string step = "/";
  for (const char c : ShownText(key)) {
    if (c == '~') {
      step += "~0";
    } else if (c == '/') {
      step += "~1";
    } else {
      step += c;
    }
  }
  return step;
}

JsonText ParseJson(const std::string& text) {
  if (text.starts_with("\xEF\xBB\xBF")) {
    JsonText result;
    result.syntax_error = "line 1, column 1: starts with a byte order mark; save as plain UTF-8";
    return result;
  }
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    JsonText result;
    result.syntax_error = "is empty";
    return result;
  }
  if (const std::size_t nul = text.find('\0'); nul != std::string::npos) {
    JsonText result;
    result.syntax_error = LooksLikeUtf16(text) ? "is UTF-16; save as UTF-8"
                                               : LineAndColumn(text, nul + 1) + ": a NUL byte";
    return result;
  }
  TreeBuilder builder(text);
  Json::sax_parse(text, &builder);
  return builder.Result();
}

}  // namespace railcast
