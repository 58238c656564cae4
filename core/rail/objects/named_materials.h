#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace railcast {

/// A material that a name stands for.
struct NamedMaterial {
  std::string_view material;  ///< Of scenarios/materials/railway.json.
  std::string_view word;      ///< Which of the words of docs/world.md the name has.
};

/// Guesses what a part of a mesh is made of by the name of its material or group: "Window_front",
/// "blackRubber.001", "Holz 2". A name's words begin at capitals and after anything but letters. A
/// word of the table with at least five letters may also be a piece of one (darkglass), a shorter
/// one must be whole (tire, but not entire).
[[nodiscard]] std::optional<NamedMaterial> MaterialOfName(std::string_view name);

}  // namespace railcast
