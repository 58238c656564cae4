#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/objects.h"

namespace railcast {

/// The types that objects may have: the four shapes, the shipped models and those of a scenario.
class ObjectTypes {
 public:
  /// Adds a model of the scenario's own table, where it is at place `entry`.
  void Add(const ModelSpec& model, std::size_t entry);
  /// Adds all models of that table.
  void Add(const std::vector<ModelSpec>& models);

  [[nodiscard]] std::optional<ObjectType> Find(std::string_view name) const;
  [[nodiscard]] std::vector<std::string> Names() const;

 private:
  std::vector<ObjectType> own_;
};

/// The models of scenarios/models/models.json, which the library holds, in its order.
[[nodiscard]] const std::vector<ObjectType>& ShippedTypes();

}  // namespace railcast
