// SPDX-License-Identifier: GPL-3.0-or-later
// A joint is dragged to where the motion starts: the loops stay closed, what cannot follow is held
// with a reason, and every change can be undone.
import assert from "node:assert/strict";
import { test } from "node:test";
import { createBench, drawn, jointAt, playTo, read, screenBox, soon, until } from "./support.mjs";

const { open } = createBench();

/** Takes hold of a joint and moves it by so many pixels, step by step. */
async function drag(page, name, dx, dy) {
  const { x, y } = await jointAt(page, name);
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let k = 1; k <= 6; k++) {
    await page.mouse.move(x + (k * dx) / 6, y + (k * dy) / 6);
    await until(page, (data) => data.drag?.moved);
  }
}

/** Counts the requests to an address that have no answer yet. @returns {() => number} */
function countAsked(page, address) {
  let open = 0;
  const count = (by) => (request) => (open += address.test(request.url()) ? by : 0);
  page.on("request", count(1));
  page.on("requestfinished", count(-1));
  page.on("requestfailed", count(-1));
  return () => open;
}

const ends = (data) => ({
  q: data.latest.methods.map(({ q }) => q),
  gaps: data.latest.methods.map(({ gap }) => gap),
  t: data.latest.t,
});

test("a dragged joint takes the closed mechanism along and becomes the start of all methods; undo and redo", async (t) => {
  const page = await open(t);
  const before = await read(page, ends);
  await drag(page, "A", -70, 12);
  await until(page, `(data) => data.drag.state.th1 > ${before.q[0][0]} + 0.3`);
  await soon(async () =>
    assert.match(
      await page.textContent(".drag-note"),
      /^A at .+ m?m, .+ m?m\. Let go to start from here\.$/,
    ),
  );
  await page.mouse.up();
  await until(page, (data) => data.drag === null && data.settings["start.th1"] > 1.3);
  const after = await read(page, ends);
  assert.equal(after.t, 0);
  assert.ok(
    after.q.every((q) => Math.abs(q[0] - after.q[0][0]) < 1e-12),
    "one start for all",
  );
  assert.ok(
    after.gaps.every((gap) => gap < 1e-12),
    `closed: ${after.gaps}`,
  );
  await until(page, (data) => data.reference?.state === "ready");
  await page.focus("#play");
  await page.keyboard.press("Control+z");
  await until(page, (data) => Object.keys(data.settings).length === 0 && data.latest?.t === 0);
  await soon(async () => assert.deepEqual((await read(page, ends)).q, before.q));
  await page.getByRole("button", { name: "Redo" }).click();
  await until(page, (data) => data.settings["start.th1"] > 1.3);
  await soon(async () => assert.deepEqual((await read(page, ends)).q, after.q));
});

test("where the loops allow no more, the last configuration is held and the reason said; Escape lets go of nothing", async (t) => {
  const page = await open(t);
  await drag(page, "B", 60, -150);
  await until(page, (data) => data.drag?.held);
  await soon(async () =>
    assert.match(
      await page.textContent(".drag-note"),
      /^Held here: no closed configuration near this one/,
    ),
  );
  await soon(async () => assert.equal(await page.locator(".leash").count(), 1));
  const finite = await read(page, (data) => data.drag.points.every(Number.isFinite));
  assert.ok(finite);
  await page.keyboard.press("Escape");
  await until(page, (data) => data.drag === null);
  await page.mouse.up();
  await soon(async () => assert.deepEqual(await read(page, (data) => data.settings), {}));
});

test("the start is set by number too, and a link carries it", async (t) => {
  const page = await open(t);
  await page.getByRole("button", { name: "lengths, masses, start" }).click();
  await soon(async () =>
    assert.ok(await page.isVisible("#parameter-th1_0"), "the crank starts where th1_0 says"),
  );
  await soon(async () => assert.ok(await page.isHidden("#start-th1")));
  await page.fill("#start-th3", "70 deg");
  await page.press("#start-th3", "Enter");
  await until(page, (data) => Math.abs(data.settings["start.th3"] - (70 * Math.PI) / 180) < 1e-9);
  const { gaps } = await read(page, ends);
  assert.ok(gaps.every((gap) => gap < 1e-12));

  // one start has one field: moved, it is the coordinates' own
  await soon(async () => assert.ok(await page.isHidden("#parameter-th1_0")));
  await soon(async () => assert.ok(await page.isHidden("#parameter-w1_0")));
  const th1 = await read(page, (data) => data.scene.coordinates[0].value);
  await soon(async () =>
    assert.ok(Math.abs(Number(await page.inputValue("#start-th1")) - th1) < 1e-9),
  );
  await page.fill("#start-w1", "90 deg/s");
  await page.press("#start-w1", "Enter");
  await until(page, (data) => Math.abs(data.scene.coordinates[0].rate_value - Math.PI / 2) < 1e-9);
  const { q } = await read(page, ends);
  await page.fill("#start-th1", "2e9");
  await page.press("#start-th1", "Enter");
  await soon(async () => assert.match(await page.textContent("#start-th1-hint"), /too large/));
  await page.focus("#play");
  await page.keyboard.press("l");
  await until(page, (data) => /link copied|address line/.test(data.notice));
  const other = await open(t, { hash: new URL(page.url()).hash });
  await soon(async () => assert.deepEqual((await read(other, ends)).q, q));
});

test("a length has a handle on its bar; one that cannot be assembled is held back with the reason", async (t) => {
  const page = await open(t);
  await page.getByRole("button", { name: "↔ lengths" }).click();
  await page.waitForSelector(".length-handle");
  const names = await page.locator(".length-handle text").allTextContents();
  assert.deepEqual(names, ["l1 0.5 m", "l2 1.2 m", "l3 0.8 m", "l4 1 m"]);
  const coupler = await screenBox(page.locator(".length-handle rect").nth(1));
  const [x, y] = [coupler.x + coupler.width / 2, coupler.y + coupler.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 12, y, { steps: 3 });
  await until(page, (data) => data.drag?.settings.l2 > 1.25);
  const preview = await read(page, (data) => [data.drag.settings, data.drag.points]);
  await page.mouse.move(x + 500, y, { steps: 3 });
  await page.waitForFunction(() =>
    /^Held here: .{10}/.test(document.querySelector(".drag-note").textContent),
  );
  const held = await read(page, (data) => data.drag.settings.l2);
  assert.ok(held > 1.2 && held < 3, `the last length that closes is ${held} m`);
  await page.mouse.up();
  await until(page, (data) => data.drag === null && data.settings.l2 > 1.2);
  const { settings, gap } = await read(page, (data) => ({
    settings: data.settings,
    gap: data.latest.methods[0].gap,
  }));
  assert.deepEqual(settings, { l2: held });
  assert.ok(gap < 1e-12);

  // what was shown on the way is the start that a run with that length has
  const [parameters, points] = preview;
  const answer = await fetch(new URL("/api/v1/assemble", page.url()), {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ scene: "four-bar", parameters }),
  });
  assert.deepEqual((await answer.json()).points, points);
});

test("a joint that is dragged to where it stands changes nothing, and there is nothing to undo", async (t) => {
  const page = await open(t);
  await page.getByRole("button", { name: "↔ lengths" }).click();
  await page.getByText("drag a square along its bar").waitFor();
  const { x, y } = await jointAt(page, "A");
  await page.mouse.move(x, y);
  const waiting = countAsked(page, /drag/); // before the first of them is asked
  await page.mouse.down();
  // out to the side and back
  await page.mouse.move(x - 30, y, { steps: 3 });
  await until(page, (data) => data.drag?.moved);
  await page.mouse.move(x, y, { steps: 3 });
  await soon(async () => {
    await drawn(page); // an answer asks for the newest wish at once
    assert.equal(waiting(), 0);
  });
  const run = await read(page, (data) => data.run);
  await page.mouse.up();
  await until(page, (data) => data.drag === null);
  const after = await read(page, ({ settings, undo, run: now }) => [
    settings,
    undo.past,
    undo.future,
    now,
  ]);
  assert.deepEqual(after, [{}, 0, 0, run]);
});

test("the place of a dragged length is where the next run starts, also late in a run", async (t) => {
  const page = await open(t);
  await playTo(page, 1.5);
  await page.getByRole("button", { name: "↔ lengths" }).click();
  await page.waitForSelector(".length-handle");
  await soon(async () =>
    assert.equal(await read(page, (data) => data.view.shown), 0, "lengths are those of the start"),
  );
  const coupler = await screenBox(page.locator(".length-handle rect").nth(1));
  const [x, y] = [coupler.x + coupler.width / 2, coupler.y + coupler.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  const waiting = countAsked(page, /assemble/);
  await page.mouse.move(x + 14, y, { steps: 3 });
  await until(page, (data) => data.drag?.settings.l2 > 1.25);
  await soon(async () => {
    await drawn(page); // an answer asks for the newest wish at once
    assert.equal(waiting(), 0);
  });
  const shown = await read(page, (data) => data.drag.points);
  await page.mouse.up();
  await until(page, (data) => data.drag === null && data.settings.l2 > 1.25);
  const start = await read(page, (data) => Array.from(data.history.pointsAt(0, 0)));
  shown.forEach((value, i) => assert.ok(Math.abs(value - start[i]) < 1e-9, `${value} ${start[i]}`));
  await page.focus("#play");
  await page.keyboard.press("Space");
  await until(page, (data) => data.state === "running");
  await soon(async () =>
    assert.ok(await read(page, (data) => !data.view.lengths), "no handle lies over the motion"),
  );
  await page.keyboard.press("Space");
});
