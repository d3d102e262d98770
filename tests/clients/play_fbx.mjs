// play_fbx.mjs LIST.json: three.js loads every {name, file, animation, times, metres_per_unit, positions, tolerance} of
// the list as an FBX, and again as what fbx2gltf (Autodesk's SDK) makes of it at 60 frames per second, and compares the
// place of every named joint with ours: positions[name][time], metres.
import { execFileSync } from 'node:child_process';
import { chmodSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import * as THREE from 'three';
import { FBXLoader } from 'three/examples/jsm/loaders/FBXLoader.js';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';

globalThis.self = globalThis;
globalThis.window = globalThis;
globalThis.ProgressEvent ??= class extends Event {};
// Textures are not looked at.
globalThis.document = { createElementNS: () => ({ addEventListener() {}, removeEventListener() {} }) };
THREE.ImageLoader.prototype.load = () => document.createElementNS();

const converter = path.join(path.dirname(createRequire(import.meta.url).resolve('fbx2gltf')), 'bin',
  { linux: 'Linux', darwin: 'Darwin' }[process.platform] ?? 'Windows_NT', 'FBX2glTF');

function arrayBuffer(file) {
  const bytes = readFileSync(file);
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
}

async function byThree(item) {
  const root = new FBXLoader().parse(arrayBuffer(item.file), '');
  return { root, clips: root.animations, metres: item.metres_per_unit };
}

async function bySdk(item) {
  const glb = item.file.replace(/\.fbx$/, '_sdk.glb');
  chmodSync(converter, 0o755);
  execFileSync(converter, ['--binary', '--anim-framerate', 'bake60', '--input', item.file, '--output', glb],
    { stdio: 'ignore' });
  const bytes = new Uint8Array(arrayBuffer(glb));
  const length = new DataView(bytes.buffer).getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length)));
  for (const key of ['materials', 'textures', 'images', 'samplers']) delete json[key];
  for (const mesh of json.meshes ?? []) for (const primitive of mesh.primitives) delete primitive.material;
  bytes.set(new TextEncoder().encode(JSON.stringify(json).padEnd(length, ' ')), 20);
  const gltf = await new GLTFLoader().parseAsync(bytes.buffer, '');
  return { root: gltf.scene, clips: gltf.animations, metres: 1 };
}

function largestDistance({ root, clips, metres }, item) {
  const clip = clips.find((c) => c.name === item.animation);
  if (!clip) return { distance: Infinity, joints: 0 };
  const mixer = new THREE.AnimationMixer(root);
  const action = mixer.clipAction(clip);
  action.setLoop(THREE.LoopOnce, 1);
  action.clampWhenFinished = true;
  const plain = new Map();
  root.traverse((object) => plain.set(object.name, object));
  const joints = Object.keys(item.positions)
    .map((name) => [name, plain.get(THREE.PropertyBinding.sanitizeNodeName(name))])
    .filter(([, object]) => object);
  let distance = 0;
  item.times.forEach((time, t) => {
    action.reset().play();
    action.time = time;
    mixer.update(0);
    root.updateMatrixWorld(true);
    for (const [name, object] of joints) {
      const place = new THREE.Vector3().setFromMatrixPosition(object.matrixWorld).multiplyScalar(metres);
      const off = place.distanceTo(new THREE.Vector3(...item.positions[name][t]));
      distance = Math.max(distance, Number.isFinite(off) ? off : Infinity);
    }
  });
  return { distance, joints: joints.length };
}

const list = JSON.parse(readFileSync(process.argv.at(-1), 'utf8'));
let failures = 0;
for (const item of list)
  for (const [program, load] of [['three.js', byThree], ['fbx2gltf', bySdk]]) {
    const { distance, joints } = largestDistance(await load(item), item);
    const good = joints >= 15 && item.times.length >= 5 && distance <= item.tolerance;
    console.log(`${item.name} in ${program}: ${joints} joints, largest distance ${distance}`
      + ` (at most ${item.tolerance})${good ? '' : '  FAILED'}`);
    failures += good ? 0 : 1;
  }
console.log(`${list.length} takes played twice, ${failures} wrong`);
process.exit(list.length > 0 && failures === 0 ? 0 : 1);
