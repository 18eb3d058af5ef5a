// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Solids of what a mechanism in space is made of: bars, plates, blocks, springs, dampers. Each has
// a mesh and `place(points)`, that moves it.
import * as THREE from "three";

const FINE = 16; // faces round a bar
const COARSE = 9; // where the processor draws, and every triangle costs time
const COILS = 8;
const COIL_STEPS = 14; // per turn

const Y = new THREE.Vector3(0, 1, 0);
const from = new THREE.Vector3();
const to = new THREE.Vector3();
const along = new THREE.Vector3();

/** Faces round whatever is round. @param {boolean} coarse */
export const facesOf = (coarse) => (coarse ? COARSE : FINE);

/** @param {THREE.Vector3} v @param {ArrayLike<number>} points @param {number} i */
const take = (v, points, i) => v.set(points[3 * i], points[3 * i + 1], points[3 * i + 2]);

/**
 * A mesh of length 1 along y, stretched from p to q.
 * @param {THREE.Object3D} node
 * @param {{p: number, q: number}} ends
 * @param {number} length at which it was made [m]
 */
function stretch(node, { p, q }, length) {
  return (points) => {
    take(from, points, p);
    take(to, points, q);
    along.subVectors(to, from);
    const now = along.length();
    node.visible = Number.isFinite(now) && now > 1e-9;
    if (node.visible) {
      node.position.copy(from);
      node.quaternion.setFromUnitVectors(Y, along.divideScalar(now));
      node.scale.set(1, now / length, 1);
    }
  };
}

/** @param {ArrayLike<number>} points @param {{p: number, q: number}} ends */
function lengthOf(points, { p, q }) {
  const length = take(from, points, p).distanceTo(take(to, points, q));
  return Number.isFinite(length) && length > 1e-9 ? length : 1e-9;
}

/** A round bar with round ends. */
function bar(shape, points, { radius, material, faces }) {
  const length = lengthOf(points, shape);
  const geometry = new THREE.CapsuleGeometry(radius, length, Math.ceil(faces / 4), faces);
  geometry.translate(0, length / 2, 0);
  const node = new THREE.Mesh(geometry, material);
  return { node, place: stretch(node, shape, length) };
}

class Coil extends THREE.Curve {
  constructor(length, radius) {
    super();
    this.made = { length, radius };
  }
  getPoint(t, out = new THREE.Vector3()) {
    const { length, radius } = this.made;
    const lead = 0.12;
    const inner = Math.min(1, Math.max(0, (t - lead) / (1 - 2 * lead)));
    const wide = radius * Math.min(1, 12 * Math.min(inner, 1 - inner));
    const angle = 2 * Math.PI * COILS * inner;
    return out.set(wide * Math.cos(angle), length * t, wide * Math.sin(angle));
  }
}

function spring(shape, points, { radius, material }) {
  const length = lengthOf(points, shape);
  const curve = new Coil(length, 1.1 * radius);
  const geometry = new THREE.TubeGeometry(curve, COILS * COIL_STEPS, 0.22 * radius, 6);
  const node = new THREE.Mesh(geometry, material);
  return { node, place: stretch(node, shape, length) };
}

/** A pot, and a rod that goes into it. */
function damper(shape, points, { radius, material, faces }) {
  const length = lengthOf(points, shape);
  const pot = new THREE.CylinderGeometry(radius, radius, 0.55 * length, faces, 1, true);
  pot.translate(0, 0.28 * length, 0);
  const rod = new THREE.CylinderGeometry(0.3 * radius, 0.3 * radius, 0.6 * length, 8);
  rod.translate(0, 0.7 * length, 0);
  const node = new THREE.Group();
  node.add(new THREE.Mesh(pot, material), new THREE.Mesh(rod, material));
  return { node, place: stretch(node, shape, length) };
}

/** A block at p; its long side points to q. */
function slider(shape, _points, { radius, material }) {
  const node = new THREE.Mesh(
    new THREE.BoxGeometry(3 * radius, 4.5 * radius, 3 * radius),
    material,
  );
  const turn = stretch(node, shape, 1);
  return {
    node,
    place(points) {
      turn(points);
      node.scale.set(1, 1, 1);
    },
  };
}

/** A flat plate of small thickness; its corners move. */
function polygon({ p, n }, points, { radius, material }) {
  const corners = Array.from({ length: n }, (_, i) => take(new THREE.Vector3(), points, p + i));
  const normal = new THREE.Vector3();
  corners.forEach((corner, i) => normal.add(corner.clone().cross(corners[(i + 1) % n])));
  normal.normalize();
  const x = corners[1].clone().sub(corners[0]).normalize();
  const y = normal.clone().cross(x);
  const flat = corners.map((corner) => new THREE.Vector2(corner.dot(x), corner.dot(y)));
  const faces = THREE.ShapeUtils.triangulateShape(flat, []);
  const index = faces.flatMap(([a, b, c]) => [a, b, c, n + a, n + c, n + b]);
  for (let i = 0; i < n; i++) {
    const j = (i + 1) % n;
    index.push(i, n + i, j, j, n + i, n + j);
  }
  const places = new Float32Array(6 * n);
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(index);
  geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
  const plate = material.clone();
  plate.side = THREE.DoubleSide;
  plate.flatShading = true;
  const node = new THREE.Mesh(geometry, plate);
  node.frustumCulled = false;
  const half = 0.35 * radius;
  return {
    node,
    place(now) {
      normal.set(0, 0, 0);
      for (let i = 0; i < n; i++) {
        normal.add(
          take(from, now, p + i)
            .clone()
            .cross(take(to, now, p + ((i + 1) % n))),
        );
      }
      normal.normalize();
      for (let i = 0; i < n; i++) {
        take(from, now, p + i);
        from.addScaledVector(normal, half).toArray(places, 3 * i);
        from.addScaledVector(normal, -2 * half).toArray(places, 3 * (n + i));
      }
      node.visible = places.every(Number.isFinite);
      geometry.attributes.position.needsUpdate = true;
    },
  };
}

/** A load acts here. */
function load({ p }, _points, { radius, material }) {
  const node = new THREE.Mesh(new THREE.OctahedronGeometry(1.8 * radius), material);
  return {
    node,
    place(points) {
      take(node.position, points, p);
      node.visible = Number.isFinite(node.position.x);
    },
  };
}

const MAKERS = { bar, spring, damper, slider, polygon, arrow: load };

/**
 * @param {import("../../state/types.js").Shape} shape
 * @param {ArrayLike<number>} points at which it is made
 * @param {{radius: number, material: any, faces: number}} how faces: round a bar
 * @returns {{node: any, place: (points: ArrayLike<number>) => void} | null} null: not a solid
 */
export function makeSolid(shape, points, how) {
  const make = MAKERS[shape.kind];
  return make ? make(shape, points, how) : null;
}
