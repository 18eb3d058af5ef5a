// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The mechanism as solids: what stands on the ground, one model per method, the reference solution.
// The selected method is opaque, with joints, shadows and frames; the others are ghosts.
import * as THREE from "three";
import { createKinematics } from "../../state/kinematics.js";
import { baseOf, drawnPoints, isCrowded } from "../../widgets/pieces.js";
import { makeJoints, makePins, makeTriad, settleTriad } from "./joints.js";
import { facesOf, makeSolid } from "./solids.js";

const GHOST = 0.28; // opacity
const REFERENCE = 0.4;

/** Frees what a model took of the graphics memory. @param {any} node */
export function release(node) {
  node.traverse((one) => {
    one.geometry?.dispose();
    [one.material ?? []].flat().forEach((material) => material.dispose());
  });
  node.removeFromParent();
}

/** @param {import("../../state/types.js").Scene} scene @param {number} k axis */
function extentAlong(scene, k) {
  const all = drawnPoints(scene)
    .map((i) => scene.points[3 * i + k])
    .filter(Number.isFinite);
  return all.length ? Math.max(...all) - Math.min(...all) : 0;
}

/** Half the width of a bar [m]. @param {import("../../state/types.js").Scene} scene */
export function widthOf(scene, shape = { width: 0 }) {
  const extent = Math.max(...[0, 1, 2].map((k) => extentAlong(scene, k)));
  const usual = (isCrowded(scene) ? 0.5 : 1) * Math.min(0.019 * scene.length, 0.025 * extent);
  return shape.width > 0 ? Math.min(0.5 * shape.width, 2 * usual) : usual;
}

/** Without gloss: what shines costs twice the time where the processor draws. */
const solid = (colour, opacity = 1) =>
  new THREE.MeshLambertMaterial({
    color: colour,
    transparent: opacity < 1,
    opacity,
    depthWrite: opacity === 1,
  });

/**
 * The solids of all moving bodies.
 * @param {import("../../state/types.js").Scene} scene
 * @param {{material: any, shadow: boolean, coarse: boolean, slim?: number}} how slim: part of the
 *   usual width; what coincides lies inside the thicker one
 */
function makeBodies(scene, { material, shadow, coarse, slim = 1 }) {
  const faces = facesOf(coarse);
  const group = new THREE.Group();
  const { solid: base, marks } = baseOf(scene);
  const still = new Set([...base, ...marks]);
  const places = scene.drawing.shapes.flatMap((shape) => {
    const radius = slim * widthOf(scene, shape);
    const made = still.has(shape)
      ? null
      : makeSolid(shape, scene.points, { radius, material, faces });
    if (made) {
      group.add(made.node);
    }
    return made ? [made.place] : [];
  });
  group.traverse((node) => {
    node.castShadow = shadow;
    node.receiveShadow = shadow;
  });
  return { group, place: (points) => places.forEach((place) => place(points)) };
}

/**
 * Makes the parts that stand on the ground: solids, guides, posts.
 * @param {any} floor @param {string} colour @param {boolean} coarse
 */
export function makeBase(scene, floor, colour, coarse) {
  const faces = facesOf(coarse);
  const group = new THREE.Group();
  const material = solid(colour);
  const { solid: base, marks } = baseOf(scene);
  const r = widthOf(scene);
  for (const shape of base) {
    const how = { radius: widthOf(scene, shape), material, faces };
    const made = makeSolid(shape, scene.points, how);
    made?.place(scene.points);
    if (made) {
      group.add(made.node);
    }
  }

  const at = (i) => new THREE.Vector3(...scene.points.slice(3 * i, 3 * i + 3));
  const feet = roundOrder(
    marks.filter(({ kind }) => kind === "ground").map(({ p }) => at(p)),
    floor.up,
  );
  feet.forEach((foot, i) => {
    const next = feet[(i + 1) % feet.length];
    const beam = i > 0 || feet.length > 2 ? makeBeam(foot, next, floor, r, material) : null;
    if (beam) {
      group.add(beam);
    }
  });
  for (const shape of marks) {
    if (shape.kind === "guide") {
      group.add(makeGuide(at(shape.p), at(shape.q), scene, r, material));
    } else {
      group.add(makePost(at(shape.p), floor, r, material));
    }
  }
  group.traverse((node) => {
    node.castShadow = true;
    node.receiveShadow = true;
  });
  return group;
}

/** A rail as long as the motion. */
function makeGuide(p, q, scene, r, material) {
  const along = q.clone().sub(p).normalize();
  const extremes = scene.extremes ?? scene.points;
  const reach = Array.from({ length: extremes.length / 3 }, (_, i) =>
    new THREE.Vector3(...extremes.slice(3 * i, 3 * i + 3)).sub(p).dot(along),
  ).filter(Number.isFinite);
  const [low, high] = [Math.min(...reach) - 4 * r, Math.max(...reach) + 4 * r];
  const geometry = new THREE.CylinderGeometry(0.5 * r, 0.5 * r, high - low, 10);
  const node = new THREE.Mesh(geometry, material);
  node.position.copy(p).addScaledVector(along, (low + high) / 2);
  node.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along);
  return node;
}

/** A thin post from the floor, that shows where in space a support is. */
function makePost(p, { ground, up }, r, material) {
  const height = Math.max(1e-9, p.dot(up) - ground);
  const node = new THREE.Group();
  const post = new THREE.Mesh(new THREE.CylinderGeometry(0.45 * r, 0.45 * r, height, 10), material);
  post.position.y = -height / 2;
  const foot = new THREE.Mesh(new THREE.CylinderGeometry(2.6 * r, 2.6 * r, 0.7 * r, 24), material);
  foot.position.y = -height + 0.35 * r;
  node.add(post, foot);
  node.position.copy(p);
  node.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), up);
  return node;
}

/** Points in their order round the middle, seen from above. */
function roundOrder(points, up) {
  const middle = points.reduce((sum, p) => sum.add(p), new THREE.Vector3());
  middle.divideScalar(Math.max(1, points.length));
  const x = new THREE.Vector3(1, 0, 0);
  const y = up.clone().cross(x);
  const angle = (p) => Math.atan2(p.clone().sub(middle).dot(y), p.clone().sub(middle).dot(x));
  return [...points].sort((a, b) => angle(a) - angle(b));
}

/** The ground as a link: a flat beam on the floor between two feet. */
function makeBeam(p, q, { ground, up }, r, material) {
  const down = (v) => v.clone().addScaledVector(up, ground + 0.3 * r - v.dot(up));
  const along = down(q).sub(down(p));
  if (along.length() < 1e-9) {
    return [];
  }
  const node = new THREE.Mesh(new THREE.BoxGeometry(2.4 * r, 0.5 * r, along.length()), material);
  const side = up.clone().cross(along).normalize();
  const basis = new THREE.Matrix4().makeBasis(side, up, along.clone().normalize());
  node.quaternion.setFromRotationMatrix(basis);
  node.position.copy(down(p)).addScaledVector(along, 0.5);
  return node;
}

/**
 * One method.
 * @param {import("../../state/types.js").Scene} scene
 * @param {{colour: string, selected: boolean, ink: string, pale: string, coarse: boolean}} look
 *   pale: of pins
 */
export function makeModel(scene, { colour, selected, ink, pale, coarse }) {
  const group = new THREE.Group();
  const bodies = makeBodies(scene, {
    material: solid(colour, selected ? 1 : GHOST),
    shadow: selected,
    coarse,
    slim: selected ? 1 : 0.86,
  });
  group.add(bodies.group);
  if (!selected) {
    return { group, place: (points) => bodies.place(points), showFrames() {} };
  }

  const r = widthOf(scene);
  const pin = solid(pale);
  const kinematics = createKinematics(scene);
  const joints = scene.joints?.length
    ? makeJoints(scene, r, { pin, axis: solid(ink), drive: solid(ink) }, coarse)
    : null;
  const pins = joints ? null : makePins(scene, r, pin, coarse);
  const triads = (scene.bodies ?? []).map(() => makeTriad(0.16 * scene.length));
  triads.forEach((triad) => {
    triad.userData = { hidden: true };
    group.add(triad);
  });
  [joints?.group, pins?.group].forEach((part) => {
    part?.traverse((node) => {
      node.castShadow = true;
    });
    if (part) {
      group.add(part);
    }
  });
  let framesShown = false;

  return {
    group,
    /** @param {ArrayLike<number>} points @param {ArrayLike<number>} q */
    place(points, q) {
      bodies.place(points);
      pins?.place(points);
      const frames = kinematics(q);
      joints?.place(frames);
      triads.forEach((triad, i) => {
        settleTriad(triad, framesShown ? frames[i] : null, scene.bodies[i].com);
      });
    },
    showFrames(on) {
      framesShown = on;
    },
  };
}

/** The reference solution, grey. @param {string} colour @param {boolean} coarse */
export function makeReference(scene, colour, coarse) {
  const material = solid(colour, REFERENCE);
  const bodies = makeBodies(scene, { material, shadow: false, coarse, slim: 0.72 });
  bodies.group.visible = false;
  return bodies;
}
