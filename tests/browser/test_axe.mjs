// SPDX-License-Identifier: GPL-3.0-or-later
// axe finds nothing on any view in any theme.
import assert from "node:assert/strict";
import { test } from "node:test";
import { violations } from "./axe.mjs";
import { createBench, playTo, soon, until } from "./support.mjs";

const { open } = createBench();

/** Presses Escape until no dialog is open: the first may close the sentence of a word. */
const shutDialog = async (page) => {
  await soon(async () => {
    if (await page.locator("dialog[open]").count()) await page.keyboard.press("Escape");
    assert.equal(await page.locator("dialog[open]").count(), 0);
  });
  await page.focus("#play");
};
const tables = async (page) => {
  for (const k of [0, 1]) {
    await page.locator("figure.plot").nth(k).getByRole("button", { name: "table" }).click();
  }
};
const press = (name) => (page) => page.getByRole("button", { name }).click();

/** The views that are opened before axe looks, by name, and how each is closed again. */
const VIEWS = {
  "the first screen": [async () => {}, async () => {}],
  "the drawer": [
    press("lengths, masses, start"),
    (page) => page.locator("#parameters").getByRole("button", { name: "Close" }).click(),
  ],
  "a card": [press("Why? index-1"), (page) => page.keyboard.press("Escape")],
  tables: [tables, tables],
  "the method's dialog": [press("add a method"), shutDialog],
  keys: [(page) => page.keyboard.press("F1"), shutDialog],
  export: [press("export"), shutDialog],
  "the error budget": [
    async (page) => {
      await page.keyboard.press("e");
      await until(page, (data) => data.studies.budget.state === "finished");
    },
    shutDialog,
  ],
  "forces and equations": [
    async (page) => {
      await page.click("#reactions summary");
      await page.click(".equation-panel summary");
      await page.waitForSelector(".term-block .katex");
      await page.waitForFunction(() => document.querySelectorAll(".reaction-table tr").length > 1);
    },
    async () => {},
  ],
};

for (const [colorScheme, width] of [
  ["light", 1366],
  ["dark", 360],
]) {
  test(`axe finds nothing on any view, ${colorScheme}, ${width} wide`, async (t) => {
    const viewport = { width, height: 780 };
    const page = await open(t, { colorScheme, viewport, bypassCSP: true });
    await playTo(page, 1.5);
    for (const [name, [show, hide]] of Object.entries(VIEWS)) {
      await show(page);
      await soon(async () => assert.deepEqual(await violations(page), [], name));
      await hide(page);
    }
  });
}
