// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Many small things of which one can be reached with Tab, and the others from there with the arrow
// keys.

/**
 * @param {SVGElement | HTMLElement} root
 * @param {{move: (from: Element, key: string) => Element | undefined, act: (node: Element) => void,
 *   tell: (node: Element | null) => void}} how
 * `move` finds the neighbour, `act` is a click or Enter, `tell` is told what is pointed at or
 * focused
 */
export function rove(root, { move, act, tell }) {
  /** @type {Element | null} */
  let present = null;

  /** @param {Element} node */
  function enter(node) {
    present?.setAttribute("tabindex", "-1");
    present = node;
    node.setAttribute("tabindex", "0");
  }

  const spotOf = (event) => /** @type {Element} */ (event.target).closest("[data-spot]");

  root.addEventListener("keydown", (event) => {
    const { key } = /** @type {KeyboardEvent} */ (event);
    const node = spotOf(event);
    if (!node) {
      return;
    }
    if (key === "Enter" || key === " ") {
      event.preventDefault();
      act(node);
    } else if (key.startsWith("Arrow")) {
      event.preventDefault();
      const next = move(node, key);
      if (next) {
        enter(next);
        /** @type {any} */ (next).focus();
      }
    }
  });
  root.addEventListener("click", (event) => {
    const node = spotOf(event);
    if (node) {
      enter(node);
      act(node);
    }
  });
  root.addEventListener("pointerover", (event) => tell(spotOf(event) ?? null));
  root.addEventListener("focusin", (event) => tell(spotOf(event) ?? null));
  return {
    /** After the things were made anew. @param {Element | null | undefined} first */
    start(first) {
      present = null;
      if (first) {
        enter(first);
      }
    },
  };
}
