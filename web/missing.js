// SPDX-License-Identifier: GPL-3.0-or-later
// Says what keeps the page from starting: a file that is missing, or a browser that is too old. A
// script of its own and no module, so that it runs where modules do not.
(() => {
  const HOW =
    "The libraries of the page are installed by `make run`; by hand: " +
    "`npm ci && npm run vendor` in the folder web. Then load the page again.";

  const LISTED = 100; // [ms] until the browser's list has the answer to a request

  /** Paths of files that the server did not have. */
  function missingFiles() {
    const files = performance
      .getEntriesByType("resource")
      .filter(({ responseStatus: status }) => status >= 400)
      .map(({ name }) => new URL(name).pathname.replace(/^\//, ""));
    return [...new Set(files)];
  }

  /** @param {string} text commands in it stand between backticks */
  function say(text) {
    const place = document.querySelector(".waiting");
    if (place && document.querySelector("main[aria-busy='true']")) {
      const code = (word) => Object.assign(document.createElement("code"), { textContent: word });
      place.replaceChildren(...text.split("`").map((part, i) => (i % 2 ? code(part) : part)));
      place.classList.add("now");
      place.setAttribute("role", "alert");
    }
  }

  /** A file of the page did not load. */
  function sayMissing() {
    setTimeout(() => {
      const files = missingFiles();
      const names = files.length ? `: the server has no ${files.join(", ")}` : "";
      say(`The page cannot start${names}. ${HOW}`);
    }, LISTED);
  }

  addEventListener(
    "error",
    (event) => {
      const { target } = event;
      if (target instanceof HTMLScriptElement) {
        sayMissing();
      } else if (target === window && event.error) {
        say(`The page cannot start: ${event.message}. A browser from 2023 or later is needed.`);
      }
    },
    true,
  );
})();
