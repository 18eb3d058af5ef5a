// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Explanations on demand: whatever has a `data-tip` shows it while it is pointed at or has the
// focus, and on touch. One bubble serves the whole page; Escape closes it.
import { h } from "./dom.js";

const WIDTH = 300; // [px] at most
const GAP = 6; // [px] between an element and its bubble
const EDGE = 8; // [px] that the bubble keeps from the window's edge

/** @param {HTMLElement} body */
export function createTips(body) {
  const bubble = h("div", { class: "tip", role: "tooltip", id: "tip", hidden: true });
  body.append(bubble);
  /** @type {Element | null} */
  let owner = null;
  let described = ""; // what described the owner before

  /** Below its owner, or above where there is no room. */
  function place() {
    if (!owner) {
      return;
    }
    const at = owner.getBoundingClientRect();
    const width = Math.min(WIDTH, innerWidth - 2 * EDGE);
    bubble.style.maxWidth = `${width}px`;
    const box = bubble.getBoundingClientRect();
    const left = Math.max(EDGE, Math.min(at.left, innerWidth - box.width - EDGE));
    const below = at.bottom + GAP;
    const top = below + box.height > innerHeight - EDGE ? at.top - GAP - box.height : below;
    bubble.style.left = `${left}px`;
    bubble.style.top = `${Math.max(EDGE, top)}px`;
  }

  /** @param {EventTarget | null} target */
  function show(target) {
    const found = target instanceof Element ? target.closest("[data-tip]") : null;
    if (found === owner) {
      return;
    }
    hide();
    const text = found?.getAttribute("data-tip");
    if (!found || !text) {
      return;
    }
    owner = found;
    // what lies over the page hides the rest; a part of the page stays in its landmark
    const home = found.closest("dialog[open], main, header, footer") ?? body;
    if (bubble.parentElement !== home) {
      home.append(bubble);
    }
    bubble.textContent = text;
    bubble.hidden = false;
    described = found.getAttribute("aria-describedby") ?? "";
    found.setAttribute("aria-describedby", `${described} tip`.trim());
    place();
  }

  function hide() {
    if (described) {
      owner?.setAttribute("aria-describedby", described);
    } else {
      owner?.removeAttribute("aria-describedby");
    }
    owner = null;
    bubble.hidden = true;
  }

  body.addEventListener("pointerover", (event) => show(event.target));
  body.addEventListener("pointerleave", hide);
  body.addEventListener("focusin", (event) => {
    const node = /** @type {Element} */ (event.target);
    if (node.matches(":focus-visible")) {
      show(node);
    }
  });
  body.addEventListener("focusout", hide);
  body.addEventListener("click", (event) => {
    const node = /** @type {Element} */ (event.target);
    if (node.closest(".term")) {
      owner = null;
      show(node);
    } else {
      hide();
    }
  });
  addEventListener("scroll", hide, { capture: true, passive: true });
  addEventListener("keydown", (event) => {
    if (event.key === "Escape" && owner) {
      hide();
      event.stopPropagation();
    }
  });
}
