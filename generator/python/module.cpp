// The Python module `railcast`: recordings and simulated frames as numpy arrays. Only the classes
// are bound here; what they do is C++ of this folder, and what needs none is in railcast/*.py.
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <thread>

#include "core/base/text.h"
#include "core/program/version.h"
#include "generator/python/bindings.h"
#include "railcast/error.h"
#include "railcast/outcome.h"

namespace railcast {
namespace {

namespace py = pybind11;

std::atomic<std::thread::id> ending_thread;  // None while Python is not ending.
std::atomic<int> num_outside = 0;            // Threads in work without the lock.

// Whether Python ends without waiting for this thread.
bool IsAbandoned() {
  const std::thread::id ending = ending_thread;
  return ending != std::thread::id() && ending != std::this_thread::get_id();
}

[[noreturn]] void StayForever() {
  for (;;) pause();
}

// Called by Python's main thread, which holds the lock, before the interpreter is taken down.
void WaitForWork() {
  constexpr auto kPause = std::chrono::milliseconds(1);
  ending_thread = std::this_thread::get_id();
  const py::gil_scoped_release released;
  while (num_outside > 0) std::this_thread::sleep_for(kPause);
}

void AddErrors(py::module_& module) {
  static py::exception<InputError> type(module, "InputError", PyExc_ValueError);
  type.doc() =
      R"(A fault in the user's input: a scenario, a command or a file.

str(error) has one line per fault, the ones that the programs print, such as
    scenarios/demo.json: /lidar/range_max_m: must be > 0 (got -5))";
  // NOLINTNEXTLINE(performance-unnecessary-value-param): the parameter that pybind11 wants.
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      type(ShownLines(error.what()).c_str());
    }
  });
}

void AddConstants(py::module_& module) {
  py::dict outcomes;
  for (std::size_t i = 0; i < kOutcomeNames.size(); ++i) {
    outcomes[py::str(std::string(kOutcomeNames[i]))] = i;
  }
  module.attr("OUTCOMES") = outcomes;
  module.attr("EXTRAS") = py::str(RAILCAST_EXTRAS).attr("split")();
  module.attr("__version__") = ProgramVersion();
}

}  // namespace

OutsideInterpreter::OutsideInterpreter() {
  // Python begins to end only with the lock, which is still held here.
  const bool is_abandoned = IsAbandoned();
  if (!is_abandoned) ++num_outside;
  state_ = PyEval_SaveThread();
  if (is_abandoned) StayForever();
}

OutsideInterpreter::~OutsideInterpreter() {
  if (IsAbandoned()) {
    --num_outside;
    StayForever();
  }
  // Until this thread has the lock, it counts, so that the interpreter cannot end meanwhile.
  PyEval_RestoreThread(state_);
  --num_outside;
}

bool IsInterrupted() {
  if (IsAbandoned()) return true;
  const py::gil_scoped_acquire acquired;
  return PyErr_CheckSignals() != 0;
}

void WatchInterpreter() {
  py::module_::import("atexit").attr("register")(py::cpp_function(WaitForWork));
  // The threads of the parent are not there in a child.
  py::module_::import("os").attr("register_at_fork")(py::arg("after_in_child") =
                                                         py::cpp_function([] { num_outside = 0; }));
}

}  // namespace railcast

PYBIND11_MODULE(_railcast, module) {
  module.doc() = "The part of railcast that is C++.";
  railcast::WatchInterpreter();
  railcast::AddErrors(module);
  railcast::AddConstants(module);
  railcast::AddFrameClasses(module);
  railcast::AddRecordingClass(module);
  railcast::AddSimulatorClass(module);
}
