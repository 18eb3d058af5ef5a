// SPDX-License-Identifier: GPL-3.0-or-later
// axe finds nothing on any view in any theme.
import assert from "node:assert/strict";
import { test } from "node:test";
import { violations } from "./axe.mjs";
import { createBench, playTo, soon, until } from "./support.mjs";

const { open } = createBench();
const LONG = 60000; // [ms] that a study may take on a busy machine

/** What is opened before axe looks, by a name. */
const VIEWS = {
  "the first screen": async () => {},
  "a card and the drawer": async (page) => {
    await page.getByRole("button", { name: "lengths, masses, start" }).click();
    await page.getByRole("button", { name: "Why? index-1" }).click();
  },
  tables: async (page) => {
    for (const k of [0, 1]) {
      await page.locator("figure.plot").nth(k).getByRole("button", { name: "table" }).click();
    }
  },
  "forces and equations": async (page) => {
    await page.click("#reactions summary");
    await page.click(".equation-panel summary");
    await page.waitForSelector(".term-block .katex");
    await page.waitForFunction(() => document.querySelectorAll(".reaction-table tr").length > 1);
  },
  "the method's dialog": async (page) => {
    await page.getByRole("button", { name: "add a method" }).click();
  },
  keys: (page) => page.keyboard.press("F1"),
  export: (page) => page.getByRole("button", { name: "export" }).click(),
  "the error budget": async (page) => {
    await page.keyboard.press("e");
    await until(page, (data) => data.studies.budget.state === "finished", LONG);
  },
};

for (const [name, show] of Object.entries(VIEWS)) {
  for (const [colorScheme, width] of [
    ["light", 1366],
    ["dark", 360],
  ]) {
    test(`axe finds nothing: ${name}, ${colorScheme}, ${width} wide`, async (t) => {
      const page = await open(t, {
        colorScheme,
        viewport: { width, height: 780 },
        bypassCSP: true,
      });
      await playTo(page, 1.5);
      await show(page);
      await soon(async () => assert.deepEqual(await violations(page), []));
    });
  }
}
