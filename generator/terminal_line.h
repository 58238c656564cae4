#pragma once

#include <string_view>

namespace railcast {

/// The line of a terminal that shows how far something is, rewritten in place; silent where stderr
/// is no terminal, but for what must be said anyhow.
class TerminalLine {
 public:
  TerminalLine();

  void Show(std::string_view text) const;
  /// Puts a line of its own before what is shown next, also where stderr is no terminal.
  void Say(std::string_view text) const;
  /// Leaves what is shown and begins a new line.
  void End() const;

 private:
  bool is_terminal_;
};

}  // namespace railcast
