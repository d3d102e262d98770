// add_playcanvas.mjs FILE.glb: PlayCanvas adds the last clip, in an additive layer, to the first frame of the one
// before it. Nodes and keys come from three.js's loader: PlayCanvas's own needs a browser.
import * as pc from 'playcanvas';
import { clipsOf, kTimes, load, plainPlaces, report } from './common.mjs';

globalThis.window ??= globalThis;
const canvas = { width: 8, height: 8, id: '', style: {}, addEventListener() {}, removeEventListener() {} };
canvas.getBoundingClientRect = () => ({ width: 8, height: 8, left: 0, top: 0 });
const options = new pc.AppOptions();
options.graphicsDevice = new pc.NullGraphicsDevice(canvas, {});
options.componentSystems = [pc.AnimComponentSystem];
options.resourceHandlers = [pc.AnimClipHandler, pc.AnimStateGraphHandler];
const app = new pc.AppBase(canvas);
app.init(options);

const kProperties = { position: 'localPosition', quaternion: 'localRotation', scale: 'localScale' };

function trackOf(clip, root) {
  const curves = [];
  const inputs = [];
  const outputs = [];
  for (const { name, times, values } of clip.tracks) {
    const [node, property] = name.split('.');
    const path = [];
    for (let at = root.getObjectByName(node); at && at !== root; at = at.parent) path.unshift(at.name);
    const target = { entityPath: ['root', ...path], component: 'graph', propertyPath: [kProperties[property]] };
    curves.push(new pc.AnimCurve([target], inputs.length, outputs.length, pc.INTERPOLATION_LINEAR));
    inputs.push(new pc.AnimData(1, times));
    outputs.push(new pc.AnimData(property === 'quaternion' ? 4 : 3, values));
  }
  return new pc.AnimTrack(clip.name, clip.duration, inputs, outputs, curves);
}

function build(object, parent) {
  for (const child of object.children) {
    const entity = new pc.Entity(child.name, app);
    entity.setLocalPosition(...child.position.toArray());
    entity.setLocalRotation(...child.quaternion.toArray());
    entity.setLocalScale(...child.scale.toArray());
    parent.addChild(entity);
    build(child, entity);
  }
}

const [file] = process.argv.slice(2);
const gltf = await load(file);
const [plain, additive] = clipsOf(gltf.animations);
const root = new pc.Entity('root', app);
app.root.addChild(root);
build(gltf.scene, root);
root.addComponent('anim', { activate: true, speed: 1 });
root.anim.addLayer('Plain', 1);
root.anim.assignAnimation('State', trackOf(plain, gltf.scene), 'Plain', 0);
root.anim.addLayer('Additive', 1, undefined, pc.ANIM_LAYER_ADDITIVE);
root.anim.assignAnimation('State', trackOf(additive, gltf.scene), 'Additive', 1);
const [base, added] = ['Plain', 'Additive'].map((name) => root.anim.findAnimationLayer(name));
const found = kTimes.map((time) => {
  base.play('State');
  added.play('State');
  base.activeStateCurrentTime = 0;
  added.activeStateCurrentTime = time;
  app.systems.fire('animationUpdate', 1e-6);
  const result = {};
  root.forEach((entity) => {
    const place = entity.getPosition();
    result[entity.name] = [place.x, place.y, place.z];
  });
  return result;
});
report('PlayCanvas', await plainPlaces(file), found);
process.exit(0);
