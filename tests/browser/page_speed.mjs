// SPDX-License-Identifier: GPL-3.0-or-later
// How fast the page is, measured by the browser's own trace in software rendering: frames a second
// while methods run, first paint, bytes before the first interaction. Prints a table; ends with
// status 1 where a figure is beyond its bound. The machine should do nothing else.
import { loadavg } from "node:os";
import { startBrowser, startServer } from "./support.mjs";

const SECONDS = 6; // of playing that are traced
const LOADS = 9; // of the page: the median counts
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
  const { traceEvents } = JSON.parse(String(await browser.stopTracing()));
  const shown = traceEvents.filter(({ name }) => name === "DrawFrame").map(({ ts }) => ts / 1e6);
  const mains = new Set(
    traceEvents
      .filter(({ name, args }) => name === "thread_name" && args.name === "CrRendererMain")
      .map(({ pid, tid }) => `${pid} ${tid}`),
  );
  const busy = traceEvents
    .filter(({ name, pid, tid }) => name === "RunTask" && mains.has(`${pid} ${tid}`))
    .reduce((sum, { tdur = 0 }) => sum + tdur / 1000, 0);
  await page.context().close();
  const span = Math.max(...shown) - Math.min(...shown);
  return { frames, shown: (shown.length - 1) / span, computing: busy / (frames * SECONDS) };
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
const stewart = await playing(solid, server.url + STEWART, true);
await Promise.all([flat.close(), solid.close()]);
await server.stop();

/** What, the figure, its bound, whether it holds, the unit. */
const ROWS = [
  ["FB0, six methods: pictures shown", fb0.shown, 55, fb0.shown >= 55, "1/s"],
  [
    "FB0, six methods: computing of the main thread",
    fb0.computing,
    16.7,
    fb0.computing <= 16.7,
    "ms",
  ],
  [
    "Stewart 6-6, solids by software: pictures shown",
    stewart.shown,
    30,
    stewart.shown >= 30,
    "1/s",
  ],
  [
    "Stewart 6-6: computing of the main thread",
    stewart.computing,
    33.3,
    stewart.computing <= 33.3,
    "ms",
  ],
  [`first paint, median of ${LOADS} empty caches`, load.paint, 200, load.paint <= 200, "ms"],
  ["on the line before the first interaction", load.bytes / 1000, 500, load.bytes <= 5e5, "kB"],
];
console.log(
  `speed of the page, 1366 x 768, software rendering, load average ${loadavg()[0].toFixed(1)}`,
);
console.log(`${"what".padEnd(50)}${"measured".padStart(10)}${"bound".padStart(8)}  unit`);
for (const [what, figure, bound, holds, unit] of ROWS) {
  const mark = holds ? "" : "  BEYOND";
  console.log(
    `${what.padEnd(50)}${figure.toFixed(1).padStart(10)}${String(bound).padStart(8)}  ${unit}${mark}`,
  );
}
process.exitCode = ROWS.every(([, , , holds]) => holds) ? 0 : 1;
