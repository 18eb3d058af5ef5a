// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Whether the drawing is made of solids: a scene in space fetches them once, if this browser draws
// with WebGL. Until they are here, and without WebGL, the SVG draws everything.
import { sentenceOf } from "../../api/client.js";
import { loadStyle } from "../../widgets/dom.js";

/** Returns whether this browser draws with WebGL 2. */
const drawsSolids = () => Boolean(document.createElement("canvas").getContext("webgl2"));

/**
 * @param {HTMLElement} frame
 * @param {import("../../state/store.js").Store} store
 * @param {import("../../session/session.js").Session} actions
 * @param {import("./stage.js").Stage} stage
 * @param {{refit: () => void, fit: () => void}} redraw
 */
export function createDepth(frame, store, actions, stage, redraw) {
  const data = store.data;
  /** @type {import("../space/space.js").Space | null} */
  let space = null;
  let asked = false;

  async function fetchSpace() {
    try {
      const [{ createSpace }] = await Promise.all([
        import("../space/space.js"),
        loadStyle("style/space.css"),
      ]);
      space = createSpace(frame, store, actions, { size: stage.size, refit: redraw.refit });
    } catch (error) {
      actions.notice(`the view in space is not here, the flat one is: ${sentenceOf(error)}`);
    }
    if (space) {
      space.resize();
      make();
    }
  }

  /** Solids for the scene, methods, selection and theme of now. */
  function make() {
    const spatial = Boolean(data.scene?.view?.spatial);
    if (spatial && !asked) {
      asked = true;
      if (drawsSolids()) {
        fetchSpace();
      }
    }
    space?.make();
    const shows = Boolean(space?.shows);
    space?.show(shows);
    frame.classList.toggle("solid", shows);
    const before = stage.camera3;
    stage.camera3 = shows ? (space?.camera ?? null) : null;
    if (stage.camera3 !== before) {
      redraw.fit();
    }
  }

  return {
    make,
    resize: () => space?.resize(),
    /** @param {number | undefined} foot */
    fit: (foot) => space?.shows && space.fit(foot),
    /** @param {number} now index of the frame shown */
    draw(now) {
      if (space?.shows) {
        const before = space.rig.target;
        space.follow(now);
        if (space.rig.target !== before && space.rig.follow) {
          stage.refresh();
        }
        space.draw(now);
      }
    },
    /** The solids alone, or null. @param {number} now @param {number} scale */
    picture: (now, scale) => (space?.shows ? space.picture(now, scale) : null),
    dispose: () => space?.dispose(),
  };
}
