#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/unknown_places.h"
#include "core/scenario/json_text.h"
#include "core/scenario/scenario_sources.h"

namespace railcast {

/// A file while a scenario is read.
struct SourceFile {
  std::filesystem::path absolute;
  std::string shown;             ///< As the user knows it.
  const SourceFile* named_by{};  ///< The file that includes it; null for the scenario itself.
  Json root;
};

/// A JSON value and where it stands.
struct Node {
  const Json* json{};
  const SourceFile* file{};
  std::string pointer;           ///< In the file.
  std::string resolved_pointer;  ///< In the resolved scenario.

  [[nodiscard]] Node Child(std::string_view key) const;
  /// The same where the key's value is at hand: a search would compare it with every other key.
  [[nodiscard]] Node Child(std::string_view key, const Json& value) const;
  [[nodiscard]] Node Child(std::size_t index) const;
};

struct Member {
  std::string key;
  Node value;
  int layer = 0;  ///< 0: written in the object itself; 1: in the file it builds on; ...
};

/// An object's members, whichever way it is given.
struct MemberList {
  std::vector<Member> members;
  bool is_complete = true;  ///< False if a file with more of them could not be read.
};

/// " (got 5)": a value as the user wrote it, cut where it is long.
[[nodiscard]] std::string Got(const Json& value);

/// Reads the files of one scenario, and gathers their faults and where things were written.
///
/// An object may be given as the name of a file that holds it ("sensors/vlp16.json"), or as an
/// object whose key "file" names a file with the keys that the object itself lacks. Names are
/// relative to the file that they are written in. Every such file is an object with "version": 1.
class JsonSource {
 public:
  /// The scenario's root, or nothing if it cannot be read.
  [[nodiscard]] std::optional<Node> Open(const std::filesystem::path& file);

  /// The root of a text that came from outside, or nothing if it is no JSON. From then on no value
  /// may name a file: whoever sent the text must not make us read any.
  [[nodiscard]] std::optional<Node> OpenText(const std::string& text, const std::string& shown);

  /// The members of an object, whichever way it is given. Nothing if that is faulty.
  [[nodiscard]] std::optional<MemberList> Members(const Node& node);
  /// The same of an object that may not be a file: part of a list, or with a "file" of its own.
  [[nodiscard]] std::optional<MemberList> PlainMembers(const Node& node);

  /// The absolute name of the file that the string `node` names; nothing if there is no such file.
  [[nodiscard]] std::optional<std::filesystem::path> FileNamedBy(const Node& node);
  /// What that file holds, which stands at `resolved_pointer` in the resolved scenario.
  [[nodiscard]] std::optional<Node> FileRoot(const Node& node, std::string resolved_pointer);
  /// Faults of a file's "version" and "$schema". @return Whether the root is an object.
  bool CheckRoot(const Node& root);

  void Fault(const Node& node, const std::string& rule);  ///< Ends with the value.
  void FaultWithoutValue(const Node& node, const std::string& rule);
  void Missing(const Node& object, std::string_view key);

  [[nodiscard]] ErrorList& errors() { return errors_; }
  /// By pointers in the resolved scenario.
  [[nodiscard]] UnknownPlaces& unknown() { return unknown_; }
  [[nodiscard]] ScenarioSources& sources() { return sources_; }

 private:
  std::optional<Node> Load(SourceFile file, std::string resolved_pointer);
  std::optional<Node> Parse(const std::string& text, SourceFile file, std::string resolved_pointer);
  [[nodiscard]] bool IsOfFile(const Node& node, const std::string& key) const;

  bool may_read_files_ = true;
  ErrorList errors_;
  UnknownPlaces unknown_;
  ScenarioSources sources_;
  std::deque<SourceFile> files_;  // Nodes point into it; a deque does not move its elements.
};

}  // namespace railcast
