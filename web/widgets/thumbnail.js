// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A small picture of a scene at its start.
import { FRONT } from "../state/look.js";
import { boxAround, createCamera, seenBox } from "./camera.js";
import { s } from "./dom.js";
import { baseOf, createPen, drawnPoints, piecesOf } from "./pieces.js";

const SIZE = { width: 360, height: 220 };

/** @param {import("../state/types.js").Scene} scene */
export function makeThumbnail(scene) {
  const look = scene.view?.spatial ? scene.view : FRONT;
  const drawn = drawnPoints(scene).flatMap((i) => scene.points.slice(3 * i, 3 * i + 3));
  const box = drawn.length && drawn.every(Number.isFinite) ? seenBox(drawn, look) : null;
  const camera = createCamera(
    box ?? boxAround(scene.envelope, scene.points),
    SIZE.width,
    SIZE.height,
    look,
    32,
  );
  const pen = createPen({ ...scene, extremes: undefined }, camera, SIZE);
  const { solid, marks } = baseOf(scene);
  const path = (name, d) => s("path", { class: name, d });
  const pieces = piecesOf(scene, scene.view?.spatial ? "alone" : "bodies");
  const sorted = scene.view?.spatial
    ? [...pieces].sort((a, b) => pen.depth(a, scene.points) - pen.depth(b, scene.points))
    : pieces;
  return s(
    "svg",
    {
      viewBox: `0 0 ${SIZE.width} ${SIZE.height}`,
      class: "picture thumbnail",
      "aria-hidden": "true",
    },
    ...marks.map((shape) => path(shape.kind, pen.mark(shape, scene.points))),
    path("base", solid.map((shape) => pen.outline(shape, scene.points)).join("")),
    s(
      "g",
      { class: "ghost slot-0 selected" },
      ...sorted.map(({ layer, shapes }) =>
        path(layer, shapes.map((shape) => pen.outline(shape, scene.points)).join("")),
      ),
    ),
  );
}
