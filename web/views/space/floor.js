// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Light, and the ground below the motion: a grid of known width that takes shadows.
import * as THREE from "three";
import { niceBelow } from "../../state/format.js";

const SHADOW_PIXELS = 1024;

/**
 * Returns what shows shadows alone, just above the grid: all of it is drawn, even where none falls.
 */
function makeSheet(width, radius, dark) {
  const sheet = new THREE.Mesh(
    new THREE.PlaneGeometry(width, width),
    new THREE.ShadowMaterial({ opacity: dark ? 0.5 : 0.22 }),
  );
  sheet.rotation.x = -Math.PI / 2;
  sheet.position.y = 1e-3 * radius;
  sheet.receiveShadow = true;
  return sheet;
}

/**
 * @param {ReturnType<typeof import("./box.js").boxOf>} box of the motion
 * @param {{line: string, dark: boolean, shadows: boolean}} look
 */
export function makeFloor({ low, high, radius, vertical, ground }, { line, dark, shadows }) {
  const group = new THREE.Group();
  const middle = low.map((x, k) => (x + high[k]) / 2);
  const up = new THREE.Vector3().setComponent(vertical, 1);

  const cell = niceBelow(radius / 2.5);
  const cells = 2 * Math.ceil((1.9 * radius) / cell);
  const grid = new THREE.GridHelper(cells * cell, cells, line, line);
  grid.material.transparent = true;
  grid.material.opacity = dark ? 0.75 : 0.9;
  const floor = new THREE.Group();
  floor.add(grid);
  if (shadows) {
    floor.add(makeSheet(cells * cell, radius, dark));
  }
  floor.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), up);
  floor.position.set(
    ...middle.map((x, k) => (k === vertical ? ground : Math.round(x / cell) * cell)),
  );
  group.add(floor);

  const sky = new THREE.HemisphereLight(0xffffff, dark ? 0x30363d : 0xb9bdb8, dark ? 1.7 : 2.1);
  sky.position.copy(up);
  const sun = new THREE.DirectionalLight(0xffffff, dark ? 1.9 : 1.7);
  const aside = new THREE.Vector3(-0.45, 0, 0.5);
  if (vertical === 2) {
    aside.set(-0.45, -0.5, 0);
  }
  sun.position
    .set(...middle)
    .addScaledVector(up, 3 * radius)
    .addScaledVector(aside, 3 * radius);
  sun.target.position.set(...middle);
  sun.castShadow = shadows;
  sun.shadow.mapSize.set(SHADOW_PIXELS, SHADOW_PIXELS);
  Object.assign(sun.shadow.camera, {
    left: -1.7 * radius,
    right: 1.7 * radius,
    top: 1.7 * radius,
    bottom: -1.7 * radius,
    near: 0.1 * radius,
    far: 9 * radius,
  });
  sun.shadow.bias = -1e-3;
  sun.shadow.normalBias = 0.004 * radius;
  group.add(sky, sun, sun.target);

  return { group, cell, ground, up, sun };
}
