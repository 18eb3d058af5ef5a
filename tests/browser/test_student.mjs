// SPDX-License-Identifier: GPL-3.0-or-later
// Ten minutes of a student who asks why a four-bar falls apart, step by step: S1 to S12. Each step
// starts on a page of its own.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { PROGRAM, ROOT, createBench, end, playTo, read, soon, stood, until } from "./support.mjs";

const ROUNDING = 1e-12; // [m] a loop that a method keeps closed
const bench = createBench();
const { open } = bench;

async function type(page, field, text) {
  await page.fill(field, text);
  await page.press(field, "Enter");
}

/** Largest gaps and changes of energy of all methods until now. */
const worst = (data) =>
  data.methods.map((_, m) => ({
    gap: data.history.worst(m, "gap", 0, data.history.count),
    energy: data.history.worst(m, "energy_change", 0, data.history.count),
  }));

const hasEnded = (kind) =>
  `({ studies }) => ["finished", "stopped"].includes(studies["${kind}"].state)`;

/** Returns the gap of the first method at a time [m]. */
const gapAt = (page, t) =>
  read(page, `(data) => data.history.columns[0].gap[data.history.indexAt(${t})]`);

test("S1 serve prints its address, and where the port is taken the next free one", async (t) => {
  const taken = new URL(bench.url).port;
  const child = spawn(PROGRAM, ["serve", "--port", taken], { cwd: ROOT });
  t.after(() => end(child));
  let text = "";
  for (const stream of [child.stdout, child.stderr]) {
    stream.on("data", (chunk) => (text += chunk));
  }
  await soon(async () => {
    assert.match(text, new RegExp(`port ${taken} is already in use; port \\d+ is used`));
    assert.match(text, /holonom is at http:\/\/127\.0\.0\.1:\d+\//);
  });
  const [url] = /http:\/\/127\.0\.0\.1:\d+\//.exec(text) ?? [];
  assert.notEqual(new URL(url).port, taken);
  assert.equal((await fetch(url)).status, 200);
});

test("S2 the page opens on a four-bar at rest with its methods; Play has the focus", async (t) => {
  const page = await open(t);
  await soon(async () => {
    const seen = await page.evaluate(() => ({
      focus: document.activeElement?.id,
      caption: document.querySelector(".caption")?.textContent,
      state: globalThis.holonom.data.state,
      names: globalThis.holonom.data.methods.map(({ formulation }) => formulation),
      gaps: globalThis.holonom.data.latest.methods.map(({ gap }) => gap),
    }));
    assert.equal(seen.focus, "play");
    assert.match(seen.caption ?? "", /crank-rocker, 1 degree of freedom/);
    assert.equal(seen.state, "paused");
    assert.ok(["index1", "baumgarte", "reduced"].every((name) => seen.names.includes(name)));
    assert.ok(seen.gaps.every((gap) => gap < ROUNDING));
  });
  const bare = await open(t, { javaScriptEnabled: false, wait: false });
  await soon(async () => assert.ok(await bare.locator(".still img").isVisible()));
});

test("S3 Space moves all methods; the raw gap grows, the others stay closed, and a sentence says so", async (t) => {
  const page = await open(t);
  await type(page, "#set-h", "1e-3");
  await until(page, (data) => data.methods.every(({ spelling }) => /h=0\.001$/.test(spelling)));
  await page.focus("#play");
  await page.keyboard.press("Space");
  await until(page, (data) => data.latest?.t > 0.2);
  await page.keyboard.press("Space");
  await stood(page);
  await playTo(page, 5); // where it stood, a swing may close the gap for a moment
  await soon(async () =>
    assert.match(await page.textContent(".seen"), /index-1: .*gap [\d.]+ [pnµ]m and growing/),
  );
  const [raw, , ...closed] = await read(page, worst);
  assert.ok(closed.every(({ gap }) => gap < ROUNDING && raw.gap > 100 * gap));
  const calm = await open(t, { reducedMotion: "reduce" });
  assert.ok(await read(calm, (data) => data.view.stepped));
});

test("S4 a step of 0.02 s opens the loop by 1 cm at 1.4 s; 0,02 and 2e-2 s are read, 0 is refused", async (t) => {
  const page = await open(t);
  await type(page, "#set-h", "0.01");
  await until(page, (data) => data.methods.every(({ spelling }) => /h=0\.01$/.test(spelling)));
  for (const text of ["0,02", "2e-2 s"]) {
    await type(page, "#set-h", text);
    await soon(async () => assert.equal(await page.inputValue("#set-h"), "0.02"));
  }
  await until(page, (data) => data.methods.every(({ spelling }) => /h=0\.02$/.test(spelling)));
  await playTo(page, 4);
  assert.ok((await gapAt(page, 1.6)) > 0.01 && (await gapAt(page, 1)) < 0.01, "near 1.4 s");
  assert.ok((await gapAt(page, 3.9)) > 0.1, "10 cm by then");
  await soon(async () => assert.match(await page.textContent(".stage, .tear"), /×/));
  await type(page, "#set-h", "0");
  await soon(async () => assert.match(await page.textContent("#set-h-hint"), /> 0/));
  assert.ok(
    (await read(page, (data) => data.methods)).every(({ spelling }) => /h=0\.02$/.test(spelling)),
    "the old run goes on",
  );
});

test("S5 Why? has what happened, the rule and things to try", async (t) => {
  const page = await open(t);
  await playTo(page, 2);
  await page.getByRole("button", { name: "Why? index-1" }).click();
  await soon(async () => {
    assert.match(await page.textContent(".card .happened"), /After .* s the loop gap is .* m?m/);
    assert.match(await page.textContent(".card .rule"), /acceleration/);
    const rule = await page.textContent(".card .rule");
    assert.ok(rule.trim().split(/\s+/).length <= 35, `the rule is short: ${rule}`);
    const tries = await page.locator(".card > .tries").first().locator("button").count();
    assert.ok(tries >= 2 && tries <= 3, `${tries} to try`);
  });
});

test("on the first page, where every method ends wrong, the record lists the dead points before", async (t) => {
  const page = await open(t);
  await playTo(page, 6);
  const line = page.locator(".record .dead-point");
  await soon(async () => assert.match(await line.first().innerText(), /dead point of th3/));
  await line.first().locator("summary").click();
  await soon(async () =>
    assert.match(
      await line.first().locator(".message").innerText(),
      /^th3 turns back there .* are listed until 1\.\d\d s: every method has left the true motion/,
    ),
  );
});

test("the card says what happens at a dead point, and a method that stops there can be tried", async (t) => {
  const page = await open(t, { hash: "#slider-crank" });
  await playTo(page, 1);
  // the record of incidents names them too, whoever has opened no card
  await soon(async () =>
    assert.match(
      await page.textContent(".incidents"),
      /dead point of x0\.\d\d s to 0\.\d\d s, \d timesWhy\?/,
    ),
  );
  await page.getByRole("button", { name: "Why? projection" }).click();
  await page.getByText(/^Dead point of x at 0\.\d\d s: what happens\?$/).waitFor();
  await page.getByText(/x turns back there while th1 moves on at \d+ rad\/s/).waitFor();
  await page.getByRole("button", { name: "reduced with x: it stops there" }).click();
  await until(page, (data) => data.methods.some((m) => /^reduced:coordinate=3@/.test(m.spelling)));
  await until(page, (data) => data.latest?.t > 0.95); // what is tried plays by itself
  await soon(async () =>
    assert.match(await page.textContent(".live"), /stopped at .*independent coordinates/),
  );
});

test("S6 trying Baumgarte with 20 closes the gap a hundredfold, and the energy hardly moves", async (t) => {
  const page = await open(t);
  await playTo(page, 9.9);
  const before = (await read(page, worst))[0];
  await page.getByRole("button", { name: "Why? index-1" }).click();
  await page.getByRole("button", { name: "Baumgarte with α = β = 20" }).click();
  await until(page, (data) => data.methods.some((m) => /alpha=20,beta=20/.test(m.spelling)));
  await until(page, (data) => data.latest?.t > 9.9); // what is tried plays by itself
  await soon(async () =>
    assert.match(
      await page.textContent(".live"),
      /until [\d.]+ s: worst gap .* before, .* now.*energy/s,
    ),
  );
  const m = await read(page, (data) =>
    data.methods.findIndex(({ spelling }) => /alpha=20,beta=20/.test(spelling)),
  );
  const after = (await read(page, worst))[m];
  assert.ok(after.gap < before.gap / 100, `${after.gap} m after ${before.gap} m`);
  assert.ok(after.energy > before.energy / 10, "a closed gap is no accuracy");
});

test("a remedy that is tried shows its effect: it plays, or is computed to where the methods stood", async (t) => {
  for (const reducedMotion of /** @type {const} */ (["no-preference", "reduce"])) {
    const page = await open(t, { reducedMotion });
    await playTo(page, 3.5);
    const stood = await read(page, (data) => data.latest.frame);
    await page.getByRole("button", { name: "Why? index-1" }).click();
    await page.getByRole("button", { name: "Baumgarte with α = β = 20" }).click();
    await until(page, (data) => data.methods.some((m) => /alpha=20,beta=20/.test(m.spelling)));
    await until(page, `(data) => data.latest?.frame >= ${stood}`);
    if (reducedMotion === "reduce") {
      const { state, frame } = await read(page, (data) => ({
        state: data.state,
        frame: data.latest.frame,
      }));
      assert.deepEqual({ state, frame }, { state: "paused", frame: stood });
    }
  }
});

test("S7 the map of α and β holds the present point and the limit of h β; a cell runs again", async (t) => {
  const page = await open(t);
  await page.getByRole("button", { name: "α, β map" }).click();
  await until(page, hasEnded("stability"));
  await page.locator(".maps .here").first().waitFor();
  await soon(async () => {
    assert.match(await page.textContent(".legend"), /predicted boundary: h β = 2\.7\d on α = β/);
    assert.match(await page.textContent(".legend"), /present values: drag the ring/);
    assert.doesNotMatch(await page.textContent(".maps"), /\b1 (runs|cells|columns)\b/);
  });
  const { run } = await read(page, ({ run }) => ({ run }));
  await page.locator('.maps [data-spot="4 4"]').first().click();
  await until(page, `(data) => data.run > ${run}`);
});

test("S8 the printed null-space form is closed and wrong by 29 J or 73 J, as its basis is chosen", async (t) => {
  const forms = ["first-entry-1", "unit-length"].map(
    (basis) => `method=nullspace-as-printed:basis=${basis}@rk4:h=1e-3`,
  );
  const page = await open(t, { hash: `#scene=four-bar&${forms.join("&")}` });
  await soon(async () =>
    assert.equal(
      await page.locator(".badge").first().textContent(),
      "model error: halving h does not help",
    ),
  );
  await playTo(page, 1);
  const [printed, unit] = await read(page, (data) => {
    const second = data.history.indexAt(1);
    return [0, 1].map((m) => ({
      gap: data.history.worst(m, "gap", 0, second),
      energy: data.history.worst(m, "energy_change", 0, second),
    }));
  });
  assert.ok(printed.gap < ROUNDING && unit.gap < ROUNDING);
  assert.ok(Math.abs(printed.energy - 72.88) < 0.5, `${printed.energy} J`);
  assert.ok(Math.abs(unit.energy - 28.81) < 0.5, `${unit.energy} J`);
  await page.click(".equation-panel summary");
  await soon(async () => assert.match(await page.textContent(".equation-panel"), /missing/));
});

test("S9 W shows error against cost, a point a trial; what failed stands as an open mark", async (t) => {
  const page = await open(t, {
    hash: "#scene=fb0&method=index1@rk4&method=baumgarte:alpha=20,beta=20@rk4",
  });
  await page.focus("#play");
  await page.keyboard.press("w");
  await until(page, hasEnded("work-precision"));
  await soon(async () => {
    const { points, failed } = await read(page, (data) => {
      const all = data.studies["work-precision"].document.methods.flatMap((m) => m.points);
      return {
        points: all.length,
        failed: all.filter(({ state }) => state === "failed").length,
      };
    });
    assert.ok(points >= 10);
    assert.ok((await page.locator(".scatter .spot").count()) >= points, "none is dropped");
    assert.ok((await page.locator(".scatter .open").count()) >= failed);
  });
});

test("S10 the flat parallelogram is announced before, and each method's fate is told there", async (t) => {
  const page = await open(t, { hash: "#parallelogram" });
  await playTo(page, 0.5);
  const met = await read(page, (data) => ({
    ahead: data.incidents.filter(({ code }) => code === "rank-ahead"),
    there: data.incidents.filter(({ code, t }) => code === "near-singular" && t < 0.5),
  }));
  assert.deepEqual(
    met.there.map(({ method }) => method),
    [0, 1, 2],
  );
  assert.ok(met.ahead.length > 0 && met.ahead[0].t < met.there[0].t, "before it is there");
  await soon(async () =>
    assert.doesNotMatch(await page.textContent("main"), /NaN|Infinity|undefined/),
  );
});

test("S11 L makes a link that opens the same frame with the same digits; a bad entry is named", async (t) => {
  const page = await open(t);
  await playTo(page, 1);
  await page.focus("#play");
  await page.keyboard.press("l");
  await until(page, (data) => /link copied|address line/.test(data.notice));
  const states = (data) => data.latest.methods.map(({ q }) => q);
  const { hash } = new URL(page.url());
  const other = await open(t, { hash });
  await until(other, `(data) => data.latest?.t >= 1`);
  await soon(async () => assert.deepEqual(await read(other, states), await read(page, states)));
  const bad = await open(t, { hash: hash.replace("selected=0", "selected=x") });
  await until(bad, (data) => /the link: .*selected/.test(data.notice));

  // the build is that which the server names; another one, even of the same version, is told
  const { build, version } = await (await fetch(new URL("/api/v1/healthz", bench.url))).json();
  assert.notEqual(build, version);
  const own = `build=${encodeURIComponent(build)}`;
  assert.ok(hash.includes(own), hash);
  const another = `build=${encodeURIComponent(`${version} of another day`)}`;
  const differing = await open(t, { hash: hash.replace(own, another) });
  await until(differing, (data) => /made by build .* of another day/.test(data.notice));
});

test("S12 the exported Python checks itself, or says on its first line what it lacks", async (t) => {
  const page = await open(t);
  await page.getByRole("button", { name: "export" }).click();
  await page.waitForSelector("#export-language option", { state: "attached" });
  await page.selectOption("#export-language", "python");
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.locator(".formats").getByRole("button", { name: "Program", exact: true }).click(),
  ]);
  const path = await download.path();
  assert.match(readFileSync(path, "utf8"), /^#!\/usr\/bin\/env python3/);
  const run = (python) => spawnSync(python, [path], { encoding: "utf8" });
  const done = run("/usr/bin/python3");
  assert.equal(done.status, 0, done.stderr);
  assert.match(done.stdout, /^ok {2}accelerations at the start/);
  assert.match(done.stdout, /the loops are open by at most \d/);
  const lacking = spawnSync("/usr/bin/python3", ["-S", path], { encoding: "utf8" });
  assert.notEqual(lacking.status, 0);
  assert.match(lacking.stdout + lacking.stderr, /^This program needs numpy and scipy/);
});
