# SPDX-License-Identifier: GPL-3.0-or-later
"""What the buttons do."""

import json
import math
import os
import shutil
import tempfile
import time

import bpy
from bpy_extras import view3d_utils
from mathutils import Vector

from . import control_rigs, glb, program, rig, settings, take


def preference(context):
    """The program's path in the add-on's preferences."""
    addon = context.preferences.addons.get(__package__)
    return addon.preferences.program if addon else ""


def scene_fps(scene):
    return scene.render.fps / scene.render.fps_base


def armature_of(context):
    """The armature that is meant: the active object, or the one that the active mesh moves with."""
    active = context.view_layer.objects.active
    if active is not None and active.type != "ARMATURE":
        return active.find_armature() or (active.parent if active.parent and active.parent.type == "ARMATURE" else active)
    return active


class Job:
    """A bake on its way: a folder with the exported rig, the program's arguments, and what comes back."""

    def __init__(self, context, variations=0):
        scene = context.scene
        self.group, self.fps = scene.ukemi, scene_fps(scene)
        if settings.Described.problem:
            raise program.ProgramError(settings.Described.problem)
        armature = armature_of(context)
        rig.check(armature)
        self.armature_name, self.library = armature.name, armature.library
        self.frame = scene.frame_current
        self.folder = tempfile.mkdtemp(prefix="ukemi-")
        self.variations = variations
        try:
            self._export(context, armature)
            self._run = program.Run(self._arguments(), preference(context))
        except BaseException:
            self.close()
            raise
        self.started = time.monotonic()

    def _value(self, name):
        """A setting in force: what is given, else the program's default."""
        found = next((v for s, v in settings.given(self.group) if s["name"] == name), None)
        described = settings.Described.named(name)
        return found if found is not None else described and described["default"]

    def _export(self, context, armature):
        scene = context.scene
        pose = rig.Pose(armature, context.evaluated_depsgraph_get())
        motion, self.at = [], 0.0
        if self.group.start == "ACTION":
            before = math.ceil((self._value("lead") or 0.0) * self.fps) + 2
            after = 2
            if self._value("recover") is not None and self._value("to") == "clip":
                after += math.ceil((self._value("duration") + self._value("recover")) * self.fps)
            self.at = before / self.fps
            motion = _sample(context, armature, range(self.frame - before, self.frame + after + 1))
        rig.write(os.path.join(self.folder, "rig.glb"), armature, pose, list(scene.objects), motion, self.fps)

    def _decided(self):
        """Settings that the add-on decides: [(name, value)]."""
        decided = [("fps", self.fps), ("keys", "all"), ("clip-only", True), ("up", "y")]
        given = {s["name"] for s, _ in settings.given(self.group)}
        if self.group.start == "ACTION":
            decided += [("clip", "scene"), ("at", self.at)]
        elif not given & {"pose", "clip"}:
            decided.append(("pose", "rest"))
        return [pair for pair in decided if pair[0] not in given]

    def _arguments(self):
        source, decided = os.path.join(self.folder, "rig.glb"), self._decided()
        if self.variations:
            return self._batch_arguments(decided)
        options = settings.arguments(self.group)
        for name, value in decided:
            options += [f"--{name}"] if value is True else [f"--{name}", f"{value:.9g}" if isinstance(value, float) else value]
        outputs = ["-o", os.path.join(self.folder, "hit.glb"), "--report", os.path.join(self.folder, "hit.json"), "--quiet"]
        return ["bake", source, *options, *outputs]

    def _batch_arguments(self, decided):
        group = self.group
        extra = [f"{name} = {json.dumps(value)}" for name, value in decided]
        jitter = f"direction-deg = {group.vary_direction:.4g}, point-m = {group.vary_point:.4g}, strength-percent = {group.vary_strength:.4g}"
        matrix = [f"variations = {self.variations}", f"jitter = {{ {jitter} }}"]
        recipe = os.path.join(self.folder, "recipe.toml")
        with open(recipe, "w", encoding="utf-8") as file:
            file.write(settings.recipe(group, ["rig.glb"], extra, matrix))
        return ["batch", recipe, "-o", os.path.join(self.folder, "out"), "--no-review"]

    def running(self):
        return self._run.running()

    def progress(self):
        seconds = f"{time.monotonic() - self.started:.1f} s"
        told = self._run.progress() if self.variations else ""
        return f"{told}  {seconds}" if told else seconds

    def results(self):
        """Waits for the end: [(clip, report)]."""
        self._run.finish()
        if not self.variations:
            return [self._read(os.path.join(self.folder, "hit.glb"), os.path.join(self.folder, "hit.json"))]
        out = os.path.join(self.folder, "out")
        with open(os.path.join(out, "manifest.json"), encoding="utf-8") as file:
            reactions = json.load(file)["reactions"]
        clips = []
        for reaction in reactions:
            file = next((f for f in reaction.get("outputs") or [] if f.endswith(".glb")), None)
            if file:
                clips.append(self._read(os.path.join(out, file), os.path.join(out, reaction["report"])))
        return clips

    @staticmethod
    def _read(clip, report):
        with open(report, encoding="utf-8") as file:
            return glb.Clip(clip), json.load(file)

    def armature(self):
        """The armature, which may have gone while the program ran."""
        found = next((o for o in bpy.data.objects if o.name == self.armature_name and o.library == self.library), None)
        if found is None:
            raise rig.RigError(f"'{self.armature_name}' is gone")
        return found

    def close(self):
        """Stops the program where it still runs, and removes the folder."""
        run = getattr(self, "_run", None)
        if run is not None:
            run.stop()
        shutil.rmtree(self.folder, ignore_errors=True)


def _sample(context, armature, frames):
    """The armature's poses at whole frames; the scene is left at the frame where it was."""
    scene = context.scene
    frame, part = scene.frame_current, scene.frame_subframe
    poses = []
    try:
        for wanted in frames:
            scene.frame_set(wanted)
            poses.append(rig.Pose(armature, context.evaluated_depsgraph_get()))
    finally:
        scene.frame_set(frame, subframe=part)
    return poses


def _previous(armature):
    animation = armature.animation_data_create()
    return animation, animation.action


def _keep_user(action):
    """An action that nothing uses any more would be lost when the file is saved."""
    if action is not None and action.users == 0:
        action.use_fake_user = True


def _keyed_tracks(context, armature, clip):
    """What is keyed: the plain rig's bones, or a control rig's controls."""
    if control_rigs.family_of(armature) is None:
        moved = take.moved_bones(armature, clip)
        bound = control_rigs.constrained(armature, moved)
        if bound:
            raise rig.RigError(
                f"bone '{bound}' has a constraint that would overrule the reaction, and this is no control rig that the "
                "add-on knows: mute its constraints, or bake on the deform skeleton"
            )
        return take.tracks_of(armature, clip)
    return take.control_tracks(context, armature, clip)


def place(context, job, clips):
    """Puts baked clips onto the armature: one as the settings say, several as tracks of their own. Returns the
    actions."""
    group, armature = context.scene.ukemi, job.armature()
    tracks = [_keyed_tracks(context, armature, clip) for clip, _ in clips]
    animation, previous = _previous(armature)
    actions, names = [], []
    for (clip, report), keyed in zip(clips, tracks):
        marks = (report.get("clip") or {}).get("marks_s") or {}
        first = job.frame - (marks.get("impact") or 0.0) * job.fps
        merge = group.result == "MERGE" and previous is not None and not job.variations
        if merge:
            action = previous.copy()
            action.name = f"{previous.name}_{clip.name}"
        else:
            action = bpy.data.actions.new(clip.name)
        curves = take.Curves(action, armature)
        take.write(curves, armature, keyed, first)
        if control_rigs.family_of(armature) is not None:
            take.switch(curves, control_rigs.switches_of(armature), first)
        take.mark(action, marks, first, job.fps)
        actions.append(action)
        if job.variations or group.result == "NLA":
            if animation.action is not None:
                _push_down(armature, animation)
            names.append(take.push(armature, curves, action.name, first, muted=bool(job.variations) and len(actions) > 1).name)
        else:
            curves.assign(animation)
    _keep_user(previous)
    group.last_armature, group.last_action = armature.name, "\n".join(a.name for a in actions)
    group.last_tracks = "\n".join(names)
    group.previous_action = previous.name if previous else ""
    return actions


def _push_down(armature, animation):
    """The active action as a track below the new ones, so that it goes on where the reaction is not."""
    action = animation.action
    track = animation.nla_tracks.new()
    track.name = action.name
    strip = track.strips.new(action.name, int(action.frame_range[0]), action)
    slot = getattr(animation, "action_slot", None)
    if slot is not None:
        strip.action_slot = slot
    animation.action = None


_running = []  # the job that a modal bake waits for


class _Bake:
    """Modal where there is a window: a timer looks after the program, Escape stops it. Else it runs through."""

    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context):
        if _running:
            return False
        return context.mode in {"OBJECT", "POSE"} and armature_of(context) is not None

    def _count(self, context):
        return 0

    def _start(self, context):
        try:
            self._job = Job(context, self._count(context))
            return True
        except (program.ProgramError, rig.RigError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return False

    def _end(self, context):
        try:
            actions = place(context, self._job, self._job.results())
        except (program.ProgramError, rig.RigError, OSError, ValueError, KeyError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        finally:
            self._job.close()
        self.report({"INFO"}, "baked " + ", ".join(action.name for action in actions))
        return {"FINISHED"}

    def execute(self, context):
        return self._end(context) if self._start(context) else {"CANCELLED"}

    def invoke(self, context, _event):
        if bpy.app.background or context.window is None:
            return self.execute(context)
        if not self._start(context):
            return {"CANCELLED"}
        _running.append(self._job)
        self._timer = context.window_manager.event_timer_add(0.05, window=context.window)
        context.window_manager.modal_handler_add(self)
        context.window_manager.progress_begin(0, 1)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC" and event.value == "PRESS":
            self.cancel(context)
            self.report({"WARNING"}, "stopped: nothing was changed")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if self._job.running():
            context.workspace.status_text_set(f"ukemi bakes: {self._job.progress()}   Esc stops it")
            return {"RUNNING_MODAL"}
        self._clear(context)
        return self._end(context)

    def cancel(self, context):
        self._clear(context)
        self._job.close()

    def _clear(self, context):
        _running.clear()
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)


class UKEMI_OT_bake(_Bake, bpy.types.Operator):
    """Bakes the reaction and puts it onto the armature"""

    bl_idname, bl_label = "ukemi.bake", "Bake"


class UKEMI_OT_bake_variations(_Bake, bpy.types.Operator):
    """Bakes several takes of the reaction, each on an NLA track of its own; the first is heard, the others are muted"""

    bl_idname, bl_label = "ukemi.bake_variations", "Bake Variations"

    def _count(self, context):
        return context.scene.ukemi.variations


class UKEMI_OT_again(bpy.types.Operator):
    """Discards the last take and bakes again, with another seed"""

    bl_idname, bl_label, bl_options = "ukemi.again", "Bake Again", {"UNDO"}

    @classmethod
    def poll(cls, context):
        return bool(context.scene.ukemi.last_action) and UKEMI_OT_bake.poll(context)

    def execute(self, context):
        several = "\n" in context.scene.ukemi.last_action
        discard(context)
        return (bpy.ops.ukemi.bake_variations if several else bpy.ops.ukemi.bake)("EXEC_DEFAULT")

    def invoke(self, context, _event):
        several = "\n" in context.scene.ukemi.last_action
        discard(context)
        (bpy.ops.ukemi.bake_variations if several else bpy.ops.ukemi.bake)("INVOKE_DEFAULT")
        return {"FINISHED"}


def _forget(group):
    for name in ("last_armature", "last_action", "last_tracks", "previous_action"):
        group.property_unset(name)


def discard(context):
    """Takes the last bake off the armature and puts back what it had."""
    group = context.scene.ukemi
    armature = bpy.data.objects.get(group.last_armature)
    if armature is not None and armature.animation_data is not None:
        animation = armature.animation_data
        for name in group.last_tracks.split("\n"):
            if name in animation.nla_tracks:
                animation.nla_tracks.remove(animation.nla_tracks[name])
        previous = bpy.data.actions.get(group.previous_action)
        if group.last_tracks and previous is not None and previous.name in animation.nla_tracks:
            animation.nla_tracks.remove(animation.nla_tracks[previous.name])
        animation.action = previous
    for name in group.last_action.split("\n"):
        action = bpy.data.actions.get(name)
        if action is not None:
            bpy.data.actions.remove(action)
    _forget(group)


class _OnLast:
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context):
        return bool(context.scene.ukemi.last_action) and not _running


class UKEMI_OT_keep(_OnLast, bpy.types.Operator):
    """Keeps the take: its action stays in the file"""

    bl_idname, bl_label = "ukemi.keep", "Keep"

    def execute(self, context):
        group = context.scene.ukemi
        for name in group.last_action.split("\n"):
            action = bpy.data.actions.get(name)
            if action is not None:
                action.use_fake_user = True
        _forget(group)
        return {"FINISHED"}


class UKEMI_OT_discard(_OnLast, bpy.types.Operator):
    """Takes the take off the armature again and puts back what was there"""

    bl_idname, bl_label = "ukemi.discard", "Discard"

    def execute(self, context):
        discard(context)
        return {"FINISHED"}


class UKEMI_OT_reset(bpy.types.Operator):
    """Leaves a setting to the program"""

    bl_idname, bl_label, bl_options = "ukemi.reset", "Reset", {"UNDO", "INTERNAL"}
    name: bpy.props.StringProperty()

    def execute(self, context):
        context.scene.ukemi.property_unset(self.name)
        return {"FINISHED"}


def heaviest_bone(mesh, polygon, armature):
    """The bone with the largest weight over a face's corners."""
    thing, weights = mesh, {}
    for corner in thing.data.polygons[polygon].vertices:
        for influence in thing.data.vertices[corner].groups:
            name = thing.vertex_groups[influence.group].name
            if name in armature.data.bones:
                weights[name] = weights.get(name, 0.0) + influence.weight
    return max(weights, key=weights.get) if weights else None


def facing(armature, mapping):
    """Left, front and up of the character in the world, from where its hips are."""
    frame = armature.matrix_world
    left = frame @ armature.pose.bones[mapping["thigh_l"]].head - frame @ armature.pose.bones[mapping["thigh_r"]].head
    up = Vector((0, 0, 1))
    left = Vector((left.x, left.y, 0.0)).normalized()
    return left, left.cross(up), up


def segment_of(armature, mapping, bone):
    """The segment that a bone belongs to: that of the nearest bone above it that the program names."""
    segments = {node: segment for segment, node in mapping.items()}
    parents = rig.Skeleton(armature).parents
    while bone is not None and bone not in segments:
        bone = parents.get(bone)
    return segments.get(bone)


class UKEMI_OT_pick(bpy.types.Operator):
    """Click on the character where it is hit; the blow comes from where you look"""

    bl_idname, bl_label, bl_options = "ukemi.pick", "Pick", {"UNDO"}

    @classmethod
    def poll(cls, context):
        return context.area is not None and context.area.type == "VIEW_3D" and armature_of(context) is not None

    def invoke(self, context, _event):
        context.window.cursor_modal_set("EYEDROPPER")
        context.workspace.status_text_set("Click on the character where it is hit   Esc: leave it")
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type in {"ESC", "RIGHTMOUSE"}:
            self._clear(context)
            return {"CANCELLED"}
        if event.type != "LEFTMOUSE" or event.value != "PRESS":
            return {"PASS_THROUGH"} if event.type in {"MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE"} else {"RUNNING_MODAL"}
        self._clear(context)
        region = next((r for r in context.area.regions if r.type == "WINDOW"), None)
        at = (event.mouse_x - region.x, event.mouse_y - region.y)
        view = context.area.spaces.active.region_3d
        origin = view3d_utils.region_2d_to_origin_3d(region, view, at)
        direction = view3d_utils.region_2d_to_vector_3d(region, view, at)
        try:
            pick(context, origin, direction)
        except (program.ProgramError, rig.RigError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        group = context.scene.ukemi
        self.report({"INFO"}, f"{group.hit} from {getattr(group, 'from')}")
        return {"FINISHED"}

    @staticmethod
    def _clear(context):
        context.window.cursor_modal_restore()
        context.workspace.status_text_set(None)


def pick(context, origin, direction):
    """Sets what is hit and from where by a ray of the world."""
    armature, depsgraph = armature_of(context), context.evaluated_depsgraph_get()
    rig.check(armature)
    hit, _place, _normal, polygon, thing, _matrix = context.scene.ray_cast(depsgraph, origin, direction)
    if not hit:
        raise rig.RigError("nothing was hit: click on the character's mesh")
    carriers = dict(rig.meshes_of(armature, context.scene.objects))
    if thing.original not in carriers:
        raise rig.RigError(f"'{thing.name}' does not move with '{armature.name}'")
    bone = carriers[thing.original] or heaviest_bone(thing, polygon, armature)
    folder = tempfile.mkdtemp(prefix="ukemi-")
    try:
        path = os.path.join(folder, "rig.glb")
        rig.write(path, armature, rig.Pose(armature, depsgraph), list(context.scene.objects))
        mapping = program.inspect(path, preference(context)).get("map") or {}
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    segment = segment_of(armature, mapping, bone) if mapping else None
    if segment is None:
        raise rig.RigError("the program finds no human in this armature" if not mapping else f"bone '{bone}' belongs to no part of the body")
    group = context.scene.ukemi
    left, front, up = facing(armature, mapping)
    source = -Vector(direction).normalized()
    group.hit = segment
    group.dial = (source.dot(left), source.dot(front), source.dot(up))


class UKEMI_OT_save_recipe(bpy.types.Operator):
    """Saves the settings as a recipe of the program, which ukemi batch bakes too"""

    bl_idname, bl_label = "ukemi.save_recipe", "Save Preset"
    filepath: bpy.props.StringProperty(subtype="FILE_PATH", default="hit.toml")
    filter_glob: bpy.props.StringProperty(default="*.toml", options={"HIDDEN"})

    def execute(self, context):
        group = context.scene.ukemi
        with open(bpy.path.ensure_ext(bpy.path.abspath(self.filepath), ".toml"), "w", encoding="utf-8") as file:
            file.write(settings.recipe(group, ["mannequin"], matrix=[f"variations = {group.variations}"]))
        return {"FINISHED"}

    def invoke(self, context, _event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}


class UKEMI_OT_load_recipe(bpy.types.Operator):
    """Takes the settings of a recipe"""

    bl_idname, bl_label, bl_options = "ukemi.load_recipe", "Load Preset", {"UNDO"}
    filepath: bpy.props.StringProperty(subtype="FILE_PATH")
    filter_glob: bpy.props.StringProperty(default="*.toml", options={"HIDDEN"})

    def execute(self, context):
        try:
            with open(bpy.path.abspath(self.filepath), encoding="utf-8") as file:
                unknown = settings.read_recipe(context.scene.ukemi, file.read())
        except (OSError, ValueError, TypeError) as error:
            self.report({"ERROR"}, f"cannot read {self.filepath}: {error}")
            return {"CANCELLED"}
        if unknown:
            self.report({"WARNING"}, "not known to this program: " + ", ".join(unknown))
        return {"FINISHED"}

    def invoke(self, context, _event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}


class UKEMI_OT_help(bpy.types.Operator):
    """Opens the page for artists as a text"""

    bl_idname, bl_label = "ukemi.help", "Help"

    def execute(self, context):
        try:
            page = program.help_page(preference(context))
        except program.ProgramError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        text = bpy.data.texts.get("ukemi help") or bpy.data.texts.new("ukemi help")
        text.from_string(page)
        self.report({"INFO"}, "see the text 'ukemi help' in the text editor")
        return {"FINISHED"}


CLASSES = [
    UKEMI_OT_bake,
    UKEMI_OT_bake_variations,
    UKEMI_OT_again,
    UKEMI_OT_keep,
    UKEMI_OT_discard,
    UKEMI_OT_reset,
    UKEMI_OT_pick,
    UKEMI_OT_save_recipe,
    UKEMI_OT_load_recipe,
    UKEMI_OT_help,
]
