#pragma once

#include <filesystem>

#include "core/frame/labels.h"
#include "core/rail/alignment_spec.h"
#include "core/scene/material.h"

namespace railcast {

/// Our own file of the real line St.Gallen - Wil, read without any check.
[[nodiscard]] AlignmentSpec ReadStGallenWil();

/// A file of TTOBench, with our sign of radii.
[[nodiscard]] AlignmentSpec ReadTtobench(const std::filesystem::path& file);

/// scenarios/labels.json and scenarios/materials/railway.json; of a label only id and name.
[[nodiscard]] LabelTable ReadLabels();
[[nodiscard]] MaterialLibrary ReadMaterials();

}  // namespace railcast
