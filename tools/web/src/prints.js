// Where feet have come down: prints on the floor, left and right in their colours, from the moment of each contact on.
import * as THREE from 'three';

const COLORS = { left: '#2f6fd0', right: '#d0702b' }; // as on contact sheets
const SETTLED_S = 0.06; // after the contact a foot has its place
const LENGTH_M = 0.25;
const WIDTH_M = 0.095;
const BEHIND_M = 0.06; // of the ankle
const HEIGHT_M = 0.003;

/// A foot's outline, heel at the origin, along -y: laid on the floor it points along +z.
function outline() {
  const shape = new THREE.Shape();
  const half = WIDTH_M / 2;
  shape.absarc(0, -half, half, 0, Math.PI);
  shape.lineTo(-half, -(LENGTH_M - half));
  shape.absarc(0, -(LENGTH_M - half), half, Math.PI, 2 * Math.PI);
  shape.closePath();
  return shape;
}

/// When feet come down: a mark of a contact, and the start for a foot that is lifted first or never.
function contactsOf(marks) {
  const steps = marks
    .map((mark) => ({ ...mark, side: /^(?:lift|contact) (left|right)/.exec(mark.name)?.[1] }))
    .filter(({ side }) => side)
    .sort((a, b) => a.time_s - b.time_s);
  const starts = ['left', 'right']
    .filter((side) => steps.length > 0 && steps.find((step) => step.side === side)?.name.startsWith('contact') !== true)
    .map((side) => ({ side, time_s: 0 }));
  return [...starts, ...steps.filter(({ name }) => name.startsWith('contact'))];
}

/// Of one motion. Clips without steps have none.
export class Prints {
  constructor(motion, scale) {
    this.group = new THREE.Group();
    const geometry = new THREE.ShapeGeometry(outline()).rotateX(-Math.PI / 2);
    const before = motion.time;
    this.prints = contactsOf(motion.clip.marks).flatMap(({ side, time_s }) => {
      const ankle = motion.joints.find(({ name }) => name === `ankle_${side[0]}`);
      if (!ankle) return [];
      motion.pose(time_s + SETTLED_S);
      const mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ color: COLORS[side], transparent: true, opacity: 0.55, depthWrite: false, toneMapped: false }));
      motion.place(ankle.origin, mesh.position).setY(HEIGHT_M);
      const way = motion.footWay(ankle);
      mesh.position.addScaledVector(way, -BEHIND_M * scale);
      mesh.rotation.y = Math.atan2(way.x, way.z);
      mesh.scale.setScalar(scale);
      this.group.add(mesh);
      return [{ side, time_s, mesh }];
    });
    motion.pose(before);
  }

  update(time) {
    for (const { time_s, mesh } of this.prints) mesh.visible = time >= time_s;
  }

  /// Those that are shown, for whoever looks from outside: side and place on the floor, metres.
  shown() {
    return this.prints.filter(({ mesh }) => mesh.visible).map(({ side, mesh }) => ({ side, place: [mesh.position.x, mesh.position.z] }));
  }
}
