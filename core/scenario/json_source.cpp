#include "core/scenario/json_source.h"

#include <unistd.h>

#include <algorithm>
#include <map>
#include <utility>

#include "core/base/input_file.h"
#include "core/base/inputs.h"
#include "core/base/shipped_files.h"
#include "core/base/text.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

std::string PlaceOfNode(const Node& node) {
  return node.pointer.empty() ? node.file->shown : node.file->shown + ": " + node.pointer;
}

// The name of the file that a string names, as messages show it.
std::string ShownName(const Node& node) {
  const fs::path name = node.json->get<std::string>();
  return ShownPath((fs::path(node.file->shown).parent_path() / name).lexically_normal());
}

std::string ShownScenario(const fs::path& file) {
  return ShownPath(file.lexically_normal());
}

SourceFile ScenarioFile(const fs::path& file) {
  return {fs::absolute(file).lexically_normal(), ShownScenario(file), nullptr, {}};
}

// The reason why a file cannot be read; empty if it can be read.
std::string Obstacle(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) return "no such file";
  if (!fs::is_regular_file(status)) {
    return "must be a file, not " + std::string(NameOf(status.type()));
  }
  if (::access(file.c_str(), R_OK) != 0) return "cannot be read";
  return "";
}

}  // namespace

std::string ValueText(const Json& value) {
  constexpr std::size_t kMaxLength = 60;
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() <= kMaxLength) return text;
  std::size_t end = kMaxLength;
  while ((static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;  // Within a character.
  return text.substr(0, end) + "...";
}

Node Node::Child(std::string_view key) const {
  return Child(key, json->at(std::string(key)));
}

Node Node::Child(std::string_view key, const Json& value) const {
  const std::string step = PointerStep(key);
  return {&value, file, pointer + step, resolved_pointer + step};
}

Node Node::Child(std::size_t index) const {
  const std::string step = PointerStep(std::to_string(index));
  return {&json->at(index), file, pointer + step, resolved_pointer + step};
}

std::optional<Node> JsonSource::Open(const fs::path& file) {
  if (const std::string obstacle = Obstacle(file); !obstacle.empty()) {
    errors_.Add({ShownPath(file), obstacle, ""});
    return std::nullopt;
  }
  return CheckedRoot(Load(ScenarioFile(file), ""), file);
}

std::optional<Node> JsonSource::OpenAs(const fs::path& file, const std::string& text) {
  return CheckedRoot(Parse(text, ScenarioFile(file), ""), file);
}

std::optional<Node> JsonSource::CheckedRoot(std::optional<Node> root, const fs::path& file) {
  if (root) sources_.Add("", ShownScenario(file), "");
  if (!root || !CheckRoot(*root)) return std::nullopt;
  return root;
}

std::optional<Node> JsonSource::OpenText(const std::string& text, const std::string& shown) {
  may_read_files_ = false;
  return Parse(text, {{}, shown, nullptr, {}}, "");
}

std::optional<Node> JsonSource::OpenShipped(const std::string& text, const std::string& name) {
  is_shipped_ = true;
  auto root = Parse(text, {name, name, nullptr, {}}, "");
  if (!root || !CheckRoot(*root)) return std::nullopt;
  return root;
}

// Whether a key belongs to the file and not to the object that is its root.
bool JsonSource::IsOfFile(const Node& node, const std::string& key) const {
  return may_read_files_ && node.pointer.empty() && (key == "version" || key == "$schema");
}

std::optional<MemberList> JsonSource::Members(const Node& node) {
  auto list = MembersWithBase(node);
  if (!list || !may_read_files_) return list;
  std::erase_if(list->members, [](const Member& member) {
    return member.key == "version" && *member.value.json == 1;
  });
  return list;
}

std::optional<MemberList> JsonSource::MembersWithBase(const Node& node) {
  const bool is_name = node.json->is_string();
  const bool names_file = is_name || (node.json->is_object() && node.json->contains("file"));
  if (!names_file && (node.beneath == nullptr || !node.json->is_object())) {
    return PlainMembers(node);
  }
  std::optional<MemberList> list;
  if (names_file) {
    // In the resolved scenario, the keys of a base file belong to the object that names the file.
    const auto root = FileRoot(is_name ? node : node.Child("file"), node.resolved_pointer);
    if (root) sources_.Add(root->resolved_pointer, root->file->shown, "");
    if (root && CheckRoot(*root)) list = Members(*root);
  } else {
    list = Members(*node.beneath);
    for (const Member& member : list ? list->members : std::vector<Member>{}) {
      sources_.Add(member.value.resolved_pointer, member.value.file->shown, member.value.pointer);
    }
  }
  if (is_name) return list;
  // Read the object's own keys even if its base file cannot be read.
  if (!list) list = MemberList{{}, false};
  // An object may have 200,000 keys, so that none is searched for among all the others.
  std::map<std::string_view, std::shared_ptr<const Node>> own_keys;
  for (const auto& [key, value] : node.json->items()) own_keys.emplace(key, nullptr);
  std::erase_if(list->members, [&](const Member& member) {
    const auto own = own_keys.find(member.key);
    if (own == own_keys.end()) return false;
    own->second = std::make_shared<const Node>(member.value);
    return true;
  });
  for (Member& member : list->members) ++member.layer;
  for (const auto& [key, value] : node.json->items()) {
    if (key == "file" || IsOfFile(node, key)) continue;
    Node child = node.Child(key, value);
    sources_.Add(child.resolved_pointer, child.file->shown, child.pointer);
    child.beneath = std::move(own_keys.at(key));
    list->members.push_back({key, std::move(child)});
  }
  return list;
}

std::optional<MemberList> JsonSource::PlainMembers(const Node& node) {
  if (!node.json->is_object()) {
    Fault(node, "must be an object");
    return std::nullopt;
  }
  MemberList list;
  for (const auto& [key, value] : node.json->items()) {
    if (IsOfFile(node, key)) continue;
    list.members.push_back({key, node.Child(key, value)});
  }
  return list;
}

std::optional<fs::path> JsonSource::FileNamedBy(const Node& node) {
  if (!may_read_files_) {
    Fault(node, "must not name a file");
    return std::nullopt;
  }
  if (!node.json->is_string()) {
    Fault(node, "must be the name of a file");
    return std::nullopt;
  }
  const auto given = node.json->get<std::string>();
  std::string shipped = is_shipped_ ? std::string(kShippedPrefix) + given : given;
  if (ShippedFile(shipped)) return shipped;
  const fs::path name = given;
  fs::path absolute = (node.file->absolute.parent_path() / name).lexically_normal();
  if (const std::string obstacle = Obstacle(absolute); !obstacle.empty()) {
    Fault(node, obstacle);
    return std::nullopt;
  }
  sources_.AddFile(absolute.string(), ShownName(node));
  return absolute;
}

std::optional<Node> JsonSource::FileRoot(const Node& node, std::string resolved_pointer) {
  const std::optional<fs::path> absolute = FileNamedBy(node);
  if (!absolute) return std::nullopt;
  const std::string shown = ShownName(node);
  std::string chain = shown;
  for (const SourceFile* file = node.file; file != nullptr; file = file->named_by) {
    chain.insert(0, file->shown + " -> ");
    std::error_code no_such_file;  // The scenario's text may stand in no file (OpenAs).
    if (fs::equivalent(file->absolute, *absolute, no_such_file)) {
      FaultWithoutValue(node, "includes itself: " + chain);
      return std::nullopt;
    }
  }
  auto root = Load({*absolute, shown, node.file, {}}, std::move(resolved_pointer));
  if (!root) unknown_.Add(node.resolved_pointer);
  return root;
}

void JsonSource::Fault(const Node& node, const std::string& rule) {
  errors_.Add({PlaceOfNode(node), rule, ValueText(*node.json)});
  unknown_.Add(node.resolved_pointer);
}

void JsonSource::FaultWithoutValue(const Node& node, const std::string& rule) {
  errors_.Add({PlaceOfNode(node), rule, ""});
  unknown_.Add(node.resolved_pointer);
}

void JsonSource::Missing(const Node& object, std::string_view key) {
  errors_.Add({object.file->shown + ": " + object.pointer + PointerStep(key), "missing", ""});
  unknown_.Add(object.resolved_pointer + PointerStep(key));
}

std::optional<Node> JsonSource::Load(SourceFile file, std::string resolved_pointer) {
  if (const auto shipped = ShippedFile(file.absolute.native())) {
    return Parse(std::string(*shipped), std::move(file), std::move(resolved_pointer));
  }
  NoteInput(file.absolute);
  const std::string text = ReadFileWhole(file.absolute);
  return Parse(text, std::move(file), std::move(resolved_pointer));
}

std::optional<Node> JsonSource::Parse(const std::string& text,
                                      SourceFile file,
                                      std::string resolved_pointer) {
  JsonText parsed = ParseJson(text);
  if (!parsed.json) {
    errors_.Add({file.shown, parsed.syntax_error, ""});
    return std::nullopt;
  }
  for (const std::string& pointer : parsed.duplicate_keys) {
    errors_.Add({file.shown + ": " + pointer, "duplicate key", ""});
    unknown_.Add(resolved_pointer + pointer);
  }
  file.root = std::move(*parsed.json);
  files_.push_back(std::move(file));
  return Node{&files_.back().root, &files_.back(), "", std::move(resolved_pointer)};
}

bool JsonSource::CheckRoot(const Node& root) {
  if (!root.json->is_object()) {
    Fault(root, "must be an object");
    return false;
  }
  if (!root.json->contains("version")) {
    Missing(root, "version");
  } else if (root.json->at("version") != 1) {
    Fault(root.Child("version"), "must be 1");
  }
  if (root.json->contains("$schema") && !root.json->at("$schema").is_string()) {
    Fault(root.Child("$schema"), "must be a string");
  }
  return true;
}

}  // namespace railcast
