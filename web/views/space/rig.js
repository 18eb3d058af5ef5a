// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Where the viewer stands in space: direction from the store, and besides it zoom, place, and
// perspective. It is the camera of the drawing's SVG too, so that names and arrows fit the solids.
import { lookOf } from "../../state/look.js";
import { posesOf } from "../../state/reference.js";
import { scaleBarOf } from "../../widgets/camera.js";
import { drawnPoints } from "../../widgets/pieces.js";
import { feetOf } from "./box.js";

const HALF_ANGLE = 0.3; // [rad] half the vertical angle of view
const MARGIN = { side: 44, top: 58, bottom: 48 }; // [px]; buttons and a joint's name at the top
const STACKED = { query: "(max-width: 639.5px)", top: 96 }; // [px] two rows of buttons lie there
const ZOOM = { least: 0.1, most: 30 }; // of what fits

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/**
 * @param {import("../../state/store.js").Data} data
 * @param {{width: number, height: number}} size [px]
 */
export function createRig(data, size) {
  let target = [0, 0, 0]; // what the middle of the picture shows [m]
  let held = false; // a person has set the view: it is not fitted again
  let fitted = 1; // [m] half the height of the picture at the target, as it fits
  let zoom = 1;
  let perspective = true;
  let follow = false;
  /** @type {number[] | null} */
  let followed = null;
  let fittedFor = ""; // scene and size
  let footRoom = MARGIN.bottom; // [px] below the mechanism

  const towardOf = ({ right, up }) => [
    right[1] * up[2] - right[2] * up[1],
    right[2] * up[0] - right[0] * up[2],
    right[0] * up[1] - right[1] * up[0],
  ];
  const halfHeight = () => fitted / zoom;
  const distance = () => halfHeight() / Math.tan(HALF_ANGLE);

  /** Points that must be seen. */
  function pointsOf() {
    const { scene } = data;
    const drawn = drawnPoints(scene);
    const place = (list, i) => [...list.slice(3 * i, 3 * i + 3)];
    const far = scene.extremes ?? [];
    const poses = [scene.points, ...posesOf(data.reference)];
    return [
      ...Array.from({ length: far.length / 3 }, (_, i) => place(far, i)),
      ...feetOf(scene),
      ...poses.flatMap((points) => drawn.map((i) => place(points, i))),
    ].filter((p) => p.length === 3 && p.every(Number.isFinite));
  }

  /** Fits once for each scene and size: what a person has zoomed stays. @param {number} [foot] */
  function fitOnce(foot) {
    const known = data.reference?.state === "ready";
    const wanted = `${data.scene?.id} ${size.width} ${size.height} ${known}`;
    if (wanted !== fittedFor && size.width > 0 && size.height > 0) {
      const other = fittedFor.split(" ")[0] !== String(data.scene?.id);
      fittedFor = wanted;
      footRoom = foot ?? MARGIN.bottom;
      held &&= !other || data.view.space !== null;
      if (!held) {
        fit();
      }
    }
  }

  /** The middle of what is seen, and the height that shows all of it. */
  function fit() {
    const look = lookOf(data);
    const toward = towardOf(look);
    const axes = [look.right, look.up, toward];
    const points = pointsOf();
    if (!points.length || !(size.width * size.height > 0)) {
      return;
    }
    const seen = points.map((p) => axes.map((axis) => dot(axis, p)));
    const middle = [0, 1, 2].map((k) => {
      const along = seen.map((p) => p[k]);
      return (Math.min(...along) + Math.max(...along)) / 2;
    });
    const below = Math.min(footRoom, 0.28 * size.height);
    const above = matchMedia(STACKED.query).matches ? STACKED.top : MARGIN.top;
    const room = {
      x: Math.max(0.2, 1 - (2 * MARGIN.side) / Math.max(1, size.width)),
      y: Math.max(0.2, 1 - (above + below) / Math.max(1, size.height)),
    };
    const aspect = size.width / Math.max(1, size.height);
    const deep = perspective ? Math.tan(HALF_ANGLE) : 0;
    fitted = Math.max(
      1e-6,
      ...seen.map((p) => {
        const [x, y, z] = p.map((value, k) => value - middle[k]);
        return (
          Math.max(Math.abs(y) / room.y, Math.abs(x) / room.x / aspect) + deep * Math.max(0, z)
        );
      }),
    );
    const lift = (fitted * (below - above)) / Math.max(1, size.height);
    target = [0, 1, 2].map(
      (k) => axes.reduce((sum, axis, i) => sum + axis[k] * middle[i], 0) - lift * look.up[k],
    );
    zoom = 1;
    held = false;
    followed = null;
  }

  return {
    HALF_ANGLE,
    fit,
    /** The view as it is now, and whether a person has set it. */
    get own() {
      const camera = held ? [halfHeight(), ...target] : [];
      return { camera, perspective, follow };
    },
    /** The view stays as it is, whatever is known later. */
    hold() {
      held = true;
    },
    /** Sets the view as a person once had. @param {import("../../state/shown.js").SpaceView} wanted */
    setOwn(wanted) {
      perspective = wanted.perspective;
      follow = wanted.follow;
      fit();
      const [height, ...middle] = wanted.camera;
      if (height > 0) {
        zoom = fitted / height;
        target = middle;
        held = true;
      }
    },
    fitOnce,
    get target() {
      return target;
    },
    get perspective() {
      return perspective;
    },
    get follow() {
      return follow;
    },
    halfHeight,
    distance,
    toward: () => towardOf(lookOf(data)),
    setPerspective(on) {
      perspective = on;
    },
    setFollow(on) {
      follow = on;
      followed = null;
    },
    /** @param {number} factor above 1: nearer */
    zoomBy(factor) {
      zoom = Math.min(ZOOM.most, Math.max(ZOOM.least, zoom * factor));
      held = true;
    },
    /** The picture moves with the pointer. @param {number} dx [px] @param {number} dy [px] */
    pan(dx, dy) {
      const { right, up } = lookOf(data);
      const metres = (2 * halfHeight()) / Math.max(1, size.height);
      target = target.map((x, k) => x - metres * (dx * right[k] - dy * up[k]));
      held = true;
    },
    /** Keeps what is followed at its place in the picture. @param {number[]} place */
    track(place) {
      if (follow && followed && place.every(Number.isFinite)) {
        const before = followed;
        target = target.map((x, k) => x + place[k] - before[k]);
      }
      followed = place.every(Number.isFinite) ? place : followed;
    },
    /** The same camera for the SVG. */
    camera() {
      const look = lookOf(data);
      const toward = towardOf(look);
      const scale = size.height / 2 / halfHeight();
      const far = distance();
      return {
        scale,
        look,
        toward,
        scaleBar: scaleBarOf(scale, size.width),
        /** @param {ArrayLike<number>} points @param {number} i @returns {[number, number]} */
        point(points, i) {
          const v = [0, 1, 2].map((k) => points[3 * i + k] - target[k]);
          const nearer = perspective ? far / Math.max(0.05 * far, far - dot(toward, v)) : 1;
          return [
            size.width / 2 + dot(look.right, v) * scale * nearer,
            size.height / 2 - dot(look.up, v) * scale * nearer,
          ];
        },
      };
    },
  };
}

/** @typedef {ReturnType<typeof createRig>} Rig */
