// play.mjs LIST.json: three.js loads every {name, file, animation, times, nodes, positions, tolerance} of the list
// (.glb or .bvh), plays it at the times and compares the world position of every named node (glTF index; place
// among the joints of a BVH) with ours: positions[time][node].
import { readFileSync } from 'node:fs';
import * as THREE from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { BVHLoader } from 'three/examples/jsm/loaders/BVHLoader.js';
import { MeshoptDecoder } from 'three/examples/jsm/libs/meshopt_decoder.module.js';

globalThis.self = globalThis;
globalThis.ProgressEvent ??= class extends Event {};

/// The file without what needs a browser: textures, and meshes that need the Draco decoder.
function withoutImages(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const length = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length)));
  for (const key of ['materials', 'textures', 'images', 'samplers']) delete json[key];
  const draco = (json.extensionsRequired ?? []).includes('KHR_draco_mesh_compression');
  for (const mesh of json.meshes ?? [])
    for (const primitive of mesh.primitives) {
      delete primitive.material;
      delete primitive.extensions?.KHR_materials_variants;
    }
  if (draco) {
    delete json.meshes;
    for (const node of json.nodes) {
      delete node.mesh;
      delete node.skin;
    }
    json.extensionsRequired = json.extensionsRequired.filter((name) => name !== 'KHR_draco_mesh_compression');
  }
  const text = new TextEncoder().encode(JSON.stringify(json).padEnd(length, ' '));
  const padded = new Uint8Array((text.length + 3) & ~3).fill(32);
  padded.set(text);
  const rest = bytes.subarray(20 + length);
  const out = new Uint8Array(20 + padded.length + rest.length);
  out.set(bytes.subarray(0, 20));
  out.set(padded, 20);
  out.set(rest, 20 + padded.length);
  const head = new DataView(out.buffer);
  head.setUint32(8, out.length, true);
  head.setUint32(12, padded.length, true);
  return out.buffer;
}

async function loadGlb({ file, animation, nodes }) {
  const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder);
  const gltf = await loader.parseAsync(withoutImages(new Uint8Array(readFileSync(file))), '');
  const byNode = new Map();
  for (const [object, links] of gltf.parser.associations)
    if (links?.nodes !== undefined && object.isObject3D && !byNode.has(links.nodes)) byNode.set(links.nodes, object);
  const clip = gltf.animations.find((a) => a.name === animation);
  return { root: gltf.scene, clip, objects: nodes.map((node) => byNode.get(node)) };
}

async function loadBvh({ file, nodes }) {
  const { skeleton, clip } = new BVHLoader().parse(readFileSync(file, 'utf8'));
  const joints = skeleton.bones.filter((bone) => bone.name !== 'ENDSITE');
  return { root: skeleton.bones[0], clip, objects: nodes.map((node) => joints[node]) };
}

function largestDistance({ root, clip, objects }, { times, positions }) {
  const mixer = new THREE.AnimationMixer(root);
  const action = mixer.clipAction(clip);
  action.setLoop(THREE.LoopOnce, 1);
  action.clampWhenFinished = true;
  let largest = 0;
  times.forEach((time, t) => {
    action.reset().play();
    action.time = time;
    mixer.update(0);
    root.updateWorldMatrix(false, true);
    objects.forEach((object, n) => {
      const distance = object.getWorldPosition(new THREE.Vector3()).distanceTo(
        new THREE.Vector3(...positions[t][n]));
      largest = Math.max(largest, Number.isFinite(distance) ? distance : Infinity);
    });
  });
  return largest;
}

const list = JSON.parse(readFileSync(process.argv.at(-1), 'utf8'));
let checked = 0;
let failures = 0;
for (const item of list) {
  const loaded = await (item.file.endsWith('.bvh') ? loadBvh(item) : loadGlb(item));
  const missing = loaded.objects.filter((object) => !object).length;
  const distance = loaded.clip && missing === 0 ? largestDistance(loaded, item) : Infinity;
  const good = item.nodes.length > 0 && item.times.length >= 10 && distance <= item.tolerance;
  console.log(`${item.name}: ${item.nodes.length} nodes, largest distance ${distance}`
    + ` (at most ${item.tolerance})${missing ? `, ${missing} nodes not found` : ''}${good ? '' : '  FAILED'}`);
  failures += good ? 0 : 1;
  checked += 1;
}
console.log(`${checked} clips played, ${failures} wrong`);
process.exit(checked > 0 && failures === 0 ? 0 : 1);
