// SPDX-License-Identifier: GPL-3.0-or-later
// What is damaged on its way to the page: links with bad entries, scenes with every kind of error,
// two tabs and another client on one comparison. Nothing may be lost, stale, or on the console.
// DAMAGED_LINKS is how many links are opened; EVERY_SCENE=1 takes all bad scenes, not every sixth.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { damaged, randomFrom } from "./damage.mjs";
import { createBench, playTo, read, ROOT, soon, until } from "./support.mjs";

const LINKS = Number(process.env.DAMAGED_LINKS ?? 16);
const EVERY = process.env.EVERY_SCENE ? 1 : 6;
const FOLDER = join(ROOT, "tests/scenes/bad");
const LONG = 60000; // [ms] that an answer may take on a busy machine

const bench = createBench();
const { open } = bench;

const ENTRIES = [
  "scene=four-bar",
  "set.l1=0.45",
  "method=index1@rk4:h=0.02",
  "method=baumgarte:alpha=7,beta=20@rk4:h=0.02",
  "method=projection@rk4:h=0.02",
  "frame=12",
  "selected=1",
  "hidden=2",
  "show=labels,arrows",
  "upper=energy_change,turned",
  "zoom=0.05,0.2",
  "why=1",
  "speed=2",
  "judged=th3",
  "until=1.5",
  "note=say%20why",
];
/** All that has to be of one run: what the page knows, and what it shows. */
const whole = (page) =>
  page.evaluate(() => {
    const { data } = globalThis.holonom;
    const text = (selector) => document.querySelector(selector)?.textContent ?? "";
    return {
      scene: data.scene.id,
      methods: data.methods.map(({ spelling }) => spelling),
      columns: data.history.nMethods,
      finite: [...data.history.pointsAt(0, data.history.count - 1)].every(Number.isFinite),
      selected: data.view.selected < data.methods.length,
      rows: document.querySelectorAll("#method-list tbody tr").length,
      refused: data.refused.length,
      title: text("#drawing-title") !== "",
      ghosts: document.querySelectorAll(".ghosts .ghost").length + data.view.hidden.size,
      notice: data.notice,
    };
  });

test(`${LINKS} damaged links: the undamaged entries run, and what is shown is of one run`, async (t) => {
  const page = await open(t, { hash: "#pendulum" });
  const random = randomFrom(23);
  for (let k = 0; k < LINKS; k++) {
    const at = random(ENTRIES.length);
    const changed = damaged(ENTRIES[at], random);
    const hash = ENTRIES.map((entry, i) => (i === at ? changed : entry)).join("&");
    const said = `${ENTRIES[at]} as ${changed}`;
    await page.evaluate((text) => (location.hash = `${text}&`), hash);
    await page.waitForFunction(() => history.state !== null, null, { timeout: LONG });
    await soon(async () => {
      const now = await whole(page);
      const lost = ENTRIES.filter(
        (entry, i) => i !== at && entry.startsWith("method=") && !/scene=/.test(ENTRIES[at]),
      ).filter((entry) => !now.methods.includes(entry.slice(7)));
      assert.deepEqual(lost, [], `${said}: methods that are lost`);
      assert.ok(now.methods.length >= 1 && now.selected && now.finite && now.title, said);
      assert.equal(now.columns, now.methods.length, `${said}: the recording is of these methods`);
      assert.equal(now.ghosts, now.methods.length, `${said}: the drawing is of these methods`);
      assert.equal(now.rows, now.methods.length + now.refused, `${said}: so is the table`);
    });
  }
});

test("scenes with every kind of error, put into the editor: each is said at a line, and the last good one runs", async (t) => {
  const page = await open(t, { hash: "#scene=four-bar&method=projection@rk4:h=0.02" });
  await page.getByRole("button", { name: "edit", exact: true }).click();
  await soon(async () => assert.match(await page.inputValue("#editor-text"), /"holonom"/));
  const good = await page.inputValue("#editor-text");
  const before = await read(page, ({ id, run, scene }) => ({ id, run, scene: scene.id }));
  const names = readdirSync(FOLDER)
    .filter((name) => name.endsWith(".json"))
    .filter((_, i) => i % EVERY === 0);
  assert.ok(names.length > 20);
  for (const name of names) {
    const text = readFileSync(join(FOLDER, name), "utf8");
    await page.evaluate((value) => {
      const field = document.querySelector("#editor-text");
      document.querySelector("#editor-state").textContent = "";
      field.value = value;
      field.dispatchEvent(new Event("input"));
    }, text);
    await soon(async () => {
      const now = await page.evaluate(() => ({
        state: document.querySelector("#editor-state").textContent,
        faults: [...document.querySelectorAll(".editor-faults li[data-line]")].map(
          ({ textContent }) => textContent,
        ),
      }));
      assert.equal(now.state, "not a scene yet: the last good one runs", name);
      assert.ok(now.faults.length > 0, `${name}: a fault at its line`);
      assert.ok(
        now.faults.every((fault) => /^line \d+..+/.test(fault)),
        `${name}: ${now.faults}`,
      );
    }, LONG);
    assert.deepEqual(
      await read(page, ({ id, run, scene }) => ({ id, run, scene: scene.id })),
      before,
      `${name}: nothing of the run has changed`,
    );
  }

  // and a good one after all of them runs
  await page.fill(
    "#editor-text",
    good.replace(/"title": *"[^"]*"/, '"title": "After all of them"'),
  );
  await until(page, (data) => data.scene.title === "After all of them", LONG);
  await soon(async () => assert.equal(await page.locator(".editor-faults li").count(), 0));
});

test("two tabs and another client: each tab keeps its own run, equal to the bit; a change from outside is followed", async (t) => {
  const hash = "#scene=four-bar&method=index1@rk4:h=0.02&method=projection@rk4:h=0.02";
  const one = await open(t, { hash });
  const two = await open(t, { hash });
  await Promise.all([playTo(one, 0.5), playTo(two, 0.5)]);
  const state = (page) =>
    read(page, ({ latest }) => JSON.stringify(latest.methods.map(({ q, v }) => [q, v])));
  assert.equal(await state(one), await state(two), "the same bits in both tabs");

  // a change in one tab is none in the other
  const kept = await read(two, ({ id, run }) => ({ id, run }));
  await one.fill("#set-h", "0.01");
  await one.keyboard.press("Enter");
  await until(one, (data) => data.methods.every(({ spelling }) => /h=0\.01$/.test(spelling)));
  assert.deepEqual(await read(two, ({ id, run }) => ({ id, run })), kept);

  // another client changes the comparison of the first tab: all of it follows
  const id = await read(one, (data) => data.id);
  const answer = await fetch(new URL(`/api/v1/comparisons/${id}`, one.url()), {
    method: "PATCH",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ methods: ["reduced@rk4:h=0.01"], parameters: { l1: 0.45 } }),
  });
  assert.equal(answer.status, 200);
  await until(one, (data) => data.methods.length === 1 && data.settings.l1 === 0.45);
  await soon(async () => {
    const now = await whole(one);
    assert.deepEqual(now.methods, ["reduced@rk4:h=0.01"]);
    assert.deepEqual(
      [now.columns, now.ghosts, now.rows],
      [1, 1, 1],
      "nothing is left of the others",
    );
  });

  // another client closes it: the tab says so when it is asked to play, and makes it again
  await fetch(new URL(`/api/v1/comparisons/${id}`, one.url()), { method: "DELETE" });
  await one.focus("#play");
  await one.keyboard.press("Space");
  await until(one, `(data) => data.id !== "${id}" && data.latest?.t > 0.05`, LONG);
  assert.deepEqual(await read(two, ({ id: own, run }) => ({ id: own, run })), kept);
  const faults = bench.faultsOf(one);
  const others = faults.filter((fault) => !(/^not found/.test(fault) && fault.includes(id)));
  faults.splice(0, faults.length, ...others); // the closed comparison was asked for once more
});
