// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The frame of the drawing: camera, pen, and what changes only with the scene and the size.
import { quantity } from "../../state/format.js";
import { lookOf } from "../../state/look.js";
import { posesOf } from "../../state/reference.js";
import { boxAround, createCamera, seenBox } from "../../widgets/camera.js";
import { s, set } from "../../widgets/dom.js";
import { createNamePlaces } from "../../widgets/name-places.js";
import { baseOf, createPen, drawnPoints } from "../../widgets/pieces.js";

const GLASS_ROOM = 104; // [px] for the magnified cut joint, below the mechanism
const TOOLS_ROOM = 52; // [px] for the buttons over the drawing, and half a joint below them

/**
 * @param {SVGSVGElement} svg
 * @param {{fixed: SVGElement, scale: SVGElement}} layers
 * @param {import("../../state/store.js").Data} data
 */
export function createStage(svg, layers, data) {
  const size = { width: 0, height: 0 };
  const stage = {
    size,
    camera: createCamera([-1, -1, 1, 1], 100, 100),
    /** null until a scene is there @type {ReturnType<typeof createPen>} */
    pen: /** @type {any} */ (null),
    places: createNamePlaces({ width: 100, height: 100 }),
    /** makes the camera of a view in space; null: the flat one is used
     * @type {(() => ReturnType<typeof createCamera>) | null} */
    camera3: null,
    /** [px] room below the mechanism */
    foot: /** @type {number | undefined} */ (undefined),
    fit,
    refresh,
  };

  /** Supports and guides, that never move. @param {number[]} points */
  function drawFixed(points) {
    const { solid, marks } = baseOf(data.scene);
    const base = solid.map((shape) => stage.pen.outline(shape, points)).join("");
    layers.fixed.replaceChildren(
      ...marks.map((shape) => s("path", { d: stage.pen.mark(shape, points), class: shape.kind })),
      s("path", { d: base, class: "base" }),
    );
  }

  function drawScale() {
    const { pixels, metres } = stage.camera.scaleBar;
    const x = 20;
    const y = size.height - 16;
    const middle = { x: x + pixels / 2, y: y - 7, "text-anchor": "middle" };
    layers.scale.replaceChildren(
      s("path", { d: `M${x} ${y - 5}V${y}H${(x + pixels).toFixed(2)}V${y - 5}` }),
      s("text", middle, quantity(metres, "m", 1)),
    );
  }

  /** The camera that shows the whole motion of the scene in the present size. */
  function fit() {
    size.width = svg.clientWidth;
    size.height = svg.clientHeight;
    set(svg, { viewBox: `0 0 ${size.width || 100} ${size.height || 100}` });
    if (!data.scene) {
      return;
    }

    stage.foot = data.scene.drawing.tears.length > 0 ? GLASS_ROOM : undefined;
    refresh();
  }

  /**
   * Points in space that must be seen: the extremes, and what the reference solution reaches.
   * @param {number[]} extremes
   */
  function farthest(extremes) {
    const drawn = drawnPoints(data.scene);
    const place = (points) => drawn.flatMap((i) => [...points.slice(3 * i, 3 * i + 3)]);
    return [...extremes, ...posesOf(data.reference).flatMap(place)];
  }

  function makeFlatCamera() {
    const from = lookOf(data);
    const box = data.scene.extremes
      ? seenBox(farthest(data.scene.extremes), from)
      : boxAround(data.scene.envelope, data.scene.points);
    return createCamera(box, size.width, size.height, from, stage.foot, TOOLS_ROOM);
  }

  /** Camera and pen of now, and what they draw once. */
  function refresh() {
    stage.camera = stage.camera3 ? stage.camera3() : makeFlatCamera();
    stage.pen = createPen(data.scene, stage.camera, size);
    stage.places = createNamePlaces(size);

    drawFixed(data.scene.points);
    drawScale();
  }

  return stage;
}

/** @typedef {ReturnType<typeof createStage>} Stage */
