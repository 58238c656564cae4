"""Builds the wheel of the Python module for pip (PEP 517), with nothing but CMake and this file.

It needs no packages of the Python registry, so that pip's isolated build works without a network.

    pip install .                                               configures and builds build/python
    pip install . --config-settings build-dir=build/release     takes the module of that build
"""

import base64
import hashlib
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
CONFIGURATION = {
    "CMAKE_BUILD_TYPE": "Release",
    "CMAKE_UNITY_BUILD": "ON",
    "Python_EXECUTABLE": sys.executable,
    "RAILCAST_BUILD_PYTHON": "ON",
    "RAILCAST_BUILD_IMPORT": "OFF",
    "RAILCAST_BUILD_VIEWER": "OFF",
    "RAILCAST_BUILD_TESTS": "OFF",
    "RAILCAST_BUILD_BENCHMARKS": "OFF",
}


def run(*command):
    subprocess.run([str(word) for word in command], check=True)


def build():
    """Builds the module; returns the build's folder."""
    folder = ROOT / "build" / "python"
    settings = [f"-D{name}={value}" for name, value in CONFIGURATION.items()]
    run("cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", *settings)
    run("cmake", "--build", folder, "--target", "railcast_python")
    return folder


def project():
    """Table `project` of pyproject.toml, with the version that CMake has."""
    table = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    version = re.search(r"project\(railcast VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text("utf-8"))[1]
    return {**table, "version": version}


def tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def description_files(table):
    """The files of the wheel that describe it, without its record."""
    metadata = ["Metadata-Version: 2.1", f"Name: {table['name']}", f"Version: {table['version']}",
                f"Summary: {table['description']}", f"License: {table['license']['text']}",
                f"Requires-Python: {table['requires-python']}",
                *(f"Requires-Dist: {name}" for name in table["dependencies"])]
    wheel = ["Wheel-Version: 1.0", "Generator: railcast", "Root-Is-Purelib: false", f"Tag: {tag()}"]
    return {"METADATA": "\n".join(metadata) + "\n", "WHEEL": "\n".join(wheel) + "\n"}


def write_wheel(path, package, table):
    info = f"{table['name']}-{table['version']}.dist-info"
    record = []
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as wheel:

        def add(name, content):
            # A fixed time, so that the same files make the same wheel.
            entry = zipfile.ZipInfo(name)
            entry.external_attr = 0o644 << 16
            wheel.writestr(entry, content, zipfile.ZIP_DEFLATED)
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            record.append(f"{name},sha256={digest},{len(content)}\n")

        for file in sorted(package.iterdir()):
            add(f"{package.name}/{file.name}", file.read_bytes())
        for name, text in description_files(table).items():
            add(f"{info}/{name}", text.encode())
        wheel.writestr(zipfile.ZipInfo(f"{info}/RECORD"), "".join(record) + f"{info}/RECORD,,\n")


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Called by pip."""
    del metadata_directory
    folder = (config_settings or {}).get("build-dir") or build()
    table = project()
    name = f"{table['name']}-{table['version']}-{tag()}.whl"
    with tempfile.TemporaryDirectory() as prefix:
        run("cmake", "--install", folder, "--component", "python", "--prefix", prefix)
        init, = pathlib.Path(prefix).rglob("railcast/__init__.py")
        write_wheel(pathlib.Path(wheel_directory) / name, init.parent, table)
    return name


def build_sdist(sdist_directory, config_settings=None):
    """Called by tools that publish; the sources are in git."""
    del sdist_directory, config_settings
    raise NotImplementedError("railcast has no source distribution; use a clone of its repository")
