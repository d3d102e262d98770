// A clip on its skeleton: where every node is at a time. Needs no drawing.
import * as THREE from 'three';
import { floats, scaled } from './library.js';

/// The last key at or before `time`, by bisection.
function keyBefore(times, time) {
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}

const from = new THREE.Quaternion();
const to = new THREE.Quaternion();

/// Local values between keys: linear, rotations on the shorter arc; before the first and after the last key theirs.
class Track {
  constructor({ node, path, step, times, values }) {
    this.node = node;
    this.path = path;
    this.step = step;
    this.times = floats(times);
    this.values = floats(values);
    this.size = path === 'quaternion' ? 4 : 3;
  }

  apply(node, time) {
    const { times, values, size } = this;
    const i = keyBefore(times, time);
    const next = Math.min(i + 1, times.length - 1);
    const span = times[next] - times[i];
    const share = this.step || span <= 0 ? 0 : Math.min(Math.max((time - times[i]) / span, 0), 1);
    const target = node[this.path];
    if (this.path === 'quaternion') {
      target.copy(from.fromArray(values, i * size).slerp(to.fromArray(values, next * size), share)).normalize();
      return;
    }
    target.fromArray(values, i * size);
    for (let c = 0; c < 3; ++c)
      target.setComponent(c, target.getComponent(c) + share * (values[next * size + c] - target.getComponent(c)));
  }
}

/// One joint's path through its range, per frame of the clip's check.
class JointPath {
  constructor(json, fps) {
    Object.assign(this, json, { fps });
    this.ay = scaled(json.a_y_deg);
    this.az = scaled(json.a_z_deg);
    this.twist = scaled(json.twist_path_deg);
    this.margin = scaled(json.margin_deg); // how far outside (positive) or inside (negative)
    this.nodeFromJoint = new THREE.Quaternion().fromArray(json.node_from_joint);
  }
  frame(time) {
    return Math.min(Math.max(time * this.fps, 0), this.margin.length - 1);
  }
  /// Linear between frames.
  at(values, time) {
    const frame = this.frame(time);
    const i = Math.floor(frame);
    const next = Math.min(i + 1, values.length - 1);
    return values[i] + (frame - i) * (values[next] - values[i]);
  }
}

/// Skeleton, clip and ranges of one reaction. `root` holds the nodes in metres, y up.
export class Motion {
  constructor(character, clip) {
    this.character = character;
    this.clip = clip;
    this.duration = clip.duration_s;
    this.tracks = clip.tracks.map((track) => new Track(track));
    this.joints = clip.rom.joints.map((joint) => new JointPath(joint, clip.rom.fps));
    this.root = new THREE.Group();
    const world = character.world_from_file;
    this.root.position.fromArray(world.position);
    this.root.position.y -= clip.floor_m;
    this.root.quaternion.fromArray(world.quaternion);
    this.root.scale.setScalar(world.scale);
    this.nodes = character.nodes.map((json) => {
      const node = new THREE.Object3D();
      node.position.fromArray(json.position);
      node.quaternion.fromArray(json.quaternion);
      node.scale.fromArray(json.scale);
      return node;
    });
    character.nodes.forEach(({ parent }, i) => (parent < 0 ? this.root : this.nodes[parent]).add(this.nodes[i]));
    this.pose(0);
  }

  pose(time) {
    this.time = Math.min(Math.max(time, 0), this.duration);
    for (const track of this.tracks) track.apply(this.nodes[track.node], this.time);
    this.root.updateMatrixWorld(true);
  }

  place(node, target = new THREE.Vector3()) {
    return target.setFromMatrixPosition(this.nodes[node].matrixWorld);
  }

  /// Where the foot below an ankle points, along the floor: to its toes, or as the figure faces where it has none.
  footWay(ankle) {
    const toes = this.character.nodes.findIndex(({ parent }) => parent === ankle.origin);
    const way = toes < 0 ? new THREE.Vector3() : this.place(toes).sub(this.place(ankle.origin)).setY(0);
    if (way.lengthSq() < 1e-4) way.fromArray(this.clip.forward).setY(0);
    return way.normalize();
  }

  /// Places of a node over the whole clip.
  pathOf(node, samples = 90) {
    const before = this.time;
    const points = [];
    for (let i = 0; i <= samples; ++i) {
      this.pose((this.duration * i) / samples);
      points.push(this.place(node));
    }
    this.pose(before);
    return points;
  }

  /// Box about all nodes in all of the clip.
  bounds(samples = 24) {
    const before = this.time;
    const box = new THREE.Box3();
    const point = new THREE.Vector3();
    for (let i = 0; i <= samples; ++i) {
      this.pose((this.duration * i) / samples);
      for (let node = 0; node < this.nodes.length; ++node) box.expandByPoint(this.place(node, point));
    }
    this.pose(before);
    return box;
  }

  /// The largest of all joints' margins at every frame.
  worst() {
    if (this.worstMargins) return this.worstMargins;
    const frames = this.joints[0]?.margin.length ?? 0;
    this.worstMargins = new Float32Array(frames).fill(-Infinity);
    for (const { margin } of this.joints) for (let i = 0; i < frames; ++i) this.worstMargins[i] = Math.max(this.worstMargins[i], margin[i]);
    return this.worstMargins;
  }

  /// The joint that comes nearest to its edge, or leaves it farthest.
  worstJoint() {
    let best = 0;
    this.joints.forEach(({ margin }, i) => {
      if (Math.max(...margin) > Math.max(...this.joints[best].margin)) best = i;
    });
    return best;
  }
}

/// Direction of the link in the joint's frame: theta = |a|, d = (cos theta, a_z sin theta / theta, -a_y sin theta / theta).
export function linkDirection(ayDeg, azDeg, target = new THREE.Vector3()) {
  const ay = THREE.MathUtils.degToRad(ayDeg);
  const az = THREE.MathUtils.degToRad(azDeg);
  const theta = Math.hypot(ay, az);
  const s = theta > 1e-9 ? Math.sin(theta) / theta : 1;
  return target.set(Math.cos(theta), az * s, -ay * s);
}

export const NEAR_DEG = 3; // this close to its edge a joint is marked
export const OUTSIDE_DEG = 0.05; // rounding of the clip's keys is no excess
