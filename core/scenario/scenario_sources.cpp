#include "core/scenario/scenario_sources.h"

#include <algorithm>

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

void ScenarioSources::Rename(std::string_view from, const std::string& to) {
  const std::size_t num_entries = entries_.size();
  Entry root;
  for (std::size_t i = 0; i < num_entries; ++i) {
    const Entry& entry = entries_[i];
    if (entry.resolved_pointer.empty()) root = entry;
    if (!Holds(from, entry.resolved_pointer)) continue;
    Entry renamed = entry;
    renamed.resolved_pointer = to + entry.resolved_pointer.substr(from.size());
    entries_.push_back(std::move(renamed));
  }
  // What has no entry of its own stands where the scenario's file has it.
  entries_.insert(entries_.begin(), {to, root.file, root.pointer + std::string(from)});
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
  const bool names_file = std::any_of(files_.begin(), files_.end(), [&](const File& file) {
    return line.starts_with(file.absolute);
  });
  std::string located(line);
  if (!names_file) {
    // Without a pointer of its own, a line is about the whole spec.
    const std::size_t end = line.starts_with('/') ? std::min(line.find(": "), line.size()) : 0;
    const std::string place = Place(std::string(resolved_pointer).append(line.substr(0, end)));
    located = place + (end == 0 ? ": " : "") + std::string(line.substr(end));
  }
  for (const File& file : files_) {
    for (std::size_t at = located.find(file.absolute); at != std::string::npos;
         at = located.find(file.absolute, at + file.shown.size())) {
      located.replace(at, file.absolute.size(), file.shown);
    }
  }
  return located;
}

}  // namespace railcast
