// SPDX-License-Identifier: GPL-3.0-or-later
// Where a reader goes: back and forward through scenes and views, links that hold all that is
// shown, and words that belong to what is open.
import assert from "node:assert/strict";
import http from "node:http";
import { test } from "node:test";
import { createBench, read, soon, until, watchTo } from "./support.mjs";

const bench = createBench();
const { open } = bench;

const spellings = (data) => data.methods.map(({ spelling }) => spelling);

test("back returns to the scene before with its methods, and closes what lies over the page", async (t) => {
  const page = await open(t);
  await page.fill("#set-h", "0.013");
  await page.press("#set-h", "Enter");
  await until(page, (data) => data.methods.every(({ spelling }) => /h=0.013/.test(spelling)));
  const before = await read(page, spellings);
  await page.selectOption("#scene", "pendulum");
  await until(page, (data) => data.scene.id === "pendulum" && data.history.count > 0);
  await soon(async () => assert.equal(new URL(page.url()).hash, "#pendulum"));

  await page.getByRole("button", { name: "lessons" }).click();
  await page.locator(".lesson-panel").waitFor();
  await page.goBack();
  await page.locator(".lesson-panel").waitFor({ state: "hidden" });
  assert.equal(await read(page, (data) => data.scene.id), "pendulum", "the scene stays");

  await page.goBack();
  await until(page, (data) => data.scene.id === "four-bar" && data.history.count > 0);
  assert.deepEqual(await read(page, spellings), before);
  await page.goForward();
  await until(page, (data) => data.scene.id === "pendulum" && data.history.count > 0);
  await page.goForward();
  await page.locator(".lesson-panel").waitFor();
  await page.getByRole("button", { name: "close", exact: true }).click();
  await page.locator(".lesson-panel").waitFor({ state: "hidden" });

  // the gallery leads on and is no place of its own
  await page.getByRole("button", { name: "gallery" }).click();
  await page
    .locator(".gallery button.card", { hasText: /slider-crank/i })
    .first()
    .click();
  await until(page, (data) => data.scene.id !== "pendulum" && data.history.count > 0);
  await page.goBack();
  await until(page, (data) => data.scene.id === "pendulum" && !data.view.gallery);
  await soon(async () => assert.equal(await page.locator(".gallery").isVisible(), false));
});

test("a scene that does not exist is said, with the names that it may stand for", async (t) => {
  const page = await open(t, { hash: "#stewart" });
  await page
    .locator(".notice")
    .getByText(/no scene is called 'stewart'; did you mean stewart-6-\d or stewart-6-\d\?/)
    .waitFor();
  assert.ok(await page.locator(".notice").isVisible());
  assert.equal(await read(page, (data) => data.scene.id), "four-bar");
});

test("a link holds plots, zoom, cards, panels and the camera of a scene in space", async (t) => {
  const page = await open(t, { hash: "#rssr", viewport: { width: 1366, height: 768 } });
  await page.waitForSelector(".stage.solid");
  await page.locator(".stage").focus();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("+");
  await page.keyboard.press("Shift+ArrowUp");
  await page.keyboard.press("p");
  await until(page, (data) => data.view.space?.camera.length === 4 && !data.view.space.perspective);
  await page.selectOption("#plot-lower", "energy_change");
  await page.locator("figure.plot").nth(1).getByRole("button", { name: "log" }).click();
  await page.locator("figure.plot").nth(0).getByRole("button", { name: "table" }).click();
  await page.click(".equation-panel summary");
  await page.getByRole("button", { name: "lengths, masses, start" }).click();
  await page.selectOption("#speed", "2");
  await until(page, (data) => data.speed === 2 && data.view.equations && data.view.parameters);
  const what = ({ view, speed }) =>
    JSON.stringify([view.plots, view.space, view.look, view.equations, view.parameters, speed]);
  const before = JSON.parse(await read(page, what));
  await page.focus("#play");
  await page.keyboard.press("l");
  await until(page, (data) => /link copied|address line/.test(data.notice));

  const other = await open(t, {
    hash: new URL(page.url()).hash,
    viewport: { width: 1366, height: 768 },
  });
  await other.waitForSelector(".stage.solid");
  const near = (a, b) =>
    typeof a === "number"
      ? assert.ok(Math.abs(a - b) <= 1e-4 * Math.max(1, Math.abs(a)), `${a} ${b}`)
      : a && typeof a === "object"
        ? Object.keys(a).forEach((key) => near(a[key], b[key]))
        : assert.equal(b, a);
  await soon(async () => near(before, JSON.parse(await read(other, what))));
  const places = (one) =>
    one.evaluate(() =>
      [...document.querySelectorAll(".picture .labels text")].map((node) =>
        ["x", "y"].map((name) => Number(node.getAttribute(name))),
      ),
    );
  await soon(async () => {
    const [here, there] = [await places(page), await places(other)];
    here.flat().forEach((x, k) => assert.ok(Math.abs(x - there.flat()[k]) < 2, `${here} ${there}`));
  });
  await soon(async () => assert.ok(await other.isVisible("#parameters")));
  await soon(async () => assert.equal(await other.inputValue("#plot-lower"), "energy_change"));
});

test("the guide speaks of the scene that it is about, and offers to open it", async (t) => {
  const page = await open(t);
  const guide = page.locator(".guide");
  await guide.getByText("One mechanism, five methods").waitFor();
  await page.selectOption("#scene", "rssr");
  await guide.getByText("The first minute is about the four-bar").waitFor();
  assert.doesNotMatch(await guide.textContent(), /index-1|joint B/);
  await guide.getByRole("button", { name: "open the four-bar" }).click();
  await until(page, (data) => data.scene.id === "four-bar");
  await guide.getByText("One mechanism, five methods").waitFor();
});

test("the sentence and the table are of one frame while the run goes on", async (t) => {
  const page = await open(t);
  await page.evaluate(() => {
    globalThis.torn = [];
    const words = () => document.querySelector("tbody tr .words").textContent;
    new MutationObserver(() => {
      // painted on one beat: when the sentence has changed, so has the table
      queueMicrotask(() => {
        if (!document.querySelector(".seen").textContent.includes(words())) {
          globalThis.torn.push([words(), document.querySelector(".seen").textContent]);
        }
      });
    }).observe(document.querySelector(".seen"), { childList: true });
  });
  await watchTo(page, 1.5);
  assert.deepEqual(await page.evaluate(() => globalThis.torn), []);
});

const PREFIX = "/course/mechanisms";

/** A proxy that serves everything below a prefix, and nothing beside it. */
async function startProxy(t) {
  const target = new URL(bench.url);
  const proxy = http.createServer((request, response) => {
    if (!request.url?.startsWith(`${PREFIX}/`)) {
      response.writeHead(404).end();
      return;
    }
    const { origin: _, ...headers } = request.headers;
    const onward = http.request(
      {
        host: target.hostname,
        port: target.port,
        method: request.method,
        path: request.url.slice(PREFIX.length),
        headers: { ...headers, host: target.host },
      },
      (answer) => {
        response.writeHead(answer.statusCode ?? 502, answer.headers);
        answer.pipe(response);
      },
    );
    onward.on("error", () => response.destroy());
    response.on("close", () => onward.destroy());
    request.pipe(onward);
  });
  await new Promise((resolve) => proxy.listen(0, "127.0.0.1", () => resolve(undefined)));
  t.after(() => {
    proxy.closeAllConnections();
    proxy.close();
  });
  return `http://127.0.0.1:${proxy.address().port}${PREFIX}/`;
}

test("the page works below a prefix: it runs, opens what it loads later, and saves a report", async (t) => {
  const page = await open(t, { url: await startProxy(t), hash: "#rssr" });
  await page.waitForSelector(".stage.solid"); // three.js and its style sheet
  await page.selectOption("#scene", "pendulum");
  await until(page, (data) => data.scene.id === "pendulum" && data.history.count > 0);
  await page.focus("#play");
  await page.keyboard.press("Space");
  await until(page, (data) => data.latest?.t > 0.2);
  await page.keyboard.press("Space");
  await page.click(".equation-panel summary");
  await page.waitForSelector(".term-block .katex");
  await page.getByRole("button", { name: "lessons" }).click();
  await page.waitForSelector(".lesson-text h2, .lesson-text h3");
  await page.keyboard.press("Escape");
  await page.focus("#play");
  await page.keyboard.press("e");
  await until(page, (data) => data.studies.budget.state === "finished");
  const report = await read(page, (data) => data.studies.budget.report);
  assert.ok(report.startsWith(`${PREFIX}/api/v1/`), report);
  const status = await page.evaluate((path) => fetch(path).then((one) => one.status), report);
  assert.equal(status, 200);
});
