// SPDX-License-Identifier: GPL-3.0-or-later
// Studies on the page: what accuracy costs, where steps are stable, where the error comes from.
import assert from "node:assert/strict";
import { test } from "node:test";
import { dotsOf, ruleOf } from "../../web/state/study-documents.js";
import { cheapestFor } from "../../web/state/wanted.js";
import { createBench, read, screenBox, screenshot, soon, until } from "./support.mjs";

const SHORT = "#scene=pendulum&method=index1@rk4:h=0.01&method=projection@dop853:rtol=1e-6";
const STABILISED =
  "#scene=four-bar&method=index1@rk4:h=1e-3&method=baumgarte:alpha=5,beta=5@rk4:h=1e-3";

const bench = createBench();
const { open } = bench;

const hasEnded = (kind) =>
  `(data) => ["finished", "stopped"].includes(data.studies["${kind}"].state) && data.studies["${kind}"].document`;

// ---- the page --------------------------------------------------------------------------------

/** The page finds the method and the cost that the engine's own ranking names, at each accuracy. */
function assertSameCheapest(study) {
  const pareto = study.pareto.find((one) => one.error === "q" && one.cost === "operations");
  assert.ok(pareto.bands.length >= 2, "accuracies that are ranked");
  const { floor } = ruleOf(study, "q");
  for (const { accuracy, best, next } of pareto.bands) {
    const list = cheapestFor(dotsOf(study, "q", "operations"), accuracy, { margin: 1, floor });
    [best, next].forEach((one, i) => {
      assert.equal(list[i] && study.methods[list[i].m].method, one?.method, `for ${accuracy}`);
      assert.ok(!one || Math.abs(list[i].cost / one.cost - 1) < 1e-9, `for ${accuracy}`); // roundings
    });
  }
}

test("W draws error against cost; a point's step is taken over by click and by keyboard", async (t) => {
  const page = await open(t, { hash: SHORT });
  await page.keyboard.press("w");
  const dialog = page.getByRole("dialog", { name: /Studies/ });
  await dialog.getByRole("progressbar").waitFor();
  await until(page, hasEnded("work-precision"));
  const spots = dialog.locator(".scatter [data-spot]");
  const points = await read(
    page,
    (data) =>
      data.studies["work-precision"].document.methods.flatMap((method) => method.points).length,
  );
  await soon(async () =>
    assert.equal(await spots.count(), points, "every point is there, failed ones too"),
  );
  await soon(async () =>
    assert.match(
      await spots.first().getAttribute("aria-label"),
      /h = .*: (error .* operations|error .*op|failed)/,
    ),
  );
  await dialog.getByRole("button", { name: "evaluations" }).click();
  await soon(async () =>
    assert.match(await spots.first().getAttribute("aria-label"), /evaluations|failed/),
  );
  await soon(async () =>
    assert.ok((await dialog.getByRole("listitem").count()) >= 3, "sentences and classes"),
  );
  const study = await read(page, (data) => data.studies["work-precision"].document);
  assertSameCheapest(study);
  const wanted = study.methods[0].points[2].method;
  await dialog.locator('.scatter [data-m="0"][data-spot="2"]').click({ force: true });
  await until(page, `(data) => data.methods[0].spelling === ${JSON.stringify(wanted)}`);
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Enter");
  const next = await read(
    page,
    (data) => data.studies["work-precision"].document.methods[0].points[3].method,
  );
  await until(page, `(data) => data.methods[0].spelling === ${JSON.stringify(next)}`);
  await dialog.getByText("on the page now").waitFor();
  await page.keyboard.press("Escape");
  await page.keyboard.press("Space"); // keys are the page's again
  await until(page, (data) => data.state === "running");
});

test("a finished study is saved as one file without network", async (t) => {
  const page = await open(t, { hash: SHORT });
  await page.getByRole("button", { name: "studies" }).click();
  await until(page, hasEnded("work-precision"));
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("link", { name: "Save as a report" }).click(),
  ]);
  assert.equal(download.suggestedFilename(), "holonom-work-precision.html");
  const chunks = [];
  for await (const chunk of await download.createReadStream()) {
    chunks.push(chunk);
  }
  const text = Buffer.concat(chunks).toString();
  assert.match(text, /<svg/);
  assert.doesNotMatch(text, /(src|href)="https?:/);
});

test("a study that is stopped shows what was done, and says so", async (t) => {
  const page = await open(t);
  await page.keyboard.press("w");
  await until(page, (data) => data.studies["work-precision"].progress > 0.1);
  await page.getByRole("button", { name: "Stop" }).click();
  await until(page, (data) => data.studies["work-precision"].state === "stopped");
  await page
    .locator(".study-run")
    .getByText(/stopped on request/)
    .waitFor();
  await soon(async () => assert.ok((await page.locator(".scatter .spot").count()) > 0));
});

test("Escape stops a study that runs and keeps what it found; the next one closes", async (t) => {
  const page = await open(t);
  await page.keyboard.press("b");
  await until(page, (data) => data.studies.stability.progress > 0.05);
  await page.keyboard.press("Escape");
  await until(page, (data) => data.studies.stability.state === "stopped");
  const dialog = page.getByRole("dialog", { name: /Studies/ });
  assert.ok(await dialog.isVisible(), "the part of the map that is there can be used");
  await soon(async () => assert.ok((await dialog.locator("[data-spot]").count()) > 0));
  await page.keyboard.press("Escape");
  await until(page, (data) => data.view.study === "");
});

test("a stopped study goes on with what is left, and is not begun again", async (t) => {
  const page = await open(t);
  const asked = [];
  page.on("request", (request) => {
    if (/\/studies\b/.test(request.url()) && request.method() !== "GET") {
      asked.push(`${request.method()} ${request.postData()?.slice(0, 20)}`);
    }
  });
  await page.keyboard.press("w");
  await until(page, (data) => data.studies["work-precision"].progress > 0.1);
  await page.getByRole("button", { name: "Stop" }).click();
  await until(page, (data) => data.studies["work-precision"].state === "stopped");
  const { id, done } = await read(page, (data) => ({
    id: data.studies["work-precision"].id,
    done: data.studies["work-precision"].document.methods.flatMap(({ points }) => points).length,
  }));
  const before = asked.length;
  await page.getByRole("button", { name: "Go on" }).click();
  await until(page, (data) => data.studies["work-precision"].state !== "stopped");
  await until(page, hasEnded("work-precision"));
  const after = await read(page, (data) => ({
    id: data.studies["work-precision"].id,
    done: data.studies["work-precision"].document.methods.flatMap(({ points }) => points).length,
  }));
  assert.equal(after.id, id, "it is the same study");
  assert.ok(after.done >= done, `${done} points were done, now ${after.done}`);
  assert.deepEqual(asked.slice(before), ['PATCH {"state":"running"}']);
  await soon(async () => assert.ok((await page.locator(".scatter .spot").count()) >= done));
});

test("B maps alpha and beta with letters and the predicted boundary; a cell sets both", async (t) => {
  const page = await open(t, { hash: STABILISED });
  await page.keyboard.press("b");
  await until(page, hasEnded("stability"));
  await soon(async () =>
    assert.ok((await page.locator(".maps .contour").count()) > 0, "at first as heat"),
  );
  await soon(async () => {
    const map = await read(page, ({ studies: { stability } }) => ({
      preset: stability.document.preset,
      steps: stability.document.steps.length,
    }));
    const menu = page.locator("#map-over option:checked");
    assert.deepEqual([map.preset, await menu.getAttribute("value")], ["baumgarte", ""]);
    assert.match(await menu.textContent(), /^the most telling map: alpha and beta/);
    const lines = await page.locator(".steps li").allTextContents();
    assert.equal(lines.length, map.steps, "the map of steps by which it was chosen");
    assert.ok(lines.every((line) => /not stiff: accuracy limits the step/.test(line)));
  });
  await soon(async () =>
    assert.match(
      await page.locator(".maps figcaption").first().textContent(),
      /^Baumgarte \(h = 1.0 ms, until [\d.]+ s\) /,
    ),
  );
  await page.getByRole("button", { name: "outcome" }).click();
  await soon(async () => {
    const letters = await page.locator(".maps .letters .letter").allTextContents();
    assert.ok(letters.includes("s") && letters.includes("g"), "stable and grown cells");
  });
  await soon(async () => assert.ok((await page.locator(".maps .boundary").count()) > 0));
  await page.locator('.maps [data-spot="3 2"]').click();
  const axes = await read(page, (data) => {
    const { x, y } = data.studies.stability.document;
    return [x.values[3], y.values[2]].map((value) => Number(value.toPrecision(4)));
  });
  await until(
    page,
    `(data) => data.methods[1].spelling.startsWith("baumgarte:alpha=${axes[0]},beta=${axes[1]}@")`,
  );
  await page.locator(".maps .here").waitFor();
  await page.keyboard.press("ArrowUp");
  await soon(async () =>
    assert.equal(
      await page.evaluate(() => document.activeElement?.getAttribute("data-spot")),
      "3 3",
    ),
  );
  await soon(async () =>
    assert.match(await page.textContent(".legend"), /predicted boundary: h β = 2\.7\d on α = β/),
  );

  // the ring is dragged to the middle of another cell, and beyond the axes it stays at their end
  const middle = async (selector) => {
    let box = null; // the ring is drawn anew when the run has changed
    while (!box) {
      await page.locator(selector).waitFor();
      box = await screenBox(page.locator(selector));
    }
    return [box.x + box.width / 2, box.y + box.height / 2];
  };
  const dragTo = async (x, y) => {
    const [fromX, fromY] = await middle(".maps .here-handle");
    await page.mouse.move(fromX, fromY);
    await page.mouse.down();
    await page.mouse.move(x, y, { steps: 4 });
    await page.mouse.up();
  };
  const wanted = await read(page, (data) => {
    const { x, y } = data.studies.stability.document;
    return [x.values[1], y.values[4]];
  });
  await dragTo(...(await middle('.maps [data-spot="1 4"] rect')));
  const near = (a, b) => `Math.abs(${a} / ${b} - 1) < 0.1`;
  const set = "data.methods[1].spelling.match(/alpha=(.*),beta=(.*)@/)";
  await until(page, `(data) => ${near(`${set}[1]`, wanted[0])} && ${near(`${set}[2]`, wanted[1])}`);
  await dragTo(1, (await middle(".maps .here-handle"))[1]);
  await until(page, `(data) => ${set}[1] < ${wanted[0]} && ${set}[1] > 0`);
  await page.getByLabel("over", { exact: true }).selectOption("limits");
  await until(page, (data) => data.studies.stability.document?.x === null);
  await soon(async () =>
    assert.equal(await page.locator(".maps .map").count(), 1, "methods side by side"),
  );
  await soon(async () =>
    assert.equal(await page.locator('.maps [data-spot$=" 0"]').count(), 2, "a column each"),
  );
});

test("the powers of ten in a map of heat can be read in both themes", async (t) => {
  for (const colorScheme of ["light", "dark"]) {
    const page = await open(t, { hash: `${STABILISED}&study=stability`, colorScheme });
    await until(page, hasEnded("stability"));
    const worst = await page.evaluate(() => {
      const pen = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
      /** Relative luminance, by the definition of contrast in the guidelines. */
      const luminance = (colour) => {
        pen.fillStyle = colour;
        pen.fillRect(0, 0, 1, 1);
        const [r, g, b] = [...pen.getImageData(0, 0, 1, 1).data].map((byte) => {
          const x = byte / 255;
          return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
        });
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      const ratios = [...document.querySelectorAll(".letters .letter.heat")].map((letter) => {
        const { fill, stroke } = getComputedStyle(letter); // the cell's colour lies round it
        const [low, high] = [luminance(fill), luminance(stroke)].sort((a, b) => a - b);
        return (high + 0.05) / (low + 0.05);
      });
      return { count: ratios.length, least: Math.min(...ratios) };
    });
    assert.ok(worst.count > 50, `${worst.count} cells`);
    assert.ok(worst.least >= 4.5, `${colorScheme}: ${worst.least}`); // what text needs
  }
});

test("a map of steps whose axis ends before the present step is made again with an axis that holds it", async (t) => {
  const page = await open(t, {
    hash: "#scene=four-bar&method=projection@rk4:h=1e-4&study=stability&map=limits",
  });
  await until(page, hasEnded("stability"));
  const { low } = await read(page, (data) => ({
    low: data.studies.stability.document.y.values[0],
  }));
  assert.ok(low > 1e-4, "the server's own axis ends before");
  await page.getByRole("button", { name: "widen the axes" }).click();
  await until(
    page,
    ({ studies: { stability } }) =>
      stability.state !== "running" && stability.document?.y.values[0] <= 1e-4,
  );
  await soon(async () =>
    assert.match(
      await page.locator(".legend").first().textContent(),
      /present values: drag the ring/,
    ),
  );
});

test("the parts of a budget have the server's names, letters and words", async (t) => {
  const page = await open(t, { hash: "#scene=four-bar&method=index1@rk4:h=1e-3" });
  const index = await (await fetch(new URL("/api/v1/", page.url()))).json();
  const { parts } = index.studies.find(({ name }) => name === "budget");
  await page.focus("#play");
  await page.keyboard.press("e");
  await until(page, (data) => data.studies.budget.state === "finished");
  const panel = page.locator("#study-budget");
  for (const [of, word] of [
    ["error", "position error"],
    ["energy", "energy"],
  ]) {
    await panel.getByRole("button", { name: word, exact: true }).click();
    await soon(async () => {
      assert.deepEqual(
        await panel.locator(".legend li").allTextContents(),
        parts[of].map(({ letter, about }) => `${letter}${about}`),
      );
      assert.deepEqual(await panel.locator("thead th").allTextContents(), [
        "method",
        "all",
        ...parts[of].map(({ word: over }) => over),
      ]);
    });
  }
});

test("E shows the parts of each method's error, that add up to it", async (t) => {
  const page = await open(t, { hash: "#scene=pendulum&method=index1@rk4:h=0.05&study=budget" });
  await until(page, hasEnded("budget"));
  const { value, parts } = await read(
    page,
    (data) => data.studies.budget.document.methods[0].error,
  );
  const sum = Object.values(parts).reduce((total, part) => total + (part ?? 0), 0);
  assert.ok(Math.abs(sum - value) <= 0.02 * Math.abs(value), "to first order");
  await soon(async () => assert.ok((await page.locator(".budget .part").count()) > 0));
  await page.getByRole("button", { name: "energy" }).last().click();
  await soon(async () =>
    assert.match(await page.locator(".budgets").textContent(), /energy at the end has changed by/),
  );
});

test("an error that is not the sum of its parts has no bar, and the time until which it was one", async (t) => {
  const page = await open(t, {
    hash: "#scene=four-bar&method=index1@rk4:h=0.02&method=projection@rk4:h=0.02&study=budget",
  });
  await until(page, hasEnded("budget"));
  const { methods } = await read(page, (data) => data.studies.budget.document);
  const held = methods.filter(({ error }) => error?.holds).length;
  assert.ok(held < methods.length, "ten seconds at this step are too long for one of them");
  await soon(async () => assert.equal(await page.locator(".budgets svg.budget").count(), held));
  await soon(async () =>
    assert.match(
      await page.locator(".budgets").textContent(),
      /It is too large to be split: its parts add up to .*\. Until .* add up to the error/,
    ),
  );

  await soon(async () => {
    const unsplit = await page.locator(".twin-table th", { hasText: "not split" }).count();
    assert.equal(unsplit, methods.length - held, "the table marks them too");
  });

  // a step that is typed, a text that is none, and the end that is offered
  await page.getByLabel("step h =").fill("nothing");
  await page.keyboard.press("Enter");
  await soon(async () =>
    assert.match(
      await page.locator(".study-bar .hint").last().textContent(),
      /'nothing' is no time/,
    ),
  );
  await page.getByLabel("step h =").fill("5 ms");
  await page.keyboard.press("Enter");
  await until(
    page,
    ({ studies: { budget } }) =>
      budget.state === "finished" &&
      budget.document.methods.every(({ method }) => /h=0\.005$/.test(method)),
  );
  await page.getByLabel("step h =").fill("");
  await page.keyboard.press("Enter");
  await page
    .getByRole("button", { name: /^split it until/ })
    .first()
    .click();
  await until(
    page,
    ({ view, studies: { budget } }) =>
      view.split.time > 0 &&
      budget.state === "finished" &&
      budget.document.methods.some(({ error }) => error?.holds),
  );
  await soon(async () =>
    assert.match(await page.getByLabel("until t =").inputValue(), /^[\d.]+ s$/),
  );
  await page.getByLabel("until t =").fill("");
  await page.keyboard.press("Enter");
  await until(
    page,
    ({ view, studies: { budget } }) => view.split.time === 0 && budget.state === "finished",
  );

  // of a coordinate that is chosen
  const largest = methods.map(({ error }) => error?.coordinate);
  const other = ["th1", "a2", "th3"].find((name) => !largest.includes(name));
  await page.locator("#budget-of").selectOption(other);
  await until(
    page,
    `({ studies: { budget } }) => budget.state === "finished" &&
      budget.document.methods.every(({ error }) => error.coordinate === "${other}")`,
  );
});

test("a link opens its study, and other methods ask for it anew", async (t) => {
  const page = await open(t, { hash: `${SHORT}&study=work-precision` });
  await until(page, hasEnded("work-precision"));
  await page
    .locator(".study-run")
    .getByText(/^done in|before all was done/)
    .waitFor();
  await page.evaluate(() => (location.hash = "#scene=pendulum&method=reduced@rk4:h=0.01"));
  await until(page, (data) => data.methods.length === 1 && data.view.study === "");
  await soon(async () => assert.equal(await page.getByRole("dialog").count(), 0));
  await page.keyboard.press("w");
  await until(page, (data) => data.studies["work-precision"].document?.methods.length === 1);

  // a budget with its fields, which the next link holds as well
  const fields = "study=budget&judged=th&until=0.5&step=0.005&budget=energy";
  await page.evaluate(
    (hash) => (location.hash = hash),
    `#scene=pendulum&method=index1@rk4:h=0.01&${fields}`,
  );
  await until(
    page,
    ({ studies: { budget } }) =>
      budget.state === "finished" && /h=0\.005$/.test(budget.document.methods[0].method),
  );
  const { time, methods } = await read(page, (data) => data.studies.budget.document);
  assert.deepEqual([time, methods[0].error.coordinate], [0.5, "th"]);
  await soon(async () => assert.equal(await page.inputValue("#budget-time"), "0.5 s"));
  await soon(async () =>
    assert.match(await page.textContent(".budgets"), /energy at the end has changed by/),
  );
  await page.getByRole("dialog").getByRole("button", { name: "link" }).click();
  await soon(async () => assert.ok(new URL(page.url()).hash.includes(fields), page.url()));
});

test("the dialog fits 360 pixels in both themes, and the page does not scroll sideways", async (t) => {
  const page = await open(t, { hash: SHORT, viewport: { width: 360, height: 760 } });
  await page.keyboard.press("w");
  await until(page, hasEnded("work-precision"));
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme });
    await until(page, `(data) => data.theme === "${colorScheme}"`);
    const wide = await page.evaluate(() => {
      const dialog = document.querySelector("dialog[open]");
      return [dialog.scrollWidth - dialog.clientWidth, document.body.scrollWidth - innerWidth];
    });
    assert.deepEqual(
      wide.map((extra) => extra <= 0),
      [true, true],
      String(wide),
    );
    await screenshot(page, `studies-360-${colorScheme}`);
  }
});
