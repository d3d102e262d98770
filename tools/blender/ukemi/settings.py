# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings in `scene.ukemi`: the program's own, as `ukemi recipe --json` tells them, and a few of the add-on's."""

import math

import bpy

from . import program

# What the add-on itself decides: the scene's frame rate, a key on every frame, files of its own making.
DECIDED = {"fps", "keys", "key-error-mm", "rotation-type", "clip-only", "bvh-unit", "up", "align", "additive"}

AUTO = "auto"  # of a choice without a default


def attribute(name):
    """The property of a setting: "ball-mass" is scene.ukemi.ball_mass."""
    return name.replace("-", "_")


def _label(setting):
    shown = setting.get("also") or [setting["name"]]  # what artists call it, where that is another word
    words = shown[0].replace("-", " ").capitalize()
    return f"{words} ({setting['unit']})" if setting.get("unit") not in (None, "1") else words


def _number(setting):
    legal = setting["range"] or {"min": -1e9, "max": 1e9}
    default = setting["default"]
    if default is None:
        default = min(max(0.0, legal["min"]), legal["max"])
    if setting["value"] == "N":  # a count
        most = min(legal["max"], 2**31 - 1)
        return bpy.props.IntProperty(
            name=_label(setting), description=_description(setting), default=int(default), min=math.ceil(legal["min"]), max=int(most)
        )
    return bpy.props.FloatProperty(
        name=_label(setting), description=_description(setting), default=default, min=legal["min"], max=legal["max"], precision=3
    )


def _description(setting):
    text = setting["help"]
    if setting["default"] is None and setting["unset"]:
        text += f" (without a value: {setting['unset']})"
    return text


def _choice(setting):
    items = [(word, word.replace("-", " ").capitalize(), "") for word in setting["choices"]]
    if setting["default"] is None:
        items.insert(0, (AUTO, "Automatic", setting["unset"] or ""))
    return bpy.props.EnumProperty(name=_label(setting), description=_description(setting), items=items, default=setting["default"] or AUTO)


def _text(setting):
    named = {"name": _label(setting), "description": _description(setting)}
    default = setting["default"]
    named["default"] = ", ".join(default) if isinstance(default, list) else default or ""
    if setting["choices"]:
        words = list(setting["choices"])
        named["search"] = lambda self, context, text: [word for word in words if text.lower() in word]
        named["search_options"] = {"SUGGESTION"}
    return bpy.props.StringProperty(**named)


def _switch(setting):
    return bpy.props.BoolProperty(name=_label(setting), description=_description(setting), default=setting["default"])


_PROPERTIES = {"number": _number, "choice": _choice, "switch": _switch}


def _aim(self, _context):
    """Writes the dial's direction as the setting "from"."""
    side, front, up = self.dial
    azimuth = math.degrees(math.atan2(side, front)) if abs(side) + abs(front) > 1e-6 else 0.0
    elevation = math.degrees(math.asin(max(-1.0, min(1.0, up / (math.hypot(side, front, up) or 1.0)))))
    setattr(self, "from", f"{round(azimuth)},{round(elevation)}" if round(elevation) else f"{round(azimuth)}")


_OWN = {
    "start": bpy.props.EnumProperty(
        name="Start from",
        description="What the character does when the blow comes",
        items=[
            ("POSE", "Pose", "the pose of the current frame, at rest"),
            ("ACTION", "Motion", "the scene's motion at the current frame, with its velocities"),
        ],
    ),
    "result": bpy.props.EnumProperty(
        name="Result",
        description="Where the reaction goes",
        items=[
            ("ACTION", "New action", "becomes the armature's action; the one before is kept"),
            ("NLA", "NLA track", "a strip on a new track above the others; the action before becomes a track too"),
            ("MERGE", "Merge", "a copy of the action, with the reaction from the current frame on"),
        ],
    ),
    "variations": bpy.props.IntProperty(name="Variations", description="Takes of Bake Variations", default=4, min=1, max=100),
    "vary_direction": bpy.props.FloatProperty(name="Direction (deg)", description="How far the takes' directions differ", default=15, min=0, max=180),
    "vary_point": bpy.props.FloatProperty(name="Point (m)", description="How far the points that are hit differ", default=0.03, min=0, max=1),
    "vary_strength": bpy.props.FloatProperty(name="Strength (%)", description="How far the strengths differ", default=15, min=0, max=90),
    "seed": bpy.props.IntProperty(name="Seed", description="Another seed gives other variations", default=0, min=0),
    "dial": bpy.props.FloatVectorProperty(
        name="From", description="Where the blow comes from, seen from the character: x its left, y its front, z above", subtype="DIRECTION", size=3, default=(0, 1, 0), update=_aim
    ),
    # What the last bake left, for Keep and Discard.
    "last_armature": bpy.props.StringProperty(options={"HIDDEN"}),
    "last_action": bpy.props.StringProperty(options={"HIDDEN"}),
    "last_tracks": bpy.props.StringProperty(options={"HIDDEN"}),
    "previous_action": bpy.props.StringProperty(options={"HIDDEN"}),
}


class Described:
    """The program's settings that the property group was made from."""

    settings = []
    problem = ""  # why there are none

    @classmethod
    def named(cls, name):
        return next((s for s in cls.settings if s["name"] == name), None)


def make_group(preference):
    """The class of scene.ukemi. Without a program it has the add-on's own properties alone."""
    try:
        Described.settings = [s for s in program.settings(preference) if s["name"] not in DECIDED]
        Described.problem = ""
    except program.ProgramError as error:
        Described.settings, Described.problem = [], str(error)
    annotations = dict(_OWN)
    for setting in Described.settings:
        annotations[attribute(setting["name"])] = _PROPERTIES.get(setting["type"], _text)(setting)
    return type("UkemiSettings", (bpy.types.PropertyGroup,), {"__annotations__": annotations})


def _written(value):
    return f"{value:.7g}" if isinstance(value, float) else str(value)


def given(group):
    """Settings that differ from the program's defaults, in its order: [(setting, value)]; a list's value is a list."""
    found = []
    for setting in Described.settings:
        name = attribute(setting["name"])
        if not group.is_property_set(name):
            continue
        value = getattr(group, name)
        if setting["type"] == "list":
            value = [entry.strip() for entry in value.split(",") if entry.strip()]
        elif setting["type"] == "number":
            if setting["default"] is not None and abs(value - setting["default"]) <= 1e-6 * max(1.0, abs(setting["default"])):
                continue
        elif value in ("", AUTO):
            continue
        if value != setting["default"]:
            found.append((setting, value))
    return found


def arguments(group):
    """The same as options of `ukemi bake`."""
    options = []
    for setting, value in given(group):
        option = "--" + setting["name"]
        if setting["type"] == "switch":
            options.append(option if value else "--no-" + setting["name"])
        else:
            for entry in value if isinstance(value, list) else [value]:
                options += [option, _written(entry)]
    return options


def _quoted(text):
    escaped = str(text).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def toml_value(setting, value):
    if setting["type"] == "list":
        return "[" + ", ".join(_quoted(entry) for entry in value) + "]"
    if setting["type"] == "switch":
        return "true" if value else "false"
    return _written(value) if setting["type"] == "number" else _quoted(value)


def recipe(group, characters, extra=(), matrix=(), outputs=("glb", "report")):
    """The settings as a recipe of the program. `extra`: further lines of [settings], `matrix`: of [[matrix]]."""
    varied = {s["name"]: v for s, v in given(group)}
    hits = varied.get("hit", (Described.named("hit") or {}).get("default") or "chest")
    lines = ["format = 1", "characters = [" + ", ".join(map(_quoted, characters)) + "]"]
    lines.append("outputs = [" + ", ".join(map(_quoted, outputs)) + "]")
    lines += [f"seed = {group.seed}", "", "[settings]"]
    lines += [f"{s['name']} = {toml_value(s, v)}" for s, v in given(group) if s["name"] not in ("hit", "seed")]
    lines += [*extra, "", "[[matrix]]", f"hit = [{_quoted(hits)}]", *matrix]
    return "\n".join(lines) + "\n"


def _parse(text):
    text = text.strip()
    if text.startswith("[") and text.endswith("]"):
        return [_parse(part) for part in text[1:-1].split(",") if part.strip()]
    if text.startswith('"') and text.endswith('"'):
        return text[1:-1].replace('\\"', '"').replace("\\\\", "\\")
    if text in ("true", "false"):
        return text == "true"
    return float(text)


def read_recipe(group, text):
    """Takes the settings of a recipe that `recipe` wrote, or one as simple: what it does not name gets its default.
    Returns the names that are no settings of this program."""
    unknown = []
    for setting in Described.settings:
        group.property_unset(attribute(setting["name"]))
    section = ""
    for line in text.splitlines():
        line = line.strip()
        if line.startswith("[") and "=" not in line:
            section = line.strip("[]")
        name, equals, value = line.partition("=")
        name = name.strip()
        if not equals or line.startswith("#") or section not in ("", "settings", "matrix", "reaction"):
            continue
        if name in ("variations", "seed"):
            setattr(group, name, int(_parse(value)))
            continue
        setting = Described.named(name)
        if setting is None:
            if name not in {"format", "characters", "outputs", "jitter", "name"} | DECIDED:
                unknown.append(name)
            continue
        parsed = _parse(value)
        if isinstance(parsed, list):
            parsed = ", ".join(parsed) if setting["type"] == "list" else parsed[0]
        setattr(group, attribute(name), parsed)
    return unknown
