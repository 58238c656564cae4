#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/scenario/json_text.h"
#include "core/scenario/object_types.h"
#include "railcast/scenario.h"

namespace railcast {

/// A file of the scenario that is being read.
struct SourceFile {
  std::filesystem::path absolute;
  std::string shown;             ///< Its name in messages.
  const SourceFile* named_by{};  ///< The file that includes it; null for the scenario itself.
  Json root;
};

/// A JSON value and its place.
struct Node {
  const Json* json{};
  const SourceFile* file{};
  std::string pointer;           ///< JSON pointer in the file.
  std::string resolved_pointer;  ///< JSON pointer in the resolved scenario.
  /// The value that a base file has at this place; null = none.
  std::shared_ptr<const Node> beneath{};

  [[nodiscard]] Node Child(std::string_view key) const;
  /// The overload for a value that is known already, which saves the linear search for the key.
  [[nodiscard]] Node Child(std::string_view key, const Json& value) const;
  [[nodiscard]] Node Child(std::size_t index) const;
};

struct Member {
  std::string key;
  Node value;
  int layer =
      0;  ///< 0: from the object itself; 1: from its base file; 2: from that file's base ...
};

/// The members of an object, including those of its base files.
struct MemberList {
  std::vector<Member> members;
  bool is_complete = true;  ///< False if a file with more of them could not be read.
};

/// A value as the user wrote it, for the end of a message: " (got 5)". Long values are cut.
[[nodiscard]] std::string ValueText(const Json& value);

/// Reads the files of one scenario and records their faults and the places of values.
///
/// An object may be given as the name of a file that holds it ("sensors/vlp16.json"), or as an
/// object whose key "file" names a file with the keys that the object itself lacks. Objects within
/// it then have the keys that they lack from the objects of that file, at any depth, unless they
/// name a file themselves. Names are relative to the file that they are written in. Every such file
/// is an object with "version": 1, which the object may keep where it is copied from there to its
/// place in another file.
class JsonSource {
 public:
  /// The scenario's root, or nothing if it cannot be read.
  [[nodiscard]] std::optional<Node> Open(const std::filesystem::path& file);

  /// As Open(), but `text` is the content of the file, which need not exist.
  [[nodiscard]] std::optional<Node> OpenAs(const std::filesystem::path& file,
                                           const std::string& text);

  /// The root of a text from an untrusted sender, or nothing if it is not JSON. From then on no
  /// value may name a file: the sender must not be able to make this program read files.
  [[nodiscard]] std::optional<Node> OpenText(const std::string& text, const std::string& shown);

  /// The root of a table that the library holds, as the files are that it names.
  /// @param name With the prefix of ShippedFile().
  [[nodiscard]] std::optional<Node> OpenShipped(const std::string& text, const std::string& name);

  /// The members of an object, whether written in place or given as a file. Nothing if faulty.
  [[nodiscard]] std::optional<MemberList> Members(const Node& node);
  /// The members of an object that may not be given as a file, because it is part of a list or has
  /// a key "file" of its own, or is one of several kinds. It replaces that of a base file as a
  /// whole.
  [[nodiscard]] std::optional<MemberList> PlainMembers(const Node& node);

  /// The absolute name of the file that the string `node` names, or its name as it is if the
  /// library holds it (ShippedFile()); nothing if there is no such file.
  [[nodiscard]] std::optional<std::filesystem::path> FileNamedBy(const Node& node);
  /// The root of that file, whose place in the resolved scenario is `resolved_pointer`.
  [[nodiscard]] std::optional<Node> FileRoot(const Node& node, std::string resolved_pointer);
  /// Checks a file's "version" and "$schema". @return Whether the root is an object.
  bool CheckRoot(const Node& root);

  void Fault(const Node& node, const std::string& rule);  ///< The message ends with the value.
  void FaultWithoutValue(const Node& node, const std::string& rule);
  void Missing(const Node& object, std::string_view key);

  [[nodiscard]] ErrorList& errors() { return errors_; }
  /// Places whose values are unknown because of faults, as pointers in the resolved scenario.
  [[nodiscard]] UnknownPlaces& unknown() { return unknown_; }
  [[nodiscard]] ScenarioSources& sources() { return sources_; }
  /// The types that objects may have, as far as they are read.
  [[nodiscard]] ObjectTypes& types() { return types_; }

 private:
  std::optional<Node> CheckedRoot(std::optional<Node> root, const std::filesystem::path& file);
  std::optional<Node> Load(SourceFile file, std::string resolved_pointer);
  std::optional<Node> Parse(const std::string& text, SourceFile file, std::string resolved_pointer);
  [[nodiscard]] bool IsOfFile(const Node& node, const std::string& key) const;
  [[nodiscard]] std::optional<MemberList> MembersWithBase(const Node& node);

  bool may_read_files_ = true;
  bool is_shipped_ = false;  // Whether the files are those that the library holds.
  ObjectTypes types_;
  ErrorList errors_;
  UnknownPlaces unknown_;
  ScenarioSources sources_;
  std::deque<SourceFile> files_;  // A deque, because nodes point to its elements.
};

}  // namespace railcast
