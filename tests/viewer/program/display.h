#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>

namespace railcast {

/// A screen in memory for all tests of this process: an Xvfb of its own, on a display number that
/// the server finds free by itself, so that concurrent programs do not race for one.
class VirtualScreen {
 public:
  /// Starts the screen at the first call and sets DISPLAY.
  /// @returns Whether there is a screen: false where Xvfb is missing.
  [[nodiscard]] static bool IsThere() {
    static const VirtualScreen screen;
    return screen.is_there_;
  }

  ~VirtualScreen() {
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
  }
  VirtualScreen(const VirtualScreen&) = delete;
  VirtualScreen& operator=(const VirtualScreen&) = delete;

 private:
  VirtualScreen() {
    std::array<int, 2> display_pipe{};
    if (::pipe(display_pipe.data()) != 0) return;
    pid_ = ::fork();
    if (pid_ == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGTERM);
      ::dup2(::open("/dev/null", O_RDWR), STDERR_FILENO);
      const std::string at = std::to_string(display_pipe[1]);
      ::execlp("Xvfb", "Xvfb", "-displayfd", at.c_str(), "-screen", "0", "1280x1024x24", "-noreset",
               "-nolisten", "tcp", nullptr);
      ::_exit(127);
    }
    ::close(display_pipe[1]);
    std::array<char, 16> number{};
    // Xvfb writes its display number and a newline once clients can connect; if it fails, the pipe
    // ends.
    std::string text;
    while (text.find('\n') == std::string::npos) {
      const auto num_read = ::read(display_pipe[0], number.data(), number.size());
      if (num_read <= 0) break;
      text.append(number.data(), static_cast<std::size_t>(num_read));
    }
    ::close(display_pipe[0]);
    if (text.empty()) return;
    is_there_ = true;
    const std::string display = std::string(":").append(text, 0, text.find('\n'));
    ::setenv("DISPLAY", display.c_str(), 1);
  }

  pid_t pid_ = -1;
  bool is_there_ = false;
};

}  // namespace railcast
