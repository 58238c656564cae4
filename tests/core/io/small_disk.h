#pragma once

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <functional>
#include <string>

namespace railcast {

/// What a process on a small disk said; not run where the system allows no mount.
struct SmallDiskResult {
  bool was_run = false;
  std::string said;
};

/// Runs `work(disk)` in a child process that sees an empty 1 MiB tmpfs at `disk`, in a mount
/// namespace of its own (and a user namespace, where we are not root). Gives back what it returns.
inline SmallDiskResult RunOnSmallDisk(
    const std::filesystem::path& disk,
    const std::function<std::string(const std::filesystem::path&)>& work) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return {};
  const pid_t child = ::fork();
  if (child == 0) {
    const bool is_mounted =
        (::unshare(CLONE_NEWNS) == 0 || ::unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0) &&
        ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
        ::mount("none", disk.c_str(), "tmpfs", 0, "size=1m") == 0;
    std::string said(is_mounted ? "1" : "0");
    if (is_mounted) said += work(disk);
    const ssize_t written = ::write(ends[1], said.data(), said.size());
    ::_exit(written == static_cast<ssize_t>(said.size()) ? 0 : 1);
  }
  ::close(ends[1]);
  std::string said;
  std::array<char, 4096> buffer{};
  ssize_t count = 0;
  while ((count = ::read(ends[0], buffer.data(), buffer.size())) > 0) {
    said.append(buffer.data(), static_cast<std::size_t>(count));
  }
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  if (said.empty() || said[0] == '0') return {};
  return {true, said.substr(1)};
}

}  // namespace railcast
