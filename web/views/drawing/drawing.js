// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The mechanism: supports once, one ghost per method, the selected method opaque and on top, with
// the buttons that say what else is drawn.
import { glyphWords } from "../../state/glyphs.js";
import { lookOf } from "../../state/look.js";
import { listen, shownIndex } from "../../state/store.js";
import { h, s, say, set } from "../../widgets/dom.js";
import { createDepth } from "./depth.js";
import { createGhosts } from "./ghosts.js";
import { createHand } from "./hand.js";
import { createHandles } from "./handles.js";
import { createLengths } from "./lengths.js";
import { createLight } from "./light.js";
import { createMarks, namedPoints } from "./marks.js";
import { createMotion } from "./motion.js";
import { createNotices } from "./notices.js";
import { createStage } from "./stage.js";

/** Groups of the picture, from the lowest to the topmost. */
const LAYERS = /** @type {const} */ ([
  "fixed",
  "traces",
  "truth",
  "ghosts",
  "drag",
  "lengths",
  "tears",
  "arrows",
  "hand",
  "labels",
  "scale",
]);
/** The parts that can be drawn or left out, and the word on each button. */
const TOGGLES = { labels: "labels", traces: "paths", reference: "reference" };

/**
 * @param {HTMLElement} el
 * @param {import("../../state/store.js").Store} store
 * @param {import("../../session/session.js").Session} actions
 */
export function createDrawing(el, store, actions) {
  const data = store.data;
  /** @type {Record<typeof LAYERS[number], any>} */
  const layers = /** @type {any} */ (
    Object.fromEntries(LAYERS.map((name) => [name, s("g", { class: name })]))
  );
  const svg = s(
    "svg",
    { role: "img", "aria-labelledby": "drawing-title", tabindex: "-1", class: "picture" },
    ...Object.values(layers),
  );
  const stage = createStage(svg, layers, data);
  const ghosts = createGhosts(layers, data, stage);
  const marks = createMarks(layers, data, stage);
  const notices = createNotices(data);
  const hand = createHand(layers.hand, data, stage, actions);
  const handles = createHandles(svg, layers.drag, data, stage, actions, hand);
  const lengths = createLengths(layers.lengths, data, stage, actions);

  const toggles = Object.fromEntries(
    Object.entries(TOGGLES).map(([key, word]) => [key, makeToggle(key, word)]),
  );
  const describe = h(
    "button",
    { type: "button", class: "quiet", onclick: () => notices.describe(true) },
    "describe",
  );
  const kindOf = h("span");
  const counts = h("span", { class: "counts" });
  const caption = h("p", { class: "caption" }, kindOf, " ", counts);
  const tools = h("div", { class: "undo-tools" }, ...lengths.tools, ...hand.tools);
  const frame = h("div", { class: "stage" }, svg, notices.ahead, handles.note, tools);
  const choices = h("div", { class: "choices" }, ...Object.values(toggles), describe);
  const glyphs = h("p", { class: "glyphs" });
  const demonstrations = h(
    "div",
    { class: "demonstrations" },
    h(
      "button",
      { type: "button", class: "plain", onclick: () => actions.fallApart() },
      "let it fall apart",
    ),
    h(
      "button",
      { type: "button", class: "plain", onclick: () => actions.holdTogether() },
      "hold it together",
    ),
  );
  el.replaceChildren(
    h("div", { class: "over" }, caption, demonstrations),
    frame,
    notices.title,
    h("div", { class: "under" }, choices, glyphs),
    notices.spoken,
  );

  /** @param {string} key of the view @param {string} word */
  function makeToggle(key, word) {
    const onclick = () => actions.setView({ [key]: !data.view[key] });
    const pressed = String(data.view[key]);
    return h("button", { type: "button", class: "quiet", "aria-pressed": pressed, onclick }, word);
  }

  /** @param {number} place among the kept frames, with its fraction */
  function drawAt(place) {
    if (!data.scene || !data.history || place < 0 || !ghosts.isReady()) {
      return;
    }
    depth.draw(place);
    if (!stage.camera3) {
      ghosts.draw(place);
    }
    marks.draw(place);
    hand.draw(place);
    light.draw();
    lengths.draw();
  }

  const draw = () => drawAt(motion.place());

  /** Another frame is shown. */
  function update() {
    if (!motion.moves()) {
      draw();
    }
    notices.update(shownIndex(data));
    if (data.state !== "running" && !data.view.replaying) {
      notices.describe(); // the text that stands for the drawing follows what is shown
    }
  }

  function fit() {
    stage.fit();
    depth.fit(stage.foot);
    say(glyphs, stage.camera3 ? glyphWords(data.scene) : "");
    refit();
  }

  /** The camera has moved. */
  function refit() {
    if (data.scene) {
      stage.refresh();
      draw();
    }
  }

  function makeGhosts() {
    const [, kind, rest] = /^(.*?)(?: (\(.*))?$/s.exec(data.scene?.caption ?? "") ?? [];
    say(kindOf, kind ?? "");
    say(counts, rest ?? "");
    demonstrations.hidden = !(data.scene?.m > 0);
    const nameless = data.scene && namedPoints(data.scene).length === 0;
    set(toggles.labels, {
      "aria-disabled": nameless ? "true" : null,
      title: nameless ? "this scene has too many joints to name, or none with a name" : null,
    });
    if (data.scene) {
      ghosts.make();
      depth.make();
      draw();
    }
  }

  /** Says on the button what the reference solution is, or why there is none. */
  function makeReference() {
    const { reference: known } = data;
    const ready = known?.state === "ready";
    ghosts.makeReference();
    const digits = ready ? `${known.digits.toFixed(1)} digits to ${known.time} s` : "";
    toggles.reference.title = ready
      ? `the reference solution, grey: ${known.means.join(" and ")} agree to ${digits}`
      : (known?.reason ?? "");
    set(toggles.reference, { "aria-disabled": ready ? null : "true" });
    if (data.scene?.extremes) {
      fit(); // the motion may go farther than was known
    } else {
      draw();
    }
  }

  function showView() {
    for (const [key, button] of Object.entries(toggles)) {
      set(button, { "aria-pressed": String(data.view[key]) });
    }
    if (stage.camera.look !== lookOf(data)) {
      (stage.camera3 ? refit : fit)();
    }
    if (ghosts.isStale()) {
      makeGhosts();
    } else {
      draw();
    }
  }

  const light = createLight(svg, store, stage, () => motion.place());
  const motion = createMotion(store, drawAt);
  const depth = createDepth(frame, store, actions, stage, { refit, fit });
  const observer = new ResizeObserver(() => {
    stage.fit();
    depth.resize();
    fit();
  });
  observer.observe(frame);
  const stop = listen(store, {
    scene: () => {
      ghosts.clear();
      fit();
      notices.clear();
    },
    methods: makeGhosts,
    reactions: draw,
    drag: () => {
      handles.draw();
      lengths.draw();
    },
    hand: () => {
      handles.loseHand();
      hand.say();
      draw();
    },
    reference: makeReference,
    theme: makeGhosts,
    view: showView,
    state: () => {
      if (data.state !== "running") {
        notices.describe();
      }
    },
  });

  return {
    /** for views that draw on the picture, or ask where a pixel is */
    stage,
    frame,
    overlay: layers.labels.parentNode,
    /** The solids of a scene in space, drawn now; null: there are none. @param {number} scale */
    solids(scale) {
      draw();
      return depth.picture(motion.place(), scale);
    },
    update,
    dispose() {
      stop();
      observer.disconnect();
      motion.dispose();
      depth.dispose();
      light.dispose();
      handles.dispose();
      el.replaceChildren();
    },
  };
}
