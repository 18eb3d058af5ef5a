// SPDX-License-Identifier: GPL-3.0-or-later
// The line between page and server: cut and mended, hidden, late, and after the end of a run.
import assert from "node:assert/strict";
import { test } from "node:test";
import { createBench, PATIENCE, drawn, fastest, playTo, read, soon, until } from "./support.mjs";

const bench = createBench();
const { open } = bench;

/** Hides the page, or shows it again. */
function show(page, visible) {
  return page.evaluate((hidden) => {
    Object.defineProperty(document, "hidden", { configurable: true, get: () => hidden });
    document.dispatchEvent(new Event("visibilitychange"));
  }, !visible);
}

/** Waits until a comparison is in a state, asked of the server itself. */
async function stateOnServer(id, state) {
  const end = Date.now() + PATIENCE;
  for (;;) {
    const answer = await fetch(`${bench.url}api/v1/comparisons/${id}`);
    if ((await answer.json()).state === state) {
      return;
    }
    assert.ok(Date.now() < end, `${id} is not ${state}`);
    await new Promise((resolve) => setTimeout(resolve, 25));
  }
}

/** The server closes a page's comparison, once the page listens to it; returns its id. */
async function closeOnServer(page) {
  await until(page, (data) => data.stream.state === "live");
  const id = await read(page, (data) => data.id);
  const answer = await fetch(`${bench.url}api/v1/comparisons/${id}`, { method: "DELETE" });
  assert.equal(answer.status, 204);
  await until(page, (data) => data.stream.state === "ended");
  return id;
}

async function type(page, field, text) {
  await page.fill(field, text);
  await page.press(field, "Enter");
}

test("a line that drops is told, and mended it resumes without a missing or repeated frame", async (t) => {
  const line = await bench.line(t);
  const page = await open(t, { url: line.url });
  await page.keyboard.press("Space");
  await until(page, (data) => data.latest?.t > 0.5);
  line.cut();
  await page.waitForFunction(() =>
    /reconnecting/.test(document.querySelector(".stream").textContent),
  );
  const seen = await read(page, (data) => data.latest.frame);
  await page.waitForTimeout(1200);
  line.mend();
  await until(page, `(data) => data.stream.state === "live" && data.latest.frame > ${seen} + 30`);
  const { stride, steps, dt } = await read(page, (data) => ({
    stride: data.history.stride,
    dt: data.frameDt,
    steps: Array.from(
      data.history.t.subarray(1, data.history.count),
      (t, i) => t - data.history.t[i],
    ),
  }));
  assert.equal(stride, 1);
  assert.ok(
    steps.every((step) => Math.abs(step - dt) < 1e-9),
    "every frame follows the one before it",
  );
});

test("a hidden page closes its stream and catches up when it is shown", async (t) => {
  const page = await open(t);
  await page.keyboard.press("Space");
  await until(page, (data) => data.latest?.t > 0.3);
  await show(page, false);
  await soon(async () => assert.match(await page.textContent(".stream"), /paused while hidden/));
  const seen = await read(page, (data) => data.latest.frame);
  await page.waitForTimeout(800);
  await soon(async () => assert.equal(await read(page, (data) => data.latest.frame), seen));
  await show(page, true);
  await until(page, `(data) => data.latest.frame > ${seen} + 40`);
  const whole = await read(page, (data) => data.history.count === data.latest.frame + 1);
  assert.ok(whole, "no frame is missing");
});

test("a finished run stops the clock; another step runs it again, Backspace sets it back", async (t) => {
  const page = await open(t, { hash: "#pendulum" });
  for (let k = 0; k < 3; k++) {
    await page.keyboard.press("=");
  }
  await until(page, (data) => data.speed === 10);
  await page.keyboard.press("Space");
  await until(page, (data) => data.state === "finished");
  await soon(async () => assert.match(await page.textContent("#play"), /Replay/));
  const generation = await read(page, (data) => data.generation);
  await type(page, "#set-h", "0.002");
  await until(page, `(data) => data.generation > ${generation} && data.latest?.t > 0.2`); // runs on by itself
  await page.focus("#play");
  await page.keyboard.press("Backspace");
  await until(page, (data) => data.state !== "running" && data.view.shown === 0);
  const frames = await read(page, (data) => data.history.count);
  await page.keyboard.press("Space");
  await until(page, (data) => data.view.replaying && data.view.shown > 3);
  await soon(async () =>
    assert.ok((await read(page, (data) => data.history.count)) >= frames, "nothing is lost"),
  );
});

test("a change made at a run's end, before the page heard of the end, runs on; what comes late of the old run is past", async (t) => {
  const line = await bench.line(t);
  const page = await open(t, { url: line.url });
  await fastest(page);
  line.hold();
  await page.keyboard.press("Space");
  await until(page, (data) => data.state === "running");
  const { id, generation } = await read(page, ({ id, generation }) => ({ id, generation }));
  await stateOnServer(id, "finished");
  await soon(async () =>
    assert.equal(
      await read(page, (data) => data.state),
      "running",
      "the end has not been heard of",
    ),
  );
  await type(page, "#set-h", "0.002");
  await until(page, `(data) => data.generation > ${generation}`);
  line.letGo();
  await until(page, (data) => data.latest?.t > 1);
  await until(page, (data) => data.state === "finished" && data.stream.state === "ended");
  const { times, dt } = await read(page, (data) => ({
    times: Array.from(data.history.t.subarray(0, data.history.count)),
    dt: data.frameDt,
  }));
  assert.ok(
    times.every((at, k) => Math.abs(at - k * dt) < 1e-9),
    "every frame of the new run is there",
  );
});

test("an answer that comes after the run's end, told by the stream, does not set it running again", async (t) => {
  const page = await open(t, { hash: "#pendulum" });
  await fastest(page);
  await page.route("**/api/v1/comparisons/*", async (route) => {
    const answer = await route.fetch(); // made while it runs, and on its way until the end
    await until(page, (data) => data.state === "finished");
    await route.fulfill({ response: answer });
  });
  const late = page.waitForResponse((answer) => answer.request().method() === "PATCH");
  await page.keyboard.press("Space");
  assert.equal((await (await late).json()).state, "running");
  await page.unroute("**/api/v1/comparisons/*");
  await drawn(page);
  assert.equal(await read(page, (data) => data.state), "finished");
  await soon(async () => assert.match(await page.textContent("#play"), /Replay/));
});

test("answers that overtake the stream are not undone by what the stream tells later", async (t) => {
  const line = await bench.line(t);
  const page = await open(t, { url: line.url });
  line.hold();
  // slower, so that the run cannot end while the page does not hear of it
  for (const speed of [0.5, 0.25, 0.1]) {
    await page.keyboard.press("-");
    await until(page, `(data) => data.speed === ${speed}`);
  }
  await page.focus("#play");
  await page.keyboard.press("Space");
  await until(page, (data) => data.state === "running");
  await page.keyboard.press("Space");
  await until(page, (data) => data.state === "paused");
  await page.evaluate(() => {
    globalThis.seen = [];
    new MutationObserver(() =>
      globalThis.seen.push([
        document.querySelector("#play").textContent,
        document.querySelector("#speed").value,
      ]),
    ).observe(document.querySelector("#transport"), {
      subtree: true,
      childList: true,
      characterData: true,
    });
  });
  const last = await read(page, (data) => Number(data.stream.id));
  line.letGo();
  await until(page, `(data) => Number(data.stream.id) >= ${last} + 5`);
  const seen = await page.evaluate(() => globalThis.seen);
  assert.deepEqual(
    seen.filter(([play, speed]) => !/Play/.test(play) || speed !== "0.1"),
    [],
  );
});

test("a page that was hidden after the end of a run has nothing to reconnect to", async (t) => {
  const page = await open(t);
  await fastest(page);
  await page.keyboard.press("Space");
  await until(page, (data) => data.stream.state === "ended");
  const asked = [];
  page.on("request", (request) => asked.push(request.url()));
  await show(page, false);
  await show(page, true);
  await page.evaluate(() => dispatchEvent(new Event("online")));
  await page.keyboard.press("-");
  await until(page, (data) => data.speed === 5);
  await page.waitForTimeout(100);
  assert.deepEqual(
    asked.filter((url) => /events/.test(url)),
    [],
  );
  await soon(async () => assert.equal(await read(page, (data) => data.stream.state), "ended"));
});

test("a comparison that the server has forgotten is made again, and said so", async (t) => {
  const page = await open(t);
  const id = await closeOnServer(page);
  await page.keyboard.press("Space");
  await until(page, (data) => data.state === "running" && data.latest?.t > 0.3);
  await soon(async () => assert.notEqual(await read(page, (data) => data.id), id));
  await soon(async () =>
    assert.match(await page.textContent(".notice"), /computed again and goes on/),
  );
  assert.deepEqual(bench.faultsOf(page).splice(0), [
    `not found: ${bench.url}api/v1/comparisons/${id}`,
  ]);
});

test("another scene opens although the server has closed the comparison before it, and nothing is said of that", async (t) => {
  const page = await open(t);
  const id = await closeOnServer(page);
  await Promise.all([
    page.waitForResponse((answer) => answer.request().method() === "DELETE"),
    page.evaluate(() => (location.hash = "#pendulum")),
  ]);
  await until(page, (data) => data.scene.id === "pendulum");
  assert.doesNotMatch(await read(page, (data) => data.notice), /could not close/);
  assert.deepEqual(bench.faultsOf(page), []);
});

test("a speed that is chosen for a comparison that the server has forgotten stays chosen", async (t) => {
  const page = await open(t);
  const asked = [];
  page.on("request", (request) => {
    if (request.method() === "POST" && /\/comparisons$/.test(request.url())) {
      asked.push(JSON.parse(request.postData()).speed);
    }
  });
  const id = await closeOnServer(page);
  await page.selectOption("#speed", "0.1");
  await until(page, `(data) => data.id !== "" && data.id !== "${id}"`);
  await soon(async () => assert.equal(await page.inputValue("#speed"), "0.1"));
  assert.deepEqual(asked, [0.1], "the new comparison has it from its start");
  await until(page, (data) => data.speed === 0.1);
  assert.deepEqual(bench.faultsOf(page).splice(0), [
    `not found: ${bench.url}api/v1/comparisons/${id}`,
  ]);
});

test("a server that ends and starts again: said plainly, every frame stays, the run goes on", async (t) => {
  const line = await bench.line(t);
  const first = await bench.server(t);
  line.mend(first.port);
  const page = await open(t, { url: line.url });
  await page.keyboard.press("Space");
  await until(page, (data) => data.latest?.t > 0.5);
  line.cut();
  await first.stop();
  await page.waitForSelector(".lost:not([hidden])");
  await soon(async () =>
    assert.match(await page.textContent(".lost"), /does not answer.*data received so far stays/),
  );
  const seen = await read(page, (data) => ({
    id: data.id,
    frame: data.latest.frame,
    run: data.run,
  }));
  const again = await bench.server(t);
  line.mend(again.port);
  await until(page, `(data) => data.id !== "${seen.id}" && data.latest.frame > ${seen.frame} + 20`);
  await soon(async () => assert.ok(await page.isHidden(".lost")));
  await soon(async () =>
    assert.match(await page.textContent(".notice"), /computed again and goes on/),
  );
  const { run, times, dt } = await read(page, (data) => ({
    run: data.run,
    times: Array.from(data.history.t.subarray(0, data.history.count)),
    dt: data.frameDt,
  }));
  assert.equal(run, seen.run, "it is the same run");
  assert.ok(
    times.every((at, k) => Math.abs(at - k * dt) < 1e-9),
    "every frame is there",
  );
});

test("pause pressed while the server is away holds when it is back", async (t) => {
  const line = await bench.line(t);
  const page = await open(t, { url: line.url });
  await page.keyboard.press("Space");
  await until(page, (data) => data.latest?.t > 0.2);
  line.cut();
  await until(page, (data) => data.stream.state === "reconnecting");
  await page.keyboard.press("Space");
  await until(page, (data) => data.state === "paused");
  await soon(async () =>
    assert.match(await page.textContent(".notice"), /will be done when it is back/),
  );
  const id = await read(page, (data) => data.id);
  line.mend();
  await stateOnServer(id, "paused");
  await until(page, (data) => data.stream.state === "live" && data.state === "paused");
});

test("a change that is refused after the comparison expired loses nothing of the recording", async (t) => {
  const page = await open(t);
  await playTo(page, 1);
  const { id, last } = await read(page, (data) => ({ id: data.id, last: data.latest.t }));
  await fetch(`${bench.url}api/v1/comparisons/${id}`, { method: "DELETE" });
  await page.getByRole("button", { name: "add a method" }).click();
  await page.fill("#pick-spelling", "projection@rk4:h=-1");
  await page.locator("dialog[open] button[type=submit]").click();
  await page.waitForFunction(() => document.querySelector("#pick-error").textContent !== "");
  await soon(async () => assert.equal(await read(page, (data) => data.latest.t), last));
  await soon(async () => assert.equal(await read(page, (data) => data.methods.length), 5));

  // one that is taken starts the runs anew
  await page.fill("#pick-spelling", "projection@rk4:h=0.01");
  await page.locator("dialog[open] button[type=submit]").click();
  await until(page, (data) => data.methods.length === 6 && data.latest?.t === 0);
  bench.faultsOf(page).length = 0; // the comparison that was deleted
});

test("a field that nobody answered shows what runs once the server is there again", async (t) => {
  const line = await bench.line(t);
  const page = await open(t, { url: line.url });
  line.cut();
  await type(page, "#set-h", "0.013");
  await page.waitForFunction(() => document.querySelector("#set-h").getAttribute("aria-invalid"));
  await soon(async () => assert.match(await page.textContent("#set-h-hint"), /does not answer/));
  line.mend();
  await page.waitForFunction(() => !document.querySelector("#set-h").getAttribute("aria-invalid"));
  await soon(async () => assert.equal(await page.inputValue("#set-h"), "0.02"));
  assert.doesNotMatch(await page.textContent("#set-h-hint"), /does not answer/);
});
