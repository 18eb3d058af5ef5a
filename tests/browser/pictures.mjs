// SPDX-License-Identifier: GPL-3.0-or-later
// usage: node tests/browser/pictures.mjs
// Takes the picture of the page that README.md shows.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { PATIENCE, playTo, ROOT, settled, startBrowser, startServer } from "./support.mjs";

const FOLDER = join(ROOT, "lessons/01-closed-loops");
const AT = 3.62; // [s] the torn loop of the unstabilised method is wide open

/** The first screen of the page, once the guide is closed. */
async function takePage(browser, url) {
  const page = await browser.newPage({ viewport: { width: 1366, height: 768 } });
  page.setDefaultTimeout(PATIENCE);
  await page.goto(url);
  await page.waitForFunction(() => globalThis.holonom?.data.reference?.state === "ready");
  await page.locator(".guide .tool").click();
  await playTo(page, AT);
  await page.locator("#play").focus();
  await page.mouse.move(700, 690);
  await settled(page);
  writeFileSync(join(FOLDER, "page.png"), await page.screenshot());
}

const [server, browser] = await Promise.all([startServer(), startBrowser()]);
try {
  await takePage(browser, server.url);
  assert.equal(server.ended(), "");
} finally {
  await browser.close();
  await server.stop();
}
