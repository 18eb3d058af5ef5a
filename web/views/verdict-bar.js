// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// One line under the first screen: what is happening, the worst first. A screen reader gets the
// same words, not more often than every two seconds; methods that stop are announced at once.
import { shownIndex, listen } from "../state/store.js";
import { sentences } from "../state/verdict.js";
import { counted, seconds } from "../state/format.js";
import { beforeAndAfter, passedAt, predictionAt, stopReason } from "../state/words.js";
import { h, say } from "../widgets/dom.js";
import { paintNoMore, paintSoon } from "../widgets/pace.js";

const PAUSE = 2000; // [ms] between two things said
const PAUSE_ENDS = 1400; // [ms] sooner when someone pauses or plays

/** @param {HTMLElement} el @param {import("../state/store.js").Store} store */
export function createVerdictBar(el, store) {
  const data = store.data;
  const seen = h("div", { class: "seen", "aria-hidden": "true" });
  const live = h("p", { class: "live hidden", "aria-live": "polite", "aria-atomic": "true" });
  const banner = h("p", { class: "banner hidden", role: "alert" });
  const changed = h("summary", {});
  const others = h("ul", {});
  const changes = h("details", { class: "change", hidden: true }, changed, others);
  el.replaceChildren(changes, seen, live, banner);
  changes.addEventListener("toggle", forgetRoom);
  let saidAt = -PAUSE;
  let timer = 0;
  let tallest = 0; // [px] of the bar since the methods changed

  /** Sentences about the frame shown, with their tones. */
  function present() {
    const now = shownIndex(data);
    if (now < 0) {
      return [];
    }
    if (now === 0) {
      return [{ text: "all methods start from the same closed configuration", tone: "calm" }];
    }
    const singular = [predictionAt(data, now), passedAt(data, now)].filter(Boolean);
    return [...singular.map((text) => ({ text, tone: "warn" })), ...sentences(data, now)];
  }

  /** Why methods have stopped until the frame shown. */
  function failures() {
    const now = shownIndex(data);
    return data.methods.flatMap((method, m) => {
      const end = data.history?.ended[m];
      const reason = data.latest?.methods[m]?.reason;
      return end <= data.history?.t[now]
        ? [
            `${method.label} stopped at ${seconds(end)}${reason ? `: ${stopReason(reason, end, data.duration)}` : ""}`,
          ]
        : [];
    });
  }

  // measured when the browser has laid it out anyway: asking at any other time costs a layout
  const measure = new ResizeObserver(keepRoom);

  /** It grows with its sentences and never shrinks: what stands above moves as little as it can. */
  function keepRoom() {
    const room = el.offsetHeight;
    if (room > tallest) {
      tallest = room;
      document.documentElement.style.setProperty("--verdict-room", `${room}px`);
    }
  }

  /** Other methods, another scene, another width: other sentences. */
  function forgetRoom() {
    tallest = 0;
    document.documentElement.style.removeProperty("--verdict-room");
    measure.unobserve(el);
    measure.observe(el); // asks for its size once, also where that is the same
  }

  /** Shows the effect of a change: of the selected method in a line, of the others under it. */
  function paintChanges() {
    const { methods, view } = data;
    const all = beforeAndAfter(data, shownIndex(data));
    const own = all.findIndex((one) => one.startsWith(`${methods[view.selected]?.label} until`));
    const [first] = all.splice(Math.max(0, own), 1);
    const more = all.length > 0 ? ` (and ${counted(all.length, "method")} more)` : "";
    changes.hidden = first === undefined;
    say(changed, first === undefined ? "" : `${first}${more}`);
    if (others.dataset.text !== all.join("\n")) {
      others.dataset.text = all.join("\n");
      others.replaceChildren(...all.map((text) => h("li", {}, text)));
    }
  }

  function paint() {
    const list = present();
    const key = list.map(({ text, tone }) => tone + text).join("\n");
    if (seen.dataset.text !== key) {
      seen.dataset.text = key;
      seen.replaceChildren(
        ...list.map(({ text, tone }) => h("span", { class: "sentence", "data-tone": tone }, text)),
      );
    }
    say(banner, failures().join("; "));
    paintChanges();
  }

  function speak() {
    timer = 0;
    saidAt = performance.now();
    const text = present().map((one) => one.text);
    say(live, [...beforeAndAfter(data, shownIndex(data)), ...text].join(". "));
  }

  function update() {
    paintSoon(paint);
    if (!timer) {
      timer = window.setTimeout(speak, Math.max(0, PAUSE - (performance.now() - saidAt)));
    }
  }

  /** Something else happens now: it is said soon. @param {number} sooner [ms] */
  function hurry(sooner) {
    clearTimeout(timer);
    timer = 0;
    saidAt -= sooner;
    update();
  }

  measure.observe(el);
  addEventListener("resize", forgetRoom);
  const stop = listen(store, {
    methods: () => {
      forgetRoom();
      hurry(PAUSE);
    },
    state: () => hurry(PAUSE_ENDS),
    view: update,
    reference: update,
  });
  return {
    update,
    dispose() {
      stop();
      removeEventListener("resize", forgetRoom);
      measure.disconnect();
      clearTimeout(timer);
      paintNoMore(paint);
      el.replaceChildren();
    },
  };
}
