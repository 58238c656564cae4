"""What railcast's objects are in the ontologies of OSDaR23 and OSDaR26, and their attributes."""

import math

# A pole may be labelled as a signal: the class of OSDaR for that is a signal's face.
POLES = {"pole": "signal_pole", "signal": "signal_pole", "mast": "catenary_pole"}
NAMES_OF_26 = {"wagons": "wagon"}

POSES = {"walking": "upright", "standing": "upright", "crouching": "other", "sitting": "sitting", "lying": "lying"}
AGES = {"man": "adult", "woman": "adult", "child": "child"}
FUNCTIONS = {"hi_vis": "worker"}  # Who wears no high-visibility vest may be anyone.
SMALL_ANIMAL_M, LARGE_ANIMAL_M = 0.6, 1.2  # Heights, where the operator's ranges meet.

# What an attribute without truth gets, if the ontology permits it: in order of preference. The
# state of a bicycle that nobody moves is called `alone` or `steady`.
NEUTRAL = ("unknown", "undefined", "alone", "steady", "other", "none", "light", "solid")


class Ontology:
    """The classes and attributes that a scene may have."""

    def __init__(self, name, definitions, models):
        self.name = name
        self.classes = definitions
        self.models = models  # model_tables.models_of().

    def class_of(self, thing, label_class):
        """The class of an object, or None if the ontology has none for it."""
        name = self.entry_of(thing).get("class", label_class)
        if thing.type == "person":
            name = "person"
        if thing.type == "pole":
            name = POLES.get(thing.label)
        return self.class_named(name)

    def entry_of(self, thing):
        """Class and attributes of the object's model; empty if it is none, or its table says nothing."""
        return self.models.get(thing.type, {}).get("osdar", {})

    def class_named(self, name):
        known = name if name in self.classes else NAMES_OF_26.get(name)
        return known if known in self.classes else None

    def attributes(self, class_name, truth, occlusion=None):
        """The attributes of an annotation of a lidar: `truth` where it is permitted, else the neutral value."""
        result = {}
        for name, rule in (self.classes[class_name] or {}).items():
            if "lidar" not in rule.get("sensor_types", ("camera", "lidar", "radar")):
                continue
            value = occlusion_of(occlusion, rule) if name == "occlusion" else value_of(rule, truth.get(name))
            if value is not None:
                result[name] = value
        return result


def value_of(rule, truth):
    """The value of an attribute; None if it is to be left out."""
    kind = rule["attribute_type"]
    if kind == "boolean":
        return bool(truth)
    if kind == "multi-reference":
        return list(truth or [])
    options = [str(option) for option in kind["options"]]
    if kind["type"] == "multi-select":
        chosen = [value for value in truth or [] if value in options]
        return chosen or (None if rule.get("optional") else ["none"])
    if isinstance(truth, bool):
        truth = str(truth).lower()
    return truth if truth in options else next((value for value in NEUTRAL if value in options), options[-1])


def occlusion_of(occlusion, rule):
    """The quarter in which the hidden share of an object lies."""
    options = [str(option) for option in rule["attribute_type"]["options"]]
    if occlusion is None:
        return "undefined"
    if not 0 <= occlusion <= 1:
        raise ValueError(f"occlusion: must be from 0 to 1 (got {occlusion})")
    if occlusion >= 1.0 and "100 %" in options:
        return "100 %"
    return options[min(int(4 * occlusion), 3)]


def truth_of(thing, spec, entry):
    """The attributes of an object that railcast knows: by its model (Ontology.entry_of()), and by its section of the
    scenario, if any."""
    truth = {name: value for name, value in entry.items() if name != "class"}
    if thing.type == "person":
        person = spec.get("person", {})
        truth["pose"] = POSES[person.get("posture", "walking")]
        truth["age"] = AGES[person.get("physique", "man")]
        truth["function"] = FUNCTIONS.get(person.get("clothing", "plain"), "unknown")
        truth["aid"] = "none"
        truth["carrying"] = ["suitcase"] if person.get("luggage") == "suitcase" else ["none"]
    height_m = thing.size_m[2]
    if entry.get("class") == "animal":
        truth["size"] = "small" if height_m < SMALL_ANIMAL_M else "medium" if height_m < LARGE_ANIMAL_M else "large"
    return truth


def place_in_train(name, names):
    """(order, names of the neighbours) of a vehicle in its train, whose vehicles are called TRAIN/1, TRAIN/2, ..."""
    train, slash, number = name.rpartition("/")
    if not slash or not number.isdigit():
        return None, []
    beside = [f"{train}/{int(number) + step}" for step in (-1, 1)]
    return int(number), [other for other in beside if other in names]


def rail_below(center, rails, reach_m=0.5):
    """(index of the track, side) of the rail under a point; (None, None) if there is none."""
    nearest = (reach_m, None, None)
    for index, stretch in enumerate(rails):
        for side, line in (("leftRail", stretch["left"]), ("rightRail", stretch["right"])):
            distance_m = min(math.hypot(x - center[0], y - center[1]) for x, y, _ in line)
            nearest = min(nearest, (distance_m, index, side), key=lambda found: found[0])
    return nearest[1], nearest[2]
