// The Python module `railcast`: recordings and simulated frames as numpy arrays. Only the classes
// are bound here; what they do is C++ of this folder, and what needs none is in railcast/*.py.
#include <exception>

#include "core/base/text.h"
#include "core/program/version.h"
#include "generator/python/bindings.h"
#include "generator/python/interpreter.h"
#include "railcast/error.h"
#include "railcast/outcome.h"

namespace railcast {
namespace {

namespace py = pybind11;

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
  module.attr("__version__") = ProgramVersion();
}

}  // namespace
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
