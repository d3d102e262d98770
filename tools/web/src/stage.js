// The one drawing context of the page: figures on a floor, in one view or in two beside each other, in the player or on
// a card. Draws only when something changed.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { addMeshes } from './figure.js';
import { Overlay } from './overlay.js';

const FIELD_OF_VIEW = 30;
const ROOM = 1.1;
const FAR_TRAVEL_M = 3.5; // from here on the camera follows the hips

function floorMaterial() {
  return new THREE.ShaderMaterial({
    transparent: true,
    depthWrite: false,
    uniforms: { line: { value: new THREE.Color() }, focus: { value: new THREE.Vector3() }, reach: { value: 3 }, strength: { value: 1 } },
    vertexShader: `varying vec3 place;
      void main() { vec4 world = modelMatrix * vec4(position, 1.0); place = world.xyz; gl_Position = projectionMatrix * viewMatrix * world; }`,
    fragmentShader: `uniform vec3 line; uniform vec3 focus; uniform float reach; uniform float strength; varying vec3 place;
      float lines(vec2 p, float width) {
        vec2 w = max(fwidth(p) * width, vec2(1e-5));
        vec2 d = abs(fract(p - 0.5) - 0.5) / w;
        return 1.0 - min(min(d.x, d.y), 1.0);
      }
      void main() {
        float fade = 1.0 - smoothstep(0.45 * reach, reach, distance(place.xz, focus.xz));
        float grid = max(0.75 * lines(place.xz, 1.2), 0.22 * lines(place.xz * 4.0, 1.0));
        gl_FragColor = vec4(line, grid * fade * strength);
        #include <colorspace_fragment>
      }`,
  });
}

/// One figure with its floor and lights.
class Scene {
  constructor() {
    this.scene = new THREE.Scene();
    this.sky = new THREE.HemisphereLight(0xffffff, 0xcbbda9, 1.9);
    this.key = new THREE.DirectionalLight(0xfff6ea, 2.5);
    this.key.castShadow = true;
    this.key.shadow.mapSize.set(1024, 1024);
    this.key.shadow.radius = 3;
    this.key.shadow.bias = -0.0004;
    this.key.shadow.normalBias = 0.02;
    Object.assign(this.key.shadow.camera, { left: -2.6, right: 2.6, top: 2.6, bottom: -2.6, near: 0.5, far: 14 });
    this.fill = new THREE.DirectionalLight(0xdfe8ff, 0.7);
    this.floor = new THREE.Mesh(new THREE.PlaneGeometry(40, 40).rotateX(-Math.PI / 2), floorMaterial());
    this.floor.renderOrder = -2;
    this.shade = new THREE.Mesh(new THREE.PlaneGeometry(40, 40).rotateX(-Math.PI / 2), new THREE.ShadowMaterial({ opacity: 0.26, depthWrite: false }));
    this.shade.position.y = 0.001;
    this.shade.receiveShadow = true;
    this.shade.renderOrder = -1;
    this.scene.add(this.sky, this.key, this.key.target, this.fill, this.floor, this.shade);
  }

  show(motion, changed) {
    this.clear();
    this.motion = motion;
    this.meshes = addMeshes(motion, changed);
    this.overlay = new Overlay(motion);
    this.scene.add(motion.root, this.overlay.group);
    this.hips = new THREE.Vector3();
  }

  clear() {
    if (!this.motion) return;
    this.scene.remove(this.motion.root, this.overlay.group);
    this.overlay.dispose();
    this.meshes.dispose();
    this.motion = null;
  }

  paint(colors) {
    this.floor.material.uniforms.line.value.set(colors.grid);
    this.shade.material.opacity = colors.dark ? 0.45 : 0.2;
    this.sky.intensity = colors.dark ? 1.6 : 1.9;
    this.overlay?.paint(colors);
  }

  pose(time, ranges) {
    if (!this.motion) return;
    this.motion.pose(time);
    this.overlay.update(ranges);
    this.motion.place(this.motion.clip.root, this.hips);
    this.key.target.position.set(this.hips.x, 0.5, this.hips.z);
    this.key.position.copy(this.key.target.position).add(new THREE.Vector3(1.9, 5.2, 2.4));
    this.fill.position.set(-3, 2, -2);
    this.floor.material.uniforms.focus.value.set(this.hips.x, 0, this.hips.z);
  }
}

/// The page's colours as the stage needs them.
function colorsOf(element) {
  const style = getComputedStyle(element);
  const color = (name) => style.getPropertyValue(name).trim();
  const dark = document.documentElement.dataset.theme === 'dark';
  return { dark, good: color('--good'), bad: color('--bad'), warn: color('--near'), calm: dark ? '#eceef2' : '#2e2a26', soft: color('--soft'), accent: color('--accent'), grid: dark ? '#6f7787' : '#a3957f' };
}

export class Stage {
  /// Throws where the browser has no WebGL.
  constructor() {
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, powerPreference: 'low-power' });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.renderer.toneMapping = THREE.NeutralToneMapping;
    this.renderer.setScissorTest(true);
    this.canvas = this.renderer.domElement;
    this.canvas.setAttribute('aria-hidden', 'true');
    this.camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 0.05, 100);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableDamping = false;
    this.controls.maxPolarAngle = 0.497 * Math.PI;
    this.controls.minDistance = 0.4;
    this.controls.maxDistance = 25;
    this.controls.addEventListener('change', () => this.ask());
    this.views = [new Scene(), new Scene()];
    this.time = 0;
    this.ranges = false;
    this.followed = new THREE.Vector3();
    this.resizes = new ResizeObserver(() => this.ask());
    this.drawn = 0;
  }

  /// Moves the canvas into an element and shows the motions, one view each.
  show(place, motions, { interactive }) {
    if (this.canvas.parentElement !== place) {
      this.resizes.disconnect();
      place.prepend(this.canvas);
      this.resizes.observe(place);
    }
    this.controls.enabled = interactive;
    this.canvas.style.pointerEvents = interactive ? '' : 'none';
    this.count = motions.length;
    const changed = () => this.ask();
    this.views.forEach((view, i) => (motions[i] ? view.motion !== motions[i] && view.show(motions[i], changed) : view.clear()));
    for (const view of this.views) view.floor.material.uniforms.strength.value = interactive ? 1 : 0.55;
    this.repaint();
  }

  hide() {
    this.resizes.disconnect();
    this.canvas.remove();
    this.count = 0;
    for (const view of this.views) view.clear();
  }

  repaint() {
    const colors = colorsOf(document.documentElement);
    for (const view of this.views) view.paint(colors);
    this.ask();
  }

  select(joints) {
    this.views.forEach((view, i) => view.motion && view.overlay.select(joints[i] ?? 0));
    this.ask();
  }

  /// Places the camera so that it holds the whole motion. `turn`: degrees about the figure from its most telling side.
  frame(turn = 0, height = 13) {
    const motions = this.views.filter((view) => view.motion).map((view) => view.motion);
    if (motions.length === 0) return;
    const boxes = motions.map((motion) => motion.bounds());
    this.travels = boxes.some((box) => Math.max(box.max.x - box.min.x, box.max.z - box.min.z) > FAR_TRAVEL_M);
    const box = boxes.reduce((all, one) => all.union(one), new THREE.Box3());
    const motion = motions[0];
    motion.pose(this.time);
    motion.place(motion.clip.root, this.followed);
    const center = this.travels ? this.followed.clone().setY(0.8) : box.getCenter(new THREE.Vector3());
    const radius = this.travels ? 1.5 : Math.max(0.55 * box.getSize(new THREE.Vector3()).length(), 0.8);
    const azimuth = this.tellingSide(motion) + THREE.MathUtils.degToRad(turn);
    const up = THREE.MathUtils.degToRad(height);
    const toCamera = new THREE.Vector3(Math.sin(azimuth) * Math.cos(up), Math.sin(up), Math.cos(azimuth) * Math.cos(up));
    const held = this.travels ? new THREE.Box3().setFromCenterAndSize(center, new THREE.Vector3(2 * radius, 1.9, 2 * radius)) : box;
    this.camera.position.copy(center).addScaledVector(toCamera, this.distanceToHold(held, center, toCamera));
    this.controls.target.copy(center);
    for (const view of this.views) view.floor.material.uniforms.reach.value = Math.max(3.2, 2.2 * radius);
    this.controls.update();
    this.ask();
  }

  /// How far from `center` the camera must be to hold all corners of a box, and some room about them.
  distanceToHold(box, center, toCamera) {
    const right = new THREE.Vector3(0, 1, 0).cross(toCamera).normalize();
    const up = toCamera.clone().cross(right);
    const tangent = Math.tan(THREE.MathUtils.degToRad(FIELD_OF_VIEW / 2)) / ROOM;
    let distance = 1;
    for (let i = 0; i < 8; ++i) {
      const corner = new THREE.Vector3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z).sub(center);
      const needed = Math.max(Math.abs(corner.dot(right)) / (tangent * this.aspect()), Math.abs(corner.dot(up)) / tangent);
      distance = Math.max(distance, needed + corner.dot(toCamera));
    }
    return distance;
  }

  /// Across the blow, turned towards the figure's front: azimuth of the camera about y, 0 on +z.
  tellingSide(motion) {
    const forward = new THREE.Vector3().fromArray(motion.clip.forward).setY(0).normalize();
    const blow = motion.clip.impact ? new THREE.Vector3().fromArray(motion.clip.impact.direction).setY(0) : new THREE.Vector3();
    if (blow.lengthSq() < 1e-4) blow.copy(forward).negate();
    blow.normalize();
    const side = new THREE.Vector3(blow.z, 0, -blow.x);
    if (side.dot(forward) < -0.05) side.negate();
    const toward = side.multiplyScalar(1).addScaledVector(forward, 0.55).normalize();
    return Math.atan2(toward.x, toward.z);
  }

  aspect() {
    const place = this.canvas.parentElement;
    if (!place || place.clientHeight === 0) return 1;
    return place.clientWidth / (this.count || 1) / place.clientHeight;
  }

  seek(time) {
    this.time = time;
    this.ask();
  }

  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.draw();
    });
  }

  followHips() {
    const [first] = this.views;
    if (!this.travels || !first.motion) return;
    const shift = first.hips.clone().sub(this.followed).setY(0);
    this.followed.copy(first.hips);
    this.camera.position.add(shift);
    this.controls.target.add(shift);
    this.camera.lookAt(this.controls.target);
  }

  draw() {
    const place = this.canvas.parentElement;
    if (!place || !this.count) return;
    const width = place.clientWidth;
    const height = place.clientHeight;
    if (width === 0 || height === 0) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const size = this.renderer.getSize(new THREE.Vector2());
    if (size.x !== width || size.y !== height || this.renderer.getPixelRatio() !== ratio) {
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
    }
    const shown = this.views.filter((view) => view.motion);
    for (const view of shown) view.pose(this.time, this.ranges);
    this.followHips();
    const part = width / this.count;
    this.camera.aspect = part / height;
    this.camera.updateProjectionMatrix();
    shown.forEach((view, i) => {
      this.renderer.setViewport(i * part, 0, part, height);
      this.renderer.setScissor(i * part, 0, part, height);
      this.renderer.render(view.scene, this.camera);
    });
    this.drawn += 1;
  }
}

let stage; // undefined: not tried yet; null: no WebGL
/// The page's stage, or null where the browser has no WebGL.
export function theStage() {
  if (stage === undefined) {
    try {
      stage = new Stage();
    } catch {
      stage = null;
    }
  }
  return stage;
}
