#include "core/extras/recipe/recipe_files.h"

#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/inputs.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/run/scenario_identity.h"
#include "core/io/run/sequence_files.h"
#include "core/mesh/mesh_import.h"
#include "core/scenario/json_text.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Hashes of files by their place in the recipe's folder.
class FileHashes {
 public:
  explicit FileHashes(fs::path folder) : folder_(std::move(folder)) {}

  /// @param folder Where the names in `value` are looked for.
  void AddNamedIn(const Json& value, const fs::path& folder) {
    if (value.is_string()) return Add(folder / value.get_ref<const std::string&>());
    for (const Json& part : value) {
      if (value.is_structured()) AddNamedIn(part, folder);
    }
  }

  [[nodiscard]] std::string Hash() const {
    std::string all;
    for (const auto& [name, hash] : hashes_) all += name + '\n' + hash + '\n';
    return all.empty() ? "" : ContentHash(all);
  }

 private:
  void Add(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return;
    const InputBytes read = ReadInput(file);
    const std::string& bytes = *read;
    if (!Note(file, bytes)) return;
    // Parts of scenarios have a version; glTF has not.
    const JsonText text = ParseJson(bytes);
    if (text.json && text.json->is_object() && text.json->contains("version")) {
      AddNamedIn(*text.json, file.parent_path());
    }
    for (const FileBeside& beside : FilesBesideMesh(bytes, file)) {
      Note(file.parent_path() / beside.name, beside.bytes);
    }
  }

  /// Returns whether the file is new.
  bool Note(const fs::path& file, const std::string& bytes) {
    const std::string name = file.lexically_normal().lexically_proximate(folder_).generic_string();
    return hashes_.emplace(name, ContentHash(bytes)).second;
  }

  fs::path folder_;
  std::map<std::string, std::string> hashes_;
};

}  // namespace

RecipeBases::RecipeBases(const Recipe& recipe) {
  ErrorList errors;
  for (const RecipeBase& base : recipe.bases) {
    // As a user would name it.
    const std::filesystem::path shown =
        std::filesystem::path(base.file).lexically_proximate(std::filesystem::current_path());
    if (base.run) {
      specs_.push_back(base.run->plan());
      jsons_.push_back(Json::parse(ResolvedScenarioJson(base.run->plan())));
      hashes_.push_back(
          ContentHash(IdentityOf(base.run->plan()).scenario_hash + base.run->Traits()));
      continue;
    }
    auto spec = Attempt("", errors, [&] { return ReadScenario(shown); });
    if (!spec) continue;
    if (spec->world.recording) {
      errors.Add({ShownPath(recipe.file.lexically_normal()) + ": " + base.pointer + "/recordings",
                  "missing: " + ShownPath(shown) + " is a plan, whose world is a recording", ""});
      continue;
    }
    jsons_.push_back(Json::parse(ResolvedScenarioJson(*spec)));
    hashes_.push_back(IdentityOf(*spec).scenario_hash);
    specs_.push_back(std::move(*spec));
  }
  errors.ThrowIfAny();
}

std::string HashOfRecipeFiles(const Recipe& recipe) {
  const fs::path folder = fs::absolute(recipe.file).lexically_normal().parent_path();
  FileHashes hashes(folder);
  const JsonText text = ParseJson(ReadFileWhole(recipe.file));
  for (const auto& [key, value] : text.json.value().items()) {
    if (key != "bases") hashes.AddNamedIn(value, folder);
  }
  return hashes.Hash();
}

}  // namespace railcast
