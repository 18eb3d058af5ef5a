// SPDX-License-Identifier: GPL-3.0-or-later
// The link is the document: opened elsewhere, damaged, with notes, and kept as the last session.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { createBench, playTo, read, soon, until } from "./support.mjs";

const bench = createBench();
const { open } = bench;

async function type(page, field, text) {
  await page.fill(field, text);
  await page.press(field, "Enter");
}

test("a link opens the same comparison at the same frame with the same numbers", async (t) => {
  const page = await open(t);
  await until(page, (data) => data.reference?.state === "ready");
  await page.getByRole("button", { name: "reference", exact: true }).click();
  await page.click(".open-parameters");
  await type(page, "#parameter-l2", "1.3");
  await until(page, (data) => data.settings.l2 === 1.3);
  await page.click("#reactions summary");
  await page.getByRole("button", { name: "paths" }).click();
  await page.keyboard.press("3");
  await page.focus("#play");
  await playTo(page, 0.5);
  await page.keyboard.press("l");
  await until(page, (data) => /link copied|address line/.test(data.notice));
  const what = (data) => ({
    frame: data.latest.frame,
    q: data.latest.methods.map(({ q }) => q),
    gaps: data.latest.methods.map(({ gap }) => gap),
    methods: data.methods.map(({ spelling }) => spelling),
    settings: data.settings,
    view: ["selected", "traces", "reference", "reactions", "arrows"].map((name) => data.view[name]),
  });
  const before = await read(page, what);
  assert.deepEqual(before.view, [2, true, false, true, false]);
  const fragment = new URL(page.url()).hash;
  assert.match(fragment, /^#scene=four-bar&set\.l2=1\.3&method=/);
  const other = await open(t, { hash: fragment });
  await until(other, `(data) => data.latest?.frame === ${before.frame} && data.view.traces`);
  await soon(async () => assert.deepEqual(await read(other, what), before));
  await soon(async () => assert.equal(await other.locator("#reactions details[open]").count(), 1));
  await other.evaluate(() => {
    location.hash = "scene=four-baar&frame=3";
  });
  await until(other, (data) => /no scene is called 'four-baar'/.test(data.notice));
});

test("an open card speaks of the frame that is shown", async (t) => {
  const page = await open(t, {
    hash: "#scene=four-bar&method=index1@rk4:h=0.02&frame=60&why=0",
  });
  const saysAfter = (time) =>
    soon(async () => {
      const words = (await page.textContent(".why-card .card")) ?? "";
      assert.match(words, new RegExp(`After ${time} s the loop gap is`));
    });
  await saysAfter("1.20");
  await soon(async () => {
    // once the reference solution has come
    assert.match(await page.textContent(".why-card .verdict"), /from the true motion/);
    assert.match(await page.textContent(".why-card .happened"), /from the reference solution/);
  });
  await page.evaluate(() => document.querySelector("#play").focus());
  await page.keyboard.press("ArrowLeft");
  await saysAfter("1.18");
});

test("one bad entry of a link is left out and named; the others stay", async (t) => {
  const page = await open(t, {
    hash: "#scene=four-bar&set.l2=1.3&set.l1=50&set.zz=1&set.start.th1=1.2&set.start.th8=1&method=projection@rk4:h=0.01&method=projektion@rk4&frame=3",
  });
  await until(page, (data) => /the link/.test(data.notice) && data.latest?.frame === 3);
  const { notice, methods, settings } = await read(page, (data) => ({
    notice: data.notice,
    methods: data.methods.map(({ spelling }) => spelling),
    settings: data.settings,
  }));
  assert.deepEqual(methods, ["projection@rk4:h=0.01"]);
  assert.equal(settings.l2, 1.3);
  assert.match(notice, /l1 is 50; 0\.1 to 3 is allowed/);
  assert.match(notice, /no parameter 'zz'/);
  assert.equal(settings["start.th1"], 1.2);
  assert.match(notice, /no coordinate named 'th8'/);
  assert.match(notice, /projektion/);
});

test("notes travel with the link; one too long to be sent becomes a file that opens it", async (t) => {
  const page = await open(t);
  await page.fill("#note", "Predict first: which one stays closed?");
  await page.focus("#play");
  await page.keyboard.press("l");
  await until(page, (data) => /link copied|address line/.test(data.notice));
  const other = await open(t, { hash: new URL(page.url()).hash });
  await soon(async () =>
    assert.equal(await other.inputValue("#note"), "Predict first: which one stays closed?"),
  );
  await soon(async () =>
    assert.match(await other.textContent(".notice"), /notes of this link: Predict first/),
  );
  await page.fill("#note", "why? ".repeat(1000));
  await page.focus("#play");
  const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("l")]);
  assert.equal(download.suggestedFilename(), "four-bar-comparison.html");
  const text = readFileSync(await download.path(), "utf8");
  const [, fragment] = /href="[^"#]*(#[^"]*)"/.exec(text) ?? [];
  const third = await open(t, { hash: fragment.replaceAll("&amp;", "&") });
  await soon(async () => assert.equal((await third.inputValue("#note")).length, 5000));
});

test("the last session of this browser can be continued, and an untouched page leaves none", async (t) => {
  const context = { viewport: { width: 1279, height: 800 } }; // a browser of this test's own
  const untouched = await open(t, context);
  await untouched.reload();
  await untouched.waitForFunction(() => globalThis.holonom?.data.history?.count > 0);
  await soon(async () => assert.ok(await untouched.isHidden(".offer")));
  const page = await open(t, context);
  await type(page, "#set-h", "0.013");
  await page.focus("#play");
  await playTo(page, 0.4);
  const state = (data) => ({
    frame: data.latest.frame,
    q: data.latest.methods.map(({ q }) => q),
  });
  const before = await read(page, state);
  await page.waitForFunction(
    (frame) => (localStorage.getItem("holonom.last") ?? "").includes(`h=0.013&frame=${frame}&`),
    before.frame,
  );
  const again = await open(t, { ...context, keep: true });
  await again.getByRole("button", { name: "continue the last session" }).click();
  await until(again, `(data) => data.latest?.frame === ${before.frame} && data.offer === ""`);
  await soon(async () => assert.deepEqual(await read(again, state), before));
});

test("eight methods have eight colours, dashes and marks", async (t) => {
  const methods = ["index1", "baumgarte", "projection", "reduced"].flatMap((name) =>
    ["0.01", "0.02"].map((h) => `&method=${name}@rk4:h=${h}`),
  );
  const page = await open(t, { hash: `#scene=four-bar${methods.join("")}` });
  await page.waitForFunction(() => globalThis.holonom?.data?.methods?.length === 8);
  const looks = await page.evaluate(() => {
    const { methods: all, look } = globalThis.holonom.data;
    return [...document.querySelectorAll("svg.swatch")].map((swatch, m) => [
      getComputedStyle(swatch).getPropertyValue("--colour"),
      swatch.querySelector("path").getAttribute("stroke-dasharray"),
      look.slots[all[m].slot].marker,
    ]);
  });
  assert.equal(looks.length, 8);
  for (const k of [0, 1, 2]) {
    const seen = looks.map((look) => look[k]);
    assert.equal(new Set(seen).size, 8, String(seen));
    // a full line has no dash; every colour is one
    assert.ok(k === 1 || seen.every((one) => one), String(seen));
  }
});
