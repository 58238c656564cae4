#include "railcast/frame.h"

#include <algorithm>
#include <set>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {

void Frame::Resize(std::uint32_t new_rows, std::uint32_t new_columns, std::uint32_t new_returns) {
  rows = new_rows;
  columns = new_columns;
  returns = new_returns;
  ForEachField(*this, [this](std::string_view, std::string_view, auto& values) {
    values.resize(num_slots());
  });
  if (has_velocity) return;
  radial_velocity_mps.clear();
  true_radial_velocity_mps.clear();
}

const Label* LabelTable::Find(std::string_view name) const {
  const auto it = std::find_if(labels_.begin(), labels_.end(),
                               [&](const Label& label) { return label.name == name; });
  return it == labels_.end() ? nullptr : &*it;
}

const Label* LabelTable::Find(std::uint32_t id) const {
  const auto it = std::find_if(labels_.begin(), labels_.end(),
                               [&](const Label& label) { return label.id == id; });
  return it == labels_.end() ? nullptr : &*it;
}

std::uint32_t LabelTable::Id(std::string_view name) const {
  const Label* label = Find(name);
  if (label == nullptr) {
    throw InputError({{"/labels", "the table must hold \"" + std::string(name) + '"', ""}});
  }
  return label->id;
}

std::vector<std::uint32_t> LabelTable::Ids(const std::vector<std::string>& names,
                                           const std::string& pointer) const {
  std::set<std::uint32_t> ids;
  ErrorList errors;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (const Label* const label = Find(names[i])) {
      ids.insert(label->id);
    } else {
      errors.Add({pointer + '/' + std::to_string(i), "must be in the label table",
                  '"' + ShownText(names[i]) + '"'});
    }
  }
  errors.ThrowIfAny();
  return {ids.begin(), ids.end()};
}

}  // namespace railcast
