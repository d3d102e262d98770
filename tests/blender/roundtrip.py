"""In Blender, FOLDER FILE...: bakes on each rig and compares where its bones are with the program's own glTF."""

import pathlib
import sys

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import stage  # noqa: E402

folder, *files = stage.arguments()
# Shares of the rig's height: Blender computes in single precision and in the file's unit (a BVH in cm is 170 m tall there).
TOLERANCE = 1e-5
MOVES = 0.03
failed = 0
for file in files:
    stage.begin()
    armature = stage.load(file)
    stage.keep_files(folder)
    scene = bpy.context.scene
    scene.ukemi.hit = "head"
    setattr(scene.ukemi, "from", "left")
    first = scene.frame_current
    assert bpy.ops.ukemi.bake("EXEC_DEFAULT") == {"FINISHED"}, file
    played = stage.Played(pathlib.Path(folder) / "hit.glb")
    names = [bone.name for bone in armature.data.bones]
    fps = scene.render.fps / scene.render.fps_base
    frames = round(played.duration * fps)
    times = [round(i * frames / 9) / fps for i in range(10)]
    distance, bone, time = stage.largest_distance(armature, played, first, names, times)
    at_start = stage.bone_places(armature, names, first)
    heights = [place.z for place in at_start]
    height = max(heights) - min(heights)
    places = [stage.bone_places(armature, names, first + frames * share // 8) for share in range(1, 9)]
    moved = max((a - b).length for later in places for a, b in zip(at_start, later))
    ok = distance <= TOLERANCE * height and moved > MOVES * height
    failed += not ok
    print(f"roundtrip: {'ok' if ok else 'WRONG'} {pathlib.Path(file).name}: {len(names)} bones, {distance / height * 1e6:.1f} millionths of its height off at {bone} {time:.2f} s, moved {moved / height:.2f} of it")
print(f"roundtrip: {len(files) - failed} of {len(files)} rigs")
sys.exit(1 if failed or not files else 0)
