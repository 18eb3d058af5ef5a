// SPDX-License-Identifier: GPL-3.0-or-later
// A hand that pulls the mechanism while it runs: with the mouse, by keys, and again from its log.
import assert from "node:assert/strict";
import test from "node:test";
import {
  createBench,
  drawn,
  jointAt,
  playTo,
  read,
  screenBox,
  soon,
  stood,
  until,
} from "./support.mjs";

const bench = createBench();

/** Plays slowly, so that a hand has time. */
async function playSlowly(page) {
  await page.selectOption("#speed", "0.05");
  await until(page, (data) => data.speed === 0.05);
  await page.focus("#play");
  await page.keyboard.press("Space");
  await until(page, (data) => data.state === "running" && data.latest?.t > 0.05);
}

const last = (data) => ({
  t: data.latest?.t,
  q: data.latest?.methods.map(({ q }) => q),
  frame: data.latest?.frame,
});

test("a hand pulls while it runs, its force is told, and the log done again gives the same bits", async (t) => {
  const page = await bench.open(t);
  await playSlowly(page);
  // on a busy machine the joint may be gone when the pointer comes: then it is tried again
  await soon(async () => {
    await page.mouse.up();
    const at = await jointAt(page, "B");
    await page.mouse.move(at.x, at.y);
    await page.mouse.down();
    await page.mouse.move(at.x + 60, at.y - 60, { steps: 4 });
    await until(page, (data) => data.hand !== null, 2000);
  });
  await until(page, (data) => data.hand !== null && data.latest?.pull);
  await soon(async () =>
    assert.match(await page.textContent(".picture .hand text"), /^[\d.]+ (m|k)?N$/),
  );
  assert.ok(await page.getByText("arrow: force of spring and damper").isVisible());
  await page.mouse.up();
  await until(page, (data) => data.hand === null && data.pulls.length >= 2);
  await page.keyboard.press("Space");
  await stood(page);

  // all methods, by an independent client: the same frames with the log
  const live = await read(page, last);
  const { pulls, methods, scene, speed } = await read(page, (data) => ({
    pulls: data.pulls,
    methods: data.methods.map(({ spelling }) => spelling),
    scene: data.scene.id,
    speed: data.settings,
  }));
  const ask = async (method, path, body) => {
    const answer = await fetch(new URL(path, bench.url), {
      method,
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(body),
    });
    return answer.json();
  };
  const made = await ask("POST", "/api/v1/comparisons", {
    scene,
    methods,
    pulls,
    parameters: speed,
  });
  const again = await ask("PATCH", `/api/v1/comparisons/${made.id}`, { step: live.frame });
  assert.deepEqual(
    again.latest.methods.map(({ q }) => q),
    live.q,
  );
  assert.ok(again.latest.methods.every(({ work }) => Math.abs(work) > 0));

  // a link does it again as well, to the same frame
  await page.keyboard.press("l");
  await until(page, (data) => /link copied|address line/.test(data.notice));
  const { hash } = new URL(page.url());
  assert.match(hash, /pulls=/);
  const other = await bench.open(t, { hash });
  await until(other, `(data) => data.latest?.frame === ${live.frame}`);
  assert.deepEqual((await read(other, last)).q, live.q);
  assert.deepEqual(await read(other, (data) => data.pulls), pulls);

  // the stored reference is of another motion; without the hand it is back
  await until(page, (data) => data.reference?.state === "none");
  const { past } = await read(page, (data) => data.undo);
  await page.getByRole("button", { name: "forget the pulls" }).click();
  await until(page, (data) => !data.pulled && data.reference?.state === "ready");
  await until(page, (data) => data.undo.undoes === "the pull");

  // forgetting is a change like others: undone, the same log is there again
  const log = JSON.stringify(pulls);
  await page.getByRole("button", { name: "Undo" }).click();
  await until(page, `(data) => data.pulled && JSON.stringify(data.pulls) === '${log}'`);
  await until(page, (data) => data.undo.future === 1);
  await page.getByRole("button", { name: "Redo" }).click();
  await until(page, (data) => !data.pulled && data.pulls.length === 0 && data.undo.future === 0);

  // so is the pull itself
  await page.getByRole("button", { name: "Undo" }).click();
  await until(page, (data) => data.pulls.length > 0 && data.undo.future === 1);
  await page.getByRole("button", { name: "Undo" }).click();
  await until(page, (data) => data.pulls.length === 0 && data.undo.future === 2);
});

test("numbers of a row stand apart, also while a hand pulls and errors are estimated", async (t) => {
  // angles and lengths: an error of both; the loops of the other scene are closed to rounding
  for (const scene of ["slider-crank", "n-four-bar"]) {
    const page = await bench.open(t, { hash: `#${scene}` });
    await page.getByRole("button", { name: "pull", exact: true }).click();
    await page.keyboard.press("ArrowRight");
    await until(page, (data) => data.hand !== null && data.pulled);
    await page.focus("#play");
    await page.keyboard.press("Space");
    await until(page, (data) => data.latest?.methods.every((one) => one.error_estimate?.q > 0));
    await soon(async () => assert.match(await page.textContent("tbody td.off"), /^≈ /));
    const touching = await page.evaluate(() =>
      [...document.querySelectorAll(".method-table tbody tr")].flatMap((row) => {
        const boxes = [...row.querySelectorAll("td:is(.gap, .off, .energy, .cost) > .number")].map(
          (node) => {
            const range = document.createRange();
            range.selectNodeContents(node);
            return { text: node.textContent, box: range.getBoundingClientRect() };
          },
        );
        return boxes.slice(1).flatMap(({ text, box }, k) => {
          const before = boxes[k];
          return before.box.right > box.left ? [`${before.text} | ${text}`] : [];
        });
      }),
    );
    assert.deepEqual(touching, [], scene);
  }
});

test("a hand pulls by keys, and lets go with Escape", async (t) => {
  const page = await bench.open(t);
  await page.getByRole("button", { name: "pull", exact: true }).click();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Shift+ArrowUp");
  await until(page, (data) => data.hand !== null);
  const { hand, from } = await read(page, (data) => ({
    hand: data.hand,
    from: Array.from(data.history.pointsAt(data.view.selected, 0)),
  }));
  assert.ok(hand.to[0] > from[3 * hand.point], "to the right");
  assert.ok(hand.to[1] > from[3 * hand.point + 1], "and up");
  await until(page, (data) => data.pulled);
  await page.keyboard.press("Escape");
  await until(page, (data) => data.hand === null);
  await drawn(page);
});

async function pullByKeys(page) {
  await page.getByRole("button", { name: "pull", exact: true }).click();
  for (let k = 0; k < 4; k++) {
    await page.keyboard.press("ArrowUp");
  }
  await until(page, (data) => data.hand !== null && data.pulled);
}

test("a pull by keys shows the newest frame, and the picture goes on", async (t) => {
  const page = await bench.open(t, { hash: "#slider-crank" });
  await playSlowly(page);
  await pullByKeys(page);
  const from = await read(page, (data) => data.latest.t);
  await until(page, `(data) => data.latest.t > ${from} + 0.1`);
  assert.equal(await read(page, (data) => data.view.shown), -1, "the newest frame");
  await page.keyboard.press("Escape");
  await until(page, (data) => data.hand === null && data.pulls.length > 0);
});

test("undo while a hand holds takes back the pull, not the scene", async (t) => {
  const page = await bench.open(t);
  await playSlowly(page);
  await page.getByRole("button", { name: "gallery" }).click();
  await page.fill("#gallery-search", "slider-crank");
  await page.locator(".gallery .cards li:visible button").first().click();
  await until(page, (data) => data.scene.id === "slider-crank" && data.undo.past === 1);
  await page.locator("#play").click();
  await until(page, (data) => data.state === "running" && data.latest?.t > 0.1);
  await pullByKeys(page);
  await page.getByRole("button", { name: "Undo" }).click();
  await until(page, (data) => data.undo.future === 1 && !data.hand && !data.pulled);
  assert.equal(await read(page, (data) => data.scene.id), "slider-crank");
  await page.getByRole("button", { name: "Redo" }).click();
  await until(page, (data) => data.pulled && data.pulls.length > 0 && data.undo.future === 0);
});

test("a recording that plays is not pulled, and the page says why", async (t) => {
  const page = await bench.open(t);
  await playTo(page, 1);
  await page.selectOption("#speed", "0.05"); // it plays for 20 s
  await until(page, (data) => data.speed === 0.05);
  await page.focus("#play");
  await page.keyboard.press("Backspace");
  await until(page, (data) => data.view.shown === 0);
  await page.locator("#play").click();
  await until(page, (data) => data.view.replaying);
  await page.getByRole("button", { name: "pull", exact: true }).click();
  await page.keyboard.press("ArrowUp");
  await until(page, (data) =>
    /^this is a recording to .* s: a hand can pull only/.test(data.notice),
  );
  assert.equal(await read(page, (data) => data.hand), null);
});

test("with pull on, a drag on methods that stand says so and changes nothing; with it off, it sets the start", async (t) => {
  const page = await bench.open(t);
  await playTo(page, 1);
  const pull = page.getByRole("button", { name: "pull", exact: true });
  await pull.click();
  const drag = async () => {
    const { x, y } = await jointAt(page, "A");
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x - 30, y - 20, { steps: 4 });
  };
  const before = await read(page, ({ run, settings, latest }) => ({ run, settings, t: latest.t }));
  await drag();
  await until(page, (data) => /^the methods stand: press Play, then pull/.test(data.notice));
  await page.mouse.up();
  assert.equal(await read(page, (data) => data.drag), null);
  assert.deepEqual(
    await read(page, ({ run, settings, latest }) => ({ run, settings, t: latest.t })),
    before,
  );
  await pull.click();
  await drag();
  await until(page, (data) => data.drag?.moved);
  await page.mouse.up();
  await until(page, (data) => "start.th1" in data.settings);
});

test("a drag over empty places of the drawing marks no text", async (t) => {
  const page = await bench.open(t);
  await drawn(page);
  const box = await screenBox(page.locator("svg.picture"));
  await page.mouse.move(box.x + 3, box.y + box.height * 0.2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width - 3, box.y + box.height - 60, { steps: 5 });
  await page.mouse.up();
  assert.equal(await page.evaluate(() => String(getSelection())), "");
});
