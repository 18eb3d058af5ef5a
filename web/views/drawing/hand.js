// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The hand that pulls: its spring, the force as an arrow with its value, and the way to pull
// without a mouse.
import { quantity } from "../../state/format.js";
import { shownIndex } from "../../state/store.js";
import { h, s, say, set } from "../../widgets/dom.js";
import * as shapes from "../../widgets/shapes.js";

const LONGEST = 70; // [px] of the arrow
const STEP = 0.1; // of the scale bar: what an arrow key moves the hand by
const MOST_POINTS = 24; // of a scene without names
const FAR = 5; // steps at once with Shift
const ROOM = 14; // [px] between the hand and its words
const EDGE = 24; // [px] half the width of its words

const within = (x, least, most) => Math.min(Math.max(x, least), most);
/** By key: how far right and how far up. @type {Record<string, number[]>} */
const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/**
 * @param {SVGElement} layer
 * @param {import("../../state/store.js").Data} data
 * @param {import("./stage.js").Stage} stage
 * @param {import("../../session/session.js").Session} actions
 */
export function createHand(layer, data, stage, actions) {
  let newton = 0; // [px/N], so that the largest force since the hand took hold fits
  let madeFor = -1;
  const points = h("select", { "aria-label": "point that the hand holds" });
  const hand = h(
    "button",
    {
      type: "button",
      class: "plain",
      "data-tip": "arrow keys move the hand, with Shift five times as far; Escape lets go",
      onkeydown: onKey,
      onblur: () => actions.letGo(),
    },
    "hand: ← → ↑ ↓",
  );
  const panel = h("span", {
    class: "pull-tools",
    role: "group",
    "aria-label": "pull",
    hidden: true,
  });
  const button = h(
    "button",
    {
      type: "button",
      class: "quiet",
      "aria-pressed": "false",
      "data-tip":
        "while the methods run, drag a joint or a link: a hand pulls it by a spring with a damper. " +
        "The arrow is the force of both, so it is along the spring only at rest. This opens the " +
        "way by keys",
      onclick: () => open(panel.hidden),
    },
    "pull",
  );
  const forget = h(
    "button",
    {
      type: "button",
      class: "quiet",
      hidden: true,
      "data-tip": "the motion without the hand, from the start",
      onclick: () => actions.forgetPulls(),
    },
    "forget the pulls",
  );
  panel.append(points, hand);
  const legend = h(
    "span",
    { class: "tool-hint", hidden: true },
    "zigzag: the hand's spring; arrow: force of spring and damper",
  );

  /** @param {boolean} on */
  function open(on) {
    panel.hidden = !on;
    set(button, { "aria-pressed": String(on) });
    if (on) {
      hand.focus();
    } else {
      actions.letGo();
    }
  }

  /** Names of the points that move, for the choice. */
  function listPoints() {
    if (madeFor === data.run || !data.scene) {
      return;
    }
    madeFor = data.run;
    const { labels, shapes: drawn } = data.scene.drawing;
    const still = new Set(data.scene.ground_points);
    const ends = new Set(drawn.flatMap(({ p, q }) => [p, q]));
    const named = labels.flatMap((name, i) => (name && !still.has(i) ? [{ name, i }] : []));
    const others = labels.flatMap((_, i) =>
      ends.has(i) && !still.has(i) ? [{ name: `point ${i}`, i }] : [],
    );
    const list = named.length > 0 ? named : others.slice(0, MOST_POINTS);
    const chosen = points.value;
    points.replaceChildren(...list.map(({ name, i }) => h("option", { value: String(i) }, name)));
    if (list.some(({ i }) => String(i) === chosen)) {
      points.value = chosen;
    }
    button.hidden = list.length === 0;
  }

  /** Returns where a point is now. @param {number} point */
  function placeOf(point) {
    const all = data.history.pointsAt(data.view.selected, shownIndex(data));
    return [0, 1, 2].map((k) => all[3 * point + k]);
  }

  /** @param {KeyboardEvent} event */
  function onKey(event) {
    const way = WAYS[event.key];
    if (event.key === "Escape" && data.hand) {
      actions.letGo();
    } else if (way && data.view.replaying) {
      actions.refusePull();
    } else if (way) {
      const point = Number(points.value);
      const from = data.hand?.point === point ? data.hand.to : placeOf(point);
      const { look, scaleBar } = stage.camera;
      const step = STEP * scaleBar.metres * (event.shiftKey ? FAR : 1);
      const to = from.map((c, k) => c + step * (way[0] * look.right[k] + way[1] * look.up[k]));
      actions.show(Infinity); // the newest: what a hand does comes after it
      actions.pull(point, to);
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }

  /** @param {number} x @param {number} y @param {number} force [N] */
  const wordsAt = (x, y, force) =>
    s(
      "text",
      {
        x: within(x, EDGE, stage.size.width - EDGE).toFixed(1),
        y: (within(y, ROOM, stage.size.height - ROOM) + 4).toFixed(1),
        "text-anchor": "middle",
      },
      quantity(force, "N", 2),
    );

  return {
    tools: [button, panel, forget, legend],
    /** Whether whoever drags wants to pull, and not to set the start. */
    isOpen: () => !panel.hidden,
    /** @param {number} now index of the frame shown */
    draw(now) {
      listPoints();
      forget.hidden = !data.pulled;
      const pull = data.history.pullAt(now);
      legend.hidden = !pull;
      if (!pull) {
        layer.replaceChildren();
        newton = 0;
        return;
      }
      const all = data.history.pointsAt(data.view.selected, now);
      const force = pull.forces[data.view.selected] ?? [0, 0, 0];
      const at = stage.camera.point(all, pull.point);
      const to = stage.camera.point(pull.to, 0);
      const size = Math.hypot(...force);
      newton = Math.min(newton || Infinity, LONGEST / Math.max(size, 1e-300));
      const along = (axis) => axis[0] * force[0] + axis[1] * force[1] + axis[2] * force[2];
      const { look } = stage.camera;
      const [dx, dy] = [newton * along(look.right), -newton * along(look.up)];
      /** @type {[number, number]} */
      const tip = [at[0] + dx, at[1] + dy];
      const away = ROOM / Math.max(1, Math.hypot(dx, dy));
      layer.replaceChildren(
        s("path", { class: "hand-spring", d: shapes.spring(at, to, 4) }),
        s("path", { class: "hand-place", d: shapes.circle(to, 5) }),
        s("path", { class: "hand-force", d: shapes.arrow(at, tip) }),
        wordsAt(tip[0] + away * dx, tip[1] + away * dy, size),
      );
    },
    say() {
      const held = data.hand;
      say(hand, held ? "Escape lets go" : "hand: ← → ↑ ↓");
    },
  };
}
