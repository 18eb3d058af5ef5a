// SPDX-License-Identifier: GPL-3.0-or-later
// Speed of the page, measured by the browser's own trace in software rendering: frames a second
// while methods run, first paint, bytes before the first interaction. Prints a table; ends with
// status 1 where a figure is beyond its bound. The machine should do nothing else.
import { readFileSync, readdirSync } from "node:fs";
import { availableParallelism, loadavg } from "node:os";
import { jointAt, startBrowser, startServer } from "./support.mjs";
import { mainThreadTime } from "./trace.mjs";

const SECONDS = 4; // of playing that are traced: the run on the platform ends at 5 s
const LOADS = 9; // of the page: the median counts
const CIRCLE = 20; // [px] of the pointer that drags a joint, once a second
const TRACED = [
  "devtools.timeline",
  "disabled-by-default-devtools.timeline",
  "disabled-by-default-devtools.timeline.frame",
  "toplevel",
];
const SOFTWARE = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const SIX = ["index1", "baumgarte", "projection", "nullspace", "reduced", "partitioning"];

const FB0 = `#scene=fb0${SIX.map((name) => `&method=${name}@rk4:h=0.01`).join("")}`;
const STEWART = "#stewart-6-6";

const TICK = 10; // [ms] of the counters of /proc

/** The processes below one, itself left out, from /proc. @param {number} root */
function below(root) {
  const parents = readdirSync("/proc")
    .filter((name) => /^\d+$/.test(name))
    .flatMap((name) => {
      try {
        const text = readFileSync(`/proc/${name}/stat`, "utf8");
        return [{ pid: Number(name), fields: text.slice(text.lastIndexOf(")") + 2).split(" ") }];
      } catch {
        return []; // it has ended meanwhile
      }
    });
  const found = new Set([root]);
  for (let before = 0; before !== found.size; ) {
    before = found.size;
    parents
      .filter(({ fields }) => found.has(Number(fields[1])))
      .forEach(({ pid }) => found.add(pid));
  }
  return parents.filter(({ pid }) => pid !== root && found.has(pid));
}

/** Processor time of the browser and the server so far [ms]: other programs do not lengthen it. */
const spent = () =>
  below(process.pid).reduce(
    (sum, { fields }) => sum + TICK * (Number(fields[11]) + Number(fields[12])),
    0,
  );

const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];

/** Opens the page and waits until it can be used. */
async function openPage(browser, url, solid) {
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
  const page = await context.newPage();
  await page.goto(url);
  await page.waitForFunction(() => globalThis.holonom?.data.reference?.state === "ready");
  if (solid) {
    await page.waitForSelector(".stage.solid");
  }
  return page;
}

/** Pictures a second that the browser showed while the run went on, and computing for each. */
async function playing(browser, url, solid) {
  const page = await openPage(browser, url, solid);
  await page.focus("#play");
  await page.keyboard.press("Space");
  await page.waitForFunction(() => globalThis.holonom.data.latest.t > 0.1);
  await browser.startTracing(page, { categories: TRACED });
  const before = spent();
  const frames = await page.evaluate(
    (seconds) =>
      new Promise((done) => {
        const began = performance.now();
        let count = 0;
        const next = () => {
          count++;
          const spent = (performance.now() - began) / 1000;
          if (spent < seconds) {
            requestAnimationFrame(next);
          } else {
            done(count / spent);
          }
        };
        requestAnimationFrame(next);
      }),
    SECONDS,
  );
  const used = spent() - before;
  const { traceEvents } = JSON.parse(String(await browser.stopTracing()));
  const shown = traceEvents.filter(({ name }) => name === "DrawFrame").map(({ ts }) => ts / 1e6);
  await page.context().close();
  const span = Math.max(...shown) - Math.min(...shown);
  return {
    shown: (shown.length - 1) / span,
    computing: mainThreadTime(traceEvents) / (frames * SECONDS),
    all: used / (frames * SECONDS),
  };
}

/**
 * Pictures a second while a joint of the four-bar is dragged, the pointer moving with each of them,
 * and how many of them have another configuration, as the server closed it.
 */
async function dragging(browser, url) {
  const page = await openPage(browser, url, false);
  const { x, y } = await jointAt(page, "A");
  await page.mouse.move(x, y);
  await page.mouse.down();
  await browser.startTracing(page, { categories: TRACED });
  const closed = await page.evaluate(
    ({ x, y, r, seconds }) =>
      new Promise((done) => {
        const svg = document.querySelector(".picture");
        const began = performance.now();
        let drawn = "";
        let count = 0;
        const next = () => {
          const now = document.querySelector(".picture .drag")?.innerHTML ?? "";
          count += Number(now !== drawn);
          drawn = now;
          const spent = (performance.now() - began) / 1000;
          const turn = 2 * Math.PI * spent;
          const place = { clientX: x + r * Math.sin(turn), clientY: y + r * (1 - Math.cos(turn)) };
          svg.dispatchEvent(new PointerEvent("pointermove", place));
          spent < seconds ? requestAnimationFrame(next) : done(count / spent);
        };
        requestAnimationFrame(next);
      }),
    { x, y, r: CIRCLE, seconds: SECONDS },
  );
  const { traceEvents } = JSON.parse(String(await browser.stopTracing()));
  const shown = traceEvents.filter(({ name }) => name === "DrawFrame").map(({ ts }) => ts / 1e6);
  await page.mouse.up();
  await page.context().close();
  return { shown: (shown.length - 1) / (Math.max(...shown) - Math.min(...shown)), closed };
}

/** First paint [ms], and what was on the line before anybody did anything [bytes]. */
async function loading(browser, url) {
  const paints = [];
  let bytes = 0;
  for (let k = 0; k < LOADS; k++) {
    const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
    const page = await context.newPage();
    const line = await context.newCDPSession(page);
    const sizes = new Map();
    await line.send("Network.enable");
    line.on("Network.loadingFinished", ({ requestId, encodedDataLength }) =>
      sizes.set(requestId, encodedDataLength),
    );
    await page.goto(url);
    await page.waitForFunction(() => globalThis.holonom?.data.reference?.state === "ready");
    paints.push(
      await page.evaluate(
        () => performance.getEntriesByName("first-contentful-paint")[0]?.startTime,
      ),
    );
    bytes = [...sizes.values()].reduce((a, b) => a + b, 0);
    await context.close();
  }
  return { paint: median(paints), bytes };
}

const server = await startServer();
const flat = await startBrowser();
const solid = await startBrowser(SOFTWARE);
const load = await loading(flat, server.url);
const fb0 = await playing(flat, server.url + FB0, false);
const drag = await dragging(flat, server.url);
const stewart = await playing(solid, server.url + STEWART, true);
await Promise.all([flat.close(), solid.close()]);
await server.stop();

/** A picture's share of all processors, at a rate. @param {number} rate [1/s] */
const share = (rate) => (1000 * availableParallelism()) / rate;

/** What, the figure, its bound, whether more is better, the unit. */
const ROWS = [
  ["FB0, six methods: pictures shown", fb0.shown, 55, true, "1/s"],
  ["  computing of the main thread for a picture", fb0.computing, 1000 / 60, false, "ms"],
  ["  computing of browser and server for a picture", fb0.all, share(60), false, "ms"],
  ["Stewart 6-6, solids by software: pictures shown", stewart.shown, 30, true, "1/s"],
  ["  computing of the main thread for a picture", stewart.computing, 1000 / 30, false, "ms"],
  ["  computing of browser and server for a picture", stewart.all, share(30), false, "ms"],
  ["dragging a joint of the four-bar: pictures shown", drag.shown, 55, true, "1/s"],
  ["  other configurations closed by the server", drag.closed, 20, true, "1/s"],
  [`first paint, median of ${LOADS} empty caches`, load.paint, 200, false, "ms"],
  ["on the line before the first interaction", load.bytes / 1000, 500, false, "kB"],
];
const holds = ([, figure, limit, more]) => (more ? figure >= limit : figure <= limit);
const line = (what, figure, limit, unit) =>
  `${what.padEnd(50)}${figure.padStart(10)}${limit.padStart(8)}  ${unit}`;
const average = loadavg()[0].toFixed(1);
console.log(`speed of the page, 1366 x 768, software rendering, load average ${average}`);
console.log(line("what", "measured", "bound", "unit"));
for (const row of ROWS) {
  const [what, figure, limit, , unit] = row;
  const mark = holds(row) ? "" : "  BEYOND";
  console.log(line(what, figure.toFixed(1), limit.toFixed(1), `${unit}${mark}`));
}
process.exitCode = ROWS.every(holds) ? 0 : 1;
