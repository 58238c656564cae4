#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/archive.h"
#include "core/scenario/json_text.h"

namespace railcast {

/// The archive that writes: makes a JSON object from a struct. It writes every value except those
/// that are absent or, if the text shall be short, those that a reader would assume anyway. It
/// ignores alternative keys and rules.
class JsonWriter final : public Archive {
 public:
  void Preset(std::string_view key,
              std::optional<std::string>& file,
              KeyDoc doc,
              const FilePreset& preset) override;
  void Types(std::string_view key, std::vector<ModelSpec>& models, KeyDoc doc) override;
  void Switches(std::string_view key,
                std::map<std::string, bool>& switches,
                KeyDoc doc,
                const std::vector<std::string>& names) override;

  template <class T>
  [[nodiscard]] static Json Write(T& value) {
    return JsonWriter().Written(RefTo(value), nullptr);
  }
  [[nodiscard]] static Json Write(const ValueRef& value) {
    return JsonWriter().Written(value, nullptr);
  }
  /// As Write(), but without the optional keys that have their defaults.
  template <class T>
  [[nodiscard]] static Json WriteShort(T& value) {
    JsonWriter writer;
    writer.is_short_ = true;
    return writer.Written(RefTo(value), nullptr);
  }

 private:
  void Visit(const Key& key, const ValueRef& value) override;
  /// @param assumed What a reader starts from; null = the type's defaults.
  [[nodiscard]] Json Written(const ValueRef& value, const Json* assumed) const;
  [[nodiscard]] Json WrittenStruct(const ValueRef& value, const Json* assumed) const;
  [[nodiscard]] const Json* AssumedOf(std::string_view key) const;

  bool is_short_ = false;
  Json assumed_ = Json::object();  // The keys that a reader knows; none if the text is not short.
  Json object_ = Json::object();
};

}  // namespace railcast
