// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// All scenes with pictures, a search and filters. Pictures are drawn from the assembled scenes,
// which come one after the other.
import { api, sentenceOf } from "../api/client.js";
import { EITHER, FILTERS, fitsSearch } from "../state/gallery.js";
import { h, say, set } from "../widgets/dom.js";
import { makeThumbnail } from "../widgets/thumbnail.js";

const AT_ONCE = 2; // requests

/**
 * @param {HTMLElement} el
 * @param {import("../state/store.js").Store} store
 * @param {import("../session/session.js").Session} actions
 */
export function createGallery(el, store, actions) {
  const data = store.data;
  /** assembled scenes, by id @type {Map<string, import("../state/types.js").Scene>} */
  const known = new Map();
  /** @type {Map<string, {card: HTMLElement, picture: HTMLElement, caption: HTMLElement}>} */
  const cards = new Map();
  const chosen = new Set();
  let fetching = false;

  const words = h("input", {
    type: "text",
    id: "gallery-search",
    autocomplete: "off",
    placeholder: "four-bar, motor, ball joint ...",
    oninput: show,
  });
  const filters = Object.entries(FILTERS).map(([name, { tip }]) => {
    const button = h(
      "button",
      {
        type: "button",
        class: "quiet",
        "data-tip": tip,
        "aria-pressed": "false",
        onclick: () => toggle(name),
      },
      name,
    );
    return { name, button };
  });
  const count = h("p", { role: "status", class: "about" });
  const list = h("ul", { class: "cards", tabindex: "0", "aria-label": "Scenes" });
  const dialog = h(
    "dialog",
    { class: "dialog gallery", "aria-labelledby": "gallery-title" },
    h(
      "div",
      { class: "card-head" },
      h("h2", { id: "gallery-title" }, "Scenes"),
      h("label", { for: "gallery-search", class: "hidden" }, "Search"),
      words,
      h(
        "div",
        { class: "choices", role: "group", "aria-label": "Filters" },
        ...filters.map(({ button }) => button),
      ),
      count,
      h("form", { method: "dialog" }, h("button", { class: "quiet" }, "Close")),
    ),
    list,
  );
  el.append(dialog);
  dialog.addEventListener("close", () => actions.setView({ gallery: false }));
  store.on("view", () => {
    if (dialog.open && !data.view.gallery) {
      dialog.close();
    }
  });

  /** @param {string} name */
  function toggle(name) {
    if (!chosen.delete(name)) {
      EITHER.filter((group) => group.includes(name)).forEach((group) =>
        group.forEach((other) => chosen.delete(other)),
      );
      chosen.add(name);
    }
    show();
  }

  function show() {
    filters.forEach(({ name, button }) =>
      set(button, { "aria-pressed": String(chosen.has(name)) }),
    );
    let shown = 0;
    for (const scene of data.scenes) {
      const fits = fitsSearch(scene, known.get(scene.id), { words: words.value, chosen });
      const card = cards.get(scene.id)?.card;
      if (card) {
        card.hidden = !fits;
        shown += Number(fits);
      }
    }
    const rest = data.scenes.length - known.size;
    const waiting = rest > 0 && chosen.size > 0 ? `, ${rest} still to be read` : "";
    say(count, `${shown} of ${data.scenes.length} scenes${waiting}`);
  }

  /** @param {string} id */
  async function choose(id) {
    try {
      await actions.loadScene(id);
      dialog.close();
    } catch (error) {
      say(count, sentenceOf(error));
    }
  }

  function makeCards() {
    for (const { id, title } of data.scenes.toSorted((a, b) => a.title.localeCompare(b.title))) {
      const picture = h("span", { class: "card-picture" });
      const caption = h("span", { class: "about" });
      const card = h(
        "li",
        {},
        h(
          "button",
          { type: "button", class: "card", onclick: () => choose(id) },
          picture,
          h("span", { class: "card-title" }, title),
          caption,
        ),
      );
      cards.set(id, { card, picture, caption });
    }
    list.replaceChildren(...[...cards.values()].map(({ card }) => card));
  }

  /** Reads the scenes that are not known yet. */
  async function fetchScenes() {
    if (fetching) {
      return;
    }
    fetching = true;
    const left = data.scenes.map(({ id }) => id).filter((id) => !known.has(id));
    const work = async () => {
      for (let id = left.shift(); id && dialog.open; id = left.shift()) {
        try {
          const scene = await api.scene(id);
          known.set(id, scene);
          const card = cards.get(id);
          card?.picture.replaceChildren(makeThumbnail(scene));
          // a difference stays in one line
          say(card?.caption ?? count, scene.caption.replaceAll(" − ", "\u00a0−\u00a0"));
        } catch (error) {
          say(cards.get(id)?.caption ?? count, sentenceOf(error));
        }
        show();
      }
    };
    await Promise.all(Array.from({ length: AT_ONCE }, work));
    fetching = false;
  }

  return {
    open() {
      if (cards.size === 0) {
        makeCards();
      }
      cards.forEach(({ card }, id) =>
        set(/** @type {Element} */ (card.firstElementChild), {
          "aria-current": id === data.scene?.id ? "true" : null,
        }),
      );
      if (!dialog.open) {
        dialog.showModal();
        words.focus();
      }
      show();
      fetchScenes();
    },
    dispose: () => dialog.remove(),
  };
}
