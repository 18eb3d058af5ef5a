// SPDX-License-Identifier: GPL-3.0-or-later
// Damage on the way to the page: links with bad entries, scenes with every kind of error,
// two tabs and another client on one comparison. Nothing may be lost, stale, or on the console.
// DAMAGED_LINKS is how many links are opened; EVERY_SCENE=1 takes all bad scenes, not every sixth.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { damaged, randomFrom } from "./damage.mjs";
import { createBench, PATIENCE, playTo, read, ROOT, soon, until } from "./support.mjs";

const LINKS = Number(process.env.DAMAGED_LINKS ?? 16);
const EVERY = process.env.EVERY_SCENE ? 1 : 6;
const FOLDER = join(ROOT, "tests/scenes/bad");
/** The windows that open links side by side. */
const WINDOWS = [
  { width: 1280, height: 900 },
  { width: 360, height: 740 },
];
const AT_ONCE = 8; // links that a page opens by itself

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
/**
 * A damaged link, and what of it is not damaged.
 * @typedef {{said: string, hash: string, methods: string[]}} Link methods: those that must run
 */

/**
 * The same links each time, whoever opens them. A text that came before is the same link.
 * @param {number} count how often a link is damaged
 * @returns {Link[]}
 */
function damagedLinks(count) {
  const random = randomFrom(23);
  const links = Array.from({ length: count }, () => {
    const at = random(ENTRIES.length);
    const changed = damaged(ENTRIES[at], random);
    const entries = ENTRIES.map((entry, i) => (i === at ? changed : entry));
    const sound = ENTRIES[at].startsWith("scene=") ? [] : ENTRIES.filter((_, i) => i !== at);
    return {
      said: `${ENTRIES[at]} as ${changed}`,
      hash: `${entries.join("&")}&`,
      methods: sound.filter((entry) => entry.startsWith("method=")).map((entry) => entry.slice(7)),
    };
  });
  return [...new Map(links.map((link) => [link.hash, link])).values()];
}

/** In the page, when it is loaded: tells when a link has been read, and what is shown then. */
function watchLinks() {
  const replace = history.replaceState;
  history.replaceState = function (...args) {
    replace.apply(this, args);
    dispatchEvent(new Event("place"));
  };
  const text = (selector) => document.querySelector(selector)?.textContent ?? "";
  /** All that has to be of one run: what the page knows, and what it shows. */
  globalThis.whole = () => {
    const { data } = globalThis.holonom;
    return {
      scene: data.scene.id,
      methods: data.methods.map(({ spelling }) => spelling),
      columns: data.history.nMethods,
      frames: data.history.count,
      finite: [...data.history.pointsAt(0, data.history.count - 1)].every(Number.isFinite),
      selected: data.view.selected < data.methods.length,
      rows: document.querySelectorAll("#method-list tbody tr").length,
      refused: data.refused.length,
      title: text("#drawing-title") !== "",
      ghosts: document.querySelectorAll(".ghosts .ghost").length + data.view.hidden.size,
      notice: data.notice,
    };
  };
}

/**
 * In the page: opens links one after the other, each when the one before is read and shown.
 * @param {{links: Link[], limit: number}} what limit: how long one may take [ms]
 * @returns {Promise<string[]>} a sentence for each that is not shown as it should be
 */
async function openLinks({ links, limit }) {
  const faults = [];
  const nextFrame = () => new Promise((done) => requestAnimationFrame(done));
  /** Returns what is not yet as it should be, or "". @param {string[]} wanted */
  const missing = (wanted) => {
    const now = globalThis.whole();
    const n = now.methods.length;
    const checks = {
      "methods are lost": wanted.every((one) => now.methods.includes(one)) && n > 0,
      "the selected method is none": now.selected,
      "no frame is there": now.frames > 0,
      "a point is no number": now.finite,
      "the drawing has no title": now.title,
      "the recording is of other methods": now.columns === n,
      "the drawing is of other methods": now.ghosts === n,
      "the table is of other methods": now.rows === n + now.refused,
    };
    const wrong = Object.keys(checks).filter((name) => !checks[name]);
    return wrong.length ? `${wrong.join(", ")}: ${JSON.stringify(now)}` : "";
  };
  for (const { said, hash, methods } of links) {
    const end = performance.now() + limit;
    const read = new Promise((done) => {
      const look = () => {
        if (history.state !== null || performance.now() > end) {
          removeEventListener("place", look);
          clearTimeout(timer);
          done(undefined);
        }
      };
      const timer = setTimeout(look, limit + 1);
      addEventListener("place", look);
      location.hash = hash;
      look(); // the address may be the one that was there
    });
    await read;
    let wrong = history.state === null ? "the link was not read to its end" : missing(methods);
    while (wrong && performance.now() < end) {
      await nextFrame();
      wrong = missing(methods);
    }
    if (wrong) {
      faults.push(`${said}: ${wrong}`);
    }
  }
  return faults;
}

test(`a link damaged ${LINKS} times: the other entries run, and what is shown is of one run`, async (t) => {
  const links = damagedLinks(LINKS);
  const total = links.length;
  const pages = await Promise.all(
    WINDOWS.map((viewport) => open(t, { hash: "#pendulum", init: watchLinks, viewport })),
  );
  let opened = 0;
  const work = pages.map(async (page) => {
    while (links.length > 0) {
      const some = links.splice(0, AT_ONCE);
      assert.deepEqual(await page.evaluate(openLinks, { links: some, limit: PATIENCE }), []);
      assert.deepEqual(bench.faultsOf(page), [], "nothing on the console");
      opened += some.length;
      if (opened % 200 < AT_ONCE && total > 200) {
        console.log(`${opened} of ${total} different links opened, none lost`);
      }
    }
  });
  await Promise.all(work);
  assert.equal(opened, total);
  t.diagnostic(`${LINKS} times damaged, ${opened} different links opened, none lost`);
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
    });
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
  await until(page, (data) => data.scene.title === "After all of them");
  await soon(async () => assert.equal(await page.locator(".editor-faults li").count(), 0));
});

test("two tabs and another client: each tab keeps its own run, equal to the bit; a change from outside is followed", async (t) => {
  const hash = "#scene=four-bar&method=index1@rk4:h=0.02&method=projection@rk4:h=0.02";
  const one = await open(t, { hash, init: watchLinks });
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
    const now = await one.evaluate(() => globalThis.whole());
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
  await until(one, `(data) => data.id !== "${id}" && data.latest?.t > 0.05`);
  assert.deepEqual(await read(two, ({ id: own, run }) => ({ id: own, run })), kept);
  const faults = bench.faultsOf(one);
  const others = faults.filter((fault) => !(/^not found/.test(fault) && fault.includes(id)));
  faults.splice(0, faults.length, ...others); // the closed comparison was asked for once more
});
