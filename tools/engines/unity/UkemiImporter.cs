// Unity 2021 or later: put this file into a folder called Editor. Every .fbx with NAME.events.json beside it gets its
// events, and what library.json (beside it or one folder up) says of it.
// Written after Unity's documentation; NOT run in an editor.
//
// Events call UkemiEvent(string) on the animated object. A clip that the library calls loopable loops; every clip gets its
// first frame as additive reference pose, so that a layer set to Additive adds what the blow did.
using System;
using System.IO;
using System.Linq;
using UnityEditor;
using UnityEngine;

public class UkemiImporter : AssetPostprocessor
{
    [Serializable] class Event { public string name = ""; public float time_s = 0; }
    [Serializable] class Events { public string clip = ""; public float duration_s = 0; public Event[] events = { }; }
    [Serializable] class Row { public string Name = ""; public string File = ""; public bool Loopable = false; }
    [Serializable] class Library { public Row[] rows = { }; }

    void OnPreprocessAnimation()
    {
        var eventsFile = Path.ChangeExtension(assetPath, null) + ".events.json";
        if (!File.Exists(eventsFile)) return;
        var events = JsonUtility.FromJson<Events>(File.ReadAllText(eventsFile));
        var importer = (ModelImporter)assetImporter;
        var clips = importer.defaultClipAnimations;
        foreach (var clip in clips.Where(c => c.name == events.clip || c.takeName == events.clip))
        {
            // The importer counts an event's time from 0 to 1.
            clip.events = events.events.Select(e => new AnimationEvent {
                functionName = "UkemiEvent",
                stringParameter = e.name,
                time = events.duration_s > 0 ? e.time_s / events.duration_s : 0,
                messageOptions = SendMessageOptions.DontRequireReceiver,
            }).ToArray();
            clip.hasAdditiveReferencePose = true;
            clip.additiveReferencePoseFrame = clip.firstFrame;
            clip.loopTime = RowOf(assetPath)?.Loopable ?? false;
        }
        importer.clipAnimations = clips;
    }

    static Row RowOf(string asset)
    {
        var folder = Path.GetDirectoryName(asset);
        foreach (var place in new[] { folder, Path.GetDirectoryName(folder) })
        {
            var file = Path.Combine(place ?? "", "library.json");
            if (!File.Exists(file)) continue;
            // JsonUtility reads no array at the top.
            var library = JsonUtility.FromJson<Library>("{\"rows\":" + File.ReadAllText(file) + "}");
            var path = Path.ChangeExtension(asset.Replace('\\', '/'), null);
            var row = library.rows.FirstOrDefault(r => path.EndsWith("/" + Path.ChangeExtension(r.File, null)));
            if (row != null) return row;
        }
        return null;
    }
}
