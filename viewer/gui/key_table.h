#pragma once

#include <span>
#include <string_view>

namespace railcast {

class Gui;

/// A key and what it does.
struct KeyBinding {
  std::string_view symbol;  ///< X's name of the key: "space", "Right", "A".
  std::string_view shown;   ///< As the help shows it; empty: listed with the line before.
  std::string_view help;
  void (*action)(Gui&);
};

/// All keys, in the order in which `?` lists them.
struct KeyTable {
  [[nodiscard]] static std::span<const KeyBinding> Bindings();
};

}  // namespace railcast
