"""Each test plants a small tree and reads what scripts/dev/lint_architecture.py says of it."""

import contextlib
import io
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/dev"))
import lint_architecture  # noqa: E402 (found through the line above)


def faults_of(files):
    """The faults of a tree with these files: {name: text}."""
    with tempfile.TemporaryDirectory() as folder:
        plant(pathlib.Path(folder), files)
        return lint_architecture.lint(pathlib.Path(folder))


def plant(root, files):
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


class NamedRooms(unittest.TestCase):

    def test_a_room_that_the_table_of_folders_lacks_is_a_fault(self):
        folder, first = "core/detect", lint_architecture.ROOM_ORDERS["core/detect"][0]
        rows = {name: f"| `{name}` | {' '.join(f'`{room}`' for room in order)} |"
                for name, order in lint_architecture.ROOM_ORDERS.items()}
        self.assertEqual(faults_of({"docs/architecture.md": "\n".join(rows.values()) + "\n"}), [])
        rows[folder] = rows[folder].replace(f"`{first}`", "")
        self.assertEqual(faults_of({"docs/architecture.md": "\n".join(rows.values()) + "\n"}),
                         [f"docs/architecture.md:1: the table of folders names every room ({folder}/{first})"])


class IncludeDirection(unittest.TestCase):

    def test_a_folder_of_core_may_include_itself_and_those_before_it(self):
        self.assertEqual(faults_of({
            "core/base/units.h": "",
            "core/scan/scan_spec.h": "",
            "core/scan/scan_pattern.h":
                '#include "core/base/units.h"\n#include "core/scan/scan_spec.h"\n',
        }), [])

    def test_a_folder_of_core_may_not_include_one_after_it(self):
        self.assertEqual(faults_of({
            "core/rail/line/course.cpp": '\n#include "core/trace/tracer.h"\n',
            "core/trace/tracer.h": "",
        }), ["core/rail/line/course.cpp:2: core/rail comes before core/trace and includes nothing of it "
             "(core/trace/tracer.h)"])

    def test_an_unknown_folder_of_core_needs_a_place_in_the_order(self):
        self.assertEqual(faults_of({"core/misc/a.cpp": '#include "core/base/error.h"\n'}), [
            "core/misc/a.cpp:1: misc has no place in the order of core's folders "
            "(core/base/error.h)"])

    def test_a_room_may_include_itself_and_those_before_it(self):
        self.assertEqual(faults_of({
            "core/rail/base/chainage_range.h": "",
            "core/rail/track/ballast.h": "",
            "core/rail/track/ballast.cpp":
                '#include "core/rail/base/chainage_range.h"\n#include "core/rail/track/ballast.h"\n',
        }), [])

    def test_a_room_may_not_include_one_after_it(self):
        self.assertEqual(faults_of({
            "core/detect/kernels/fog.h": '\n#include "core/detect/beam/footprint.h"\n',
            "core/detect/beam/footprint.h": "",
        }), ["core/detect/kernels/fog.h:2: core/detect/kernels comes before core/detect/beam and includes nothing of "
             "it (core/detect/beam/footprint.h)"])

    def test_a_public_header_counts_as_part_of_the_room_that_implements_it(self):
        self.assertEqual(faults_of({
            "core/include/railcast/rail_world.h": "",
            "core/rail/track/ballast.h": '#include "railcast/rail_world.h"\n',
            "core/rail/world/rail_world.cpp": '#include "railcast/rail_world.h"\n',
        }), ["core/rail/track/ballast.h:1: core/rail/track comes before core/rail/world and includes nothing of it "
             "(railcast/rail_world.h)"])

    def test_every_file_stands_in_a_room_of_the_order(self):
        rooms = "core/detect has the rooms base, kernels, clutter, detector, beam, effects"
        self.assertEqual(faults_of({"core/detect/fog.h": "", "core/detect/misc/fog.h": ""}), [
            f"core/detect/fog.h:1: {rooms} (.)", f"core/detect/misc/fog.h:1: {rooms} (misc)"])

    def test_programs_share_core_and_nothing_else(self):
        self.assertEqual(faults_of({
            "viewer/main.cpp": '#include "railcast/frame.h"\n#include "analysis/stats.h"\n',
            "core/simulate/simulator.cpp": '#include "generator/sequence.h"\n',
        }), [
            "core/simulate/simulator.cpp:1: core includes no generator (generator/sequence.h)",
            "viewer/main.cpp:2: viewer includes no analysis (analysis/stats.h)"])

    def test_tests_may_include_everything(self):
        self.assertEqual(faults_of({
            "tests/all_test.cpp": '#include "viewer/a.h"\n#include "core/io/b.h"\n'
                                  '#include <pcl/io/pcd_io.h>\n#include <OpenMesh/Core/IO/MeshIO.hh>\n',
        }), [])

    def test_an_extra_includes_what_those_use_that_its_list_names(self):
        files = {
            "core/extras/packets/pcap/a.h": "",
            "core/extras/ros/bag/b.h": '#include "core/extras/packets/pcap/a.h"\n',
            "core/extras/ros/CMakeLists.txt": "railcast_extra(\n  USES core/packets\n  SOURCES b.cpp)\n",
            "generator/extras/ros/c.cpp": '#include "core/extras/packets/pcap/a.h"\n',
            "generator/extras/ros/CMakeLists.txt": "railcast_extra(\n  USES core/ros\n  SOURCES c.cpp)\n",
        }
        self.assertEqual(faults_of(files), [])
        files["core/extras/ros/CMakeLists.txt"] = "railcast_extra(\n  SOURCES b.cpp)\n"
        self.assertEqual(faults_of(files), [
            "core/extras/ros/bag/b.h:1: an extra's CMakeLists.txt names the extras that it uses (core/packets)",
            "generator/extras/ros/c.cpp:1: an extra's CMakeLists.txt names the extras that it uses (core/packets)"])

    def test_our_own_files_are_included_from_the_root(self):
        self.assertEqual(faults_of({"core/base/error.cpp": '#include "error.h"\n'}), [
            'core/base/error.cpp:1: our own files are included from the root ("error.h")'])


class Libraries(unittest.TestCase):

    def test_each_library_stays_where_it_belongs(self):
        self.assertEqual(faults_of({
            "core/trace/tracer.cpp": "#include <embree3/rtcore.h>\n",
            "core/mesh/obj_reader.cpp": "#include <OpenMesh/Core/IO/MeshIO.hh>\n",
            "core/scenario/json_reader.h": "#include <nlohmann/json.hpp>\n",
            "core/io/pcd.cpp": "#include <pcl/io/pcd_io.h>\n",
            "viewer/main.cpp": "#include <vtkRenderer.h>\n",
            "core/program/options.cpp": "#include <CLI/CLI.hpp>\n",
        }), [])

    def test_a_library_elsewhere_is_a_fault(self):
        for include, owners in {
            "embree3/rtcore.h": "core/trace and tests include Embree",
            "OpenMesh/Core/IO/MeshIO.hh": "core/mesh and tests include OpenMesh",
            "nlohmann/json.hpp": "core/mesh, core/scenario, core/fidelity, core/io, core/extras, generator, analysis and "
                                 "tests include nlohmann",
            "pcl/point_types.h": "core/io, core/points, core/track, core/include/railcast/io, generator, analysis and tests "
                                 "include PCL",
            "vtkRenderer.h": "viewer and tests include VTK",
            "CLI/CLI.hpp": "core/program and tests include CLI11",
        }.items():
            with self.subTest(include):
                self.assertEqual(faults_of({"core/rail/base/a.cpp": f"#include <{include}>\n"}),
                                 [f"core/rail/base/a.cpp:1: only {owners} ({include})"])


class PublicHeaders(unittest.TestCase):

    def test_they_include_the_standard_library_eigen_and_each_other(self):
        self.assertEqual(faults_of({
            "core/include/railcast/transform.h": "#include <vector>\n#include <Eigen/Core>\n",
            "core/include/railcast/frame.h": '#include "railcast/transform.h"\n',
        }), [])

    def test_they_include_no_other_library_even_where_it_belongs(self):
        self.assertEqual(faults_of({
            "core/include/railcast/io/stream.h": "#include <pcap/pcap.h>\n",
        }), ["core/include/railcast/io/stream.h:1: only core/extras/packets and tests include libpcap "
             "(pcap/pcap.h)",
             "core/include/railcast/io/stream.h:1: public headers include the standard library "
             "and Eigen only (pcap/pcap.h)"])

    def test_those_of_io_may_include_pcl_as_well(self):
        self.assertEqual(faults_of({
            "core/include/railcast/io/cloud_files.h":
                "#include <pcl/PCLPointCloud2.h>\n#include <zlib.h>\n",
        }), ["core/include/railcast/io/cloud_files.h:2: public headers include the standard "
             "library and Eigen only (zlib.h)"])

    def test_they_include_no_private_header(self):
        self.assertEqual(faults_of({
            "core/include/railcast/error.h": '#include "core/base/text.h"\n',
            "core/base/text.h": "",
        }), ["core/include/railcast/error.h:1: a public header includes no private one "
             "(core/base/text.h)"])

    def test_each_stands_where_the_folder_stands_that_implements_it(self):
        self.assertEqual(faults_of({
            "core/scan/pattern.cpp": '#include "railcast/lidar.h"\n',
            "core/scene/mesh.cpp": '#include "railcast/lidar.h"\n',
            "core/include/railcast/lidar.h": "",
        }), ["core/scene/mesh.cpp:1: core/scene comes before core/scan and includes nothing of it "
             "(railcast/lidar.h)"])

    def test_a_new_one_needs_a_folder(self):
        self.assertEqual(faults_of({
            "core/include/railcast/turnout.h": '#include "railcast/frame.h"\n',
        }), ["core/include/railcast/turnout.h:1: turnout has no place in the order of core's folders "
             "(railcast/frame.h)"])


class TypeNames(unittest.TestCase):

    def test_no_two_types_have_one_name(self):
        self.assertEqual(faults_of({
            "core/detect/beam/footprint.h": "class Footprint {\n};\n",
            "core/rail/structures/standing_height.h": "\nstruct Footprint {\n};\n",
            "viewer/view.h": "using Footprint = int;\n",
        }), ["core/rail/structures/standing_height.h:2: no two types have one name (Footprint, also "
             "core/detect/beam/footprint.h:1)",
             "viewer/view.h:1: no two types have one name (Footprint, also "
             "core/detect/beam/footprint.h:1)"])

    def test_declarations_nested_types_and_anonymous_namespaces_are_no_second_one(self):
        self.assertEqual(faults_of({
            "core/detect/beam/footprint.h": "class Footprint final : public Beam {\n  struct Part {};\n};\n",
            "core/detect/beam/footprint.cpp": "struct Footprint::Part {\n};\n",
            "core/detect/detector/detector.h": "class Footprint;\n",
            "core/rail/world/rail_world.cpp": "namespace {\nstruct Footprint {\n};\n}  // namespace\n",
        }), [])


class AnonymousNames(unittest.TestCase):

    def test_sources_of_one_library_have_different_ones(self):
        anonymous = "namespace {\nconstexpr double kStep_m = 0.5;\n\nint Count(int n) {\n}\n}  // namespace\n"
        self.assertEqual(faults_of({
            "core/rail/base/a.cpp": anonymous,
            "core/scan/b.cpp": anonymous,
            "core/io/c.cpp": anonymous,
        }), ["core/scan/b.cpp:4: sources of one library give their own functions and constants "
             "different names (Count, also core/rail/base/a.cpp)",
             "core/scan/b.cpp:2: sources of one library give their own functions and constants "
             "different names (kStep_m, also core/rail/base/a.cpp)"])

    def test_a_name_may_be_overloaded_within_a_source(self):
        self.assertEqual(faults_of({
            "core/rail/base/a.cpp": "namespace {\nint Count(int n) {\n}\n\nint Count(bool b) {\n}\n}  // namespace\n",
        }), [])

    def test_types_count_too(self):
        self.assertEqual(faults_of({
            "core/rail/base/a.cpp": "namespace {\nstruct Span {\n};\n}  // namespace\n",
            "core/scan/b.cpp": "namespace {\nclass Span final {\n};\n}  // namespace\n",
        }), ["core/scan/b.cpp:2: sources of one library give their own functions and constants "
             "different names (Span, also core/rail/base/a.cpp)"])

    def test_sources_of_a_test_program_define_nothing_alike(self):
        text = ("namespace {\nconstexpr double kStep_m = 0.5;\n\nint Count(const std::map<int, int>& n, int of = 1) {\n}\n"
                "class Steps : public testing::Test {\n};\nTEST_F(Steps, Rise) {\n}\n}  // namespace\n")
        files = {"tests/core/a_test.cpp": text, "tests/core/sub/b_test.cpp": text, "tests/core/c_test.cpp": text,
                 "tests/core/CMakeLists.txt": "railcast_add_test(a WING core_tests SOURCES a_test.cpp LIBS x)\n"
                                              "railcast_add_test(c_test SOURCES c_test.cpp)\n",
                 "tests/core/sub/CMakeLists.txt": "if(x)\n  railcast_add_test(b WING core_tests\n  SOURCES b_test.cpp)\n"}
        self.assertEqual(faults_of(files), [
            f"tests/core/sub/b_test.cpp:{line}: sources of one test program give what they define different names "
            f"({what}, also tests/core/a_test.cpp)"
            for line, what in ((8, "Steps.Rise"), (2, "kStep_m"), (6, "Steps"), (4, "Count(const std::map<int, int>&, int)"))])

    def test_functions_of_a_test_program_may_be_overloaded(self):
        files = {f"tests/{name}_test.cpp": f"namespace {{\nint Count({name} n) {{\n}}\n}}  // namespace\n"
                 for name in ("int", "bool")}
        files["tests/CMakeLists.txt"] = "railcast_add_test(it SOURCES int_test.cpp bool_test.cpp)\n"
        self.assertEqual(faults_of(files), [])

    def test_a_function_of_a_test_program_is_called_like_no_type(self):
        files = {"tests/a_test.cpp": "namespace {\nint Count() {\n}\n}  // namespace\n",
                 "tests/b_test.cpp": "namespace {\nstruct Count {\n};\n}  // namespace\n"}
        for sources, line in (("a_test.cpp b_test.cpp", "b_test.cpp:2"), ("b_test.cpp a_test.cpp", "a_test.cpp:2")):
            files["tests/CMakeLists.txt"] = f"railcast_add_test(it SOURCES {sources})\n"
            self.assertEqual([fault.partition(": ")[0] for fault in faults_of(files)], [f"tests/{line}"])


class Cycles(unittest.TestCase):

    def test_a_circle_of_includes_is_named_once(self):
        self.assertEqual(faults_of({
            "core/base/a.h": '#include "core/base/b.h"\n',
            "core/base/b.h": '#include "core/base/c.h"\n',
            "core/base/c.h": '\n#include "core/base/a.h"\n',
        }), ["core/base/c.h:2: includes make no circle "
             "(core/base/a.h -> core/base/b.h -> core/base/c.h -> core/base/a.h)"])

    def test_two_ways_to_the_same_header_are_no_circle(self):
        self.assertEqual(faults_of({
            "core/base/a.h": '#include "core/base/b.h"\n#include "core/base/c.h"\n',
            "core/base/b.h": '#include "core/base/d.h"\n',
            "core/base/c.h": '#include "core/base/d.h"\n',
            "core/base/d.h": "",
        }), [])


class Units(unittest.TestCase):

    def names_flagged(self, declaration):
        faults = faults_of({"core/base/a.h": f"#pragma once\n\nstruct A {{\n{declaration}\n}};\n"})
        for fault in faults:
            self.assertTrue(fault.startswith("core/base/a.h:4: a dimensional name ends in its unit"))
        return [fault.rpartition("(")[2][:-1] for fault in faults]

    def test_a_dimensional_name_without_its_unit_is_a_fault(self):
        for declaration, names in {
            "  double range = 3.0;": ["range"],
            "  float max_speed_{};": ["max_speed_"],
            "  double speed_limit() const;": ["speed_limit"],
            "  std::vector<float> ranges;": ["ranges"],
            "  std::optional<std::array<double, 3>> lengths;": ["lengths"],
            "  void Move(int count, const double& distance);": ["distance"],
            "  double height, width_m, angle;": ["height", "angle"],
        }.items():
            with self.subTest(declaration):
                self.assertEqual(self.names_flagged(declaration), names)

    def test_units_and_shares_of_like_are_enough(self):
        for declaration in (
            "  double range_min_m = 0.5;",
            "  double incidence_angle_rad{};",
            "  float rain_rate_mmph_;",
            "  double rain_dropout_rate_exponent = 0.63;",
            "  std::vector<double> heights_m;",
            "  double SpeedLimit_mps(double time_s) const;",
        ):
            with self.subTest(declaration):
                self.assertEqual(self.names_flagged(declaration), [])

    def test_counts_comments_and_other_words_are_left_alone(self):
        for declaration in (
            "  int num_ranges;",
            "  // A double range is two of them.",
            "  double orange = 1.0;",
            "  double reflectivity{};  ///< A double time;",
        ):
            with self.subTest(declaration):
                self.assertEqual(self.names_flagged(declaration), [])


class Fragments(unittest.TestCase):

    def test_a_comment_or_description_does_not_lean_on_the_word_before_it(self):
        self.assertEqual(faults_of({
            "core/scan/a.h": "float a;  ///< Of the beam.\n/// Those of a frame.\nint b;\n"
                             "//  Offset.\nint c;  // As above, in turns.\n",
            "core/scan/b.cpp": 'a.Required("b", s.b, "Of the beam.");\n',
        }), ["core/scan/a.h:1: a comment or description says what it is about (Of the beam.)",
             "core/scan/a.h:2: a comment or description says what it is about (Those of a frame.)",
             "core/scan/a.h:5: a comment or description says what it is about (As above, in turns.)",
             "core/scan/b.cpp:1: a comment or description says what it is about (Of the beam.)"])

    def test_a_line_that_continues_a_comment_may_begin_with_any_word(self):
        self.assertEqual(faults_of({
            "core/scan/a.h": "/// The azimuth\n/// Of a beam.\nint a;\n",
            "core/scan/b.cpp": 'const char* const b = "http://a // Of a page";\nSay("The azimuth "\n    "Of a beam");\n',
            "tests/core/scan/c.cpp": "// Of a beam.\n",
        }), [])


class Sizes(unittest.TestCase):

    def test_five_hundred_lines_are_allowed_and_one_more_is_not(self):
        self.assertEqual(faults_of({
            "core/base/a.cpp": "\n" * 500,
            "core/base/b.cpp": "\n" * 501,
        }), ["core/base/b.cpp:500: a file has at most 500 lines (501)"])


class CommandLine(unittest.TestCase):

    def run_on(self, files):
        out, err = io.StringIO(), io.StringIO()
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(out), \
                contextlib.redirect_stderr(err):
            plant(pathlib.Path(folder), files)
            status = lint_architecture.main(["lint_architecture.py", folder])
        return status, out.getvalue(), err.getvalue()

    def test_long_files_are_listed_longest_first_and_are_no_fault(self):
        self.assertEqual(self.run_on({
            "core/base/a.cpp": "\n" * 301,
            "core/base/b.cpp": "\n" * 400,
            "core/base/c.cpp": "\n" * 300,
        }), (0, "long: core/base/b.cpp: 400 lines\nlong: core/base/a.cpp: 301 lines\n", ""))

    def test_a_source_that_a_list_names_exists(self):
        self.assertEqual(faults_of({
            "core/a.cpp": "",
            "tests/fuzz/CMakeLists.txt": "set(tried\n ${PROJECT_SOURCE_DIR}/core/a.cpp\n ${PROJECT_SOURCE_DIR}/core/b.cpp)\n",
        }), ["tests/fuzz/CMakeLists.txt:3: a source that is listed exists (core/b.cpp)"])

    def test_faults_go_to_standard_error_and_fail(self):
        self.assertEqual(self.run_on({"core/base/a.h": "double time;\n"}), (
            1, "", "core/base/a.h:1: a dimensional name ends in its unit (time)\n"))


if __name__ == "__main__":
    unittest.main()
