"""Reads the operator's definitions, which scripts/export_osdar.py and scripts/check_osdar.py need."""

import json
import pathlib

import yaml

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "shared" / "data" / "raillabel"
SOURCE = "https://github.com/dbinfrago/raillabel-providerkit"


def read_definition(folder, name):
    """A file of YAML or JSON, which stands in the folder itself or as in the operator's repository."""
    places = (folder / name, folder / "ontologies" / name, folder / "schemas" / name)
    path = next((path for path in places if path.exists()), None)
    if path is None:
        raise ValueError(f"{folder}: must hold {name}; clone {SOURCE} and give its folder config by --definitions")
    try:
        text = path.read_text("utf-8")
        return json.loads(text) if path.suffix == ".json" else yaml.safe_load(text)
    except (ValueError, yaml.YAMLError) as error:
        raise ValueError(f"{path}: {' '.join(str(error).split())}") from error
