// SPDX-License-Identifier: GPL-3.0-or-later
// The printed book: its figures, its formulas, and what must stand together on a page.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { PROGRAM, ROOT, startBrowser } from "./support.mjs";

test("the book has whole figures, and no line begins with the mark behind a formula", async (t) => {
  const folder = mkdtempSync(join(tmpdir(), "book-"));
  t.after(() => rmSync(folder, { recursive: true }));
  const file = join(folder, "book.html");
  execFileSync("node", [join(ROOT, "lessons/book.mjs"), PROGRAM, file], { cwd: ROOT });
  const browser = await startBrowser();
  t.after(() => browser.close());
  const page = await browser.newPage();
  await page.goto(pathToFileURL(file).href);
  const found = await page.evaluate(() => {
    const texts = (node) => node.nextSibling?.nodeType === Node.TEXT_NODE && node.nextSibling.data;
    const formulas = [...document.querySelectorAll("section .katex")].filter(
      (n) => !n.closest(".katex-display, .kept"),
    );
    const captions = [...document.querySelectorAll("section figcaption")];
    return {
      chapters: document.querySelectorAll("section").length,
      broken: [...document.images].filter((i) => !i.complete || i.naturalWidth === 0).length,
      numbers: captions.map((c) =>
        /^Figure (\d+)\.(\d+)\. \S/.exec(c.textContent)?.slice(1).map(Number),
      ),
      formulas: formulas.length,
      kept: document.querySelectorAll(".kept > .katex").length,
      loose: formulas
        .filter((n) => /^[.,;:!?)\]]/.test(texts(n) || ""))
        .map((n) => n.textContent)
        .slice(0, 3),
      loosePlots: document.querySelectorAll("li > .plot:first-child svg").length,
      plots: document.querySelectorAll(".plot svg").length,
      stages: document.body.innerText.includes("solve: solve the saddle-point system"),
    };
  });
  assert.equal(found.chapters, 12, "eleven lessons and the answers");
  assert.equal(found.broken, 0);
  assert.ok(found.formulas > 200 && found.kept > 50, JSON.stringify(found));
  assert.deepEqual(found.loose, []);
  assert.ok(found.plots >= 5 && found.loosePlots === 0);
  assert.ok(found.stages, "a stage is parted from what it does");

  // within a chapter figures are counted from 1, without a gap
  const last = new Map();
  for (const number of found.numbers) {
    assert.ok(number, "a caption begins with its number");
    assert.equal(number[1], (last.get(number[0]) ?? 0) + 1, `figure ${number.join(".")}`);
    last.set(number[0], number[1]);
  }
});
