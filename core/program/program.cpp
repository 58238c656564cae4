#include "core/program/program.h"

#include <fcntl.h>
#include <malloc.h>
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/write_file.h"
#include "core/program/command_line.h"
#include "core/program/version.h"
#include "railcast/remark.h"

namespace railcast {
namespace {

// Opens /dev/null in place of each closed standard stream; open() takes the lowest free number. A
// closed stdout is opened read-only, so that writing to it still fails.
void TakeClosedStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    (void)::open("/dev/null", stream == STDOUT_FILENO ? O_RDONLY : O_RDWR);
  }
}

// Ignores SIGXFSZ, so that a write beyond `ulimit -f` fails with an error that names the file.
void RefuseLargeFiles() {
  (void)::signal(SIGXFSZ, SIG_IGN);
}

// Keeps memory that is freed: each frame takes some megabytes anew, and pages that were given back
// to the system cost more time than reading a frame's file.
void KeepFreedMemory() {
  constexpr int kLargest = 32 << 20;
  (void)::mallopt(M_MMAP_THRESHOLD, kLargest);
  (void)::mallopt(M_TRIM_THRESHOLD, 4 * kLargest);
}

std::terminate_handler default_terminate = nullptr;

[[noreturn]] void EndWith(std::string_view line) {
  static_cast<void>(::write(STDERR_FILENO, line.data(), line.size()));
  ::_exit(kExitFailure);
}

constexpr std::string_view kOutOfThreads =
    "no further thread can be started; fewer threads or more memory are needed\n";

// TBB has no exception type for this and is compared by text; std::thread throws EAGAIN.
bool IsOutOfThreads(const std::exception& error) {
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  return std::string_view(error.what()).starts_with("pthread_create has failed") ||
         (system != nullptr && system->code() == std::errc::resource_unavailable_try_again);
}

// The JSON library writes texts of users as they are, or not at all; compared by text, too.
bool IsNoUtf8(const std::exception& error) {
  return std::string_view(error.what()).starts_with("[json.exception.type_error.316]");
}

// Reports that memory or threads have run out where no exception may be thrown, for example while
// TBB starts its threads. It must not allocate memory.
[[noreturn]] void Terminate() {
  try {
    if (std::current_exception() != nullptr) std::rethrow_exception(std::current_exception());
  } catch (const std::bad_alloc&) {
    EndWith("out of memory\n");
  } catch (const std::exception& error) {
    if (IsOutOfThreads(error)) EndWith(kOutOfThreads);
  } catch (...) {
    // Any other exception is a bug; the default handler below reports it.
  }
  default_terminate();
  std::abort();
}

// Returns the line as a shell would read it, with the program's path reduced to its name.
std::string CommandLine(const std::string& program, int argc, char** argv) {
  std::string line = program;
  for (int i = 1; i < argc; ++i) {
    line += " ";
    line += ShellWord(argv[i]);
  }
  return line;
}

/// Each once, although a command may read its sources several times, and not always to the end.
class RemarksOfRun {
 public:
  RemarksOfRun() {
    SetRemarkReceiver([this](const Remark& remark) { Take(remark); });
  }
  RemarksOfRun(const RemarksOfRun&) = delete;
  RemarksOfRun& operator=(const RemarksOfRun&) = delete;
  ~RemarksOfRun() { SetRemarkReceiver(nullptr); }

  void Print(const std::string& program, std::ostream& out) const {
    for (const Remark& remark : remarks_) {
      out << program << ": remark " << remark.type().name << ": " << ShownLines(remark.Text())
          << "\n";
    }
  }

 private:
  void Take(const Remark& remark) {
    const auto known = std::ranges::find_if(remarks_, [&](const Remark& other) {
      return other.kind == remark.kind && other.place == remark.place;
    });
    if (known == remarks_.end()) {
      remarks_.push_back(remark);
    } else {
      known->number = std::max(known->number, remark.number);
    }
  }

  std::vector<Remark> remarks_;
};

int RunMain(const std::string& program,
            const std::function<int()>& main,
            std::ostream& complaints) {
  const RemarksOfRun remarks;
  try {
    const int status = main();
    remarks.Print(program, complaints);
    return status;
  } catch (const InputError& error) {
    remarks.Print(program, complaints);
    complaints << ShownLines(error.what()) << "\n";
  } catch (const std::bad_alloc&) {
    complaints << program << ": out of memory\n";
  } catch (const std::exception& error) {
    if (IsOutOfThreads(error)) {
      complaints << kOutOfThreads;
    } else if (IsNoUtf8(error)) {
      complaints << program << ": names in files of JSON must be UTF-8\n";
    } else {
      complaints << program << ": " << ShownLines(error.what()) << "\n";
    }
  }
  return kExitFailure;
}

int ParseAndRun(const ProgramSpec& spec, int argc, char** argv) {
  CLI::App app(spec.description, spec.name);
  app.set_version_flag("--version", "railcast " + ProgramVersion());
  app.failure_message(SayWhatIsWrong);
  app.footer(spec.footer);
  ProgramCommand command;
  ProgramOptions options(&app);
  spec.add(options, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitSuccess : kExitUsage;
  }
  return command(CommandLine(spec.name, argc, argv));
}

// Returns if there are none, as from the program of the extras itself.
void RunWithExtras(const std::string& program, char** argv) {
  std::error_code error;
  const auto own = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto other = own.parent_path().parent_path() / "libexec/railcast" / program;
  ::execv(other.c_str(), argv);
}

}  // namespace

int RunProgram(const std::string& program,
               const std::function<int()>& main,
               std::ostream& complaints) {
  TakeClosedStreams();
  KeepFreedMemory();
  RefuseLargeFiles();
  default_terminate = std::set_terminate(Terminate);
  const int status = RunMain(program, main, complaints);
  errno = 0;
  std::cout.flush();
  std::fflush(stdout);
  if (std::cout.good() && std::ferror(stdout) == 0) return status;
  // If an earlier write failed and nothing is buffered any more, flushing leaves errno at 0 and the
  // reason is no longer known.
  complaints << (errno != 0 ? FileError("stdout", errno).what()
                            : "stdout: not all of it could be written")
             << "\n";
  return status != kExitSuccess ? status : kExitFailure;
}

int ProgramMain(const ProgramSpec& spec, int argc, char** argv) {
  RunWithExtras(spec.name, argv);
  return RunProgram(
      spec.name, [&] { return ParseAndRun(spec, argc, argv); }, std::cerr);
}

void AddExtraCommand(const ExtraCommands& built,
                     const std::string& name,
                     const std::string& extra,
                     ProgramOptions& app,
                     ProgramCommand& command) {
  if (const auto found = built.find(name); found != built.end()) {
    found->second(app, command);
    return;
  }
  app.AddForeignCommand(name, "Not installed").WhenParsed([&command, name, extra] {
    command = [name, extra](const std::string& /*all*/) -> int { throw LacksExtra(name, extra); };
  });
}

}  // namespace railcast
