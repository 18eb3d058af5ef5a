// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Forces in every joint by the selected method at the time shown: a table that is asked for
// while it is open, and the choice to draw the forces as arrows.
import { quantity, seconds } from "../state/format.js";
import { markWords, sizeOf, zeroOf } from "../state/reactions.js";
import { listen } from "../state/store.js";
import { h, say, set } from "../widgets/dom.js";

const AXES = [
  { key: "world", word: "world axes", title: "x, y and z of the scene" },
  {
    key: "joint",
    word: "joint axes",
    title: "reference direction, axis × reference, axis, on the joint's parent",
  },
];
const NAMES = { world: ["x", "y", "z"], joint: ["1", "2", "3"] };
const DIGITS = 3;
const TORN = 1e-3; // of the scene's length: a gap that can be seen

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createReactions(el, store, actions) {
  const data = store.data;
  const summary = h("summary", {}, h("h2", { id: "reactions-title" }, "Forces in the joints"));
  const whose = h("p", { class: "about" });
  const arrows = h(
    "button",
    {
      type: "button",
      class: "quiet",
      "aria-pressed": "false",
      onclick: () => actions.setView({ arrows: !data.view.arrows }),
    },
    "draw as arrows",
  );
  let axes = "world";
  const frames = AXES.map(({ key, word, title }) =>
    h("button", { type: "button", class: "quiet", title, onclick: () => chooseAxes(key) }, word),
  );
  const table = h("table", { class: "numbers" });
  const along = h("table", { class: "numbers" });
  const scroll = h(
    "div",
    {
      class: "reaction-table",
      tabindex: "0",
      role: "region",
      "aria-labelledby": "reactions-title",
    },
    table,
    along,
  );
  const details = h(
    "details",
    { class: "fold reaction-panel" },
    summary,
    h("div", { class: "reaction-head" }, whose, h("div", { class: "choices" }, ...frames, arrows)),
    scroll,
  );
  el.replaceChildren(details);

  /** @param {string} key */
  function chooseAxes(key) {
    axes = key;
    show();
  }

  /** Plane mechanisms carry forces in the plane and moments about its normal. */
  function columns() {
    const spatial = Boolean(data.scene?.view?.spatial) || axes === "joint";
    const names = NAMES[axes];
    const forces = spatial ? [0, 1, 2] : [0, 1];
    const moments = spatial ? [0, 1, 2] : [2];
    return { names, forces, moments };
  }

  function head({ names, forces, moments }) {
    const cell = (text) => h("th", { scope: "col" }, text);
    return h(
      "tr",
      {},
      cell("Joint"),
      cell("Force"),
      ...forces.map((k) => cell(`F${names[k]}`)),
      ...moments.map((k) => cell(`M${names[k]}`)),
      cell("Remark"),
    );
  }

  function row(item, zero, { forces, moments }) {
    const own = axes === "joint";
    const force = own ? item.joint_force : item.force;
    const moment = own ? item.joint_moment : item.moment;
    const cell = (value, unit, least) =>
      h(
        "td",
        {},
        value === undefined ? "–" : quantity(Math.abs(value) < least ? 0 : value, unit, DIGITS),
      );
    return h(
      "tr",
      {},
      h("th", { scope: "row" }, item.name),
      cell(sizeOf(item.force), "N", zero.force),
      ...forces.map((k) => cell(force?.[k], "N", zero.force)),
      ...moments.map((k) => cell(moment?.[k], "N m", zero.moment)),
      h("td", { class: "note" }, remarkOf(item)),
    );
  }

  /**
   * A loop that has visibly opened at this joint: its halves are apart, and the force acts at two
   * places.
   * @param {import("../state/reactions.js").Reaction} item
   */
  function tornBy({ name }) {
    const { reactions, history, scene } = data;
    const loops = new Set(scene.rows.map(({ loop }) => loop));
    if (!reactions || !loops.has(name)) {
      return 0;
    }
    const gap = history.columns[reactions.method].gap[history.indexAt(reactions.t)];
    return gap > TORN * scene.length ? gap : 0;
  }

  /** The joint of a torn loop has its remark; the others carry what that loop does to them. */
  function tornWords({ mark, list }) {
    const torn = mark === "of open loops" ? [] : list.filter((item) => tornBy(item) > 0);
    return torn.length
      ? `The loop is open at ${torn.map(({ name }) => name).join(", ")}: the forces of the other joints of this loop are of a torn mechanism too.`
      : "";
  }

  /**
   * Returns what to know of a force before it is used.
   * @param {import("../state/reactions.js").Reaction} item
   */
  function remarkOf(item) {
    const gap = tornBy(item);
    const torn = `this loop is open by ${quantity(gap, "m")}: the force belongs to a mechanism that has come apart, not to this joint`;
    return [gap > 0 ? torn : "", item.determined ? "" : "one of many: constraints are dependent"]
      .filter(Boolean)
      .join("; ");
  }

  /**
   * Shows the efforts that act along coordinates and at no place: formulas, gears.
   * @param {import("../state/reactions.js").Effort[]} efforts
   */
  function showEfforts(efforts) {
    const cell = (text) => h("th", { scope: "col" }, text);
    const rows = efforts.map(({ name, kind, coordinate, unit, value, determined }) =>
      h(
        "tr",
        {},
        h("th", { scope: "row" }, name),
        h("td", {}, coordinate),
        h("td", {}, quantity(value, unit, DIGITS)),
        h("td", { class: "note" }, noteOf(kind, determined)),
      ),
    );
    along.replaceChildren(
      ...(rows.length > 0
        ? [
            h("thead", {}, h("tr", {}, cell("Formula"), cell("Along"), cell("Effort"), cell(""))),
            h("tbody", {}, ...rows),
          ]
        : []),
    );
  }

  /** @param {string} kind @param {boolean} determined */
  function noteOf(kind, determined) {
    if (!determined) {
      return "one of many: constraints are dependent";
    }
    return kind === "energies" ? "in the joint's moment or force above" : "";
  }

  function show() {
    set(arrows, { "aria-pressed": String(data.view.arrows) });
    frames.forEach((button, i) => set(button, { "aria-pressed": String(AXES[i].key === axes) }));
    const answer = data.reactions;
    if (!details.open || !answer) {
      return;
    }
    const method = data.methods[answer.method];
    if (answer.reason || !method) {
      say(whose, answer.reason);
      table.replaceChildren();
      showEfforts([]);
      return;
    }
    const when = `${method.label} at ${seconds(answer.t, data.duration)}. ${markWords(answer.mark)}${tornWords(answer)}`;
    showEfforts(answer.efforts);
    if (answer.list.length === 0) {
      say(
        whose,
        `Formulas have no joints. Generalised force of each constraint along each coordinate: ${when}`,
      );
      table.replaceChildren();
      return;
    }
    say(whose, `Force and moment of the parent body on the child body, at the joint: ${when}`);
    const shown = columns();
    const zero = zeroOf(answer.list, data.scene.length);
    table.replaceChildren(
      h("thead", {}, head(shown)),
      h("tbody", {}, ...answer.list.map((item) => row(item, zero, shown))),
    );
  }

  function follow() {
    if (details.open !== data.view.reactions) {
      actions.setView({ reactions: details.open });
    } else {
      show();
    }
  }

  details.addEventListener("toggle", follow);
  let wasOpen = data.view.reactions;
  /** Opened by a link, or by hand: then the store follows. */
  function obey() {
    if (wasOpen !== data.view.reactions) {
      wasOpen = data.view.reactions;
      details.open = wasOpen;
    }
    show();
  }

  const stop = listen(store, { reactions: show, view: obey, scene: show });
  return {
    update() {},
    dispose() {
      stop();
      el.replaceChildren();
    },
  };
}
