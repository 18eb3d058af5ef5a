// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Two plots over one clock: at first the error against the reference above, the loop gap below.
// They share the cursor, the values that are pointed at, and the zoom.
import { listen } from "../state/store.js";
import { createPlotPane } from "./plot-pane.js";

const REDRAW = 66; // [ms]
const PANES = ["upper", "lower"];

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createPlots(el, store, actions) {
  const data = store.data;
  const panes = PANES.map((id) =>
    createPlotPane(data, actions, {
      id,
      onHover: hover,
      onZoom: (zoom) => actions.setView({ zoom }),
    }),
  );
  el.replaceChildren(...panes.map(({ figure }) => figure));
  let painted = 0;
  let timer = 0;
  let run = -1;
  let scene = "";

  /** @param {number | null} t */
  function hover(t) {
    panes.forEach((pane) => pane.setHover(t));
  }

  /** @param {boolean} anew */
  function setSeries(anew) {
    panes.forEach((pane) => pane.setSeries(anew));
    painted = 0;
    update();
  }

  function paint() {
    painted = performance.now();
    panes.forEach((pane) => pane.paint());
  }

  function update() {
    const wait = REDRAW - (performance.now() - painted);
    if (wait <= 0) {
      paint();
    } else if (!timer) {
      timer = window.setTimeout(() => {
        timer = 0;
        paint();
      }, wait);
    }
  }

  const stop = listen(store, {
    methods: () => {
      if (scene !== data.scene?.id) {
        scene = data.scene?.id ?? "";
        data.view.zoom = null;
      }
      setSeries(run !== data.run);
      run = data.run;
    },
    view: () => {
      panes.forEach((pane) => pane.obey());
      setSeries(false);
    },
    theme: () => setSeries(false),
    reference: () => setSeries(false),
  });
  return {
    update,
    dispose() {
      stop();
      clearTimeout(timer);
      panes.forEach((pane) => pane.dispose());
      el.replaceChildren();
    },
  };
}
