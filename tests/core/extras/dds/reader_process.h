#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>

extern char** environ;

namespace railcast {

/// A reader of Fast DDS in a process of its own (fast_reader.cpp).
class ReaderProcess {
 public:
  ReaderProcess(std::uint32_t domain,
                const std::string& topic,
                const std::string& type,
                int delay_ms = 0) {
    std::array<int, 2> in{};
    std::array<int, 2> out{};
    if (::pipe2(in.data(), O_CLOEXEC) != 0 || ::pipe2(out.data(), O_CLOEXEC) != 0) {
      throw std::runtime_error("pipe2 failed");
    }
    posix_spawn_file_actions_t streams;
    ::posix_spawn_file_actions_init(&streams);
    ::posix_spawn_file_actions_adddup2(&streams, in[0], STDIN_FILENO);
    ::posix_spawn_file_actions_adddup2(&streams, out[1], STDOUT_FILENO);
    std::array<std::string, 5> words = {RAILCAST_FAST_READER, std::to_string(domain), topic, type,
                                        std::to_string(delay_ms)};
    std::array<char*, 6> arguments{};
    for (std::size_t i = 0; i < words.size(); ++i) arguments[i] = words[i].data();
    const int status =
        ::posix_spawn(&pid_, words[0].c_str(), &streams, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&streams);
    ::close(in[0]);
    ::close(out[1]);
    stdin_ = in[1];
    said_ = ::fdopen(out[0], "r");
    if (status != 0) throw std::runtime_error("cannot start " + words[0]);
  }
  ~ReaderProcess() {
    Signal(SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    ::close(stdin_);
    std::fclose(said_);
  }
  ReaderProcess(const ReaderProcess&) = delete;
  ReaderProcess& operator=(const ReaderProcess&) = delete;

  void Signal(int signal) const { ::kill(pid_, signal); }
  /// The next line that it says.
  [[nodiscard]] std::string WaitForLine() {
    std::array<char, 64> line{};
    if (std::fgets(line.data(), line.size(), said_) == nullptr) return "";
    std::string text = line.data();
    text.pop_back();
    return text;
  }

 private:
  pid_t pid_{};
  int stdin_ = -1;
  std::FILE* said_ = nullptr;
};

}  // namespace railcast
