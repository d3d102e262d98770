// A character's meshes on a motion's nodes. Geometry, textures and materials are shared between all of its reactions.
import * as THREE from 'three';
import { floats, indices, words } from './library.js';

const shared = new WeakMap(); // character -> { geometries, materials }

function geometryOf(part) {
  const geometry = new THREE.BufferGeometry();
  const set = (name, text, size) => text && geometry.setAttribute(name, new THREE.BufferAttribute(floats(text), size));
  set('position', part.positions, 3);
  set('normal', part.normals, 3);
  set('uv', part.uvs, 2);
  set('color', part.colors, 4);
  if (part.skin >= 0) {
    geometry.setAttribute('skinIndex', new THREE.BufferAttribute(words(part.joints), 4));
    set('skinWeight', part.weights, 4);
  }
  geometry.setIndex(new THREE.BufferAttribute(indices(part.indices), 1));
  if (!part.normals) geometry.computeVertexNormals();
  return geometry;
}

function textureOf(uri, changed) {
  const texture = new THREE.TextureLoader().load(uri, changed);
  texture.flipY = false;
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.anisotropy = 4;
  return texture;
}

const PLAIN = { color: [0.72, 0.66, 0.58, 1], image: -1, alpha: 'opaque', cutoff: 0.5, double_sided: true };

function materialOf(json, part, textures) {
  return new THREE.MeshStandardMaterial({
    color: new THREE.Color().fromArray(json.color),
    opacity: json.alpha === 'blend' ? json.color[3] : 1,
    transparent: json.alpha === 'blend',
    alphaTest: json.alpha === 'mask' ? json.cutoff : 0,
    map: json.image >= 0 && part.uvs ? textures[json.image] : null,
    vertexColors: Boolean(part.colors),
    side: json.double_sided ? THREE.DoubleSide : THREE.FrontSide,
    shadowSide: THREE.DoubleSide,
    roughness: 0.75,
    metalness: 0,
  });
}

function resources(character, changed) {
  if (!shared.has(character)) {
    const textures = character.images.map((uri) => textureOf(uri, changed));
    shared.set(character, {
      geometries: character.parts.map(geometryOf),
      materials: character.parts.map((part) => materialOf(character.materials[part.material] ?? PLAIN, part, textures)),
    });
  }
  return shared.get(character);
}

/// Adds the character's meshes to the motion's nodes. `changed` is called when a texture has arrived.
export function addMeshes(motion, changed) {
  const { character } = motion;
  const { geometries, materials } = resources(character, changed);
  const skeletons = character.skins.map(({ joints, inverse_bind }) => {
    const matrices = floats(inverse_bind);
    return new THREE.Skeleton(
      joints.map((joint) => motion.nodes[joint]),
      joints.map((_, i) => new THREE.Matrix4().fromArray(matrices, 16 * i)),
    );
  });
  const meshes = character.parts.map((part, i) => {
    const mesh = part.skin >= 0 ? new THREE.SkinnedMesh(geometries[i], materials[i]) : new THREE.Mesh(geometries[i], materials[i]);
    if (part.skin >= 0) mesh.bind(skeletons[part.skin], new THREE.Matrix4());
    mesh.castShadow = true;
    mesh.receiveShadow = true;
    mesh.frustumCulled = false;
    (part.skin >= 0 || part.node < 0 ? motion.root : motion.nodes[part.node]).add(mesh);
    return mesh;
  });
  return {
    meshes,
    dispose() {
      for (const skeleton of skeletons) skeleton.dispose();
    },
  };
}
