#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <list>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "generator/python/bindings.h"
#include "generator/python/held_simulation.h"
#include "generator/python/rail_lines.h"

namespace railcast {
namespace {

namespace py = pybind11;

// Does long work without the interpreter's lock.
template <typename Work>
auto WithoutGil(const Work& work) {
  try {
    const OutsideInterpreter outside;
    return work();
  } catch (const Interrupted&) {
    throw py::error_already_set();  // The KeyboardInterrupt, or what the signal's handler raised.
  }
}

std::filesystem::path PathOf(const py::object& scenario) {
  try {
    return scenario.cast<std::filesystem::path>();
  } catch (const py::cast_error&) {
    const py::object type = scenario.get_type().attr("__name__");
    throw py::type_error("scenario: must be a path, a dict or JSON text (got " +
                         type.cast<std::string>() + ")");
  }
}

ScenarioSpec ReadScenarioOf(const py::object& scenario, const std::filesystem::path& file) {
  std::string text;
  if (py::isinstance<py::dict>(scenario)) {
    text = JsonText(scenario);
  } else if (py::isinstance<py::str>(scenario)) {
    text = scenario.cast<std::string>();
    if (!text.starts_with('{')) return WithoutGil([&] { return ReadScenario(text); });
  } else {
    const std::filesystem::path path = PathOf(scenario);
    return WithoutGil([&] { return ReadScenario(path); });
  }
  return WithoutGil([&] { return ReadScenarioText(text, file); });
}

/// In a process that was forked from the maker's, the simulation lasts until the process ends.
struct EndWhereMade {
  void operator()(HeldSimulation* simulation) const {
    if (simulation->IsOfThisProcess()) delete simulation;
  }
};

/// The simulations that are not deleted yet, also those that are being made, which are null.
/// Guarded by the interpreter's lock; never destroyed itself.
std::list<std::unique_ptr<HeldSimulation, EndWhereMade>>& Simulations() {
  static auto& simulations = *new std::list<std::unique_ptr<HeldSimulation, EndWhereMade>>();
  return simulations;
}

/// Ends the simulations that Python has not deleted when it ends, for example because a thread that
/// it has abandoned still holds them. Their threads would go on building scenes while the process
/// destroys the libraries that they build them with.
void EndSimulations() {
  Simulations().clear();
}

struct RemoveFromSimulations {
  void operator()(const HeldSimulation* simulation) const {
    Simulations().remove_if([&](const auto& held) { return held.get() == simulation; });
  }
};
/// What Python holds.
using SimulationPointer = std::unique_ptr<HeldSimulation, RemoveFromSimulations>;

SimulationPointer MakeSimulation(const py::object& scenario,
                                 const std::filesystem::path& file,
                                 std::int64_t threads) {
  const ScenarioSpec spec = ReadScenarioOf(scenario, file);
  // In the list from the start: Python may abandon this thread before it has the lock again.
  const auto held = Simulations().emplace(Simulations().end());
  try {
    WithoutGil([&] { held->reset(new HeldSimulation(spec, threads, IsInterrupted)); });
  } catch (...) {
    Simulations().erase(held);
    throw;
  }
  return SimulationPointer(held->get());
}

py::array_t<double> LineArray(const std::vector<Vector3>& line_m) {
  py::array_t<double> array(std::vector<py::ssize_t>{static_cast<py::ssize_t>(line_m.size()), 3});
  double* to = array.mutable_data();
  for (const Vector3& point : line_m) to = std::copy_n(point.data(), 3, to);
  return array;
}

void AddRails(py::module_& module) {
  py::class_<RailLines>(
      module, "Rails",
      R"(The two rails of a stretch of track, in the order in which the vehicle comes
to them. What other tracks have in common with the vehicle's way is not
part of them.)")
      .def_readonly("track", &RailLines::track, "Name of the track; of a route its first.")
      .def_readonly("is_ego", &RailLines::is_ego, "Whether it is the vehicle's way.")
      .def_property_readonly(
          "left", [](const RailLines& self) { return LineArray(self.left_m); },
          R"(Middle of the head of the left rail, as the vehicle faces, at top of rail, every metre,
in the sensor's axes in m: float64, (n, 3).)")
      .def_property_readonly(
          "right", [](const RailLines& self) { return LineArray(self.right_m); },
          "The same of the right rail: float64, (n, 3).");
  RefuseUnmade<RailLines>();
}

void ApplyCommand(HeldSimulation& self,
                  const py::object& command,
                  std::int64_t frame,
                  const HeldSimulation::Sensor& sensor) {
  const std::string line =
      py::isinstance<py::str>(command) ? command.cast<std::string>() : JsonText(command);
  WithoutGil([&] { self.Apply(line, frame, sensor); });
}

/// The columns of samples as arrays, by their names with the units.
template <typename Sample>
py::dict ColumnsOf(const std::vector<Sample>& samples) {
  py::dict columns;
  ForEachColumn(Sample{}, [&]<typename Value>(const std::string& name, const std::string& unit,
                                              const Value&) {
    constexpr bool kIsVector = std::is_same_v<Value, Vector3>;
    using Number = std::conditional_t<kIsVector, double, Value>;
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(samples.size())};
    if (kIsVector) shape.push_back(3);
    py::array_t<Number> column(shape);
    Number* to = column.mutable_data();
    for (const Sample& sample : samples) {
      ForEachColumn(sample, [&]<typename Other>(const std::string& other, const std::string&,
                                                const Other& value) {
        if (other != name) return;
        if constexpr (std::is_same_v<Other, Value> && kIsVector) {
          to = std::copy_n(value.data(), 3, to);
        } else if constexpr (std::is_same_v<Other, Value>) {
          *to++ = value;
        }
      });
    }
    columns[py::str(unit.empty() ? name : name + "_" + unit)] = column;
  });
  return columns;
}

py::dict MotionOf(HeldSimulation& self, std::int64_t frame) {
  const MotionSamples samples = WithoutGil([&] { return self.Motion(frame); });
  const MotionSensorsSpec spec = self.scenario().motion_sensors.value_or(MotionSensorsSpec{});
  py::dict sensors;
  const auto add = [&](const auto& of_kind, const auto& samples_of_kind) {
    for (std::size_t i = 0; i < of_kind.size(); ++i) {
      sensors[py::str(of_kind[i].name)] = ColumnsOf(samples_of_kind.at(i));
    }
  };
  add(spec.imus, samples.imus);
  add(spec.gnss, samples.gnss);
  add(spec.odometers, samples.odometers);
  return sensors;
}

using SimulatorClass = py::class_<HeldSimulation, SimulationPointer>;

void AddWork(SimulatorClass& simulator) {
  simulator
      .def(py::init(&MakeSimulation), py::arg("scenario"), py::kw_only(),
           py::arg("file") = "scenario", py::arg("threads") = 0,
           R"(scenario: the path of a scenario file, or the scenario as a dict or as JSON text
    (a str that begins with "{").
file: the file that a dict or a text stands for, which need not exist: names of other
    files are relative to its folder, and messages show its name.
threads: number of threads; 0 = all cores.

Raises InputError with all faults of the scenario, the lines of `railcast-generate
check`.)")
      .def(
          "scan",
          [](HeldSimulation& self, std::int64_t frame, const HeldSimulation::Sensor& sensor,
             bool objects) {
            return WithoutGil([&] { return self.Scan(frame, sensor, objects); });
          },
          py::arg("frame"), py::arg("sensor") = 0, py::kw_only(), py::arg("objects") = false,
          R"(Makes a frame with all fields.

frame: its index, from 0; frames are 1 / rate_hz apart.
sensor: index or name of the sensor, where the scenario has several.
objects: whether Frame.objects lists the objects within range, which takes rays of its
    own.

The interpreter's lock is released meanwhile. Ctrl-C ends the building of a scene;
otherwise it takes effect after the frame. Raises InputError if the vehicle or an object
leaves its track in that frame.)")
      .def(
          "rails",
          [](HeldSimulation& self, std::int64_t frame, const HeldSimulation::Sensor& sensor,
             double behind_m, double ahead_m) {
            return WithoutGil([&] { return self.Rails(frame, sensor, {behind_m, ahead_m}); });
          },
          py::arg("frame"), py::arg("sensor") = 0, py::kw_only(), py::arg("behind_m") = 20.0,
          py::arg("ahead_m") = 200.0,
          R"(The rails of all tracks about the vehicle at a frame's stamp; its own way is first.

behind_m, ahead_m: how far from the vehicle's origin, along the chainage; >= 0.)")
      .def("motion", &MotionOf, py::arg("frame"),
           R"(The samples of the motion sensors in the time of a frame of the first sensor, from its
stamp on and before the next one's: for each sensor, by its name, a dict of arrays by the
names of the columns in its file, where a vector is one column of shape (n, 3).)")
      .def("apply", &ApplyCommand, py::arg("command"), py::arg("frame"), py::arg("sensor") = 0,
           R"(Applies a command of docs/commands.md, which holds for frames stamped at the stamp of
that frame or later, of all sensors.

command: a dict or JSON text, such as {"command": "brake"}.
frame, sensor: when; not before the last command. Earlier frames may still be made.

Raises InputError with the lines that a live run answers; nothing has changed then.)");
}

void AddProperties(SimulatorClass& simulator) {
  simulator
      .def_property_readonly(
          "sensors", [](const HeldSimulation& self) { return SensorNames(self.scenario()); },
          "Names of the sensors; that of a single one may be empty.")
      .def_property_readonly(
          "labels", [](const HeldSimulation& self) { return LabelDict(self.labels()); },
          "Ids in the field `label`, by name.")
      .def_property_readonly(
          "materials",
          [](const HeldSimulation& self) {
            std::vector<std::string> names;
            const MaterialLibrary library(self.scenario().materials);
            for (const Material& material : library.materials()) names.push_back(material.name);
            return names;
          },
          "Names of materials by their number in the field `material`.")
      .def_property_readonly(
          "scenario",
          [](const HeldSimulation& self) {
            return ParsedJson(ResolvedScenarioJson(self.scenario()));
          },
          "The scenario with every default and every file's content in place, as a dict.");
}

}  // namespace

void AddSimulatorClass(pybind11::module_& module) {
  if (Py_AtExit(EndSimulations) != 0)
    throw std::runtime_error("Py_AtExit has no room for another function");
  AddRails(module);
  SimulatorClass simulator(module, "Simulator",
                           R"(Makes the frames of a scenario in memory.

    sim = railcast.Simulator("scenarios/st_gallen_approach.json")
    frame = sim.scan(30)

A frame depends on the scenario, its index and the commands alone, never on frames
before or on the number of threads, and equals that of `railcast-generate sequence` bit for bit.
Frames in ascending order are fastest.)");
  RefuseUnmade<HeldSimulation>();
  AddWork(simulator);
  AddProperties(simulator);
}

}  // namespace railcast
