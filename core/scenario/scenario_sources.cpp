#include "railcast/scenario.h"

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
  // Values without an entry of their own come from the scenario's file.
  entries_.insert(entries_.begin(), {to, root.file, root.pointer + std::string(from)});
}

std::string ScenarioSources::Place(std::string_view resolved_pointer) const {
  // The deepest entry wins. Of several entries for one place the last one wins: a base file that
  // names a base itself is entered before that one.
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

Fault ScenarioSources::Locate(const Fault& fault, std::string_view resolved_pointer) const {
  Fault located = fault;
  const std::string& named = fault.place.empty() ? fault.rule : fault.place;
  const bool names_file = std::ranges::any_of(
      files_, [&](const File& file) { return named.starts_with(file.absolute); });
  if (!names_file) {
    // A line without a pointer is about the whole spec.
    const bool has_pointer = fault.place.starts_with('/');
    const std::size_t end = has_pointer ? std::min(fault.place.find(": "), fault.place.size()) : 0;
    located.place = Place(std::string(resolved_pointer).append(fault.place.substr(0, end)));
    if (!has_pointer && !fault.place.empty()) located.place += ": ";
    located.place += fault.place.substr(end);
  }
  for (const File& file : files_) {
    for (std::string* const part : {&located.place, &located.rule, &located.value}) {
      for (std::size_t at = part->find(file.absolute); at != std::string::npos;
           at = part->find(file.absolute, at + file.shown.size())) {
        part->replace(at, file.absolute.size(), file.shown);
      }
    }
  }
  return located;
}

}  // namespace railcast
