// add_three.mjs FILE.glb: three.js adds the last clip to the first frame of the one before it.
import * as THREE from 'three';
import { clipsOf, kTimes, load, places, plainPlaces, report } from './common.mjs';

const [file] = process.argv.slice(2);
const gltf = await load(file);
const [plain, additive] = clipsOf(gltf.animations);
additive.blendMode = THREE.AdditiveAnimationBlendMode;
const mixer = new THREE.AnimationMixer(gltf.scene);
const base = mixer.clipAction(plain).play();
const added = mixer.clipAction(additive).play();
const found = kTimes.map((time) => {
  base.time = 0;
  added.time = time;
  mixer.update(0);
  return places(gltf.scene);
});
report('three.js', await plainPlaces(file), found);
