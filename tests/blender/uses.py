"""In Blender, FOLDER MANNEQUIN.glb: every way to use the add-on, on one rig."""

import math
import pathlib
import sys
import traceback

import bpy
from mathutils import Matrix, Vector

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import stage  # noqa: E402

folder, mannequin = stage.arguments()


def fresh():
    """The mannequin in a scene of 30 frames per second, at frame 12."""
    stage.begin()
    stage.keep_files(folder)
    armature = stage.load(mannequin)
    armature.animation_data_clear()
    for action in list(bpy.data.actions):
        bpy.data.actions.remove(action)
    scene = bpy.context.scene
    scene.render.fps = 30
    scene.frame_set(12)
    scene.ukemi.duration = 0.5
    return armature, scene, scene.ukemi


def bake():
    assert bpy.ops.ukemi.bake("EXEC_DEFAULT") == {"FINISHED"}


def curves(action, path):
    return [c for c in action.fcurves if c.data_path == path]


def hips(armature):
    return armature.data.bones[0].name


def place(armature, name, frame):
    return stage.bone_places(armature, [name], frame)[0]


def refusal(call):
    try:
        call()
    except RuntimeError as error:
        return str(error)
    raise AssertionError("was not refused")


def test_settings_are_the_programs():
    from ukemi import program

    _, scene, group = fresh()
    told = program.settings()
    assert len(told) > 40
    have = group.bl_rna.properties.keys()
    missing = [s["name"] for s in told if s["name"].replace("-", "_") not in have]
    assert set(missing) == {"fps", "keys", "key-error-mm", "rotation-type", "clip-only", "bvh-unit", "up", "align", "additive"}, missing
    for setting in told:
        name = setting["name"].replace("-", "_")
        if name in have and setting["type"] != "list" and setting["default"] is not None and name != "duration":
            value = getattr(group, name)
            same = abs(value - setting["default"]) < 1e-6 if setting["type"] == "number" else value == setting["default"]
            assert same, (name, value, setting["default"])


def test_action_is_named_and_marked_and_starts_at_the_frame():
    armature, scene, group = fresh()
    group.hit = "head"
    bake()
    action = armature.animation_data.action
    assert action.name == "head_front", action.name
    assert tuple(action.frame_range) == (12.0, 27.0), tuple(action.frame_range)
    assert [m.frame for m in action.pose_markers if m.name == "impact"] == [12]
    assert scene.frame_current == 12


def test_options_reach_the_program():
    armature, _, group = fresh()
    group.preset, group.strength, group.root_motion = "kick", 2.0, "in-place"
    bake()
    import json

    report = json.loads((pathlib.Path(folder) / "hit.json").read_text())
    assert report["impact"]["preset"] == "kick"
    assert report["clip"]["root_motion"] == "in-place"
    assert report["settings"]["fps"] == 30


def test_still_bones_get_no_curves_and_keep_their_pose():
    armature, _, group = fresh()
    finger = next(b for b in armature.pose.bones if "Index1" in b.name)
    finger.rotation_mode = "QUATERNION"
    finger.rotation_quaternion = (0.9, 0.1, 0.0, 0.0)
    held = finger.matrix_basis.copy()
    bake()
    action = armature.animation_data.action
    assert not curves(action, f'pose.bones["{finger.name}"].rotation_quaternion')
    assert finger.matrix_basis == held


def test_the_pose_of_the_scene_is_where_it_starts():
    armature, _, _ = fresh()
    arm = armature.pose.bones["LeftArm"]
    arm.rotation_mode = "QUATERNION"
    arm.rotation_quaternion = (math.cos(0.3), 0.0, 0.0, math.sin(0.3))
    bpy.context.view_layer.update()
    before = place(armature, "LeftForeArm", 12)
    bake()
    assert (place(armature, "LeftForeArm", 12) - before).length < 1e-4


def test_euler_bones_get_continuous_euler_curves():
    armature, _, group = fresh()
    names = ["LeftArm", "Spine", hips(armature)]
    for name, mode in zip(names, ("XYZ", "ZYX", "YXZ")):
        armature.pose.bones[name].rotation_mode = mode
    armature.pose.bones["RightArm"].rotation_mode = "AXIS_ANGLE"
    group.duration = 2.0
    bake()
    action = armature.animation_data.action
    for name in names:
        found = curves(action, f'pose.bones["{name}"].rotation_euler')
        assert len(found) == 3 and not curves(action, f'pose.bones["{name}"].rotation_quaternion')
        for curve in found:
            values = [p.co[1] for p in curve.keyframe_points]
            assert max(abs(a - b) for a, b in zip(values, values[1:])) < math.pi, name
    assert len(curves(action, 'pose.bones["RightArm"].rotation_axis_angle')) == 4
    played = stage.Played(pathlib.Path(folder) / "hit.glb")
    distance = stage.largest_distance(armature, played, 12, [b.name for b in armature.data.bones], [i / 5 for i in range(10)])
    assert distance[0] < 1e-4, distance


def test_nla_puts_a_track_above_the_action_before():
    armature, _, group = fresh()
    group.result = "NLA"
    armature.pose.bones[0].keyframe_insert("location", frame=1)
    before = armature.animation_data.action
    bake()
    tracks = armature.animation_data.nla_tracks
    assert [t.name for t in tracks] == [before.name, "chest_front"], [t.name for t in tracks]
    assert armature.animation_data.action is None
    assert place(armature, "Head", 27) != place(armature, "Head", 12)
    bpy.ops.ukemi.discard()
    assert not len(armature.animation_data.nla_tracks) and armature.animation_data.action == before


def test_merge_keeps_what_comes_before():
    armature, _, group = fresh()
    bone = armature.pose.bones[hips(armature)]
    for frame in (1, 6, 20):
        bone.location.x = frame / 100
        bone.keyframe_insert("location", frame=frame)
    before = armature.animation_data.action
    was = [place(armature, "Head", frame) for frame in (1, 4, 8)]
    bpy.context.scene.frame_set(12)
    group.result = "MERGE"
    bake()
    action = armature.animation_data.action
    assert action != before and before.use_fake_user
    for frame, old in zip((1, 4), was):
        assert (place(armature, "Head", frame) - old).length < 1e-5
    assert action.frame_range[1] == 27
    bpy.ops.ukemi.discard()
    assert armature.animation_data.action == before and list(bpy.data.actions) == [before]


def test_motion_goes_into_the_blow():
    armature, scene, group = fresh()
    bone = armature.pose.bones[hips(armature)]
    path = Vector((0.0, 0.0, 2.0))  # m/s in the bone's own axes
    for frame in (1, 31):
        bone.location = path * ((frame - 1) / 30)
        bone.keyframe_insert("location", frame=frame)
    for curve in armature.animation_data.action.fcurves:
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"
    scene.frame_set(12)
    at = [place(armature, hips(armature), frame) for frame in (11, 12)]
    scene.frame_set(12)
    velocity = (at[1] - at[0]) * 30
    assert velocity.length > 1.9
    group.start, group.duration = "ACTION", 0.3
    group.hit, group.strength = "hand_l", 0.01
    bake()
    after = [place(armature, hips(armature), frame) for frame in (12, 14)]
    assert (after[0] - at[1]).length < 1e-3
    assert ((after[1] - after[0]) * 15 - velocity).length < 0.4 * velocity.length, ((after[1] - after[0]) * 15, velocity)


def test_root_motion_on_the_object():
    armature, scene, group = fresh()
    armature.matrix_world = Matrix.Translation((1, 2, 0)) @ Matrix.Rotation(0.5, 4, "Z")
    bpy.context.view_layer.update()
    group.root_motion, group.duration = "root", 2.0
    bake()
    action = armature.animation_data.action
    assert len(curves(action, "location")) == 3
    scene.frame_set(12)
    first = armature.matrix_world.translation.copy()
    assert (first - Vector((1, 2, 0))).length < 1e-5, first
    scene.frame_set(60)
    assert (armature.matrix_world.translation - first).length > 0.1
    played = stage.Played(pathlib.Path(folder) / "hit.glb")
    distance = stage.largest_distance(armature, played, 12, [b.name for b in armature.data.bones], [i / 6 for i in range(10)])
    assert distance[0] < 1e-4, distance


def test_variations_are_tracks_of_their_own():
    armature, _, group = fresh()
    group.variations = 3
    assert bpy.ops.ukemi.bake_variations("EXEC_DEFAULT") == {"FINISHED"}
    tracks = armature.animation_data.nla_tracks
    assert len(tracks) == 3 and [t.mute for t in tracks] == [False, True, True]
    places = []
    for track in tracks:
        for other in tracks:
            other.mute = other != track
        places.append(place(armature, "Head", 26))
    assert min((a - b).length for i, a in enumerate(places) for b in places[:i]) > 1e-4, places
    bpy.ops.ukemi.discard()
    assert not len(armature.animation_data.nla_tracks) and not len(bpy.data.actions)


def test_keep_and_again():
    armature, _, group = fresh()
    bake()
    group.hit = "head"
    assert bpy.ops.ukemi.again("EXEC_DEFAULT") == {"FINISHED"}
    assert [a.name for a in bpy.data.actions] == ["head_front"]
    bpy.ops.ukemi.keep()
    assert bpy.data.actions["head_front"].use_fake_user and not group.last_action
    assert not bpy.ops.ukemi.discard.poll()


def test_recipes_go_out_and_come_in():
    _, _, group = fresh()
    group.hit, group.strength, group.until_rest, group.recover, group.variations = "head", 1.5, False, 0.4, 7
    setattr(group, "from", "30,10")
    path = str(pathlib.Path(folder).with_name("preset.toml"))
    bpy.ops.ukemi.save_recipe("EXEC_DEFAULT", filepath=path)
    group.hit, group.strength, group.tone, group.variations = "chest", 1.0, 0.5, 2
    assert bpy.ops.ukemi.load_recipe("EXEC_DEFAULT", filepath=path) == {"FINISHED"}
    assert (group.hit, group.until_rest, group.variations, getattr(group, "from")) == ("head", False, 7, "30,10")
    assert abs(group.strength - 1.5) < 1e-6 and abs(group.recover - 0.4) < 1e-6
    assert not group.is_property_set("tone")
    from ukemi import program

    run = program.Run(["batch", path, "-o", path + ".out", "--dry-run"])
    run.finish()


def test_picks_bone_and_direction():
    armature, _, group = fresh()
    from ukemi import operators

    head = place(armature, "Head", 12) + Vector((0, 0, 0.08))
    operators.pick(bpy.context, head + Vector((3, 0, 0)), Vector((-1, 0, 0)))
    assert (group.hit, getattr(group, "from")) == ("head", "90"), (group.hit, getattr(group, "from"))
    chest = place(armature, "Spine2", 12)
    operators.pick(bpy.context, chest + Vector((0, -3, 3)), Vector((0, 1, -1)))
    assert group.hit == "chest" and getattr(group, "from") == "0,45", (group.hit, getattr(group, "from"))
    assert "nothing was hit" in str(raised(lambda: operators.pick(bpy.context, Vector((50, 0, 0)), Vector((1, 0, 0)))))


def raised(call):
    try:
        call()
    except Exception as error:
        return error
    raise AssertionError("nothing was raised")


def test_refuses_with_the_reason():
    armature, _, group = fresh()
    armature.scale = (1, 2, 1)
    assert "scale that is not the same" in refusal(bpy.ops.ukemi.bake)
    armature.scale = (-1, -1, -1)
    assert "mirrored" in refusal(bpy.ops.ukemi.bake)
    armature.scale = (1, 1, 1)
    setattr(group, "from", "letf")
    assert "did you mean 'left'" in refusal(bpy.ops.ukemi.bake).replace("Did", "did")
    setattr(group, "from", "left")
    armature.pose.bones["LeftArm"].constraints.new("IK")
    assert "LeftArm" in refusal(bpy.ops.ukemi.bake)
    assert not len(bpy.data.actions)


def linked():
    """A scene into which the mannequin is linked from another file: the armature, active, and its mesh."""
    fresh()
    path = str(pathlib.Path(folder).with_name("linked.blend"))
    bpy.ops.wm.save_as_mainfile(filepath=path)
    stage.begin()
    stage.keep_files(folder)
    with bpy.data.libraries.load(path, link=True) as (source, target):
        target.objects = list(source.objects)
    objects = [o for o in target.objects if o.type in ("ARMATURE", "MESH")]
    for thing in objects:
        bpy.context.scene.collection.objects.link(thing)
    return next(o for o in objects if o.type == "ARMATURE")


def test_a_linked_armature_is_refused_and_an_override_is_baked():
    armature = linked()
    bpy.context.view_layer.objects.active = armature
    assert "library override" in refusal(bpy.ops.ukemi.bake)
    own = armature.override_create(remap_local_usages=True)
    if own.name not in bpy.context.scene.collection.objects:
        bpy.context.scene.collection.objects.link(own)
    bpy.context.view_layer.objects.active = own
    bpy.context.scene.ukemi.duration = 0.5
    bake()
    assert own.animation_data.action.library is None
    played = stage.Played(pathlib.Path(folder) / "hit.glb")
    distance = stage.largest_distance(own, played, 1, [b.name for b in own.data.bones], [i / 20 for i in range(10)])
    assert distance[0] < 1e-4, distance


def test_of_several_armatures_the_active_one_is_baked():
    first, scene, _ = fresh()
    second = stage.load(mannequin)
    second.animation_data_clear()
    second.location.x = 2
    bpy.context.view_layer.objects.active = next(o for o in second.children if o.type == "MESH")
    bake()
    assert first.animation_data is None and second.animation_data.action is not None
    assert place(second, "Head", 20).x > 1


def test_other_objects_stay():
    armature, scene, _ = fresh()
    empty = bpy.data.objects.new("parent", None)
    scene.collection.objects.link(empty)
    empty.matrix_world = Matrix.Translation((3, -1, 0.5)) @ Matrix.Rotation(1.0, 4, "Z") @ Matrix.Scale(0.01, 4)
    armature.parent = empty
    armature.matrix_local = Matrix.Scale(100.0, 4)
    cube = bpy.data.objects.new("cube", bpy.data.meshes.new("cube"))
    scene.collection.objects.link(cube)
    cube.location.x = 1
    cube.keyframe_insert("location", frame=1)
    cube.location.x = 5
    cube.keyframe_insert("location", frame=20)
    scene.frame_set(12)
    counts = {name: len(getattr(bpy.data, name)) for name in ("objects", "meshes", "armatures", "collections", "materials")}
    where = cube.matrix_world.copy(), empty.matrix_world.copy(), armature.matrix_world.copy()
    bake()
    assert counts == {name: len(getattr(bpy.data, name)) for name in counts}
    assert where == (cube.matrix_world, empty.matrix_world, armature.matrix_world)
    assert scene.frame_current == 12 and bpy.context.view_layer.objects.active == armature
    played = stage.Played(pathlib.Path(folder) / "hit.glb")
    distance = stage.largest_distance(armature, played, 12, [b.name for b in armature.data.bones], [i / 20 for i in range(10)])
    assert distance[0] < 1e-4, distance


def main():
    failed, tests = 0, [(n, t) for n, t in globals().items() if n.startswith("test_")]
    for name, test in tests:
        try:
            test()
            print(f"uses: ok {name}")
        except Exception:
            failed += 1
            print(f"uses: WRONG {name}\n{traceback.format_exc()}")
    print(f"uses: {len(tests) - failed} of {len(tests)}")
    sys.exit(1 if failed or not tests else 0)


main()
