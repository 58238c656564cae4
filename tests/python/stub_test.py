"""The stub lists what the module has, and every part of it has a docstring."""

import ast
import pathlib
import unittest

import support  # noqa: F401  Skips where numpy is missing.

import railcast
from railcast import _railcast

STUB = pathlib.Path(_railcast.__file__).parent / "_railcast.pyi"
# Written by the language rather than by us.
INHERITED = {"__doc__", "__init__", "__module__", "__new__", "__repr__"}


def own_names(thing):
    return {name for name in vars(thing) if not name.startswith("_") or name in ("__getitem__", "__contains__",
                                                                                "__len__", "__iter__")}


class Stub(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.stub = ast.parse(STUB.read_text("utf-8"))
        cls.classes = {node.name: node for node in cls.stub.body if isinstance(node, ast.ClassDef)}

    def test_names_are_those_of_the_module(self):
        public = {name for name in vars(_railcast) if not name.startswith("_")} | {"__version__"}
        named = set(self.classes)
        named |= {node.name for node in self.stub.body if isinstance(node, ast.FunctionDef)}
        named |= {node.target.id for node in self.stub.body if isinstance(node, ast.AnnAssign)}
        self.assertEqual(named, public)
        self.assertEqual(set(railcast.__all__), public | {"Dataset", "SCENARIOS"})

    def test_members_are_those_of_the_classes(self):
        for name, node in self.classes.items():
            members = {item.name for item in node.body if isinstance(item, ast.FunctionDef)} - INHERITED
            if name != "InputError":
                self.assertEqual(members, own_names(getattr(_railcast, name)), name)

    def test_parameters_are_those_of_the_functions(self):
        for owner, name in (("Simulator", "scan"), ("Simulator", "apply"), ("Frame", "points"), ("Frame", "sensor_from_box")):
            method, = (item for item in self.classes[owner].body if getattr(item, "name", "") == name)
            signature = getattr(getattr(_railcast, owner), name).__doc__.split("\n")[0]
            arguments = [argument.arg for argument in (*method.args.args, *method.args.kwonlyargs)]
            for argument in arguments:
                self.assertRegex(signature, rf"\b{argument}: ")

    def test_everything_has_a_docstring(self):
        self.assertTrue(railcast.open.__doc__ and railcast.InputError.__doc__)
        for name in set(self.classes) - {"InputError"}:
            owner = getattr(_railcast, name)
            self.assertTrue(owner.__doc__, name)
            for member in own_names(owner) - {"__len__", "__iter__", "__contains__"}:
                self.assertTrue(getattr(owner, member).__doc__, f"{name}.{member}")

    def test_the_package_says_that_it_has_types(self):
        self.assertTrue((STUB.parent / "py.typed").exists())


if __name__ == "__main__":
    unittest.main()
