// SPDX-License-Identifier: GPL-3.0-or-later
// The reference solution on the page: a grey ghost, grey curves, and how far each method is off it.
import assert from "node:assert/strict";
import { test } from "node:test";
import { createBench, playTo, soon, until } from "./support.mjs";
import { createGrowing, offReference, referenceAt } from "../../web/state/reference.js";

const bench = createBench();
const { open } = bench;

const isReady = (data) => data.reference?.state === "ready";

const ready = (points, stride = 1, own = 1e-9) => ({
  state: "ready",
  points: points.map((row) => Float64Array.from(row)),
  stride,
  own,
});

test("between two samples the reference moves on a straight line, and past its end it says nothing", () => {
  const reference = ready(
    [
      [0, 0, 0],
      [1, 2, 3],
    ],
    4,
  );
  assert.deepEqual([...referenceAt(reference, 4)], [1, 2, 3]);
  assert.deepEqual([...referenceAt(reference, 2)], [0.5, 1, 1.5]);
  assert.equal(referenceAt(reference, 5), null);
  assert.equal(referenceAt(null, 0), null);
  assert.equal(referenceAt({ ...reference, state: "asked" }, 0), null);
});

test("the farthest point counts, and no error below the reference's own is claimed", () => {
  const reference = ready(
    [
      [0, 0, 0, 1, 0, 0],
      [0, 0, 0, 1, 0, 0],
    ],
    2,
    1e-6,
  );
  assert.equal(offReference(reference, 2, [0, 0, 0, 1, 3, 4]), 5);
  assert.equal(offReference(reference, 0, [1e-9, 0, 0, 1, 0, 0]), 1e-6);
  assert.ok(Number.isNaN(offReference(reference, 1, [0, 0, 0, 1, 0, 0])), "between samples");
  assert.ok(Number.isNaN(offReference(reference, 4, [0, 0, 0, 1, 0, 0])), "past its end");
  assert.ok(Number.isNaN(offReference(reference, 0, [NaN, 0, 0, 1, 0, 0])), "no points");
});

test("columns grow with the run and start anew with another reference", () => {
  let asked = 0;
  const growing = createGrowing((m, i) => {
    asked++;
    return 10 * m + i;
  });
  const history = { nMethods: 2, t: new Float64Array(8), stride: 1, count: 2 };
  const first = {};
  assert.deepEqual([...growing(history, first)[1].slice(0, 3)], [10, 11, NaN]);
  history.count = 3;
  assert.equal(growing(history, first)[1][2], 12);
  assert.equal(asked, 6, "each value once");
  growing(history, {});
  assert.equal(asked, 12, "all anew");
});

test("the reference is a grey ghost that moves, names its digits and can be put away", async (t) => {
  const page = await open(t, { hash: "#scene=four-bar&method=index1@rk4:h=0.02" });
  await until(page, isReady);
  const ghost = page.locator(".truth path");
  const button = page.getByRole("button", { name: "reference", exact: true });
  await soon(async () => assert.ok((await ghost.count()) > 0));
  await soon(async () =>
    assert.match(
      await button.getAttribute("title"),
      /in long double .* agree to 1\d\.\d digits to 10 s/,
    ),
  );
  const grey = await page.evaluate(() => {
    const { look, theme } = globalThis.holonom.data;
    const probe = document.createElement("i");
    probe.style.color = look.reference[theme];
    document.body.append(probe);
    return [
      getComputedStyle(probe).color,
      getComputedStyle(document.querySelector(".truth path")).stroke,
    ];
  });
  assert.equal(grey[1], grey[0]);
  const at = () => ghost.first().getAttribute("d");
  const before = await at();
  await playTo(page, 3);
  await soon(async () => assert.notEqual(await at(), before, "it moves"));
  await button.click();
  await soon(async () => assert.equal(await ghost.count(), 0));
  await button.click();
  await soon(async () => assert.ok((await ghost.count()) > 0));
});

test("the error in the table of methods and in its curve is the distance from the reference", async (t) => {
  const page = await open(t);
  await until(page, isReady);
  await playTo(page, 2);
  const figure = page.locator("figure.plot").first();
  await soon(async () => assert.equal(await figure.locator("select").first().inputValue(), "off"));
  await soon(async () => assert.ok(await figure.locator(".no-curve").isHidden()));
  await figure.getByRole("button", { name: "table" }).click();
  const named = await page.evaluate(() =>
    globalThis.holonom.data.methods.map(({ label }) => label),
  );
  await soon(async () => {
    const cells = await figure.locator("tbody td:last-child").allTextContents();
    assert.deepEqual(await figure.locator("tbody th").allTextContents(), named);
    assert.ok(
      cells.every((text) => /^[\d.×⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+ ?[a-zµ]*m$/.test(text)),
      cells.join("; "),
    );
    const errors = await page.locator(".method-table tbody td.off .number").allTextContents();
    assert.equal(errors.length, named.length);
    assert.ok(
      errors.every((text) => /^(< )?\S+ \S*m$/.test(text)),
      errors.join("; "),
    );
  });
  // the loop stays shut to rounding, and yet the motion is off: not the same number
  const own = await page.evaluate(() => globalThis.holonom.data.reference.own);
  assert.ok(own > 0 && own < 1e-9, `the reference's own error is ${own} m`);
});

test("other parameters have no stored reference: it is said, and computed when asked for", async (t) => {
  const page = await open(t);
  await until(page, isReady);
  const figure = page.locator("figure.plot").first();
  await page.evaluate(() => {
    const [{ name, initial }] = globalThis.holonom.data.scene.parameters;
    globalThis.changed = [name, 1.02 * initial];
  });
  await page.click(".open-parameters");
  const field = page.locator(".parameters input:not([type=range])").first();
  await field.fill(String((await page.evaluate(() => globalThis.changed))[1]));
  await field.press("Enter");
  await until(page, (data) => data.reference?.state === "none");
  const note = figure.locator(".no-curve");
  await soon(async () =>
    assert.match(await note.textContent(), /none is stored for these parameters/),
  );
  await soon(async () => assert.equal(await page.locator(".truth path").count(), 0));
  await note.getByRole("button", { name: "compute it" }).click();
  await until(page, isReady);
  await soon(async () => assert.ok(await note.isHidden()));
  await soon(async () => assert.ok((await page.locator(".truth path").count()) > 0));
});
