"""Puts the shared libraries that a wheel needs into it, with names of their own, as auditwheel does.

Programs of a wheel find the libraries beside them, on any system with a C library that is no older than the one that
they were linked with. The names are changed because a process has one library of each name: another module's libtbb
must not be taken for ours. Needs ldd, readelf, strip (binutils) and patchelf.
"""

import hashlib
import pathlib
import re
import shutil
import subprocess

# Every system that the tag manylinux allows has these (PEP 600).
OF_THE_SYSTEM = re.compile(r"(linux-vdso|ld-linux[-\w]*|libc|libm|libdl|librt|libpthread|libresolv|libgcc_s|libstdc\+\+)"
                           r"\.so")


def run(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def needed_by(file):
    """{name: path} of all libraries that are loaded with a file, but for the system's."""
    found = {}
    for line in run("ldd", file).splitlines():
        name, _, place = line.strip().partition(" => ")
        if not place or OF_THE_SYSTEM.match(name):
            continue
        if not place.startswith("/"):
            raise FileNotFoundError(f"{file}: {name} is not installed")
        found[name] = pathlib.Path(place.split(" (")[0])
    return found


def direct_needs(file):
    return re.findall(r"\(NEEDED\)\s+Shared library: \[(.+)\]", run("readelf", "-d", file))


def own_name(path):
    """libtbb.so.12 with a part of its digest: libtbb-0a1b2c3d.so.12."""
    digest = hashlib.sha256(path.read_bytes()).hexdigest()[:8]
    stem, suffix = path.name.split(".so", 1)
    return f"{stem}-{digest}.so{suffix}"


def rename_needs(file, names, folder):
    """Makes a program or library load those of `folder`, by their own names."""
    renamed = [word for need in direct_needs(file) if need in names
               for word in ("--replace-needed", need, names[need].name)]
    up = "/".join([".."] * (len(file.parent.relative_to(folder.parent).parts)) or ["."])
    origin = "$ORIGIN" if file.parent == folder else f"$ORIGIN/{up}/{folder.name}"
    # In two steps: patchelf 0.14 mixes the operations up.
    if renamed:
        run("patchelf", *renamed, file)
    run("patchelf", "--set-rpath", origin, file)


def licence_of(path):
    """The file of copyright of the Debian package that a library is of; None elsewhere."""
    if not shutil.which("dpkg-query"):
        return None
    for place in (path, path.resolve()):
        for name in (str(place), str(place).removeprefix("/usr")):
            said = subprocess.run(["dpkg-query", "-S", name], check=False, capture_output=True, text=True).stdout
            if said:
                return pathlib.Path("/usr/share/doc") / said.split(":")[0] / "copyright"
    return None


def bundle(files, folder):
    """Copies what `files` load to `folder`, which is beside the package, and makes them load the copies.

    Returns {name in the wheel: file of copyright} of the libraries.
    """
    libraries = {}
    for file in files:
        libraries.update(needed_by(file))
    folder.mkdir()
    names, licences = {}, {}
    for name, path in sorted(libraries.items()):
        names[name] = folder / own_name(path)
        shutil.copy(path.resolve(), names[name])
        licences[names[name].name] = licence_of(path)
    for file in [*files, *names.values()]:
        file.chmod(0o755)
        run("strip", "--strip-unneeded", file)
        rename_needs(file, names, folder)
    for copy in names.values():
        run("patchelf", "--set-soname", copy.name, copy)
    return licences


def least_libc(files):
    """(2, 35) where the newest function of the C library that the files call is of version 2.35."""
    versions = {tuple(map(int, version.split(".")))
                for file in files for version in re.findall(r"Name: GLIBC_(\d+\.\d+)", run("readelf", "-V", file))}
    return max(versions)
