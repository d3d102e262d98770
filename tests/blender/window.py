"""In Blender with a window and --enable-event-simulate, FOLDER MANNEQUIN.glb: panel, modal bake, Escape and undo in a
real event loop. Writes FOLDER/panel.png."""

import pathlib
import sys
import traceback

import bpy
from mathutils import Euler

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import stage  # noqa: E402

folder, mannequin = stage.arguments()


def view():
    """Window, area and regions of the 3D view, for operators."""
    window = bpy.context.window_manager.windows[0]
    area = next(a for a in window.screen.areas if a.type == "VIEW_3D")
    region = next(r for r in area.regions if r.type == "WINDOW")
    return {"window": window, "screen": window.screen, "area": area, "region": region}


def armature():
    return next(o for o in bpy.data.objects if o.type == "ARMATURE")


def state():
    """What a scene is made of, as text: one undo must bring it back."""
    lines = [f"{kind} {thing.name}" for kind in ("objects", "actions", "meshes") for thing in getattr(bpy.data, kind)]
    animation = armature().animation_data
    lines.append(f"action {animation.action.name if animation and animation.action else None}")
    lines += [f"track {t.name}" for t in (animation.nla_tracks if animation else ())]
    lines += [f"{b.name} {[round(v, 5) for row in b.matrix for v in row]}" for b in armature().pose.bones]
    return "\n".join(lines)


def press(key):
    window = view()["window"]
    area = view()["area"]
    x, y = area.x + area.width // 2, area.y + area.height // 2
    window.event_simulate(type=key, value="PRESS", x=x, y=y)
    window.event_simulate(type=key, value="RELEASE", x=x, y=y)


def open_tab():
    """A click on the tab "Ukemi", the fourth of the sidebar."""
    region = next(r for r in view()["area"].regions if r.type == "UI")
    x, y = region.x + region.width - 14, region.y + region.height - 155
    view()["window"].event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
    for value in ("PRESS", "RELEASE"):
        view()["window"].event_simulate(type="LEFTMOUSE", value=value, x=x, y=y)


def steps():
    """Each `yield` lets the event loop run for so many seconds."""
    with bpy.context.temp_override(**view()):
        stage.load(mannequin)
    armature().animation_data_clear()
    for action in list(bpy.data.actions):
        bpy.data.actions.remove(action)
    space = view()["area"].spaces.active
    space.show_region_ui = True
    space.region_3d.view_perspective = "PERSP"
    space.region_3d.view_rotation = Euler((1.35, 0.0, 0.9)).to_quaternion()
    space.region_3d.view_distance, space.region_3d.view_location = 3.6, (0.1, -0.1, 0.75)
    bpy.ops.ed.undo_push(message="the test begins")
    yield 0.5
    open_tab()
    yield 0.5

    before = state()
    with bpy.context.temp_override(**view()):
        assert bpy.ops.ukemi.bake("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    from ukemi import operators

    assert operators._running and not bpy.ops.ukemi.bake.poll()
    waited = 0.0
    while operators._running:
        yield 0.1
        waited += 0.1
        assert waited < 60, "the bake does not end"
    action = armature().animation_data.action
    assert action is not None and action.name == "chest_front"
    print(f"window: ok modal bake, {waited:.1f} s")
    bpy.context.scene.frame_set(11)
    yield 0.5
    screenshot = str(pathlib.Path(folder) / "panel.png")
    with bpy.context.temp_override(**view()):
        bpy.ops.screen.screenshot(filepath=screenshot)
    bpy.context.scene.frame_set(1)
    yield 0.2

    with bpy.context.temp_override(**view()):
        bpy.ops.ed.undo()
    yield 0.5
    assert state() == before, "undo left something"
    print("window: ok one undo")

    armature_now = armature()
    bpy.context.view_layer.objects.active = armature_now
    bpy.context.scene.ukemi.duration = 60.0
    bpy.context.scene.ukemi.until_rest = False
    before = state()
    with bpy.context.temp_override(**view()):
        assert bpy.ops.ukemi.bake("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    job = operators._running[0]
    press("ESC")
    waited = 0.0
    while operators._running:
        yield 0.05
        waited += 0.05
        assert waited < 20, "Escape does not stop it"
    assert not job.running() and not pathlib.Path(job.folder).exists()
    assert state() == before
    print(f"window: ok Escape, {waited:.2f} s")


def drive(script):
    try:
        return next(script)
    except StopIteration:
        print("window: 3 of 3", flush=True)
        status = 0
    except BaseException:
        traceback.print_exc()
        status = 1
    sys.stdout.flush()
    import os

    os._exit(status)


def main():
    stage.shims.install()
    bpy.context.preferences.view.show_splash = False
    bpy.ops.preferences.addon_enable(module="ukemi")
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    script = steps()
    bpy.app.timers.register(lambda: drive(script), first_interval=1.0)


main()
