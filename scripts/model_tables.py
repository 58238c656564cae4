"""The types of objects that are models: those that railcast ships, and those of a run's own table."""

import json
import pathlib

SHIPPED = pathlib.Path(__file__).resolve().parent.parent / "scenarios" / "models" / "models.json"


def models_of(scenario):
    """The entries of both tables by their names; `scenario` is the content of scenario.resolved.json."""
    shipped = json.loads(SHIPPED.read_text("utf-8"))["models"]
    return {model["name"]: model for model in (*shipped, *scenario.get("models", []))}
