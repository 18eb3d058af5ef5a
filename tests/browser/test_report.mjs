// SPDX-License-Identifier: GPL-3.0-or-later
// The report as a file in a browser: no network, no error, from the keyboard, on a narrow screen,
// and on paper without scripts.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { PROGRAM, ROOT, startBrowser } from "./support.mjs";

const METHODS = ["projection@rk4", "index1@rk4", "nullspace-as-printed@rk4"];
const WORDS = ["--methods", ...METHODS, "--levels", "3", "--samples", "0", "--time-limit", "0"];
const MAKE_LIMIT = 120000; // [ms]

let folder, file, browser;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "holonom-report-"));
  const path = join(folder, "report.html");
  execFileSync(PROGRAM, ["report", "fb0", ...WORDS, "--out", path], {
    cwd: ROOT,
    env: { ...process.env, HOLONOM_CACHE: folder },
    stdio: "ignore",
    timeout: MAKE_LIMIT,
  });
  file = pathToFileURL(path).href;
  browser = await startBrowser();
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** Opens it, runs `use`, and holds that nothing else was asked for and nothing went wrong. */
async function withPage(options, use) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  const wrong = [];
  page.on("console", (message) => message.type() === "error" && wrong.push(message.text()));
  page.on("pageerror", (error) => wrong.push(String(error)));
  page.on("request", (request) => request.url() !== file && wrong.push(request.url()));
  await page.goto(file);
  await use(page);
  assert.deepEqual(wrong, []);
  await context.close();
}

const isShown = (locator) =>
  locator.evaluate((node) => node.checkVisibility({ contentVisibilityAuto: true }));

for (const javaScriptEnabled of [true, false]) {
  test(`on paper what is folded is there, ${javaScriptEnabled ? "with" : "without"} scripts`, () =>
    withPage({ javaScriptEnabled }, async (page) => {
      const heads = ["Methods", "Runs that did not reach the end", "How it was measured"];
      for (const name of heads) {
        const head = page.locator("h3", { hasText: name });
        assert.equal(await isShown(head), false, `${name} is folded on a screen`);
      }
      await page.emulateMedia({ media: "print" });
      for (const name of heads) {
        assert.equal(await isShown(page.locator("h3", { hasText: name })), true, name);
      }
      assert.equal(await isShown(page.locator("details.all table")), false, "not every point");
      assert.equal(await isShown(page.locator(".names")), false, "nothing to press on paper");
    }));
}

test("the keyboard chooses the plot and hides a method", () =>
  withPage({}, async (page) => {
    assert.equal(await page.locator("#e0").getAttribute("aria-label"), "error of the coordinates");
    await page.locator("#e0").focus();
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.locator("#e1").isChecked(), true);
    assert.equal(await page.locator(".plot.e1.c1").isVisible(), true);
    assert.equal(await page.locator(".plot.e0.c1").isVisible(), false);
    const button = page.locator(".names button", { hasText: METHODS[1] });
    await button.focus();
    await page.keyboard.press("Enter");
    assert.equal(await button.getAttribute("aria-pressed"), "false");
    assert.equal(await page.locator('.plot.e1.c1 .series[data-m="1"]').isVisible(), false);
    assert.equal(await page.locator('.plot.e1.c1 .series[data-m="0"]').isVisible(), true);
  }));

for (const width of [360, 1280]) {
  test(`${width} wide: tables scroll in themselves, by the keyboard too, and the page does not`, () =>
    withPage({ viewport: { width, height: 800 } }, async (page) => {
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width);
      const table = page.locator(".scroll").first();
      await table.focus();
      await page.keyboard.press("ArrowRight");
      const room = await table.evaluate((node) => node.scrollWidth - node.clientWidth);
      assert.equal(room > 0, width === 360);
      if (room > 0) {
        await page.waitForFunction((node) => node.scrollLeft > 0, await table.elementHandle());
      }
    }));
}
