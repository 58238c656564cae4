#include "core/extras/recipe/drafted_scenario.h"

#include <algorithm>
#include <utility>

#include "core/base/text.h"
#include "core/extras/recipe/json_place.h"

namespace railcast {
namespace {

// Whether a value may be or hold the name of a file with more keys.
bool MayNameFile(const Json& value) {
  if (value.is_string()) return true;
  if (value.is_object() && value.contains("file")) return true;
  return value.is_structured() && std::any_of(value.begin(), value.end(), MayNameFile);
}

}  // namespace

DraftedScenario::DraftedScenario(const Recipe& recipe,
                                 std::optional<std::uint32_t> number,
                                 const Json& base,
                                 std::size_t base_index)
    : file_(recipe.file),
      shown_(ShownPath(recipe.file.lexically_normal())),
      number_(number ? "scenario " + std::to_string(*number) + ": " : ""),
      json_(base),
      run_(recipe.bases.at(base_index).run.get()) {
  origins_.push_back({"", recipe.bases[base_index].pointer});
}

void DraftedScenario::Set(const std::string& pointer,
                          const Json& value,
                          const std::string& recipe_pointer) {
  const bool is_inside = std::ranges::any_of(unread_, [&](const std::string& outer) {
    return pointer != outer && LiesWithin(pointer, outer);
  });
  if (is_inside) ResolveFiles();
  if (const auto obstacle = SetAt(json_, pointer, value)) {
    throw InputError(std::vector<Fault>{FaultAt(recipe_pointer, *obstacle)});
  }
  Note(pointer, recipe_pointer);
  if (MayNameFile(value)) unread_.push_back(pointer);
}

void DraftedScenario::Note(const std::string& pointer, const std::string& recipe_pointer) {
  origins_.push_back({pointer, recipe_pointer});
}

void DraftedScenario::ResolveFiles() {
  json_ = Json::parse(ResolvedScenarioJson(Read()));
  unread_.clear();
}

ScenarioSpec DraftedScenario::Read() const {
  return Located([&] { return ReadScenarioText(json_.dump(), file_); });
}

ScenarioSpec DraftedScenario::OnLine(ScenarioSpec scenario) const {
  if (run_ == nullptr) return scenario;
  return Located([&] { return run_->OnLine(std::move(scenario)); });
}

DraftedScenario::Start DraftedScenario::start() const {
  if (start_) return *start_;
  const Json vehicle = json_.value("vehicle", Json::object());
  const Json motion = vehicle.value("motion", Json::object());
  const bool is_reverse = motion.is_object() && motion.value("reverse", Json()) == true;
  const Json start = vehicle.value("start_s_m", Json());
  return {start.is_number() ? start.get<double>() : 0.0, is_reverse ? -1.0 : 1.0};
}

Fault DraftedScenario::FaultAt(const std::string& recipe_pointer, const std::string& rule) const {
  return {shown_ + ": " + recipe_pointer, number_ + rule, ""};
}

std::vector<Fault> DraftedScenario::InRecipe(const InputError& error) const {
  const std::string prefix = shown_ + ": ";
  std::vector<Fault> faults;
  for (Fault fault : error.faults()) {
    // A fault without a place of its own stands in its rule.
    std::string& text = fault.place.empty() ? fault.rule : fault.place;
    if (!text.starts_with(prefix)) {
      faults.push_back(std::move(fault));
      continue;
    }
    std::string pointer = text.substr(prefix.size());
    pointer = pointer.substr(0, pointer.find(": "));
    std::string rule = text.substr(prefix.size());
    if (!fault.place.empty()) rule += ": " + fault.rule;
    Fault located = FaultAt(RecipePointerOf(pointer), rule);
    located.value = fault.value;
    faults.push_back(std::move(located));
  }
  return faults;
}

// The key whose value holds the place most closely; else the last one whose value lies in it.
std::string DraftedScenario::RecipePointerOf(const std::string& pointer) const {
  const Origin* best = nullptr;
  for (const Origin& origin : origins_) {
    if (!LiesWithin(pointer, origin.pointer)) continue;
    if (best == nullptr || origin.pointer.size() >= best->pointer.size()) best = &origin;
  }
  if (best != nullptr && !best->pointer.empty()) return best->recipe_pointer;
  for (const Origin& origin : origins_) {
    if (!origin.pointer.empty() && LiesWithin(origin.pointer, pointer)) best = &origin;
  }
  return best == nullptr ? "" : best->recipe_pointer;
}

}  // namespace railcast
