#include "core/scenario/scenario_sources.h"

namespace railcast {
namespace {

bool Holds(std::string_view outer, std::string_view pointer) {
  return pointer.starts_with(outer) &&
         (pointer.size() == outer.size() || pointer[outer.size()] == '/');
}

}  // namespace

void ScenarioSources::Add(std::string resolved_pointer, std::string file, std::string pointer) {
  entries_.push_back({std::move(resolved_pointer), std::move(file), std::move(pointer)});
}

void ScenarioSources::AddFile(std::string absolute, std::string shown) {
  files_.push_back({std::move(absolute), std::move(shown)});
}

std::string ScenarioSources::Place(std::string_view resolved_pointer) const {
  // The deepest entry wins; of several at one place, the last: a section's base file, if it names
  // a base itself, is entered before that one.
  const Entry* best = nullptr;
  for (const Entry& entry : entries_) {
    if (!Holds(entry.resolved_pointer, resolved_pointer)) continue;
    if (best == nullptr || entry.resolved_pointer.size() >= best->resolved_pointer.size()) {
      best = &entry;
    }
  }
  if (best == nullptr) return std::string(resolved_pointer);
  const std::string pointer =
      best->pointer + std::string(resolved_pointer.substr(best->resolved_pointer.size()));
  return pointer.empty() ? best->file : best->file + ": " + pointer;
}

std::string ScenarioSources::Locate(std::string_view line,
                                    std::string_view resolved_pointer) const {
  for (const File& file : files_) {
    if (line.starts_with(file.absolute)) {
      return file.shown + std::string(line.substr(file.absolute.size()));
    }
  }
  const std::size_t end = line.starts_with('/') ? line.find(": ") : 0;
  if (end == 0 || end == std::string_view::npos) {
    return Place(resolved_pointer) + ": " + std::string(line);
  }
  return Place(std::string(resolved_pointer) + std::string(line.substr(0, end))) +
         std::string(line.substr(end));
}

}  // namespace railcast
