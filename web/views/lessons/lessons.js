// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Lessons beside the drawing: text with set formulas, exhibits that run in the page, predictions,
// exercises. The page makes room for them; what was read and solved is kept in this browser.
import { sentenceOf } from "../../api/client.js";
import { documents } from "../../api/documents.js";
import { lessonAddress } from "../../state/link.js";
import { createProgress } from "../../state/progress.js";
import { lessonOf } from "../../state/shown.js";
import { h, loadStyle } from "../../widgets/dom.js";
import { hasMath, make, wordsOf } from "./blocks.js";
import { createExercise, openExercises } from "./exercise.js";
import { makeExhibit, makePrediction, makeSlip } from "./live.js";

const KATEX_STYLE = "vendor/katex/katex.min.css";

/**
 * @param {HTMLElement} el
 * @param {import("../../state/store.js").Store} store
 * @param {import("../../session/session.js").Session} actions
 */
export function createLessons(el, store, actions) {
  const data = store.data;
  const progress = createProgress();
  /** @type {Map<string, string>} */
  const titles = new Map();
  let katex = null;
  let shown = "";
  let isOpen = false;
  /** what is made when it is first seen @type {Map<Element, () => Promise<void> | void>} */
  const waiting = new Map();

  const menu = h("select", {
    id: "lesson",
    "aria-label": "Lesson",
    onchange: () => actions.setView({ lesson: menu.value }),
  });
  const text = h("article", {
    class: "lesson-text",
    tabindex: "0",
    "aria-label": "Text of the lesson",
  });
  const button = (word, tip, onclick) =>
    h("button", { type: "button", class: "quiet", "data-tip": tip, onclick }, word);
  const back = button("previous", "the lesson before this one", () => move(-1));
  const next = button("next", "the lesson after this one", () => move(1));
  const panel = h(
    "section",
    { class: "lesson-panel", "aria-label": "Lessons", hidden: true },
    h(
      "div",
      { class: "card-head" },
      menu,
      h(
        "div",
        { class: "choices" },
        back,
        next,
        button("print", "this lesson on paper", putOnPaper),
        button("close", "back to the page", close),
      ),
    ),
    text,
  );
  el.append(panel);
  const watcher = new IntersectionObserver(
    (entries) => {
      for (const { target, isIntersecting } of entries) {
        if (isIntersecting) {
          waiting.get(target)?.();
          waiting.delete(target);
          watcher.unobserve(target);
        }
      }
    },
    { root: text, rootMargin: "200px" },
  );

  /** Paper needs the pictures that nobody has seen yet as well. */
  async function drawAll() {
    const pictures = [...waiting].filter(([node]) => node.matches(".exhibit-picture"));
    for (const [node] of pictures) {
      waiting.delete(node);
      watcher.unobserve(node);
    }
    const images = [...text.querySelectorAll("img")];
    images.forEach((image) => (image.loading = "eager"));
    await Promise.allSettled([
      ...pictures.map(([, act]) => act()),
      ...images.map((image) => image.decode()),
    ]);
  }

  /** Nothing stays folded or undrawn on paper; what was opened for it is closed again. */
  async function prepare() {
    const { filled, close } = openExercises(text);
    addEventListener("afterprint", close, { once: true });
    await filled;
    await drawAll();
  }

  async function putOnPaper() {
    await prepare();
    print();
  }

  /** @param {Element} node @param {() => Promise<void> | void} act */
  function whenSeen(node, act) {
    waiting.set(node, act);
    watcher.observe(node);
  }

  function fillMenu() {
    menu.replaceChildren(
      ...data.lessons.map(({ id, title, problems = [] }, i) => {
        const solved = problems.filter((one) => progress.solved(one)?.score > 0).length;
        const marks = [
          progress.isRead(id) ? "read" : "",
          solved ? `${solved} of ${problems.length} exercises` : "",
        ].filter(Boolean);
        const name = title.replace(/^\d+\. /, ""); // a title may hold its number already
        const words = `${i + 1}. ${name}${marks.length ? ` (${marks.join(", ")})` : ""}`;
        return h("option", { value: id }, words);
      }),
    );
    menu.value = shown;
  }

  const placeOf = (id) => data.lessons.findIndex((one) => one.id === id);

  /** @param {number} by */
  function move(by) {
    const to = data.lessons[placeOf(shown) + by];
    if (to) {
      actions.setView({ lesson: to.id });
    }
  }

  /** @param {any} lesson */
  function kitOf(lesson) {
    let questions = 0;
    let exhibits = 0;
    const kit = {
      katex,
      picture: (src) => documents.pictureAddress(lesson.id, src),
      live: {
        exhibit: (block) => makeExhibit(block, kit, actions, { number: ++exhibits, whenSeen }),
        predict: (block) => {
          const k = questions++;
          return makePrediction(block, kit, {
            number: k,
            made: progress.predicted(lesson.id, k),
            choose: (choice) => progress.setPredicted(lesson.id, k, choice),
          });
        },
        slip: (block) => makeSlip(block, kit),
        exercise: (block) => exercise(block.id, make(block.children, kit)),
      },
    };
    return kit;
  }

  /** @param {string} id @param {Node[]} about */
  const exercise = (id, about) =>
    createExercise({ id, title: titles.get(id), about, progress, changed: fillMenu });

  /** Titles of all exercises, asked for once; without them an exercise shows its name alone. */
  async function learnTitles() {
    if (titles.size) {
      return;
    }
    try {
      const { problems } = await documents.problems();
      problems.forEach(({ id, title }) => titles.set(id, title));
    } catch {
      // each exercise still says its title when it is opened
    }
  }

  /** @param {string} id */
  async function show(id) {
    shown = id;
    fillMenu();
    back.disabled = placeOf(id) <= 0;
    next.disabled = placeOf(id) === data.lessons.length - 1;
    try {
      const [lesson] = await Promise.all([documents.lesson(id), learnTitles()]);
      if (!katex && lesson.blocks.some(hasMath)) {
        const [library] = await Promise.all([import("katex"), loadStyle(KATEX_STYLE)]);
        katex = library.default;
      }
      if (id === shown) {
        fill(lesson);
      }
    } catch (error) {
      text.replaceChildren(h("p", { class: "hint" }, sentenceOf(error)));
    }
  }

  /** Ids of exercises that the text itself names. @param {any[]} blocks @returns {string[]} */
  const named = (blocks) =>
    blocks.flatMap(({ kind, id, children = [] }) => (kind === "exercise" ? [id] : named(children)));

  /** @param {any} lesson */
  function fill(lesson) {
    watcher.disconnect();
    waiting.clear();
    const inText = named(lesson.blocks);
    const others = lesson.problems.filter((id) => !inText.includes(id));
    const end = h("p", { class: "about" });
    text.replaceChildren(
      ...make(lesson.blocks, kitOf(lesson)),
      ...(others.length ? [h("h3", {}, "Exercises"), ...others.map((id) => exercise(id, []))] : []),
      end,
    );
    const following = data.lessons[placeOf(lesson.id) + 1];
    end.replaceChildren(
      ...(following
        ? [
            "The end of this lesson. Next: ",
            h("a", { href: `#${lessonAddress(following.id)}` }, following.title),
          ]
        : ["The end of the last lesson."]),
    );
    text.scrollTop = 0;
    text.setAttribute("aria-label", wordsOf(lesson.blocks.slice(0, 1)) || lesson.title);
    whenSeen(end, () => {
      progress.setRead(lesson.id);
      fillMenu();
    });
  }

  function close() {
    actions.setView({ panel: "" });
  }

  /** Opens or closes as the view says; the lesson is the one it names, or that of the scene. */
  function obey() {
    const wanted = data.view.panel === "lessons";
    if (wanted !== isOpen) {
      isOpen = wanted;
      panel.hidden = !wanted;
      document.body.classList.toggle("reads", wanted);
      (wanted ? text : document.getElementById("play"))?.focus({ preventScroll: true });
    }
    if (!wanted) {
      return;
    }
    const id = lessonOf(data);
    if (id !== shown) {
      show(id);
    }
    data.view.lesson = id;
  }

  panel.addEventListener("keydown", (event) => {
    if (event.key === "Escape") {
      close();
    }
  });

  addEventListener("beforeprint", () => isOpen && prepare()); // asked for by the browser's own menu
  store.on("view", obey);
  return { open: obey };
}
