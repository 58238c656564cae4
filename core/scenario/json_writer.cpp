#include "core/scenario/json_writer.h"

#include <utility>

#include "core/base/error.h"
#include "core/scenario/descriptions.h"

namespace railcast {

void JsonWriter::Preset(std::string_view key,
                        std::optional<std::string>& file,
                        KeyDoc doc,
                        const FilePreset& /*preset*/) {
  Optional(key, file, doc);
}

void JsonWriter::Types(std::string_view key, std::vector<ModelSpec>& models, KeyDoc doc) {
  if (!models.empty()) Required(key, models, doc);
}

void JsonWriter::Switches(std::string_view key,
                          std::map<std::string, bool>& switches,
                          KeyDoc /*doc*/,
                          const std::vector<std::string>& /*names*/) {
  object_[std::string(key)] = switches;
}

void JsonWriter::Visit(const Key& key, const ValueRef& value) {
  if (value.type->kind == ValueType::Kind::kOptional) {
    if (value.type->size(value.place) == 0) {
      if (key.is_nullable) object_[std::string(key.name)] = nullptr;
      return;
    }
    return Visit(key, {value.type->at(value.place, 0), value.type->of()});
  }
  const Json* const assumed = AssumedOf(key.name);
  if (!key.is_required && assumed != nullptr && *assumed == Write(value)) return;
  object_[std::string(key.name)] = Written(value, assumed);
}

const Json* JsonWriter::AssumedOf(std::string_view key) const {
  const auto it = assumed_.find(std::string(key));
  return it == assumed_.end() ? nullptr : &*it;
}

Json JsonWriter::WrittenStruct(const ValueRef& value, const Json* assumed) const {
  JsonWriter writer;
  writer.is_short_ = is_short_;
  if (is_short_) {
    writer.assumed_ = assumed != nullptr ? *assumed : Write(NewValue(*value.type).ref());
  }
  value.type->describe(writer, value.place);
  return std::move(writer.object_);
}

Json JsonWriter::Written(const ValueRef& value, const Json* assumed) const {
  using Kind = ValueType::Kind;
  const ValueType& type = *value.type;
  switch (type.kind) {
    case Kind::kBool:
      return *static_cast<const bool*>(value.place);
    case Kind::kNumber:
      return *static_cast<const double*>(value.place);
    case Kind::kWhole:
      return type.whole(value.place);
    case Kind::kSigned:
      return *static_cast<const std::int64_t*>(value.place);
    case Kind::kText:
      return *static_cast<const std::string*>(value.place);
    case Kind::kName:
      return type.name(value.place);
    case Kind::kObjectType:
      return NameOf(*static_cast<const ObjectType*>(value.place));
    case Kind::kOptional:
    case Kind::kArray:
    case Kind::kList: {
      Json list = Json::array();
      for (std::size_t i = 0; i < type.size(value.place); ++i) {
        list.push_back(Written({type.at(value.place, i), type.of()}, nullptr));
      }
      return list;
    }
    case Kind::kMap: {
      Json object = Json::object();
      for (const std::string& key : type.keys(value.place)) {
        object[key] = Written({type.member(value.place, key), type.of()}, nullptr);
      }
      return object;
    }
    case Kind::kJson:
      return *static_cast<const Json*>(value.place);
    case Kind::kVariant: {
      const std::size_t index = type.size(value.place);
      const ValueType::Alternative alternative = type.alternatives()[index];
      Json json = {{"type", alternative.name}};
      json.update(Written({type.at(value.place, index), alternative.type}, nullptr));
      return json;
    }
    case Kind::kStruct:
      return WrittenStruct(value, assumed);
    case Kind::kOwn:
      break;
  }
  Check(false, "what reads itself is not written");
  return {};
}

}  // namespace railcast
