// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The moving mechanism: one ghost per method, the selected one opaque and on top, and the reference
// solution in grey beneath them.
import { referenceAt } from "../../state/reference.js";
import { s, set } from "../../widgets/dom.js";
import { isCrowded, piecesOf } from "../../widgets/pieces.js";

/**
 * @typedef {ReturnType<typeof piecesOf>[number] & {path: SVGElement}} Drawn a piece and its path
 * @typedef {{group: SVGElement, pieces: Drawn[], sorted: boolean}} Ghost sorted: by depth
 */

/**
 * @param {{ghosts: SVGElement, truth: SVGElement}} layers
 * @param {import("../../state/store.js").Data} data
 * @param {import("./stage.js").Stage} stage
 */
export function createGhosts(layers, data, stage) {
  /** @type {Ghost[]} */
  let ghosts = [];
  /** @type {Drawn[]} */
  let truth = [];
  let drawnFor = ""; // selection and hidden methods, as they were when the ghosts were made
  const viewKey = () => JSON.stringify([data.view.selected, ...data.view.hidden]);

  /**
   * The selected method in pieces that cover each other, any other in one path per layer.
   * @param {number} m
   * @returns {Ghost}
   */
  function makeGhost(m) {
    const method = data.methods[m];
    const selected = m === data.view.selected;
    const inSpace = Boolean(data.scene.view?.spatial);
    const how = !selected || isCrowded(data.scene) ? "together" : inSpace ? "alone" : "bodies";
    const dash = data.look.slots[method.slot].dash.join(" ");

    const pieces = piecesOf(data.scene, how).map((piece) => ({
      ...piece,
      path: s("path", {
        class: piece.layer,
        "stroke-dasharray": (!selected && piece.layer === "outline" && dash) || null,
      }),
    }));
    const name = `ghost slot-${method.slot}${selected ? " selected" : ""}`;
    const group = s("g", { class: name }, ...pieces.map(({ path }) => path));
    return { group, pieces, sorted: how === "alone" };
  }

  /**
   * Sorts pieces: those farther away come first.
   * @param {Ghost} ghost @param {ArrayLike<number>} points
   */
  function sortPieces(ghost, points) {
    const depths = new Map(ghost.pieces.map((piece) => [piece, stage.pen.depth(piece, points)]));
    const order = [...ghost.pieces].sort((a, b) => Number(depths.get(a)) - Number(depths.get(b)));
    if (order.some((piece, i) => ghost.group.childNodes[i] !== piece.path)) {
      ghost.group.replaceChildren(...order.map(({ path }) => path));
    }
  }

  /** @param {Drawn[]} pieces @param {ArrayLike<number>} points */
  function drawPieces(pieces, points) {
    for (const { shapes, path } of pieces) {
      set(path, { d: shapes.map((shape) => stage.pen.outline(shape, points)).join("") });
    }
  }

  /** @param {number} now place among the kept frames */
  function drawReference(now) {
    const { reference, history, view } = data;
    const points = view.reference ? referenceAt(reference, history.frameAt(now)) : null;
    const pieces = points ? truth : [];
    if (layers.truth.childElementCount !== pieces.length) {
      layers.truth.replaceChildren(...pieces.map(({ path }) => path));
    }
    if (points) {
      drawPieces(pieces, points);
    }
  }

  return {
    /** The ghosts belong to the methods and the selection of now. */
    isReady: () => ghosts.length === data.methods.length,
    isStale: () => drawnFor !== viewKey(),
    /** Forgets them: the scene is another one, its methods follow. */
    clear() {
      ghosts = [];
    },
    make() {
      ghosts = data.methods.map((_, m) => makeGhost(m));
      const shown = data.methods.map((_, m) => m).filter((m) => !data.view.hidden.has(m));
      const isSelected = (m) => Number(m === data.view.selected);
      const order = shown.sort((a, b) => isSelected(a) - isSelected(b));
      layers.ghosts.replaceChildren(...order.map((m) => ghosts[m].group));
      drawnFor = viewKey();
    },
    /** Paths for the reference solution, once it is known. */
    makeReference() {
      const known = data.reference?.state === "ready" && data.scene;
      truth = (known ? piecesOf(data.scene, "together") : []).map((piece) => ({
        ...piece,
        path: s("path", { class: piece.layer }),
      }));
      layers.truth.replaceChildren();
    },
    /** @param {number} now place among the kept frames, with its fraction */
    draw(now) {
      ghosts.forEach((ghost, m) => {
        if (ghost.group.parentNode) {
          const points = data.history.pointsAt(m, now);
          drawPieces(ghost.pieces, points);
          if (ghost.sorted) {
            sortPieces(ghost, points);
          }
          ghost.group.classList.toggle(
            "ended",
            data.history.ended[m] <= data.history.t[Math.floor(now)],
          );
        }
      });
      drawReference(now);
    },
  };
}
