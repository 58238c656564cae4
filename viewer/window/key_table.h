#pragma once

#include <span>
#include <string_view>

namespace railcast {

class ViewWindow;

/// A key and what it does.
struct KeyBinding {
  std::string_view symbol;  ///< X's name of the key: "space", "Right", "A".
  std::string_view shown;   ///< As people know it; empty: part of the line before.
  std::string_view help;
  void (*action)(ViewWindow&);
};

/// All of them, as `?` lists them.
struct KeyTable {
  [[nodiscard]] static std::span<const KeyBinding> Bindings();
};

}  // namespace railcast
