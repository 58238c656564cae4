#include "core/io/run/table_records.h"

#include "core/io/record/read_record.h"
#include "core/io/record/record_text.h"
#include "core/scenario/descriptions.h"

namespace railcast {

void Describe(Archive& a, LabelsRecord& s) {
  a.Required("version", s.version, "Version of the file's format.", Within(1, 1));
  a.Required("labels", s.labels, "The labels, as in a scenario's table of labels.");
}

void Describe(Archive& a, MaterialRecord& s) {
  a.Required("id", s.id, "Number of the material in the points; 0 means none.");
  a.Required("name", s.name, "Name of the material.");
  a.Required("reflectivity", s.reflectivity,
             "Diffuse reflectance at 905 nm; 1 = white Lambertian.");
  a.Required("reflectivity_1550nm", s.reflectivity_1550nm, "Diffuse reflectance at 1550 nm.");
  a.Required("facet_slope_deg", s.facet_slope_deg,
             "Oren-Nayar's sigma, the diffuse roughness; 0 = Lambertian.");
  a.Required("specular_f0", s.specular_f0,
             "Reflectance of the GGX lobe at normal incidence, 905 nm.");
  a.Required("specular_f0_1550nm", s.specular_f0_1550nm,
             "Reflectance of the GGX lobe at normal incidence, 1550 nm.");
  a.Required("specular_roughness", s.specular_roughness, "Alpha of the GGX lobe.");
  a.Required("retroreflectance", s.retroreflectance,
             "Peak of a retroreflector as a multiple of a white Lambertian; 0 = none.");
}

void Describe(Archive& a, MaterialsRecord& s) {
  a.Required("version", s.version, "Version of the file's format.", Within(1, 1));
  a.Required("materials", s.materials, "The materials, as in a scenario's table of materials.");
}

std::string LabelsJson(const LabelTable& labels) {
  return RecordFile(LabelsRecord{.labels = {labels.labels().begin(), labels.labels().end()}});
}

std::string MaterialsJson(const MaterialLibrary& materials) {
  MaterialsRecord record;
  for (const Material& material : materials.materials()) {
    record.materials.push_back(
        {.id = static_cast<std::uint16_t>(record.materials.size()),
         .name = material.name,
         .reflectivity = material.reflectivity,
         .reflectivity_1550nm = material.reflectivity_1550nm.value_or(material.reflectivity),
         .facet_slope_deg = material.facet_slope_deg,
         .specular_f0 = material.specular_f0,
         .specular_f0_1550nm = material.specular_f0_1550nm.value_or(material.specular_f0),
         .specular_roughness = material.specular_roughness,
         .retroreflectance = material.retroreflectance});
  }
  return RecordFile(record);
}

std::vector<std::string> ReadMaterialNames(const std::string& text, const std::string& place) {
  std::vector<std::string> names;
  for (const MaterialRecord& material : ReadRecord<MaterialsRecord>(text, place).materials) {
    if (names.size() <= material.id) names.resize(material.id + std::size_t{1});
    names[material.id] = material.name;
  }
  return names;
}

}  // namespace railcast
