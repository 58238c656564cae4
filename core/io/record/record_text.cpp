#include "core/io/record/record_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scenario/archive.h"

namespace railcast {
namespace {

// Text in which nothing is escaped does without the JSON library.
void AppendJsonText(const std::string& value, std::string& text) {
  const bool is_plain = std::ranges::all_of(value, [](char letter) {
    return letter >= ' ' && letter <= '~' && letter != '"' && letter != '\\';
  });
  if (is_plain) {
    text.append(1, '"').append(value).append(1, '"');
  } else {
    try {
      text.append(Json(value).dump());
    } catch (const Json::type_error&) {
      throw InputError("names in files of JSON must be UTF-8 (got " + Quoted(value) + ")");
    }
  }
}

void AppendValue(const ValueRef& value, std::string& text);

bool IsEmpty(const ValueRef& value) {
  using Kind = ValueType::Kind;
  switch (value.type->kind) {
    case Kind::kOptional:
    case Kind::kList:
      return value.type->size(value.place) == 0;
    case Kind::kMap:
      return value.type->keys(value.place).empty();
    case Kind::kText:
      return static_cast<const std::string*>(value.place)->empty();
    case Kind::kBool:
      return !*static_cast<const bool*>(value.place);
    case Kind::kJson:
      return static_cast<const Json*>(value.place)->is_null();
    default:
      return false;
  }
}

/// The archive that appends the members of a record.
class RecordWriter final : public Archive {
 public:
  explicit RecordWriter(std::string& text) : text_(text) {}

  void Preset(std::string_view /*key*/,
              std::optional<std::string>& /*file*/,
              KeyDoc /*doc*/,
              const FilePreset& /*preset*/) override {
    Check(false, "a record has no preset");
  }
  void Types(std::string_view /*key*/,
             std::vector<ModelSpec>& /*models*/,
             KeyDoc /*doc*/) override {
    Check(false, "a record has no models");
  }
  void Switches(std::string_view /*key*/,
                std::map<std::string, bool>& /*switches*/,
                KeyDoc /*doc*/,
                const std::vector<std::string>& /*names*/) override {
    Check(false, "a record has no switches");
  }

 private:
  void Visit(const Key& key, const ValueRef& value) override {
    if (!key.is_required && IsEmpty(value)) return;
    if (!is_first_) text_ += ',';
    is_first_ = false;
    AppendJsonText(std::string(key.name), text_);
    text_ += ':';
    AppendValue(value, text_);
  }

  std::string& text_;
  bool is_first_ = true;
};

// `append` is called with each number from 0.
template <typename Append>
void AppendEach(std::size_t size, std::string& text, const Append& append) {
  for (std::size_t i = 0; i < size; ++i) {
    if (i > 0) text += ',';
    append(i);
  }
}

void AppendValue(const ValueRef& value, std::string& text) {
  using Kind = ValueType::Kind;
  const ValueType& type = *value.type;
  switch (type.kind) {
    case Kind::kBool:
      text += *static_cast<const bool*>(value.place) ? "true" : "false";
      return;
    case Kind::kNumber:
      return AppendJsonNumber(*static_cast<const double*>(value.place), text);
    case Kind::kWhole:
      text += std::to_string(type.whole(value.place));
      return;
    case Kind::kSigned:
      text += std::to_string(*static_cast<const std::int64_t*>(value.place));
      return;
    case Kind::kText:
      return AppendJsonText(*static_cast<const std::string*>(value.place), text);
    case Kind::kName:
      return AppendJsonText(type.name(value.place), text);
    case Kind::kOptional:
      if (type.size(value.place) > 0)
        return AppendValue({type.at(value.place, 0), type.of()}, text);
      text += "null";
      return;
    case Kind::kArray:
    case Kind::kList:
      text += '[';
      AppendEach(type.size(value.place), text, [&](std::size_t i) {
        AppendValue({type.at(value.place, i), type.of()}, text);
      });
      text += ']';
      return;
    case Kind::kMap: {
      const std::vector<std::string> keys = type.keys(value.place);
      text += '{';
      AppendEach(keys.size(), text, [&](std::size_t i) {
        AppendJsonText(keys[i], text);
        text += ':';
        AppendValue({type.member(value.place, keys[i]), type.of()}, text);
      });
      text += '}';
      return;
    }
    case Kind::kJson:
      text += static_cast<const Json*>(value.place)->dump();
      return;
    case Kind::kStruct: {
      text += '{';
      RecordWriter writer(text);
      type.describe(writer, value.place);
      text += '}';
      return;
    }
    case Kind::kObjectType:
    case Kind::kVariant:
    case Kind::kOwn:
      break;
  }
  Check(false, "a record has no values of this kind");
}

}  // namespace

void AppendJsonNumber(double number, std::string& text) {
  if (!std::isfinite(number)) {
    text.append("null");
    return;
  }
  std::array<char, 64> digits{};
  const char* const end =
      nlohmann::detail::to_chars(digits.data(), digits.data() + digits.size(), number);
  text.append(digits.data(), static_cast<std::size_t>(end - digits.data()));
}

void AppendRecord(const ValueRef& record, std::string& text) {
  AppendValue(record, text);
}

}  // namespace railcast
