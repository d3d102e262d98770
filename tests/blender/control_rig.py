"""In Blender, FOLDER: bakes on the rig that Rigify generates of its human metarig; the deform bones are compared with
the program's own glTF, and the rig's switches stand on FK."""

import pathlib
import sys

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import stage  # noqa: E402

(folder,) = stage.arguments()
TOLERANCE_M = 1e-4
MIDDLE_OF_THE_NECK = "DEF-spine.005"  # Rigify places it between neck and head itself


def main():
    stage.begin()
    bpy.ops.preferences.addon_enable(module="rigify")
    bpy.ops.object.armature_human_metarig_add()
    bpy.ops.pose.rigify_generate()
    armature = bpy.context.object
    stage.keep_files(folder)
    from ukemi import rig

    bpy.context.scene.ukemi.hit = "head"
    setattr(bpy.context.scene.ukemi, "from", "left")
    objects = len(bpy.data.objects)
    assert bpy.ops.ukemi.bake("EXEC_DEFAULT") == {"FINISHED"}
    assert len(bpy.data.objects) == objects
    assert not any(c.type == "COPY_TRANSFORMS" and c.target and c.target.name.startswith("ukemi") for b in armature.pose.bones for c in b.constraints)
    played = stage.Played(pathlib.Path(folder) / "hit.glb")
    frames = round(played.duration * 24)
    names = [name for name in rig.Skeleton(armature).names if name != MIDDLE_OF_THE_NECK]
    times = [round(i * frames / 9) / 24 for i in range(10)]
    distance, bone, time = stage.largest_distance(armature, played, 1, names, times)
    keyed = {curve.data_path for curve in armature.animation_data.action.fcurves}
    assert not any("_ik" in path or "DEF-" in path for path in keyed), keyed
    assert armature.pose.bones["thigh_parent.L"]["IK_FK"] == 1.0
    assert 'pose.bones["upper_arm_parent.R"]["IK_FK"]' in keyed
    ok = distance <= TOLERANCE_M and len(names) > 100
    print(f"control_rig: {'ok' if ok else 'WRONG'} Rigify: {len(names)} deform bones, {distance * 1e6:.1f} um at {bone} {time:.2f} s")
    sys.exit(0 if ok else 1)


main()
