// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of the scene: two notations with present numbers, folded cosines, and terms that
// light up what they belong to, and back.
import assert from "node:assert/strict";
import { test } from "node:test";
import { partsOf } from "../../web/state/belongs.js";
import { createBench, playTo, read, screenBox, screenshot, soon } from "./support.mjs";

const { open } = createBench();

test("an entry belongs to the bodies of its velocities and to its loop", () => {
  const scene = {
    bodies: [{ name: "crank" }, { name: "coupler" }],
    coordinates: [{ name: "th1", rate: "w1", joint: "O1" }],
    joints: [{ name: "O1", child: 0 }],
    rows: [{ loop: "B" }, { loop: "B" }],
  };
  const speeds = ["w1", "omega_coupler"];
  assert.deepEqual(partsOf({ term: "M", row: 2, column: 1 }, speeds, scene).bodies, [1, 0]);
  const entry = partsOf({ term: "J", row: 1, column: 2 }, speeds, scene);
  assert.deepEqual([entry.bodies, entry.tears], [[1], ["B"]]);
  assert.deepEqual(partsOf({ term: "phi", row: 1 }, speeds, scene).curves, ["gap"]);
});

/** M a - J'λ - f, row by row, with the accelerations and multipliers that the table shows. */
const restOfRows = (page) =>
  page.evaluate(async () => {
    const { evaluate, valuesAt } = await import(new URL("state/formula.js", location.href).href);
    const { data } = globalThis.holonom;
    const shown = (row) =>
      document
        .querySelector(`.notation-table tbody tr:nth-child(${row}) td.number`)
        .textContent.split(", ")
        .map((text) => parseFloat(text.replace("−", "-")));
    const [a, lambda] = [shown(6), shown(7)];
    const answer = await fetch("api/v1/equations", {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify({ scene: data.scene.id, format: "json" }),
    }).then((response) => response.json());
    const state = { t: 0, ...data.history.stateAt(data.view.selected, 0) };
    const values = valuesAt(answer, data.scene, state);
    const rest = a.map(() => 0);
    for (const { term, row, column, text } of answer.entries) {
      const value = evaluate(text, values);
      if (term === "M") {
        rest[row - 1] += value * a[column - 1];
        rest[column - 1] += row === column ? 0 : value * a[row - 1];
      } else if (term === "J") {
        rest[column - 1] -= value * lambda[row - 1];
      } else if (term === "f") {
        rest[row - 1] -= value;
      }
    }
    return rest;
  });

test("terms light up links and curves, links light up terms; numbers follow the state", async (t) => {
  const page = await open(t, { viewport: { width: 1366, height: 1200 } });
  await page.click(".equation-panel summary");
  await page.waitForSelector(".term-block .katex");
  await soon(async () => assert.match(await page.textContent(".notation-table"), /rad\/s²/));
  await page.waitForFunction(() =>
    /Rank of J: 2 of 2/.test(document.querySelector(".notation").textContent),
  );
  const first = await page.textContent(".notation-table tbody tr:nth-child(6) td.number");
  // -15.47 rad/s² at the start: the accelerations that POST /terms gives
  assert.match(first, /^−15\.47 rad\/s²/);
  assert.match(
    await page.textContent(".notation-table tbody tr:nth-child(6) td:nth-child(3)"),
    /time derivatives of w1, omega_coupler, w3, the order of M's rows/,
  );
  for (const rest of await restOfRows(page)) {
    assert.ok(Math.abs(rest) < 2e-2, `M a - J'λ - f = ${rest} with four digits of each`);
  }
  await soon(async () =>
    assert.match(await page.innerHTML(".terms"), /M_\{21\} = M_\{12\} = [^<]*\\cos\\left\(/),
  );

  const line = page.locator('.term-block .line[data-bodies="0"]').first();
  await line.hover();
  await page.waitForFunction(() => document.querySelector(".picture > .lit")?.getAttribute("d"));
  await screenshot(page, "equations-lit", { seen: true });
  await page.locator(".term-block", { hasText: "loop closure" }).locator(".line").first().focus();
  await page.waitForSelector("figure.plot.lit");

  await page.evaluate(() => scrollTo(0, 0));
  const bar = await page.evaluate(() => {
    const { history, view, scene } = globalThis.holonom.data;
    return { points: [...history.pointsAt(view.selected, 0)], shape: scene.drawing.shapes[0] };
  });
  assert.equal(bar.shape.kind, "bar");
  const box = await screenBox(page.locator(".ghost.selected .outline").first());
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForSelector(".term-block .line.lit", { state: "attached" });

  await playTo(page, 0.3);
  await page.waitForFunction(
    (before) =>
      document.querySelector(".notation-table tbody tr:nth-child(6) td.number").textContent !==
      before,
    first,
  );
  await soon(async () => assert.ok(await read(page, (data) => data.latest.t > 0.3)));
});
