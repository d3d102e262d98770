// What the scripts of this folder share: files as three.js loads them, and where it has their joints.
import { readFileSync } from 'node:fs';
import * as THREE from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';

globalThis.self = globalThis;
globalThis.ProgressEvent ??= class extends Event {};

export const kTimes = [0, 0.25, 0.6, 1.2];

export function load(file, plugin) {
  const bytes = readFileSync(file);
  const loader = new GLTFLoader();
  if (plugin) loader.register(plugin);
  return loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
}

/// The last two clips of a file: the plain one and the additive one.
export const clipsOf = (animations) => animations.slice(-2);

export function places(root) {
  const result = {};
  root.updateMatrixWorld(true);
  root.traverse((object) => {
    if (object.name) result[object.name] = object.getWorldPosition(new THREE.Vector3()).toArray();
  });
  return result;
}

/// Places of the joints in the plain clip, at each time.
export async function plainPlaces(file) {
  const gltf = await load(file);
  const mixer = new THREE.AnimationMixer(gltf.scene);
  mixer.clipAction(clipsOf(gltf.animations)[0]).play();
  return kTimes.map((time) => {
    mixer.setTime(time);
    return places(gltf.scene);
  });
}

/// Prints one line of JSON: the largest distance between the same joints, metres, and how many were compared.
export function report(engine, expected, found) {
  let worst = 0;
  let count = 0;
  expected.forEach((places, i) => {
    for (const name of Object.keys(places)) {
      if (!found[i][name]) continue;
      ++count;
      worst = Math.max(worst, Math.hypot(...places[name].map((value, k) => value - found[i][name][k])));
    }
  });
  console.log(JSON.stringify({ engine, worst_m: worst, count }));
}
