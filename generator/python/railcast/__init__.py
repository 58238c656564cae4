"""railcast: LiDAR simulation for railways. Recordings and simulated frames as numpy arrays.

    import railcast
    frame = railcast.Simulator("scenarios/st_gallen_approach.json").scan(30)
    xyz, label = frame.points(), frame["label"][frame.has_point]

open() reads recordings, Simulator makes frames in memory, and Dataset gives frames of recordings
by index, as loaders for training want them. Faults in a user's input raise InputError.
"""

from ._railcast import OUTCOMES, Frame, InputError, Object, Rails, Recording, Simulator, __version__, open
from .dataset import Dataset

__all__ = [
    "OUTCOMES", "Dataset", "Frame", "InputError", "Object", "Rails", "Recording", "Simulator",
    "__version__", "open"
]
