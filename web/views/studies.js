// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The studies of what is on the page, in one dialog: a tab each, how far it is, and what comes of
// it.
import { sentenceOf } from "../api/client.js";
import { studyKinds } from "../state/catalogue.js";
import { KEYS } from "../state/keys.js";
import { listen } from "../state/store.js";
import { labelsIn, missingIn } from "../state/study-documents.js";
import { capital } from "../state/words.js";
import { h, say, set } from "../widgets/dom.js";
import { createStudyBudget } from "./study-budget.js";
import { createStudyCost } from "./study-cost.js";
import { createStudyMap } from "./study-map.js";

/** The letter that opens a kind of study, as " (key W on the page)"; "" where there is none. */
function keyOf(kind) {
  const key = KEYS.find(({ action, argument }) => action === "study" && argument === kind);
  return key ? ` (key ${key.shown} on the page)` : "";
}

/** A study that this page cannot draw: the server's report shows it. */
function createPlain() {
  const words = "This page has no picture for this study. The report has all of it.";
  return { el: h("div", {}, h("p", { class: "told" }, words)), paint() {} };
}

const TOLD_EVERY = 2000; // [ms] for those who listen

/** "12 s", "2 min" @param {number} seconds */
const span = (seconds) =>
  seconds < 90 ? `${Math.max(1, Math.ceil(seconds))} s` : `${Math.ceil(seconds / 60)} min`;

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createStudies(el, store, actions) {
  const data = store.data;
  const { studies } = actions;
  const cost = createStudyCost(store, (m, spelling, words) => {
    const spellings = data.methods.map((method) => method.spelling);
    spellings[m] = spelling;
    apply(() => actions.setMethods(spellings), words);
  });
  const map = createStudyMap(store, {
    preset: studies.preset,
    changePreset(preset) {
      actions.setView({ map: preset });
      studies.start("stability");
    },
    widen: (over) => studies.start("stability", over),
    onPick: ({ m, spelling, parameters, words }) =>
      apply(async () => {
        for (const [name, value] of Object.entries(parameters)) {
          await actions.setParameter(name, value);
        }
        const spellings = data.methods.map((method) => method.spelling);
        if (m >= 0 && spellings[m] !== spelling) {
          spellings[m] = spelling;
          await actions.setMethods(spellings);
        }
      }, words),
  });
  const budget = createStudyBudget(store, {
    show(name) {
      actions.setView({ budget: name });
      budget.paint();
    },
    judged: studies.judged,
    judge(coordinate) {
      actions.setView({ judged: coordinate });
      studies.start("budget");
    },
    split: studies.split,
    setSplit(change) {
      const scene = data.scene.id;
      actions.setView({ split: { scene, ...studies.split(), ...change } });
      studies.start("budget");
    },
  });
  /** @type {Record<string, {el: HTMLElement, paint: () => void}>} */
  const drawn = { "work-precision": cost, stability: map, budget };
  const kinds = studyKinds();
  const KINDS = kinds.map(({ name }) => name);
  const views = Object.fromEntries(KINDS.map((kind) => [kind, drawn[kind] ?? createPlain()]));
  const wordOf = (kind) => capital(kinds.find(({ name }) => name === kind)?.title ?? kind);
  const title = h("h2", { id: "studies-title" });
  const tabs = kinds.map(({ name: kind, about }) =>
    h(
      "button",
      {
        type: "button",
        role: "tab",
        class: "quiet",
        id: `tab-${kind}`,
        "aria-controls": `study-${kind}`,
        title: about + keyOf(kind),
        onclick: () => actions.setView({ study: kind }),
      },
      wordOf(kind),
    ),
  );
  const bar = h("progress", { max: 1, "aria-label": "How far the study is" });
  const state = h("span", { class: "number" });
  const spoken = h("p", { class: "hidden", role: "status" });
  const note = h("p", { class: "study-note", role: "alert" });
  const coming = h("p", { class: "about", hidden: true });
  const stop = h(
    "button",
    {
      type: "button",
      class: "plain",
      title: "what was found stays (key Escape)",
      onclick: () => studies.stop(data.view.study),
    },
    "Stop",
  );
  const goOn = h(
    "button",
    {
      type: "button",
      class: "plain",
      title: "compute what is left; what was done stays",
      onclick: () => studies.goOn(data.view.study),
    },
    "Go on",
  );
  const again = h(
    "button",
    { type: "button", class: "plain", onclick: () => studies.start(data.view.study) },
    "Run again",
  );
  const report = h("a", { class: "study-link", download: "" }, "Save as a report");
  const link = h(
    "button",
    {
      type: "button",
      class: "quiet",
      title: "copy a link that opens this study",
      onclick: () => actions.share().then(tellNotice),
    },
    "link",
  );
  const close = h(
    "button",
    { type: "button", class: "tool", "aria-label": "Close", onclick: () => dialog.close() },
    "×",
  );
  const panels = KINDS.map((kind) =>
    h(
      "div",
      {
        role: "tabpanel",
        id: `study-${kind}`,
        "aria-labelledby": `tab-${kind}`,
        class: "study-panel",
      },
      views[kind].el,
    ),
  );
  const dialog = h(
    "dialog",
    {
      class: "dialog study",
      "aria-labelledby": "studies-title",
      onclose: () => actions.setView({ study: "" }),
      oncancel: onCancel,
    },
    h("div", { class: "study-head" }, title, link, close),
    h(
      "div",
      {
        class: "study-tabs",
        role: "tablist",
        "aria-labelledby": "studies-title",
        onkeydown: onTabKey,
      },
      ...tabs,
    ),
    h("div", { class: "study-run" }, bar, state, stop, goOn, again, report),
    coming,
    note,
    spoken,
    ...panels,
  );
  el.append(dialog);
  let told = 0;
  let toldOf = ""; // the kind and state that were told last
  let present = ""; // the kind that is shown

  /** @param {KeyboardEvent} event */
  function onTabKey(event) {
    const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (by) {
      event.preventDefault();
      const n = KINDS.length;
      const next = (KINDS.findIndex((kind) => kind === data.view.study) + by + n) % n;
      actions.setView({ study: KINDS[next] });
      tabs[next].focus();
    }
  }

  /**
   * Escape stops a study that runs, and what it has found stays; then it closes.
   * @param {Event} event
   */
  function onCancel(event) {
    const kind = data.view.study;
    if (event.target === dialog && data.studies[kind]?.state === "running") {
      event.preventDefault();
      studies.stop(kind);
      say(note, "Stopped; what was found stays. Escape closes the studies.");
    }
  }

  const tellNotice = () => say(note, data.notice);

  /** A change of what is on the page, told here because the page lies behind. */
  async function apply(change, words) {
    try {
      await change();
      map.mark();
      showRun();
      say(note, `${words} on the page now.`);
    } catch (error) {
      say(note, sentenceOf(error));
    }
  }

  /** @param {string} kind */
  function open(kind) {
    if (!data.scene) {
      return;
    }
    present = kind;
    if (!dialog.open) {
      dialog.showModal();
      tabs[KINDS.findIndex((one) => one === kind)].focus();
    }
    say(title, `Studies: ${data.scene.title}`);
    tabs.forEach((tab, i) =>
      set(tab, {
        "aria-selected": String(KINDS[i] === kind),
        tabindex: KINDS[i] === kind ? 0 : -1,
      }),
    );
    panels.forEach((panel, i) => (panel.hidden = KINDS[i] !== kind));
    say(note, "");
    if (
      data.studies[kind].state === "none" ||
      (data.studies[kind].state !== "running" && !studies.isPresent(kind))
    ) {
      studies.start(kind);
    }
    show();
  }

  /** Text that stands while a study runs that has nothing to show yet. */
  const COMING = {
    "work-precision":
      "Every method runs with a row of steps. The picture comes when all have run; Stop shows those that have.",
    stability: "Every cell of the map is a run. The map fills in as they end.",
    budget:
      "Every method runs several times, so that the sources of its error can be told apart. The bars come when all have run.",
  };

  function stateWords({ state: now, progress, left, elapsed, reason, document }) {
    if (now === "running") {
      return `${Math.round(100 * progress)} %${left === null ? "" : `, ${span(left)} left at most`}`;
    }
    const missing = document ? missingIn(document, labelsIn(document, data.methods)) : "";
    return now === "finished"
      ? `done in ${span(elapsed)}`
      : missing
        ? `${reason}; left out: ${missing}`
        : reason;
  }

  function showRun() {
    const kind = data.view.study;
    const study = data.studies[kind];
    if (!study) {
      return;
    }
    const runs = study.state === "running";
    const words = stateWords(study);
    bar.hidden = stop.hidden = !runs;
    bar.value = study.progress;
    again.hidden = runs;
    goOn.hidden = !studies.canGoOn(kind);
    report.hidden = !study.report;
    set(report, { href: study.report || null });
    const old =
      !runs && study.document && !studies.isPresent(kind)
        ? " – of the methods and parameters before the last change"
        : "";
    say(state, words + old);
    state.dataset.kind = study.state === "failed" ? "error" : "";
    coming.hidden = !runs || Boolean(study.document);
    say(coming, coming.hidden ? "" : COMING[kind]);
    const of = `${kind} ${study.state}`;
    if (!runs || of !== toldOf || Date.now() - told > TOLD_EVERY) {
      told = Date.now();
      toldOf = of;
      say(spoken, `${wordOf(kind)}: ${words}`);
    }
  }

  function show() {
    const kind = data.view.study;
    if (kind && dialog.open) {
      showRun();
      const has = Boolean(data.studies[kind].document);
      views[kind].el.classList.toggle("waiting", !has);
      views[kind].paint();
    }
  }

  let width = 0;
  const observer = new ResizeObserver(() => {
    if (dialog.open && dialog.clientWidth !== width) {
      width = dialog.clientWidth;
      show();
    }
  });
  observer.observe(dialog);
  const stopListening = listen(store, {
    study: (kind) => {
      if (kind === data.view.study && data.studies[kind].state === "running") {
        showRun();
        views[kind].el.classList.toggle("waiting", !data.studies[kind].document);
      } else if (kind === data.view.study) {
        show();
      }
    },
    theme: show,
    view: () => {
      if (data.view.study && (!dialog.open || data.view.study !== present)) {
        open(data.view.study);
      } else if (!data.view.study && dialog.open) {
        dialog.close();
      }
    },
  });
  return {
    open,
    update() {},
    dispose() {
      stopListening();
      observer.disconnect();
      dialog.remove();
    },
  };
}
