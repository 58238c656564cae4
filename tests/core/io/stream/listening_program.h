#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <string>

#include "railcast/io/stream.h"

namespace railcast {

/// Returns a port of this machine that only this process uses: any 127.x.x.x is loopback.
[[nodiscard]] inline Endpoint OwnEndpoint() {
  constexpr std::uint32_t kFirst = 0x7F010000;  // 127.1.0.0
  constexpr std::uint32_t kNum = 0x00FE0000;
  return {kFirst + static_cast<std::uint32_t>(::getpid()) % kNum, 27'400};
}

/// A program that first prints "listening at HOST:PORT"; it is ended after a minute in any case.
class ListeningProgram {
 public:
  explicit ListeningProgram(const std::string& command)
      : pipe_(
            ::popen(("echo $$; exec timeout --foreground 60 " + command + " 2>&1").c_str(), "r")) {
    pid_ = std::stoi(Line());
    const std::string line = Line();
    const std::string head = "listening at ";
    EXPECT_EQ(line.substr(0, head.size()), head) << line;
    if (line.size() > head.size())
      at_ = ParseEndpoint(line.substr(head.size(), line.size() - head.size() - 1), 0);
  }
  ~ListeningProgram() {
    if (pipe_ != nullptr) static_cast<void>(ExitStatus());
  }
  ListeningProgram(const ListeningProgram&) = delete;
  ListeningProgram& operator=(const ListeningProgram&) = delete;

  [[nodiscard]] const Endpoint& at() const { return at_; }
  /// Returns the next line of its output; empty at the end.
  [[nodiscard]] std::string Line() {
    std::array<char, 512> text{};
    return std::fgets(text.data(), text.size(), pipe_) == nullptr ? "" : text.data();
  }
  /// Returns all further lines.
  [[nodiscard]] std::string Rest() {
    std::string rest;
    for (std::string line = Line(); !line.empty(); line = Line()) rest += line;
    return rest;
  }
  /// Interrupts it as Ctrl-C would; timeout passes the signal on.
  void Interrupt(int signal = SIGINT) const { ::kill(pid_, signal); }
  /// Waits for its end and returns its exit status.
  [[nodiscard]] int ExitStatus() {
    const int status = ::pclose(pipe_);
    pipe_ = nullptr;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  FILE* pipe_;
  int pid_{};
  Endpoint at_;
};

}  // namespace railcast
