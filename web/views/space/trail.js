// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The way of a point as a tube. Rings are added as the recording grows; scrubbing only changes how
// many of them are drawn.
import * as THREE from "three";

const AROUND = 6;
const MOST = 4000; // rings

/**
 * @param {number} radius [m]
 * @param {any} material
 */
export function createTrail(radius, material) {
  const geometry = new THREE.BufferGeometry();
  const places = new THREE.BufferAttribute(new Float32Array(3 * AROUND * MOST), 3);
  const normals = new THREE.BufferAttribute(new Float32Array(3 * AROUND * MOST), 3);
  const index = new Uint32Array(6 * AROUND * (MOST - 1));
  for (let i = 0, at = 0; i < MOST - 1; i++) {
    for (let k = 0; k < AROUND; k++) {
      const [a, b] = [AROUND * i + k, AROUND * i + ((k + 1) % AROUND)];
      index.set([a, b, a + AROUND, b, b + AROUND, a + AROUND], at);
      at += 6;
    }
  }
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  geometry.setAttribute("position", places);
  geometry.setAttribute("normal", normals);
  const node = new THREE.Mesh(geometry, material);
  node.frustumCulled = false;
  let built = 0;
  let builtFor = "";

  const here = new THREE.Vector3();
  const before = new THREE.Vector3();
  const next = new THREE.Vector3();
  const forward = new THREE.Vector3();
  const side = new THREE.Vector3(1, 0, 0);
  const other = new THREE.Vector3();
  const out = new THREE.Vector3();

  /** A ring of corners round a place; its normal turns as little as it can. */
  function putRing(i, placeAt) {
    placeAt(here, i);
    placeAt(before, Math.max(0, i - 1));
    placeAt(next, i + 1);
    forward.subVectors(next, before);
    if (!(forward.lengthSq() > 0)) {
      forward.set(0, 0, 1);
    }
    forward.normalize();
    side.addScaledVector(forward, -side.dot(forward));
    if (!(side.lengthSq() > 1e-6)) {
      side.set(forward.y, forward.z, forward.x).addScaledVector(forward, -0.5);
    }
    side.normalize();
    other.crossVectors(forward, side);
    for (let k = 0; k < AROUND; k++) {
      const angle = (2 * Math.PI * k) / AROUND;
      out.copy(side).multiplyScalar(Math.cos(angle)).addScaledVector(other, Math.sin(angle));
      out.toArray(normals.array, 3 * (AROUND * i + k));
      out
        .multiplyScalar(radius)
        .add(here)
        .toArray(places.array, 3 * (AROUND * i + k));
    }
  }

  return {
    node,
    /**
     * @param {string} key another key: another recording
     * @param {number} count frames that are there
     * @param {number} now the last one that is drawn
     * @param {(i: number) => ArrayLike<number>} placeOf x, y, z of a frame
     */
    draw(key, count, now, placeOf) {
      const skip = Math.max(1, Math.ceil(count / MOST));
      const wanted = Math.floor((count - 1) / skip);
      const made = `${key} ${skip}`;
      if (made !== builtFor || wanted < built) {
        built = 0;
        builtFor = made;
      }
      const placeAt = (v, i) => {
        const place = placeOf(Math.min(count - 1, skip * i));
        return v.set(place[0], place[1], place[2]);
      };
      if (built < wanted) {
        // the last ring was made without its successor
        for (let i = Math.max(0, built - 1); i <= wanted && i < MOST; i++) {
          putRing(i, placeAt);
        }
        built = wanted;
        places.needsUpdate = true;
        normals.needsUpdate = true;
      }
      geometry.setDrawRange(0, 6 * AROUND * Math.max(0, Math.min(built, Math.floor(now / skip))));
    },
    dispose: () => geometry.dispose(),
  };
}
