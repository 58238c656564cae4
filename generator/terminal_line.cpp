#include "generator/terminal_line.h"

#include <unistd.h>

#include <iostream>

#include "core/base/shown_text.h"

namespace railcast {

TerminalLine::TerminalLine() : is_terminal_(::isatty(STDERR_FILENO) == 1) {}

void TerminalLine::Show(std::string_view text) const {
  // CR: to the line's begin. ESC [K: clear to its end.
  if (is_terminal_) std::cerr << "\r\033[K" << text << std::flush;
}

void TerminalLine::Say(std::string_view text) const {
  Show("");
  std::cerr << ShownLines(text) << "\n" << std::flush;
}

void TerminalLine::End() const {
  if (is_terminal_) std::cerr << "\n";
}

}  // namespace railcast
