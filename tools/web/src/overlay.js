// Over the figure: its joints coloured by how near they are to the edge of their range, the selected joint's range as a
// patch of the sphere that its link sweeps, the way of the hips, the prints of its feet, the blow.
import * as THREE from 'three';
import { linkDirection, NEAR_DEG, OUTSIDE_DEG } from './motion.js';
import { Prints } from './prints.js';

const RINGS = 8;
const PER_EDGE = 6;
const ARROW_SHOWN_S = 0.45;

const marginColor = (margin, colors) => (margin > OUTSIDE_DEG ? colors.bad : margin > -NEAR_DEG ? colors.warn : colors.calm);

/// Directions of a polygon's outline, each edge divided.
function outlineOf(polygon) {
  const points = [];
  polygon.forEach(([ay, az], i) => {
    const [nextAy, nextAz] = polygon[(i + 1) % polygon.length];
    for (let k = 0; k < PER_EDGE; ++k) points.push([ay + ((nextAy - ay) * k) / PER_EDGE, az + ((nextAz - az) * k) / PER_EDGE]);
  });
  return points;
}

/// The polygon on the unit sphere: rings about the reference direction (the polygon is star-shaped about it).
function patchGeometry(polygon) {
  const outline = outlineOf(polygon);
  const n = outline.length;
  const positions = [...linkDirection(0, 0)];
  const faces = [];
  const direction = new THREE.Vector3();
  for (let ring = 1; ring <= RINGS; ++ring)
    for (const [ay, az] of outline) positions.push(...linkDirection((ay * ring) / RINGS, (az * ring) / RINGS, direction));
  for (let i = 0; i < n; ++i) faces.push(0, 1 + i, 1 + ((i + 1) % n));
  for (let ring = 0; ring < RINGS - 1; ++ring)
    for (let i = 0; i < n; ++i) {
      const a = 1 + ring * n + i;
      const b = 1 + ring * n + ((i + 1) % n);
      faces.push(a, a + n, b, b, a + n, b + n);
    }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
  geometry.setIndex(faces);
  return { geometry, edge: positions.slice(-3 * n) };
}

function lineGeometry(points) {
  return new THREE.BufferGeometry().setFromPoints(points);
}

/// What is drawn over one motion. Colours come from the page's theme: see `paint`.
export class Overlay {
  constructor(motion) {
    this.motion = motion;
    this.group = new THREE.Group();
    this.scale = (motion.character.height_m || 1.75) / 1.75;
    this.makeDots();
    this.makePatch();
    this.makeTrail();
    this.makeArrow();
    this.prints = new Prints(motion, this.scale);
    this.group.add(this.prints.group);
    this.select(motion.worstJoint());
  }

  makeDots() {
    this.dots = new THREE.Group();
    const geometry = new THREE.SphereGeometry(0.017 * this.scale, 16, 12);
    this.dotMeshes = this.motion.joints.map(() => {
      const material = new THREE.MeshBasicMaterial({ depthTest: false, transparent: true, toneMapped: false });
      const mesh = new THREE.Mesh(geometry, material);
      mesh.renderOrder = 5;
      this.dots.add(mesh);
      return mesh;
    });
    this.group.add(this.dots);
  }

  makePatch() {
    this.patch = new THREE.Group();
    const base = { transparent: true, depthWrite: false, toneMapped: false };
    this.surface = new THREE.Mesh(undefined, new THREE.MeshBasicMaterial({ ...base, opacity: 0.22, side: THREE.DoubleSide }));
    this.edge = new THREE.LineLoop(undefined, new THREE.LineBasicMaterial({ ...base, depthTest: false }));
    this.link = new THREE.Line(undefined, new THREE.LineBasicMaterial({ ...base, depthTest: false }));
    this.tip = new THREE.Mesh(new THREE.SphereGeometry(0.045, 16, 12), new THREE.MeshBasicMaterial({ ...base, depthTest: false }));
    this.surface.renderOrder = 3;
    this.edge.renderOrder = this.link.renderOrder = 4;
    this.tip.renderOrder = 6;
    this.patch.add(this.surface, this.edge, this.link, this.tip);
    this.group.add(this.patch);
  }

  makeTrail() {
    const points = this.motion.pathOf(this.motion.clip.root);
    for (const point of points) point.y = 0.004;
    this.trail = new THREE.Line(lineGeometry(points), new THREE.LineBasicMaterial({ transparent: true, opacity: 0.55, toneMapped: false }));
    this.group.add(this.trail);
  }

  makeArrow() {
    const { impact } = this.motion.clip;
    if (!impact) return;
    const s = this.scale;
    this.arrowMaterial = new THREE.MeshStandardMaterial({ transparent: true, roughness: 0.6 });
    this.arrow = new THREE.Group();
    const head = new THREE.Mesh(new THREE.ConeGeometry(0.045 * s, 0.11 * s, 24), this.arrowMaterial);
    const shaft = new THREE.Mesh(new THREE.CylinderGeometry(0.016 * s, 0.016 * s, 0.34 * s, 16), this.arrowMaterial);
    head.position.y = -0.055 * s;
    shaft.position.y = -0.28 * s;
    this.arrow.add(head, shaft);
    const direction = new THREE.Vector3().fromArray(impact.direction).normalize();
    this.arrow.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), direction);
    this.arrow.position.fromArray(impact.point ?? [0, 0, 0]);
    this.arrow.position.y -= impact.point ? this.motion.clip.floor_m : 0;
    this.impactTime = this.motion.clip.marks.find((mark) => mark.name === 'impact')?.time_s ?? 0;
    this.group.add(this.arrow);
  }

  select(joint) {
    this.selected = joint;
    const path = this.motion.joints[joint];
    if (!path) return;
    this.surface.geometry?.dispose();
    this.edge.geometry?.dispose();
    const { geometry, edge } = patchGeometry(path.polygon_deg);
    this.surface.geometry = geometry;
    this.edge.geometry = new THREE.BufferGeometry().setAttribute('position', new THREE.Float32BufferAttribute(edge, 3));
  }

  paint(colors) {
    this.colors = colors;
    this.surface.material.color.set(colors.good);
    this.edge.material.color.set(colors.good);
    this.trail.material.color.set(colors.soft);
    this.arrowMaterial?.color.set(colors.accent);
  }

  /// Follows the motion's present pose.
  update(ranges) {
    const { motion, colors } = this;
    this.dots.visible = ranges;
    this.prints.update(motion.time);
    this.patch.visible = ranges && motion.joints.length > 0;
    if (this.arrow) {
      const since = motion.time - this.impactTime;
      this.arrow.visible = Math.abs(since) < ARROW_SHOWN_S;
      this.arrowMaterial.opacity = 1 - Math.abs(since) / ARROW_SHOWN_S;
    }
    if (!ranges) return;
    motion.joints.forEach((joint, i) => {
      const margin = joint.at(joint.margin, motion.time);
      motion.place(joint.origin, this.dotMeshes[i].position);
      this.dotMeshes[i].material.color.set(marginColor(margin, colors));
      this.dotMeshes[i].scale.setScalar(i === this.selected ? 1.5 : 1);
    });
    this.updatePatch();
  }

  updatePatch() {
    const joint = this.motion.joints[this.selected];
    if (!joint) return;
    const { time } = this.motion;
    const color = marginColor(joint.at(joint.margin, time), this.colors);
    this.motion.place(joint.origin, this.patch.position);
    this.motion.nodes[joint.parent].getWorldQuaternion(this.patch.quaternion).multiply(joint.nodeFromJoint);
    this.patch.scale.setScalar(0.27 * this.scale);
    linkDirection(joint.at(joint.ay, time), joint.at(joint.az, time), this.tip.position);
    this.tip.material.color.set(color);
    this.link.material.color.set(color);
    this.link.geometry?.dispose();
    this.link.geometry = lineGeometry([new THREE.Vector3(), this.tip.position]);
  }

  dispose() {
    this.group.traverse((object) => {
      object.geometry?.dispose();
      object.material?.dispose();
    });
  }
}
