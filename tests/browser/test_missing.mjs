// SPDX-License-Identifier: GPL-3.0-or-later
// A page whose libraries are not there, or whose browser is too old, says so at once.
import assert from "node:assert/strict";
import test from "node:test";
import { createBench } from "./support.mjs";

const bench = createBench();

/** The page, loaded anew with some of its files answered otherwise. */
async function reloaded(t, pattern, answer) {
  const page = await bench.open(t, { wait: false, fresh: true });
  await page.route(pattern, (route) => route.fulfill(answer));
  await page.reload({ waitUntil: "commit" });
  return page;
}

test("libraries that are not installed are named, with the command that installs them", async (t) => {
  const page = await reloaded(t, "**/vendor/**", { status: 404, body: "" });
  const alert = page.getByRole("alert").filter({ hasText: "cannot start" });
  await alert.waitFor();
  const text = await alert.textContent();
  assert.match(text, /the server has no .*vendor\/uplot\/uPlot\.esm\.js/);
  assert.match(text, /make run/);
  bench.faultsOf(page).splice(0); // what is missing is the point of the test
});

test("a browser that cannot read the page is told which one can", async (t) => {
  const page = await reloaded(t, "**/main.js", {
    status: 200,
    contentType: "text/javascript",
    body: "this is no script",
  });
  const alert = page.getByRole("alert").filter({ hasText: "cannot start" });
  await alert.waitFor();
  assert.match(await alert.textContent(), /A browser from 2023 or later is needed/);
  bench.faultsOf(page).splice(0);
});
