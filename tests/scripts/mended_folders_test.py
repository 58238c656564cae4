"""Whether nobody loses a frame: mended_folders_test.py BUILD_DIR [--all] [KIND...].

Each command that makes a folder of numbered items makes a small one. Of the folder, a file of each kind is removed, cut, or
changed by a byte, or an unfinished file is left beside it: one of these damages, each in its turn and two at once, or with
--all each alone; a run is killed several times; and its disk is full. The same command must then make the folder again, with the same bytes. A
folder of another run and one with a file of others are refused in one line, and nothing in them is changed. So is one in
which a link stands in place of a file or a folder of any kind, by the command (a file or two and a folder; with --all each)
and by verify: what the link leads to stays as it is.
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "dev"))
import small_runs  # noqa: E402 (found through the line above)

# Reports say when they were made.
ENVIRONMENT = {**os.environ, "SOURCE_DATE_EPOCH": "0"}
# Runs that make what others take.
INPUTS = ("generate sequence coarse.json --frames 4 --out drive",
          "generate sequence rig.json --frames 3 --format kitti --out kitti_drive",
          "generate sequence rig.json --frames 3 --format mcap --out bag_drive",
          "generate stream sensor_vlp16.json --protocol vlp16 --duration 0.3 --pcap vlp16.pcap",
          "generate dataset recipe_small.json --shard 1/2 --out shard_1",
          "generate dataset recipe_small.json --shard 2/2 --out shard_2")
# By name: the command that makes the folder and mends it, and the files that say whose it is: without them, or with others,
# it is another's.
KINDS = {
    "pcd": ("generate sequence rig.json --frames 4 --out out", ("run.json",)),
    "kitti": ("generate sequence rig.json --frames 4 --format kitti --out out", ("run.json",)),
    "objects": ("generate sequence rig.json --frames 4 --format objects --out out", ("run.json",)),
    "mcap": ("generate sequence rig.json --frames 4 --format mcap --out out", ("run.json",)),
    "rosbag2": ("generate sequence rig.json --frames 4 --format rosbag2 --out out", ("run.json",)),
    "osi": ("generate sequence coarse.json --frames 4 --format osi --out out", ("run.json",)),
    "osi_mcap": ("generate sequence coarse.json --frames 4 --format osi-mcap --out out", ("run.json",)),
    "sensors": ("generate sequence two.json --frames 4 --merged --out out", ("front/run.json", "roof/run.json")),
    "sensors_mcap": ("generate sequence two.json --frames 4 --format mcap --out out", ("front/run.json", "roof/run.json")),
    "into_sequence": ("generate insert drive plan_coarse.json --out out", ("run.json",)),
    "into_kitti": ("generate insert kitti_drive plan_rig.json --out out", ("run.json",)),
    "into_capture": ("generate insert vlp16.pcap plan_standing.json --out out", ("run.json",)),
    "into_bag": ("generate insert bag_drive/frames.mcap plan_rig.json --out out", ("run.json",)),
    "converted": ("generate convert drive out --format ply", ("run.json",)),
    "converted_clouds": ("generate convert vlp16.pcap out --format pcd", ("run.json",)),
    "converted_mcap": ("generate convert drive out --format mcap", ("run.json",)),
    "converted_rosbag2": ("generate convert kitti_drive out --format rosbag2", ("run.json",)),
    "dataset": ("generate dataset recipe_small.json --out out", ("dataset.json",)),
    "shard": ("generate dataset recipe_small.json --shard 2/2 --out out", ("dataset.json",)),
    "merged": ("generate merge shard_1 shard_2 --out out", ("dataset.json",)),
    "dataset_mcap": ("generate dataset recipe_small.json --format mcap --out out", ("dataset.json",)),
    "dataset_of_sensors": ("generate dataset recipe_two.json --merged --out out", ("dataset.json",)),
    "dataset_of_plans": ("generate dataset recipe_plans.json --out out", ("dataset.json",)),
    "study": ("analyze study study.json --out out", ("study.json",)),
}
# Most of a run's time goes into the world around the vehicle, so that the line is short.
SHORT = {"world": {**small_runs.DRIVE["world"], "objects": [{**small_runs.PERSON, "s_m": 70}], "alignment": {
             "course": {"type": "elements", "elements": [{"type": "straight", "length_m": 90}]}}},
         "vehicle": {**small_runs.DRIVE["vehicle"], "start_s_m": 10}}
SCENARIOS = {
    **{name: small_runs.INPUTS[name] | SHORT for name in ("coarse.json", "rig.json", "two.json")},
    "recipe_small.json": {**small_runs.INPUTS["recipe.json"], "num_scenarios": 3, "num_frames": 2},
    "recipe_plans.json": {"version": 1, "seed": 5, "num_scenarios": 2, "num_frames": 2,
                          "bases": [{"file": "plan_coarse.json", "recordings": ["drive"]}],
                          "objects": [{"name": "box", "count": {"type": "choice", "values": [1]},
                                       "object": {"type": "box", "size_m": [1, 1, 1], "h_m": 0},
                                       "ahead_m": {"type": "uniform", "min": 15, "max": 30}}]},
    "plan_coarse.json": {**small_runs.PLAN, "lidar": small_runs.COARSE["lidar"]},
}


class Folder:
    """Trials with one kind of folder, each of which has a place of its own beside links to all inputs."""

    def __init__(self, kind, build, inputs):
        self.kind, self.build, self.inputs = kind, build, inputs
        self.command, self.owners = KINDS[kind]

    def place(self, name):
        place = self.inputs.parent / f"{self.kind}_{name}"
        place.mkdir()
        for file in self.inputs.iterdir():
            (place / file.name).symlink_to(file)
        return place / "out"

    def words(self, text=None):
        program, *words = (text or self.command).split()
        program = f"railcast-{program}"
        return [str(self.build / small_runs.PROGRAMS[program] / program), *words]

    def run(self, out, text=None):
        return subprocess.run(self.words(text), cwd=out.parent, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              check=False, env=ENVIRONMENT)


def hashes_of(folder):
    """Of all files but those that say how long something took, and databases, whose bytes change as they are opened."""
    return {str(file.relative_to(folder)): hashlib.sha256(file.read_bytes()).hexdigest()
            for file in sorted(folder.rglob("*"))
            if file.is_file() and not file.name.startswith("report.") and file.suffix != ".db3"}


def one_of_each(names):
    """Of the files whose names differ by their numbers, the one in the middle."""
    alike = {}
    for name in names:
        alike.setdefault(re.sub(r"\d+", "#", name), []).append(name)
    return [group[len(group) // 2] for group in alike.values()]


def remove(file):
    file.unlink()


def remove_folder(folder):
    shutil.rmtree(folder)


def cut(file):
    os.truncate(file, file.stat().st_size // 2)


def change(file):
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    file.write_bytes(data)


def leave_unfinished(file):
    file.with_name(file.name + ".part").write_bytes(file.read_bytes()[:100])


DAMAGES = (remove, cut, change, leave_unfinished)


def differences(found, wanted):
    names = [f"+{name}" for name in found.keys() - wanted.keys()] + [f"-{name}" for name in wanted.keys() - found.keys()]
    return names + [name for name in wanted.keys() & found.keys() if wanted[name] != found[name]]


def refusal_fault(folder, ended, target, before):
    """What is wrong with the refusal of a folder; None if it is one line and nothing was changed."""
    lines = ended.stderr.strip().splitlines()
    if ended.returncode != 1 or len(lines) != 1:
        return f"exit status {ended.returncode}, {len(lines)} lines: {lines[:2]}"
    changed = differences(hashes_of(target), before)
    return f"refused, but changed {changed}" if changed else None


def mended_fault(folder, target, wanted):
    """What is wrong with the folder after its command has run; None if it is as it was made."""
    ended = folder.run(target)
    if ended.returncode != 0:
        return f"exit status {ended.returncode}: {(ended.stderr.strip().splitlines() or ['nothing'])[-1]}"
    wrong = differences(hashes_of(target), wanted)
    return f"left {wrong}" if wrong else None


def copy_of(whole, target):
    shutil.copytree(whole, target, copy_function=shutil.copyfile, symlinks=True)


def try_damages(folder, whole, wanted, damages):
    """Does each of the damages, (what is done, to which file or folder), and runs the command once."""
    words = ", ".join(f"{damage.__name__} {name}" for damage, name in damages)
    target = folder.place(words.replace("/", "_"))
    copy_of(whole, target)
    for damage, name in damages:
        damage(target / name)
    if any(is_anothers(folder, damage, name) for damage, name in damages):
        before = hashes_of(target)
        said = refusal_fault(folder, folder.run(target), target, before)
    else:
        said = mended_fault(folder, target, wanted)
    shutil.rmtree(target.parent)
    return said and f"{folder.kind}: {words}: {said}"


def is_anothers(folder, damage, name):
    """Whether the damage makes the folder another's."""
    return name in folder.owners and damage is not leave_unfinished


def in_twos(folder, damages):
    """The damages of which two are mended at once; what makes the folder another's stands alone."""
    alone = [[damage] for damage in damages if is_anothers(folder, *damage)]
    others = [damage for damage in damages if not is_anothers(folder, *damage)]
    half = (len(others) + 1) // 2
    return alone + [others[i::half] for i in range(half)]


def try_stranger(folder, whole, within):
    target = folder.place(f"stranger_{within.replace('/', '_')}")
    copy_of(whole, target)
    (target / within / "notes.txt").write_text("mine")
    before = hashes_of(target)
    said = refusal_fault(folder, folder.run(target), target, before)
    shutil.rmtree(target.parent)
    return said and f"{folder.kind}: a stranger in {within}: {said}"


def all_of(path):
    """The bytes of a file, or of all files of a folder; nothing where there is none."""
    return {file: file.read_bytes() for file in (path, *path.rglob("*")) if file.is_file() and not file.is_symlink()}


def link_fault(folder, target, name, elsewhere, text=None):
    """What is wrong with what a command says of a folder in which `name` is a link; None if it refuses the link."""
    before = all_of(target), all_of(elsewhere)
    ended = folder.run(target, text)
    lines = (ended.stdout + ended.stderr if text else ended.stderr).strip().splitlines()
    if ended.returncode != 1 or len(lines) != 1 or name not in lines[0] or "symbolic link" not in lines[0]:
        return f"exit status {ended.returncode}, {len(lines)} lines: {lines[:2]}"
    return None if (all_of(target), all_of(elsewhere)) == before else "refused, but changed"


def try_links(folder, whole, turn, has_all):
    """Puts a link in place of each kind of file and folder: to what was there or, of every second one, to nothing."""
    target, faults = folder.place("links"), []
    copy_of(whole, target)
    files = one_of_each(sorted(str(file.relative_to(whole)) for file in whole.rglob("*") if file.is_file()))
    folders = one_of_each(sorted(str(file.relative_to(whole)) for file in whole.rglob("*") if file.is_dir()))
    tried = {files[turn % len(files)], files[(3 * turn + 1) % len(files)], *(folders[turn % len(folders):][:1] if folders else [])}
    for i, name in enumerate(files + folders):
        kept = target.parent / "kept"
        (target / name).rename(kept)
        elsewhere = target.parent / ("nothing" if (i + turn) % 2 else "kept")
        (target / name).symlink_to(elsewhere)
        for text in ("analyze verify out", None) if has_all or name in tried else ("analyze verify out",):
            said = link_fault(folder, target, name, elsewhere, text)
            faults += [f"{folder.kind}: {text or folder.command}: a link {name}: {said}"] if said else []
        (target / name).unlink()
        kept.rename(target / name)
    shutil.rmtree(target.parent)
    return "\n".join(faults)


def try_kills(folder, wanted, duration_s, num=4):
    target = folder.place("killed")
    moments = random.Random(folder.kind)
    for _ in range(num):
        run = subprocess.Popen(folder.words(), cwd=target.parent, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               env=ENVIRONMENT)
        time.sleep(moments.uniform(0.0, duration_s))
        run.kill()
        run.wait()
    said = mended_fault(folder, target, wanted)
    shutil.rmtree(target.parent)
    return said and f"{folder.kind}: killed: {said}"


def try_full_disk(folder, wanted, num_bytes, shares):
    """Runs the command on disks with these shares of the room that the folder takes, then on the same with enough."""
    for share in shares:
        target = folder.place(f"full_{share}")
        target.mkdir()
        script = ('mount -t tmpfs -o size="$1" none out || exit; shift; "$@" >/dev/null 2>said; status=$?\n'
                  'mount -o remount,size=1g none out; "$@" >/dev/null 2>again; echo $status $?; cp -r out copy')
        size = str(int(num_bytes * share) // 4096 * 4096 + 4096)
        ended = subprocess.run(["unshare", "-rm", "sh", "-c", script, "sh", size, *folder.words()],
                               cwd=target.parent, text=True, capture_output=True, check=False, env=ENVIRONMENT)
        if not ended.stdout:
            return None  # The system does not allow mounts.
        first, again = ended.stdout.split()
        said = (target.parent / "said").read_text().strip().splitlines()
        wrong = differences(hashes_of(target.parent / "copy"), wanted)
        shutil.rmtree(target.parent)
        if first != "1" or len(said) != 1 or not re.search("no space left|disk is full", said[0], re.IGNORECASE):
            return f"{folder.kind}: a full disk ({share}): exit status {first}: {said}"
        if again != "0" or wrong:
            return f"{folder.kind}: after a full disk ({share}): exit status {again}, left {wrong}"
    return None


def check(folder, turn, pool, has_all):
    """The trials with one kind of folder. Which damages and disks these are without `has_all` depends on the turn, so that
    all are tried on one kind of folder or another."""
    whole = folder.place("whole")
    began = time.monotonic()
    ended = folder.run(whole)
    duration_s = time.monotonic() - began
    if ended.returncode != 0:
        raise RuntimeError(f"{folder.kind}: {ended.stderr}")
    wanted = hashes_of(whole)
    # What is whole stays.
    said = mended_fault(folder, whole, wanted)
    if said:
        raise RuntimeError(f"{folder.kind}: run again: {said}")
    named = [name for name in one_of_each(wanted) if (whole / name).stat().st_size > 0]
    damages = [(damage, name) for i, name in enumerate(named, turn)
               for damage in (DAMAGES if has_all else [DAMAGES[i % len(DAMAGES)]])]
    trials = [[damage] for damage in damages] if has_all else in_twos(folder, damages)
    folders = {str(parent) for name in wanted for parent in pathlib.PurePath(name).parents} - {"."}
    trials += [[(remove_folder, name)] for name in one_of_each(sorted(folders))]
    results = [pool.submit(try_damages, folder, whole, wanted, trial) for trial in trials]
    num_bytes = sum((whole / name).stat().st_size for name in wanted)
    shares = (0.2, 0.5, 0.8)
    results.append(pool.submit(try_full_disk, folder, wanted, num_bytes, shares if has_all else [shares[turn % 3]]))
    results += [pool.submit(try_stranger, folder, whole, name) for name in (".", *one_of_each(sorted(folders)))]
    results.append(pool.submit(try_links, folder, whole, turn, has_all))
    results.append(pool.submit(try_kills, folder, wanted, duration_s))
    return results


def main(build, kinds, has_all):
    with tempfile.TemporaryDirectory() as temporary:
        inputs = pathlib.Path(temporary).resolve() / "inputs"
        inputs.mkdir()
        small_runs.make_inputs(build, inputs)
        for name, content in SCENARIOS.items():
            (inputs / name).write_text(json.dumps(content))
        for text in INPUTS:
            subprocess.run(Folder("pcd", build, inputs).words(text), cwd=inputs, check=True, capture_output=True)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            results = [result for turn, kind in enumerate(kinds or KINDS)
                       for result in check(Folder(kind, build, inputs), turn, pool, has_all)]
            faults = [fault for fault in (result.result() for result in results) if fault]
    print("\n".join(faults + [f"{len(results)} trials, {len(faults)} faults"]))
    return 1 if faults else 0


if __name__ == "__main__":
    words = [word for word in sys.argv[2:] if word != "--all"]
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), words, "--all" in sys.argv))
