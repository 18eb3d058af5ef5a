// SPDX-License-Identifier: GPL-3.0-or-later
// The recording: played from where the scrubber stands, pointed at, zoomed, and saved as data.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { createBench, fastest, playTo, read, screenBox, soon, stood, until } from "./support.mjs";

const { open } = createBench();

/** Requests that change a comparison, from now on. */
function watchChanges(page) {
  const changes = [];
  page.on("request", (request) => {
    if (request.method() === "PATCH") {
      changes.push(request.postData());
    }
  });
  return changes;
}

test("Play goes on from where the scrubber stands, and computes nothing again", async (t) => {
  const page = await open(t);
  await playTo(page, 2);
  await page.selectOption("#speed", "0.05"); // the recording does not end while it is looked at
  await until(page, (data) => data.speed === 0.05);
  const frames = await read(page, (data) => data.history.count);
  await page.evaluate(() => {
    const scrub = document.querySelector("#scrub");
    scrub.value = "0.8";
    scrub.dispatchEvent(new Event("input"));
  });
  await until(page, (data) => data.view.shown > 0);
  const from = await read(page, (data) => data.history.t[data.view.shown]);
  assert.ok(Math.abs(from - 0.8) < 0.03, `${from} s`);
  const changes = watchChanges(page);
  await page.focus("#play");
  await page.keyboard.press("Space");
  await until(page, `(data) => data.view.replaying && data.history.t[data.view.shown] > ${from}`);
  const shown = await read(page, (data) => data.history.t[data.view.shown]);
  assert.ok(shown < 2, `it goes on from ${from} s, at ${shown} s`);
  await soon(async () => assert.equal(await page.textContent("#play"), "Pause"));
  await page.keyboard.press("Space");
  await until(page, (data) => !data.view.replaying);
  await soon(async () => assert.equal(await read(page, (data) => data.history.count), frames));
  assert.deepEqual(changes, [], "the server was asked for nothing");
});

test("after the recording the computation goes on; at the end Replay starts from 0, and loops", async (t) => {
  const page = await open(t, { hash: "#pendulum" });
  await page.focus("#play");
  await page.keyboard.press("Space");
  await until(page, (data) => data.latest?.t > 0.5);
  await page.keyboard.press("Space");
  await stood(page);
  await page.keyboard.press("Backspace");
  await until(page, (data) => data.view.shown === 0);
  const head = await read(page, (data) => data.latest.t);
  await fastest(page);
  await page.keyboard.press("Space");
  await until(page, `(data) => data.latest.t > ${head} && data.view.shown < 0`);
  await until(page, (data) => data.state === "finished");
  const frames = await read(page, (data) => data.history.count);
  await soon(async () => assert.equal(await page.textContent("#play"), "Replay"));
  await page.getByRole("button", { name: "loop", exact: true }).click();
  await page.focus("#play");
  await page.keyboard.press("Space");
  await until(page, `(data) => data.view.replaying && data.view.shown > ${frames} / 2`);
  let before = -1;
  await soon(async () => {
    const at = await read(page, (data) => data.view.shown);
    const again = at < before;
    before = at;
    assert.ok(again, `it starts again; now at ${at}`);
  });
  await soon(async () => assert.equal(await read(page, (data) => data.history.count), frames));
});

/** The outlines drawn while so many frames pass: in the page, picture by picture. */
const outlines = (page, frames) =>
  page.evaluate(
    (most) =>
      new Promise((done) => {
        const { data } = globalThis.holonom;
        const now = () => (data.view.shown < 0 ? data.history.count - 1 : data.view.shown);
        const first = now();
        const seen = new Set();
        const look = () => {
          seen.add(document.querySelector(".ghost.selected .outline").getAttribute("d"));
          if (now() < first + most) {
            requestAnimationFrame(look);
          } else {
            done(seen.size);
          }
        };
        look();
      }),
    frames,
  );

test("in slow motion the picture goes on evenly between frames, live and from the recording; what stands is a frame", async (t) => {
  const page = await open(t);
  await page.selectOption("#speed", "0.05");
  await until(page, (data) => data.speed === 0.05);
  await page.focus("#play");
  await page.keyboard.press("Space");
  await until(page, (data) => data.history.count > 3);
  // frames alone would be one picture each; a slow machine paints few between them
  const live = await outlines(page, 4);
  assert.ok(live >= 8, `${live} pictures of 4 frames as they come`);
  await page.keyboard.press("Space");
  await stood(page);

  const outline = () =>
    page.evaluate(() => document.querySelector(".ghost.selected .outline").getAttribute("d"));
  const stands = await outline();
  await page.keyboard.press("ArrowLeft");
  await soon(async () => assert.notEqual(await outline(), stands));
  await page.keyboard.press("ArrowRight");
  await soon(async () => assert.equal(await outline(), stands));

  await page.keyboard.press("Backspace");
  await until(page, (data) => data.view.shown === 0);
  await page.keyboard.press("Space");
  await until(page, (data) => data.view.replaying && data.view.shown > 0);
  const again = await outlines(page, 3);
  assert.ok(again >= 6, `${again} pictures of 3 frames of the recording`);
});

test("pointing at a plot shows the values of all curves in both plots", async (t) => {
  const page = await open(t);
  await playTo(page, 2);
  await until(page, (data) => data.reference?.state === "ready");
  const box = await screenBox(page.locator(".u-over").first());
  await page.mouse.move(box.x + 0.1 * box.width, box.y + box.height / 2);
  const labels = await read(page, (data) => data.methods.map(({ label }) => label));
  await soon(async () => {
    const texts = await page.locator(".readout").allTextContents();
    assert.equal(texts.length, 2);
    for (const text of texts) {
      assert.match(text, /^1\.0\d s/);
      labels.forEach((label) => assert.ok(text.includes(label), `${label} in ${text}`));
    }
  });
  const gap = await read(page, (data) => data.history.columns[0].gap[data.history.indexAt(1)]);
  assert.ok(gap > 0);
  await page.mouse.move(5, 5);
  await soon(async () => assert.equal(await page.locator(".readout:visible").count(), 0));
});

test("dragging zooms both plots, a double click shows the whole run again; decades can be left", async (t) => {
  const page = await open(t);
  await playTo(page, 2);
  const box = await screenBox(page.locator(".u-over").last());
  const [x, y] = [box.x, box.y + box.height / 2];
  await page.mouse.move(x + 0.05 * box.width, y);
  await page.mouse.down();
  await page.mouse.move(x + 0.15 * box.width, y, { steps: 4 });
  await page.mouse.up();
  await soon(async () =>
    assert.equal(await page.getByRole("button", { name: "whole run" }).count(), 2),
  );
  await page.mouse.click(x + 0.5 * box.width, y);
  await until(page, (data) => data.view.shown > 0);
  const shown = await read(page, (data) => data.history.t[data.view.shown]);
  assert.ok(Math.abs(shown - 1) < 0.1, `the middle of 0.5 to 1.5 s is ${shown} s`);
  await page.mouse.dblclick(x + 0.5 * box.width, y);
  await soon(async () =>
    assert.equal(await page.locator("button:visible", { hasText: "whole run" }).count(), 0),
  );
  const log = page.locator("figure.plot").last().getByRole("button", { name: "log" });
  await log.click();
  await soon(async () => assert.equal(await log.getAttribute("aria-pressed"), "false"));
  await page.selectOption("#plot-lower", "energy_change");
  await soon(async () => assert.equal(await log.getAttribute("aria-pressed"), "true"));
});

test("two recordings are compared: a kept one stays in the plots beside the next run", async (t) => {
  const page = await open(t);
  await playTo(page, 1);
  await page.keyboard.press("k");
  await until(page, (data) => data.kept !== null);
  const before = await read(page, (data) => data.kept.history.columns[0].gap[20]);
  await page.fill("#set-h", "0.005");
  await page.press("#set-h", "Enter");
  await until(page, (data) => /h=0.005/.test(data.methods[0].spelling));
  await page.focus("#play");
  await playTo(page, 1);
  // a plot that is drawn anew meanwhile has not seen the pointer come
  await soon(async () => {
    const box = await screenBox(page.locator(".u-over").last());
    await page.mouse.move(0, 0);
    await page.mouse.move(box.x + 0.05 * box.width, box.y + box.height / 2);
    assert.match(await page.locator(".readout").last().textContent(), /index-1, kept/);
  });
  const now = await read(page, (data) => data.history.columns[0].gap[20]);
  assert.ok(before > 10 * now, `${before} m with the long step, ${now} m with the short one`);
  await page.keyboard.press("k");
  await until(page, (data) => data.kept === null);
});

test("a pane shows a phase plot: velocity against coordinate, for every method", async (t) => {
  const page = await open(t);
  await playTo(page, 1);
  await page.selectOption("#plot-lower", "phase");
  const figure = page.locator("figure.plot").last();
  await soon(async () => assert.equal(await figure.locator(".phase path.orbit").count(), 5));
  await soon(async () => {
    const d = await figure.locator(".phase path.orbit").first().getAttribute("d");
    assert.ok(d?.length > 100 && !/NaN/.test(d));
  });
  await soon(async () => assert.match(await figure.locator(".phase").textContent(), /th1.*w1/s));

  // what the stream adds to a frame: the smallest singular value and the largest multiplier
  for (const name of ["sigma_min", "lambda_max"]) {
    await page.selectOption("#plot-lower", name);
    await soon(async () => {
      const values = await read(
        page,
        `(data) => [...data.history.columns[2].${name}.slice(1, 20)]`,
      );
      assert.ok(
        values.every((value) => value > 0 && value < 1e4),
        `${name}: ${values}`,
      );
    });
  }
});

test("the recording is saved as CSV and NDJSON with every digit, the drawing as SVG and PNG", async (t) => {
  const page = await open(t);
  await playTo(page, 0.2);
  await page.getByRole("button", { name: "export" }).click();
  const fetchFile = async (word) => {
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.locator(".formats").getByRole("button", { name: word, exact: true }).click(),
    ]);
    return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
  };
  await until(page, (data) => data.reference?.state === "ready");
  const kept = await read(page, (data) => ({
    count: data.history.count,
    stride: data.reference.stride,
    t: data.history.t[3],
    gap: data.history.columns[1].gap[3],
    spelling: data.methods[1].spelling,
  }));

  const csv = await fetchFile("CSV");
  assert.equal(csv.name, "four-bar.csv");
  const lines = csv.bytes.toString().trim().split("\n");
  const head =
    "t [s],method,th1 [rad],a2 [rad],th3 [rad],w1 [rad/s],wa2 [rad/s],w3 [rad/s]," +
    "error [m],gap [m],velocity_gap [m/s],energy_change [J],ops,evals,cpu [s],steps,pivot_ratio," +
    "work [J],sigma_min,condition,lambda_max [N or N m]";
  assert.equal(lines[0], head);
  assert.equal(lines.length, 1 + 5 * kept.count);
  assert.ok(lines.some((line) => line.includes(`,${kept.gap},`)));

  const rows = (await fetchFile("NDJSON")).bytes.toString().trim().split("\n").map(JSON.parse);
  const row = rows.find((one) => one.t === kept.t && one.method === kept.spelling);
  assert.equal(row.gap, kept.gap);

  // the error is known at the samples of the reference, and is that of the plot
  const [, first, second] = [...new Set(rows.map(({ t: time }) => time))].map((time) =>
    rows.find((one) => one.t === time && one.method === kept.spelling),
  );
  assert.equal(kept.stride, 1);
  assert.ok(first.error > 0 && first.error < second.error && second.error < 1e-3, second.error);

  const svg = (await fetchFile("SVG")).bytes.toString();
  assert.match(svg, /^<svg[^>]* xmlns="http:\/\/www.w3.org\/2000\/svg"/);
  assert.doesNotMatch(svg, /var\(--|class=/);
  const { t: time, words } = await read(page, (data) => ({
    t: data.history.t[data.view.shown < 0 ? data.history.count - 1 : data.view.shown],
    words: data.methods.map(({ label }) => label),
  }));
  assert.ok(svg.includes(`, t = ${time.toFixed(2)} s<`), "the picture says its time");
  words.forEach((label) => assert.ok(svg.includes(`>${label}: `), `and names ${label}`));
  const png = (await fetchFile("PNG")).bytes;
  assert.equal(png.subarray(1, 4).toString(), "PNG");
});

test("incidents that a run counts and does not list are in the page's count", async (t) => {
  const page = await open(t, { hash: "#scene=parallelogram&method=projection@rk4:h=1e-3" });
  await playTo(page, 4.9); // flat twelve times in 5 s, five of them are listed
  await soon(async () => {
    const lines = await page.locator(".incidents summary").allTextContents();
    const counted = lines.filter((line) => / and later, 1\d times/.test(line));
    assert.ok(counted.length >= 2, lines.join("; "));
    assert.ok(
      lines.some((line) => /close to a singular configuration.* and later, 12 times/.test(line)),
      lines.join("; "),
    );
  });
});
