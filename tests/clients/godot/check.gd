# Prints what tools/engines/godot/post_import.gd made of hits/hit.glb.
extends SceneTree


func _init():
	var scene = load("res://hits/hit.glb").instance()
	var row = scene.get_meta("ukemi")
	print("row ", row["Name"], " ", row["Outcome"], " ", row["EndPose"])
	var animation = player_below(scene).get_animation(row["Clip"])
	print("loop ", animation.loop)
	for track in range(animation.get_track_count()):
		if animation.track_get_type(track) == Animation.TYPE_METHOD:
			for key in range(animation.track_get_key_count(track)):
				print("event %.3f %s %s" % [animation.track_get_key_time(track, key),
						animation.method_track_get_name(track, key), animation.method_track_get_params(track, key)[0]])
	quit()


func player_below(node):
	if node is AnimationPlayer:
		return node
	for child in node.get_children():
		var found = player_below(child)
		if found != null:
			return found
	return null
