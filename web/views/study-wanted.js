// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A field for the accuracy that is wanted, and the method that reaches it for the least.
import { plain, quantity } from "../state/format.js";
import { withSetting } from "../state/spelling.js";
import { cheapestFor, rankingOf, sizeToRun, wantedError } from "../state/wanted.js";
import { listed } from "../state/verdict.js";
import { h, say } from "../widgets/dom.js";

const FIRST = "1 mm";

/** @param {import("../state/wanted.js").Reach} reach */
function sizeWords(reach) {
  const size = sizeToRun(reach);
  return reach.dot.sizeName === "h"
    ? `h = ${quantity(size, "s")}`
    : `rtol = ${plain(Number(size.toPrecision(2)))}`;
}

/**
 * @param {import("../state/store.js").Data} data
 * @param {{
 *   labelOf: (m: number) => string, costText: (cost: number) => string,
 *   onPick: (m: number, spelling: string, words: string) => void,
 * }} how
 */
export function createWanted(data, { labelOf, costText, onPick }) {
  const field = h("input", {
    type: "text",
    id: "wanted-error",
    value: FIRST,
    size: 10,
    autocomplete: "off",
    spellcheck: "false",
    oninput: () => answer(),
  });
  const said = h("p", { role: "status" });
  const run = h("button", { type: "button", class: "try", hidden: true, onclick: pick }, "run it");
  const el = h(
    "div",
    { class: "wanted" },
    h("label", { for: "wanted-error" }, "error wanted"),
    field,
    said,
    run,
  );
  /**
   * @type {{
   *   dots: import("../state/wanted.js").Dot[][], error: string, ranked: boolean,
   *   rule: import("../state/wanted.js").Rule,
   * }}
   */
  let now = { dots: [], error: "q", ranked: true, rule: { margin: 1, floor: 0 } };
  /** @type {import("../state/wanted.js").Reach | null} */
  let best = null;

  function pick() {
    if (best) {
      const { m, dot } = best;
      const size = plain(sizeToRun(best));
      const spelling = withSetting(data.catalogue, dot.spelling, dot.sizeName, size);
      onPick(m, spelling, `${labelOf(m)} runs with ${sizeWords(best)}`);
    }
  }

  /** @param {{words: string}} wanted @param {import("../state/wanted.js").Reach[]} list */
  function sentence({ words }, list) {
    const [first, next] = list;
    const others = now.dots.flatMap((dots, m) =>
      dots.length && !list.some((one) => one.m === m) ? [labelOf(m)] : [],
    );
    const without = others.length ? ` ${listed(others)}: not reached in this study.` : "";
    if (!first) {
      return `For ${words}: no run of this study is accurate enough.`;
    }
    const { close, unsteady } = rankingOf(list);
    if (close.length > 1 || unsteady || !now.ranked) {
      const shown = close.length > 1 ? close : list.slice(0, 2);
      const times = shown.map(
        (one) => `${labelOf(one.m)} with ${sizeWords(one)} ${costText(one.cost)}`,
      );
      const near = close.length > 1 ? "too close to rank" : "the halves of a timing disagree";
      const why = now.ranked ? near : "this study ranks no times";
      return `For ${words}: not ranked by time: ${listed(times)}, ${why}.${without}`;
    }
    const about = first.atMost ? "at most" : "about";
    const more = next
      ? ` Next: ${labelOf(next.m)}, ${plain(Number((next.cost / first.cost).toPrecision(3)))} times that.`
      : "";
    return `For ${words}: ${labelOf(first.m)} with ${sizeWords(first)} is the cheapest, ${about} ${costText(first.cost)}.${more}${without}`;
  }

  function answer() {
    const wanted = wantedError(field.value, now.error, data.scene.length);
    const list = wanted ? cheapestFor(now.dots, wanted.value, now.rule) : [];
    best = list[0] ?? null;
    run.hidden = best === null;
    field.toggleAttribute("aria-invalid", !wanted);
    say(
      said,
      wanted
        ? sentence(wanted, list)
        : "type an error above 0, such as 1 mm, 0.1 % or 1e-3; lengths belong to errors of position and gap",
    );
  }

  return {
    el,
    /**
     * @param {import("../state/wanted.js").Dot[][]} dots @param {string} error its name
     * @param {boolean} ranked false: the study ranks none of its times
     * @param {import("../state/wanted.js").Rule} rule by which the study's points are read
     */
    show(dots, error, ranked, rule) {
      now = { dots, error, ranked, rule };
      answer();
    },
  };
}
