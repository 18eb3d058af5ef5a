// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Light or dark: as the system says, or as chosen; the methods' colours follow from the look table
// of the server.
import { h } from "./dom.js";

const KEY = "holonom-theme";

/** @param {import("../state/store.js").Store} store */
export function createTheme(store) {
  const system = matchMedia("(prefers-color-scheme: dark)");
  let chosen = localStorage.getItem(KEY);

  function apply() {
    const theme =
      chosen === "light" || chosen === "dark" ? chosen : system.matches ? "dark" : "light";
    store.data.theme = theme;
    document.documentElement.dataset.theme = theme;
    const look = store.data.look;
    if (look) {
      look.slots.forEach((slot, i) =>
        document.documentElement.style.setProperty(`--slot-${i}`, slot[theme]),
      );
      document.documentElement.style.setProperty("--reference", look.reference[theme]);
    }
    store.emit("theme");
  }

  system.addEventListener("change", apply);
  store.on("ready", apply);
  apply();
  return {
    toggle() {
      chosen = store.data.theme === "dark" ? "light" : "dark";
      localStorage.setItem(KEY, chosen);
      apply();
    },
    /** The page cannot start: said in place of it. @param {string} sentence */
    failure: (sentence) =>
      h(
        "div",
        { class: "failure", role: "alert" },
        h("p", {}, sentence),
        h("p", {}, h("a", { href: location.href }, "Try again")),
      ),
  };
}
