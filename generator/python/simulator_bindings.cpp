#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "generator/python/bindings.h"
#include "generator/python/held_simulation.h"
#include "generator/python/rail_lines.h"

namespace railcast {
namespace {

namespace py = pybind11;

// Whether Ctrl-C was pressed. Only Python's main thread learns that, as for all of its own waiting.
bool IsInterrupted() {
  const py::gil_scoped_acquire acquired;
  return PyErr_CheckSignals() != 0;
}

// Does long work without the interpreter's lock.
template <typename Work>
auto WithoutGil(const Work& work) {
  try {
    const py::gil_scoped_release released;
    return work();
  } catch (const Interrupted&) {
    throw py::error_already_set();  // The KeyboardInterrupt, or what the signal's handler raised.
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
    const auto path = scenario.cast<std::filesystem::path>();
    return WithoutGil([&] { return ReadScenario(path); });
  }
  return WithoutGil([&] { return ReadScenarioText(text, file); });
}

std::unique_ptr<HeldSimulation> MakeSimulation(const py::object& scenario,
                                               const std::filesystem::path& file,
                                               std::int64_t threads) {
  const ScenarioSpec spec = ReadScenarioOf(scenario, file);
  return WithoutGil([&] { return std::make_unique<HeldSimulation>(spec, threads, IsInterrupted); });
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
      "The two rails of a stretch of track, in the order in which the vehicle comes\n"
      "to them. What other tracks have in common with the vehicle's way is not\n"
      "part of them.")
      .def_readonly("track", &RailLines::track, "Name of the track; of a route its first.")
      .def_readonly("is_ego", &RailLines::is_ego, "Whether it is the vehicle's way.")
      .def_property_readonly(
          "left", [](const RailLines& self) { return LineArray(self.left_m); },
          "Middle of the head of the left rail, as the vehicle faces, at top of rail, every "
          "metre,\n"
          "in the sensor's axes in m: float64, (n, 3).")
      .def_property_readonly(
          "right", [](const RailLines& self) { return LineArray(self.right_m); },
          "The same of the right rail: float64, (n, 3).");
}

void ApplyCommand(HeldSimulation& self,
                  const py::object& command,
                  std::int64_t frame,
                  const HeldSimulation::Sensor& sensor) {
  const std::string line =
      py::isinstance<py::str>(command) ? command.cast<std::string>() : JsonText(command);
  WithoutGil([&] { self.Apply(line, frame, sensor); });
}

}  // namespace

void AddSimulatorClass(pybind11::module_& module) {
  AddRails(module);
  py::class_<HeldSimulation>(
      module, "Simulator",
      "Makes the frames of a scenario in memory.\n\n"
      "    sim = railcast.Simulator(\"scenarios/st_gallen_approach.json\")\n"
      "    frame = sim.scan(30)\n\n"
      "A frame depends on the scenario, its index and the commands alone, never on the frames "
      "before\n"
      "or on the number of threads, and equals that of `railcast-generate sequence` bit for bit.\n"
      "Frames in ascending order are fastest.")
      .def(py::init(&MakeSimulation), py::arg("scenario"), py::kw_only(),
           py::arg("file") = "scenario", py::arg("threads") = 0,
           "scenario: the path of a scenario file, or the scenario itself as a dict or as JSON "
           "text\n"
           "    (a str that begins with \"{\").\n"
           "file: the file that a dict or a text stands for, which need not exist: names of other\n"
           "    files are relative to its folder, and messages show its name.\n"
           "threads: number of threads; 0 = all cores.\n\n"
           "Raises InputError with all faults of the scenario, the lines of `railcast-generate\n"
           "check`.")
      .def(
          "scan",
          [](HeldSimulation& self, std::int64_t frame, const HeldSimulation::Sensor& sensor,
             bool objects) {
            return WithoutGil([&] { return self.Scan(frame, sensor, objects); });
          },
          py::arg("frame"), py::arg("sensor") = 0, py::kw_only(), py::arg("objects") = false,
          "Makes a frame with all fields.\n\n"
          "frame: its index, from 0; frames are 1 / rate_hz apart.\n"
          "sensor: index or name of the sensor, where the scenario has several.\n"
          "objects: whether Frame.objects lists the objects within range, which takes rays of its\n"
          "    own.\n\n"
          "The interpreter's lock is released meanwhile. Ctrl-C ends the building of the scene, "
          "and\n"
          "otherwise takes effect after the frame. Raises InputError if the vehicle or an object\n"
          "leaves its track in that frame.")
      .def(
          "rails",
          [](HeldSimulation& self, std::int64_t frame, const HeldSimulation::Sensor& sensor,
             double behind_m, double ahead_m) {
            return WithoutGil([&] { return self.Rails(frame, sensor, {behind_m, ahead_m}); });
          },
          py::arg("frame"), py::arg("sensor") = 0, py::kw_only(), py::arg("behind_m") = 20.0,
          py::arg("ahead_m") = 200.0,
          "The rails of all tracks about the vehicle at a frame's stamp, first those of its own "
          "way.\n\n"
          "behind_m, ahead_m: how far from the vehicle's origin, along the chainage.")
      .def("apply", &ApplyCommand, py::arg("command"), py::arg("frame"), py::arg("sensor") = 0,
           "Applies a command of docs/commands.md, which holds for frames stamped at the stamp of\n"
           "that frame or later, of all sensors.\n\n"
           "command: a dict or JSON text, such as {\"command\": \"brake\"}.\n"
           "frame, sensor: when; not before the last command. Frames before may still be "
           "scanned.\n\n"
           "Raises InputError with the lines that a live run answers; nothing has changed then.")
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

}  // namespace railcast
