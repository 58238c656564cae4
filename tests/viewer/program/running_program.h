#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/core/io/default_signals.h"

namespace railcast {

/// A running program, killed by the destructor if it is still running.
class RunningProgram {
 public:
  /// @param said_file Receives stdout and stderr.
  /// @param folder Its working directory; empty: that of the test.
  RunningProgram(const std::vector<std::string>& arguments,
                 std::filesystem::path said_file,
                 const std::filesystem::path& folder = {})
      : said_file_(std::move(said_file)) {
    std::vector<char*> pointers;
    for (const std::string& argument : arguments) {
      pointers.push_back(const_cast<char*>(argument.c_str()));
    }
    pointers.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ != 0) return;
    UseDefaultSignals();
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int file = ::open(said_file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    if (!folder.empty() && ::chdir(folder.c_str()) != 0) ::_exit(126);
    ::execvp(pointers[0], pointers.data());
    ::_exit(127);
  }
  ~RunningProgram() {
    if (!status_) Kill();
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  [[nodiscard]] bool IsAlive() {
    int status = 0;
    if (!status_ && ::waitpid(pid_, &status, WNOHANG) == pid_) status_ = status;
    return !status_.has_value();
  }
  void Kill() {
    if (IsAlive()) ::kill(pid_, SIGKILL);
    (void)ExitStatus();
  }
  void Interrupt() const { ::kill(pid_, SIGINT); }
  /// Waits for the program to end and returns its exit status; 128 plus the number of a signal that
  /// ended it.
  int ExitStatus() {
    int status = 0;
    if (!status_ && ::waitpid(pid_, &status, 0) == pid_) status_ = status;
    const int ended = status_.value_or(-1);
    return WIFEXITED(ended) ? WEXITSTATUS(ended) : 128 + WTERMSIG(ended);
  }
  [[nodiscard]] pid_t pid() const { return pid_; }

  /// Returns the output so far.
  [[nodiscard]] std::string Said() const {
    std::ifstream file(said_file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// Waits for a condition to hold while the program is running, for at most a minute, which is
  /// enough on busy machines, too.
  template <typename Condition>
  [[nodiscard]] bool WaitUntil(Condition&& is_so) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!is_so()) {
      if (!IsAlive() || std::chrono::steady_clock::now() > end) return is_so();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
  }

  /// Returns the memory in use, in KiB (VmRSS).
  [[nodiscard]] long Memory_KiB() const {
    std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
    std::string line;
    while (std::getline(status, line)) {
      if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
    }
    return 0;
  }

 private:
  std::filesystem::path said_file_;
  pid_t pid_ = -1;
  std::optional<int> status_;
};

}  // namespace railcast
