#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace railcast {

/// One class of our label table and its counterparts in published data sets.
struct Label {
  std::uint32_t id{};
  std::string name;                   ///< Lower snake case, unique.
  std::array<std::uint8_t, 3> rgb{};  ///< Apart for the colour-blind, too.
  std::string whu_railway3d;          ///< Class name in WHU-Railway3D; "Others" where none fits.
  std::string osdar23;                ///< Class name in OSDaR23; empty where none fits.
  std::uint16_t semantic_kitti{};     ///< Id written to .label files: SemanticKITTI's own
                                      ///< where a class fits, above 259 where none does.
  std::uint16_t semantic_kitti_nearest{};  ///< The nearest of SemanticKITTI's own ids.

  bool operator==(const Label&) const = default;
};

/// The label table of `scenarios/labels.json`. Id 0 is `unlabeled`: nothing was hit.
class LabelTable {
 public:
  LabelTable() = default;
  /// @pre Ids and names are unique; the scenario reader checks.
  explicit LabelTable(std::vector<Label> labels) : labels_(std::move(labels)) {}

  [[nodiscard]] const std::vector<Label>& labels() const { return labels_; }
  [[nodiscard]] const Label* Find(std::string_view name) const;
  [[nodiscard]] const Label* Find(std::uint32_t id) const;

  /// @throws InputError if the table lacks the name.
  [[nodiscard]] std::uint32_t Id(std::string_view name) const;

 private:
  std::vector<Label> labels_;
};

}  // namespace railcast
