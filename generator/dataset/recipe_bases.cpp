#include "generator/dataset/recipe_bases.h"

#include <utility>

#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/io/run/scenario_identity.h"

namespace railcast {

RecipeBases::RecipeBases(const Recipe& recipe) {
  ErrorList errors;
  for (const RecipeBase& base : recipe.bases) {
    // As a user would name it.
    const std::filesystem::path shown =
        std::filesystem::path(base.file).lexically_proximate(std::filesystem::current_path());
    auto spec = Attempt("", errors, [&] { return ReadScenario(shown); });
    if (!spec) continue;
    jsons_.push_back(Json::parse(ResolvedScenarioJson(*spec)));
    hashes_.push_back(IdentityOf(*spec).scenario_hash);
    specs_.push_back(std::move(*spec));
  }
  errors.ThrowIfAny();
}

}  // namespace railcast
