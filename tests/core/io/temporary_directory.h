#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace railcast {

inline std::filesystem::path MakeDirectory(std::string name) {
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
  return name;
}

/// Makes a new directory, in memory where the system allows it, so that tests do not wait for a
/// disk. It is deleted with its contents when this process ends, in whatever way: a failed Check or
/// a signal runs no destructors, so a shell in a session of its own waits for the end.
inline std::filesystem::path MakeDirectoryForLife() {
  const std::filesystem::path memory = "/dev/shm";
  const auto parent =
      std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
  const std::filesystem::path directory = MakeDirectory((parent / "railcast_test_XXXXXX").string());
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe2 failed");
  posix_spawn_file_actions_t streams;
  ::posix_spawn_file_actions_init(&streams);
  ::posix_spawn_file_actions_adddup2(&streams, ends[0], STDIN_FILENO);
  // The shell must not hold stdout and stderr open, or readers of the test's output would wait for
  // it.
  ::posix_spawn_file_actions_addopen(&streams, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_addopen(&streams, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t own_session;
  ::posix_spawnattr_init(&own_session);
  ::posix_spawnattr_setflags(&own_session, POSIX_SPAWN_SETSID);
  std::string shell = "sh";
  std::string option = "-c";
  std::string commands = "read nothing; rm -rf \"$0\"";
  std::string path = directory.string();
  const std::array<char*, 5> arguments = {shell.data(), option.data(), commands.data(), path.data(),
                                          nullptr};
  pid_t pid = 0;
  if (::posix_spawn(&pid, "/bin/sh", &streams, &own_session, arguments.data(), environ) != 0) {
    throw std::runtime_error("posix_spawn failed");
  }
  ::posix_spawnattr_destroy(&own_session);
  ::posix_spawn_file_actions_destroy(&streams);
  ::close(ends[0]);  // The other end closes with the process.
  return directory;
}

/// A new directory that is deleted with its contents.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    static const std::filesystem::path parent = MakeDirectoryForLife();
    path_ = MakeDirectory((parent / "XXXXXX").string());
  }
  ~TemporaryDirectory() { std::filesystem::remove_all(path_); }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace railcast
