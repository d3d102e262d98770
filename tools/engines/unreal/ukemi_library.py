"""Unreal Engine 5, editor Python: a batch's library as a DataTable, its events as notifies.

Written after Epic's documentation of the Python API of 5.3; NOT run in an engine. library.csv itself is tested with
every build: one header, unique row names, no empty numbers, no nested cells.

Once: add UkemiReaction.h to a C++ module of the project and build it, so that the row struct /Script/MODULE.UkemiReaction
exists, and import the clips (.fbx) as Animation Sequences named like their files. Then, in the editor's Python console:

    import ukemi_library
    ukemi_library.import_table("D:/hits/library.csv", "/Game/Hits", "/Script/MyGame.UkemiReaction")
    ukemi_library.add_notifies("D:/hits", "/Game/Hits")
"""

import json
import pathlib

import unreal

TRACK = "ukemi"


def import_table(csv_file, folder, struct_path):
    """Makes or refills FOLDER/DT_Reactions from library.csv."""
    path = f"{folder}/DT_Reactions"
    table = unreal.load_asset(path) if unreal.EditorAssetLibrary.does_asset_exist(path) else None
    if table is None:
        factory = unreal.DataTableFactory()
        factory.set_editor_property("struct", unreal.load_object(None, struct_path))
        tools = unreal.AssetToolsHelpers.get_asset_tools()
        table = tools.create_asset("DT_Reactions", folder, unreal.DataTable, factory)
    if not unreal.DataTableFunctionLibrary.fill_data_table_from_csv_file(table, csv_file):
        raise RuntimeError(f"{csv_file} does not fit {struct_path}")
    unreal.EditorAssetLibrary.save_loaded_asset(table)
    return table


def add_notifies(batch_folder, folder):
    """A notify for each event of every NAME.events.json whose clip was imported as FOLDER/NAME.

    They are montage notifies: the notify name is the event's, and Play Montage passes it to On Notify Begin.
    """
    library = unreal.AnimationLibrary
    for events_file in sorted(pathlib.Path(batch_folder).rglob("*.events.json")):
        name = events_file.name[: -len(".events.json")]
        path = f"{folder}/{name}"
        if not unreal.EditorAssetLibrary.does_asset_exist(path):
            continue
        sequence = unreal.load_asset(path)
        if TRACK in [str(track) for track in library.get_animation_notify_track_names(sequence)]:
            library.remove_animation_notify_track(sequence, TRACK)
        library.add_animation_notify_track(sequence, TRACK)
        for event in json.loads(events_file.read_text(encoding="utf-8"))["events"]:
            notify = library.add_animation_notify_event(
                sequence, TRACK, event["time_s"], unreal.AnimNotify_PlayMontageNotify
            )
            notify.set_editor_property("notify_name", event["name"])
        unreal.EditorAssetLibrary.save_loaded_asset(sequence)
