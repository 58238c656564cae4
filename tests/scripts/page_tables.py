"""What page_commands_test.py takes for what the pages name, and what it does not run for which reason."""

# Pages whose commands another test runs.
RUN_ELSEWHERE = {
    "docs/tutorial.md": "Tutorial.RunsAsWritten",
    "docs/tutorial_insert.md": "TutorialOfInsertions.RunsAsWritten",
    "docs/analysis.md": "EveryCommand, as rows of small_runs.py"}

# What the readers' shells have besides railcast.
SHELL_TOOLS = ("bash", "cat", "cp", "head", "mkdir", "protoc", "python3", "rm", "sed", "seq", "sleep", "wc", "env")

# What is not run, wherever it stands: it succeeds and does nothing.
OTHERS = {
    "needs root, or changes the machine": ("apt", "sudo", "systemctl", "man"),
    "builds, which other tests do": (
        "cmake", "cc", "pip", "scripts/build.sh", "scripts/demo.sh", "scripts/test.sh", "build/examples/simulate_frame_cpp"),
    "not in Debian, or not a package of the tests": (
        "ros2", "rviz2", "ffmpeg", "podman", "pcl_vlp_viewer", "pcl_hdl_viewer_simple", "tshark", "curl", "visualize.py",
        "examples/brake_node.py"),
    "takes hours, an idle machine or a cluster": (
        "scripts/reproduce_paper.sh", "scripts/cluster/submit.sh", "scripts/dev/measure_detection.py",
        "scripts/dev/measure_textures.py",
        "scripts/dev/measure_results.py", "scripts/dev/effects_table.py"),
}

HAS_ITS_ROW = "takes seconds, and has its row in small_runs.py"
INSTALLS = "installs, as tests/python/wheel_test.py does"
# Lines that are not run, by the page and how they begin. Of synopses the options are looked for all the same.
LEFT_OUT = {
    "docs/dossier.md": {"railcast-analyze dossier": HAS_ITS_ROW},
    "docs/evaluate.md": {
        "examples/collect_detections.py [ADDRESS]": "ends with a fault where nothing comes; runs below, with a sender"},
    "docs/fit.md": {"railcast-analyze fit SOURCE... --scenario": HAS_ITS_ROW},
    "docs/frontier.md": {"build/release/analysis/railcast-analyze frontier": HAS_ITS_ROW},
    "docs/insert.md": {
        "railcast-generate replay run.mcap --protocol packets": "railcast writes no bag of packets to replay"},
    "docs/install.md": {"python3 -m venv env": INSTALLS, "env/bin/pip": INSTALLS},
    "docs/osdar.md": {
        "scripts/export_osdar.py": "needs the operator's definitions; tests/python/osdar_test.py runs it",
        "scripts/check_osdar.py": "the same"},
    "docs/python.md": {"python3 -m venv --system": INSTALLS, "env/bin/pip": INSTALLS},
    "docs/results/published.md": {
        "build/release/tests/bench/railcast-measure settings": "makes images of 1920 x 1080 pixels"},
    "docs/service.md": {
        "mkdir -p /etc": "writes to /etc", "cp my_scenario.json /etc": "the same", "echo 'RAILCAST_OPT": "the same"},
}

# Words of railcast's command lines, and what takes their place, in turn; @N is a number that was not used before.
WORDS = (
    (r"(--out|--pcap|--resolved|--commands-log|--summary|--http) (DIR|FOLDER|FILE|LOG)\b", r"\1 made_@N"),
    (r"--commands LOG\b", "--commands live/brakes.jsonl"),
    (r"\bDIR\|FILE\|udp://HOST:PORT\b", "drive"),
    (r"\bSCENARIO\.json --screenshot FILE\.png", "drive.json --screenshot plan.png"),
    (r"\bSCENARIO\b", "drive.json"),
    (r"(?<=preset )\s*(SOURCE|CAPTURE) --scenario drive\.json", "standing.pcap --scenario standing.json"),
    (r"(?<=fit )\s*SOURCE\b", "again"),
    (r"\bPLAN\.json\b", "plan.json"),
    (r"\b(DIR|SOURCE|RECORDING|RUN)\b", "drive"),
    (r"\bMAP\b", "map.geojson"),
    (r"\bRECIPE\b", "recipe.json"),
    (r"\bA B\b", "again again"),
    (r"--commands-port P\b", "--commands-port 27401"),
    (r"/lidar/points\b", "/raster/points"),
    (r"--interface eth0\b", ""),
    (r"/usr/share/railcast/", ""),
    (r"drive\.json --protocol (?!ros2|railcast)(\S+)", r"sensor_\1.json --protocol \1"),
    (r"--to 255\.255\.255\.255", "--to 127.0.0.1"),
    (r"--from-s 2200 --to-s 2400", "--from-s 100 --to-s 110"),
    (r"replay out/drive --insert", "replay drive --insert"),
    (r"drive\.pcap --insert plan\.json", "drive.pcap --insert plan_standing.json"),
)

# What the rows of small_runs.py make that stands for something of the reader's.
READERS = {
    "out/demo": "drive", "out/front": "again", "out/roof": "again", "out/drive_objects": "inserted",
    **{f"out/{name}": "formats/kitti" for name in "abcd"}, "drive.pcap": "standing.pcap", "mine.jsonl": "detected.jsonl",
    "run.mcap": "formats/mcap/frames.mcap", "run_directory": "formats/rosbag2/rosbag2", "OS-1-128.json": "os1.json",
    "my_scenario.json": "drive.json"}
