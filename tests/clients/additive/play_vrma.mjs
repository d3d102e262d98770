// play_vrma.mjs CLIP.vrma AVATAR.vrm...: three-vrm plays the clip on each avatar and prints, one line of JSON each,
// where hips, head and feet are (VRM space, y up, the avatar faces +z) at the times of common.mjs.
import * as THREE from 'three';
import { kTimes, load } from './common.mjs';

globalThis.window ??= globalThis;
globalThis.document ??= { createElementNS: () => ({ addEventListener() {}, removeEventListener() {}, style: {} }) };
const { VRMLoaderPlugin, VRMUtils } = await import('@pixiv/three-vrm');
const { VRMAnimationLoaderPlugin, createVRMAnimationClip } = await import('@pixiv/three-vrm-animation');

const [file, ...avatars] = process.argv.slice(2);
console.warn = () => {};
const loaded = await load(file, (parser) => new VRMAnimationLoaderPlugin(parser));
const animation = loaded.userData.vrmAnimations[0];
for (const avatar of avatars) {
  const { vrm } = (await load(avatar, (parser) => new VRMLoaderPlugin(parser))).userData;
  VRMUtils.rotateVRM0(vrm);
  const clip = createVRMAnimationClip(animation, vrm);
  const mixer = new THREE.AnimationMixer(vrm.scene);
  mixer.clipAction(clip).play();
  const place = (bone) => vrm.humanoid.getRawBoneNode(bone).getWorldPosition(new THREE.Vector3()).toArray();
  const found = kTimes.map((time) => {
    mixer.setTime(time);
    vrm.update(0);
    vrm.scene.updateMatrixWorld(true);
    return { hips: place('hips'), head: place('head'), feet: [place('leftFoot'), place('rightFoot')] };
  });
  console.log(JSON.stringify({ version: vrm.meta.metaVersion, tracks: clip.tracks.length, duration_s: clip.duration, found }));
}
