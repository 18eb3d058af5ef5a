// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Glyphs of joints that show their axes: pin and axis, slide with its rail, cross, ball, plate. A
// driven joint carries a ring with an arrow.
import * as THREE from "three";
import { jointPlace } from "../../state/kinematics.js";
import { facesOf } from "./solids.js";

/** A cylinder along z, of a number of faces. */
function rod(radius, length, faces, material) {
  const geometry = new THREE.CylinderGeometry(radius, radius, length, faces);
  geometry.rotateX(Math.PI / 2);
  return new THREE.Mesh(geometry, material);
}

/** The same, along x. */
function rodAlongX(radius, length, faces, material) {
  const geometry = new THREE.CylinderGeometry(radius, radius, length, faces);
  geometry.rotateZ(Math.PI / 2);
  return new THREE.Mesh(geometry, material);
}

/** A ball of as many faces round it, and half as many from pole to pole. */
const ball = (radius, faces, material) =>
  new THREE.Mesh(new THREE.SphereGeometry(radius, faces, Math.ceil(faces / 2)), material);

/** A ring round z, or an arc of it. */
const hoop = (radius, thick, faces, material, arc = 2 * Math.PI) =>
  new THREE.Mesh(
    new THREE.TorusGeometry(radius, thick, Math.ceil(faces / 3), 2 * faces, arc),
    material,
  );

/**
 * The shape of each type, by r of a bar [m] and n faces round it.
 * @type {Record<string, (r: number, n: number, of: {pin: any, axis: any}) => any[]>}
 */
const GLYPHS = {
  revolute: (r, n, { pin, axis }) => [
    rod(1.45 * r, 3.4 * r, n, pin),
    rod(0.28 * r, 13 * r, n, axis),
  ],
  prismatic: (r, n, { axis }) => [rod(0.4 * r, 16 * r, n, axis)],
  cylindrical: (r, n, { pin, axis }) => [
    rod(1.6 * r, 5 * r, n, pin),
    rod(0.5 * r, 18 * r, n, axis),
  ],
  universal: (r, n, { pin, axis }) => [ball(1.1 * r, n, pin), rod(0.55 * r, 6 * r, n, axis)],
  spherical: (r, n, { pin, axis }) => [ball(1.8 * r, n, pin), hoop(1.9 * r, 0.25 * r, n, axis)],
  planar: (r, n, { pin, axis }) => [
    new THREE.Mesh(new THREE.BoxGeometry(7 * r, 7 * r, 0.4 * r), pin),
    rod(0.25 * r, 9 * r, n, axis),
  ],
};

/** An arrow round the axis: this joint is driven. */
function ring(r, faces, material) {
  const arc = 1.6 * Math.PI;
  const turn = hoop(3.2 * r, 0.3 * r, faces, material, arc);
  const head = new THREE.Mesh(new THREE.ConeGeometry(0.95 * r, 2 * r, 10), material);
  head.position.set(3.2 * r * Math.cos(arc), 3.2 * r * Math.sin(arc), 0);
  head.rotation.z = arc;
  const node = new THREE.Group();
  node.add(turn, head);
  node.position.z = 2.6 * r;
  return node;
}

/** An arrow along the axis: this joint is driven to slide. */
function push(r, material) {
  const node = new THREE.Mesh(new THREE.ConeGeometry(1.3 * r, 3 * r, 12), material);
  node.rotation.x = Math.PI / 2;
  node.position.z = 7 * r;
  return node;
}

const x = new THREE.Vector3();
const y = new THREE.Vector3();
const z = new THREE.Vector3();
const basis = new THREE.Matrix4();

/** @param {any} node @param {{at: number[], axis: number[], ref: number[]}} place */
function settle(node, { at, axis, ref }) {
  z.fromArray(axis);
  x.fromArray(ref);
  y.crossVectors(z, x);
  node.position.fromArray(at);
  node.quaternion.setFromRotationMatrix(basis.makeBasis(x, y, z));
}

/**
 * All joints of a scene.
 * @param {import("../../state/types.js").Scene} scene
 * @param {number} r half a bar's width [m]
 * @param {{pin: any, axis: any, drive: any}} materials
 * @param {boolean} coarse
 */
export function makeJoints(scene, r, materials, coarse) {
  const faces = facesOf(coarse);
  const group = new THREE.Group();
  const driven = new Set(
    scene.coordinates.filter(({ actuated }) => actuated).map(({ joint }) => joint),
  );
  const places = (scene.joints ?? []).flatMap((joint) => {
    const make = GLYPHS[joint.type];
    if (!make) {
      return [];
    }
    const node = new THREE.Group();
    node.add(...make(r, faces, materials));
    if (driven.has(joint.name)) {
      const slides = joint.type === "prismatic";
      node.add(slides ? push(r, materials.drive) : ring(r, faces, materials.drive));
    }
    node.userData = { joint: joint.name };
    group.add(node);

    // the second axis of a universal joint is the child's
    const second =
      joint.type === "universal" ? rodAlongX(0.55 * r, 6 * r, faces, materials.axis) : null;
    if (second) {
      group.add(second);
    }
    return [{ joint, node, second }];
  });

  return {
    group,
    /** @param {(import("../../state/kinematics.js").Frame | null)[]} frames */
    place(frames) {
      for (const { joint, node, second } of places) {
        const slides = joint.type === "prismatic" || joint.type === "cylindrical";
        const here = jointPlace(joint, frames, slides) ?? jointPlace(joint, frames, !slides);
        node.visible = here !== null;
        if (here) {
          settle(node, here);
        }
        const there = second ? jointPlace(joint, frames, true) : null;
        if (second && there) {
          settle(second, there);
        }
      }
    },
  };
}

/**
 * Pins at points, where a scene has no joints.
 * @param {any} scene @param {number} r @param {any} material @param {boolean} coarse
 */
export function makePins(scene, r, material, coarse) {
  const group = new THREE.Group();
  const shapes = scene.drawing.shapes.filter(({ kind }) => kind === "pivot" || kind === "ground");
  const pin = ball(1.5 * r, facesOf(coarse), material);
  const nodes = shapes.map(({ p }) => {
    const node = pin.clone();
    group.add(node);
    return { node, p };
  });
  return {
    group,
    /** @param {ArrayLike<number>} points */
    place(points) {
      for (const { node, p } of nodes) {
        node.position.set(points[3 * p], points[3 * p + 1], points[3 * p + 2]);
        node.visible = Number.isFinite(node.position.x);
      }
    },
  };
}

const AXES = /** @type {const} */ ([
  [0xc23b2e, 1],
  [0x3f8f3a, 0.8],
  [0x3568c4, 0.6],
]);

/** The axes of a body at its centre of mass: x red and longest, y green, z blue and shortest. */
export function makeTriad(length) {
  const node = new THREE.Group();
  AXES.forEach(([colour, part], k) => {
    const material = new THREE.MeshBasicMaterial({ color: colour });
    const shaft = new THREE.CylinderGeometry(0.018 * length, 0.018 * length, part * length, 8);
    shaft.translate(0, (part * length) / 2, 0);
    const tip = new THREE.ConeGeometry(0.06 * length, 0.16 * length, 10);
    tip.translate(0, part * length, 0);
    const axis = new THREE.Group();
    axis.add(new THREE.Mesh(shaft, material), new THREE.Mesh(tip, material));
    axis.quaternion.setFromUnitVectors(
      new THREE.Vector3(0, 1, 0),
      new THREE.Vector3(k === 0 ? 1 : 0, k === 1 ? 1 : 0, k === 2 ? 1 : 0),
    );
    node.add(axis);
  });
  return node;
}

/** @param {any} node @param {import("../../state/kinematics.js").Frame | null} frame */
export function settleTriad(node, frame, com) {
  node.visible = frame !== null;
  if (frame) {
    const { origin, turn: m } = frame;
    basis.set(m[0], m[1], m[2], 0, m[3], m[4], m[5], 0, m[6], m[7], m[8], 0, 0, 0, 0, 1);
    node.quaternion.setFromRotationMatrix(basis);
    node.position.fromArray(com).applyQuaternion(node.quaternion);
    node.position.add(z.fromArray(origin));
  }
}
