// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The name, the scene menu, and the buttons for studies, links, exports, theme and help.
import { sentenceOf } from "../api/client.js";
import { listen } from "../state/store.js";
import { h } from "../widgets/dom.js";

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 * @param {{toggleTheme: () => void, openKeys: () => void, openStudy: (kind: string) => void,
 *   openExport: () => void, openGuide: () => void, openGallery: () => void,
 *   openEditor: () => void, openLessons: () => void}} open
 */
export function createHeader(el, store, actions, open) {
  const data = store.data;
  const menu = h(
    "select",
    { id: "scene", onchange: load, disabled: true },
    h("option", {}, "four-bar"),
  );
  const button = (word, tip, onclick) =>
    h("button", { type: "button", class: "quiet", "data-tip": tip, onclick }, word);
  const theme = button("dark", "", open.toggleTheme);
  const about = h("p", { class: "about scene-about" });
  el.append(
    h(
      "div",
      { class: "scene-pick" },
      h("label", { for: "scene" }, "Scene"),
      menu,
      button("gallery", "all scenes with pictures", open.openGallery),
      button("edit", "this scene as a document; build with the mouse; open a file", () =>
        open.openEditor(),
      ),
    ),
    about,
    h(
      "div",
      { class: "choices" },
      button("lessons", "the lesson of this scene; its menu lists all", open.openLessons),
      button(
        "studies",
        "what accuracy costs (W), where steps are stable (B), where the error comes from (E)",
        () => open.openStudy("work-precision"),
      ),
      button("link", "copy a link to what is shown (L)", () => actions.share()),
      button("export", "save the recording as data or the drawing as a picture", open.openExport),
      button("guide", "the first minute, step by step", open.openGuide),
      theme,
      button("keys", "all keys of the page (F1)", open.openKeys),
    ),
  );

  async function load() {
    const wanted = menu.value;
    try {
      await actions.loadScene(wanted);
    } catch (error) {
      menu.value = data.scene?.id ?? menu.value;
      actions.notice(sentenceOf(error));
    }
  }

  function fill() {
    const option = ({ id, title }) => h("option", { value: id }, title);
    const groups = data.lessons.map(({ title, scenes }) =>
      h(
        "optgroup",
        { label: title },
        ...data.scenes.filter(({ id }) => scenes.includes(id)).map(option),
      ),
    );
    const placed = new Set(data.lessons.flatMap(({ scenes }) => scenes));
    const others = data.scenes.filter(({ id }) => !placed.has(id)).map(option);
    menu.replaceChildren(
      ...groups.filter((group) => group.childElementCount > 0),
      ...(others.length ? [h("optgroup", { label: "Other scenes" }, ...others)] : []),
    );
    menu.disabled = false;
  }

  /** A scene that is none of the shipped ones has an entry of its own, as long as it runs. */
  function showScene() {
    menu.querySelector("[data-own]")?.remove();
    if (data.document) {
      const title = `${data.scene.title || data.scene.id} (yours)`;
      menu.prepend(h("option", { value: "", "data-own": "true" }, title));
    }
    menu.value = data.document ? "" : (data.scene?.id ?? "");
  }

  function showTheme() {
    theme.textContent = data.theme === "dark" ? "light" : "dark";
    theme.setAttribute("aria-label", `${theme.textContent} theme`);
  }

  const stop = listen(store, {
    ready: fill,
    scene: () => {
      showScene();
      menu.title = data.scene?.title ?? "";
      about.textContent = (data.scene?.about ?? "").split(/(?<=\.)\s/)[0];
    },
    theme: showTheme,
  });
  showTheme();
  return {
    update() {},
    dispose() {
      stop();
      el.querySelectorAll(".scene-pick, .about, .choices").forEach((node) => node.remove());
    },
  };
}
