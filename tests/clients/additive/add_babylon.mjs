// add_babylon.mjs FILE.glb: Babylon.js adds the last clip to the first frame of the one before it.
import { readFileSync } from 'node:fs';
import { clipsOf, kTimes, plainPlaces, report } from './common.mjs';

globalThis.XMLHttpRequest ??= class {};
const { NullEngine } = await import('@babylonjs/core/Engines/nullEngine.js');
const { Scene } = await import('@babylonjs/core/scene.js');
const { FreeCamera } = await import('@babylonjs/core/Cameras/freeCamera.js');
const { Vector3 } = await import('@babylonjs/core/Maths/math.vector.js');
await import('@babylonjs/core/Animations/index.js');
const { SceneLoader } = await import('@babylonjs/core/Loading/sceneLoader.js');
await import('@babylonjs/loaders/glTF/2.0/index.js');

const [file] = process.argv.slice(2);
const scene = new Scene(new NullEngine({ renderWidth: 8, renderHeight: 8 }));
scene.useRightHandedSystem = true;
new FreeCamera('camera', new Vector3(0, 0, 5), scene);
const data = `data:;base64,${readFileSync(file).toString('base64')}`;
const loaded = await SceneLoader.ImportMeshAsync('', '', data, scene, undefined, '.glb');
loaded.animationGroups.forEach((group) => group.stop());
const [base, added] = clipsOf(loaded.animationGroups);
added.isAdditive = true;
const found = kTimes.map((time) => {
  base.stop();
  added.stop();
  base.start(true, 1e-9); // stays on its first frame
  added.start(true, 1);
  base.setWeightForAllAnimatables(1);
  added.setWeightForAllAnimatables(1);
  scene._animate(0.001);
  scene._animate(Math.max(time * 1000, 0.001));
  const result = {};
  for (const node of scene.transformNodes) {
    node.computeWorldMatrix(true);
    result[node.name] = node.getAbsolutePosition().asArray();
  }
  return result;
});
report('Babylon.js', await plainPlaces(file), found);
process.exit(0);
