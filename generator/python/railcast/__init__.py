"""railcast: LiDAR simulation for railways. Recordings and simulated frames as numpy arrays.

    import railcast
    frame = railcast.Simulator(railcast.SCENARIOS / "st_gallen_approach.json").scan(30)
    xyz, label = frame.points(), frame["label"][frame.has_point]

SCENARIOS is the folder of the scenarios that come with railcast. open() reads recordings, Simulator makes frames in
memory, and Dataset gives frames of recordings by index, as loaders for training want them. Faults in a user's input
raise InputError. EXTRAS lists the optional readers in this build, whose formats open() reads as well: "packets", "ros",
"osi". OUTCOMES has the values of the field `outcome` by name.
"""

import pathlib

from ._railcast import EXTRAS, OUTCOMES, Frame, InputError, Object, Rails, Recording, Simulator, __version__, open
from .dataset import Dataset


def _folder_of_scenarios():
    here = pathlib.Path(__file__).resolve().parent
    # In a wheel; where the package is installed below /usr or /usr/local; among the sources.
    places = [here / "scenarios"]
    if len(here.parents) > 3:
        places += [here.parents[3] / "share" / "railcast" / "scenarios", here.parents[2] / "scenarios"]
    return next((place for place in places if place.is_dir()), places[0])


SCENARIOS: pathlib.Path = _folder_of_scenarios()

__all__ = [
    "EXTRAS", "OUTCOMES", "Dataset", "Frame", "InputError", "Object", "Rails", "Recording", "SCENARIOS", "Simulator",
    "__version__", "open"
]
