# Godot 3: post-import script for baked .glb files ("Custom Script" in the Import dock).
# Tried in Godot 3.2.3, headless: tests/clients.
#
# Beside FILE.glb it looks for FILE.events.json (ukemi bake --events, or "events" in a recipe's outputs) and, there or in
# the folder above, for library.json (ukemi batch). Events become calls of ukemi_event(name) on the scene's root; clips
# that the library calls loopable loop. The root keeps the clip's row of the library as its meta "ukemi".
tool
extends EditorScenePostImport


func post_import(scene):
	var player = find_player(scene)
	if player == null:
		return scene
	var source = get_source_file()
	var events = read_json(source.get_basename() + ".events.json")
	if typeof(events) == TYPE_DICTIONARY and player.has_animation(events["clip"]):
		add_events(player.get_animation(events["clip"]), events["events"])
	var row = library_row(source)
	if row != null:
		scene.set_meta("ukemi", row)
		if player.has_animation(row["Clip"]):
			player.get_animation(row["Clip"]).loop = row["Loopable"]
	return scene


func find_player(node):
	if node is AnimationPlayer:
		return node
	for child in node.get_children():
		var found = find_player(child)
		if found != null:
			return found
	return null


# A method track on the root, which the player's root_node (its parent) is.
func add_events(animation, events):
	var track = animation.add_track(Animation.TYPE_METHOD)
	animation.track_set_path(track, NodePath("."))
	for event in events:
		animation.track_insert_key(track, event["time_s"], {"method": "ukemi_event", "args": [event["name"]]})


# The row whose file is this one; null where there is none.
func library_row(source):
	var folder = source.get_base_dir()
	for place in [folder, folder.get_base_dir()]:
		var rows = read_json(place + "/library.json")
		if typeof(rows) == TYPE_ARRAY:
			for row in rows:
				if source.ends_with("/" + row["File"]):
					return row
	return null


func read_json(path):
	var file = File.new()
	if file.open(path, File.READ) != OK:
		return null
	var parsed = JSON.parse(file.get_as_text())
	return parsed.result if parsed.error == OK else null
