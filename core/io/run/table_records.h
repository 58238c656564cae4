#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "railcast/frame.h"
#include "railcast/material.h"

namespace railcast {

class Archive;

// The tables of a run that stand beside its frames.

/// The content of labels.json, which ReadLabelTable() reads.
struct LabelsRecord {
  std::uint32_t version = 1;
  std::vector<Label> labels;
};
void Describe(Archive& a, LabelsRecord& s);

/// A material by the id that frames have; 0 means none.
struct MaterialRecord {
  std::uint16_t id{};
  std::string name{};
  double reflectivity{};
  double reflectivity_1550nm{};
  double facet_slope_deg{};
  double specular_f0{};
  double specular_f0_1550nm{};
  double specular_roughness{};
  double retroreflectance{};
};
void Describe(Archive& a, MaterialRecord& s);

/// The content of materials.json.
struct MaterialsRecord {
  std::uint32_t version = 1;
  std::vector<MaterialRecord> materials{};
};
void Describe(Archive& a, MaterialsRecord& s);

[[nodiscard]] std::string LabelsJson(const LabelTable& labels);
[[nodiscard]] std::string MaterialsJson(const MaterialLibrary& materials);

/// The materials' names by their ids.
/// @throws InputError "place: rule" if the text is not a materials.json.
[[nodiscard]] std::vector<std::string> ReadMaterialNames(const std::string& text,
                                                         const std::string& place);

}  // namespace railcast
