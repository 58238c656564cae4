"""Builds the wheel of the Python module and of the programs for pip (PEP 517), with CMake and patchelf.

It needs no packages of the Python registry, so that pip's isolated build works without a network.

    pip wheel .                                               configures and builds build/python
    pip wheel . --config-settings build-dir=build/release     takes what that build has

The wheel runs on other systems of the same machine and version of Python: its libraries are inside.
"""

import base64
import contextlib
import hashlib
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile

import wheel_libraries

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = ("railcast-generate", "railcast-analyze")
RUN_BY_PROGRAMS = ("railcast-recordings",)  # Found beside them.
# The scenarios are installed with the product's programs, manual pages with all; those with all extras are in the wheel.
TARGETS = ("railcast_python", *PROGRAMS, *(f"{name}-product" for name in PROGRAMS), "railcast_manuals")
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


def run_with_progress(*command, terminal="/dev/tty"):
    """Runs Ninja and shows on the user's terminal, if there is one, how far it is: pip hides what a backend prints."""
    shown = -1
    with subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE, text=True) as ninja:
        for line in ninja.stdout:
            print(line, end="", flush=True)
            step = re.match(r"\[(\d+)/(\d+)\]", line)
            percent = 100 * int(step[1]) // int(step[2]) if step else shown
            if percent // 5 > shown // 5:
                shown = percent
                with contextlib.suppress(OSError), open(terminal, "a", encoding="utf-8") as screen:
                    screen.write(f"\nrailcast: {percent} % compiled, of some 20 minutes on 2 cores")
    if ninja.returncode != 0:
        raise subprocess.CalledProcessError(ninja.returncode, command)


def build():
    """Builds module and programs; returns the build's folder."""
    folder = ROOT / "build" / "python"
    settings = [f"-D{name}={value}" for name, value in CONFIGURATION.items()]
    run("cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", *settings)
    run_with_progress("cmake", "--build", folder, "--target", *TARGETS)
    return folder


def project():
    """Table `project` of pyproject.toml, with the version that CMake has."""
    table = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    text = (ROOT / "CMakeLists.txt").read_text("utf-8")
    version = re.search(r"project\(railcast VERSION (\S+)", text)[1]
    # PEP 440 writes 1.0.0-rc.1 as 1.0.0rc1.
    version += re.search(r'set\(RAILCAST_PRERELEASE "(.*)"\)', text)[1].replace("-rc.", "rc")
    return {**table, "version": version}


def tag(binaries):
    """The oldest systems that the wheel runs on (PEP 600)."""
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    system = re.sub("[-.]", "_", sysconfig.get_platform())
    if system.startswith("linux_") and platform.libc_ver()[0] == "glibc":
        major, minor = wheel_libraries.least_libc(binaries)
        system = system.replace("linux_", f"manylinux_{major}_{minor}_", 1)
    return f"{python}-{python}-{system}"


def description_files(table, wheel_tag):
    """The files of the wheel that describe it, without its record."""
    metadata = ["Metadata-Version: 2.1", f"Name: {table['name']}", f"Version: {table['version']}",
                f"Summary: {table['description']}", f"License: {table['license']['text']}",
                f"Requires-Python: {table['requires-python']}",
                *(f"Requires-Dist: {name}" for name in table["dependencies"])]
    wheel = ["Wheel-Version: 1.0", "Generator: railcast", "Root-Is-Purelib: false", f"Tag: {wheel_tag}"]
    scripts = ["[console_scripts]", *(f"{name} = railcast.programs:{name.split('-')[1]}" for name in PROGRAMS)]
    return {"METADATA": metadata, "WHEEL": wheel, "entry_points.txt": scripts}


def write_wheel(path, tree):
    """Packs the files of a folder, with a record of them."""
    info, = (folder.name for folder in tree.glob("*.dist-info"))
    record = []
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as wheel:
        for file in sorted(entry for entry in tree.rglob("*") if entry.is_file()):
            name, content = file.relative_to(tree).as_posix(), file.read_bytes()
            # A fixed time, so that the same files make the same wheel.
            entry = zipfile.ZipInfo(name)
            entry.external_attr = (0o100755 if file.stat().st_mode & 0o100 else 0o100644) << 16
            wheel.writestr(entry, content, zipfile.ZIP_DEFLATED)
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            record.append(f"{name},sha256={digest},{len(content)}\n")
        wheel.writestr(zipfile.ZipInfo(f"{info}/RECORD"), "".join(record) + f"{info}/RECORD,,\n")


def gather(build_folder, tree):
    """Copies what is in the wheel to `tree`; returns its programs and libraries, and the licences of the latter."""
    prefix = tree / "prefix"
    for component in ("python", "programs", "extras"):
        run("cmake", "--install", build_folder, "--component", component, "--prefix", prefix)
    init, = prefix.rglob("railcast/__init__.py")
    package = tree / "railcast"
    shutil.move(init.parent, package)
    shutil.copy(ROOT / "generator" / "python" / "programs.py", package)
    shutil.move(prefix / "share" / "railcast" / "scenarios", package / "scenarios")
    (package / "bin").mkdir()
    binaries = list(package.glob("*.so"))
    for name in (*PROGRAMS, *RUN_BY_PROGRAMS):
        binaries.append(pathlib.Path(shutil.move(prefix / "libexec" / "railcast" / name, package / "bin" / name)))
    shutil.rmtree(prefix)
    libraries = tree / "railcast.libs"
    licences = wheel_libraries.bundle(binaries, libraries)
    return [*binaries, *libraries.iterdir()], licences


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Called by pip."""
    del metadata_directory
    for tool in ("patchelf", "strip", "readelf"):
        if not shutil.which(tool):
            raise FileNotFoundError(f"{tool} is needed to make a wheel (Debian: patchelf, binutils)")
    folder = (config_settings or {}).get("build-dir") or build()
    table = project()
    with tempfile.TemporaryDirectory() as name:
        tree = pathlib.Path(name)
        binaries, licences = gather(folder, tree)
        wheel_tag = tag(binaries)
        stem = f"{re.sub('[-_.]+', '_', table['name'])}-{table['version']}"
        info = tree / f"{stem}.dist-info"
        (info / "licenses").mkdir(parents=True)
        for file, lines in description_files(table, wheel_tag).items():
            (info / file).write_text("\n".join(lines) + "\n", "utf-8")
        shutil.copy(ROOT / "scripts" / "packaging" / "copyright", info / "licenses" / "railcast")
        for library, licence in licences.items():
            if licence:
                shutil.copy(licence, info / "licenses" / library)
        wheel = f"{stem}-{wheel_tag}.whl"
        write_wheel(pathlib.Path(wheel_directory) / wheel, tree)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    """Called by tools that publish; the sources are in git."""
    del sdist_directory, config_settings
    raise NotImplementedError("railcast has no source distribution; use a clone of its repository")
