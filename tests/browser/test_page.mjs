// SPDX-License-Identifier: GPL-3.0-or-later
// The page, looked at and used without a mouse: layout, names, contrast, keys,
// tables, no script.
import assert from "node:assert/strict";
import { test } from "node:test";
import { evaluate, valuesAt } from "../../web/state/formula.js";
import {
  createBench,
  drawn,
  playTo,
  read,
  screenBox,
  screenshot,
  settled,
  soon,
  stood,
  until,
  watchTo,
} from "./support.mjs";

const SMALLEST_TARGET = 24; // [px] WCAG 2.5.8
const TEXT_CONTRAST = 4.5; // WCAG 1.4.3
const THEMES = ["light", "dark"];

const bench = createBench();
const { open } = bench;

/** In the page: what moves without being asked to, by name and place. */
function noteShifts() {
  globalThis.shifts = [];
  new PerformanceObserver((list) => {
    for (const entry of list.getEntries()) {
      const nodes = entry.sources.map(
        ({ node, previousRect: a, currentRect: b }) =>
          `${node?.getAttribute?.("class") || node?.nodeName} from ${[a.x, a.y, a.width, a.height]} to ${[b.x, b.y, b.width, b.height]}`,
      );
      globalThis.shifts.push(`${entry.value.toFixed(5)} ${nodes.join("; ")}`);
    }
  }).observe({ type: "layout-shift", buffered: true });
}

for (const theme of THEMES) {
  test(`1280 wide, ${theme}: nothing overflows and nothing moves after the first paint`, async (t) => {
    const page = await open(t, { colorScheme: theme, fresh: true, init: noteShifts });
    await watchTo(page, 1.5);
    await soon(async () => assert.deepEqual(await page.evaluate(() => globalThis.shifts), []));
    await screenshot(page, `page-1280-${theme}`); // resizes the page, so it comes after
    await soon(async () =>
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 1280),
    );
  });
}

test("360 and 320 wide: one column in reading order, no horizontal scroll", async (t) => {
  const page = await open(t, { viewport: { width: 360, height: 780 } });
  await playTo(page, 1.5);
  for (const width of [360, 320]) {
    await page.setViewportSize({ width, height: 780 });
    await soon(async () =>
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width),
    );
    // the status line is at its own place at the end of the page
    await page.evaluate(() => scrollTo(0, document.body.scrollHeight));
    const tops = await page.evaluate(() =>
      ["mechanism", "methods", "controls", "verdict", "plots", "happening", "equations"].map(
        (id) => document.getElementById(id).getBoundingClientRect().top,
      ),
    );
    assert.deepEqual(
      tops,
      [...tops].sort((a, b) => a - b),
    );
    await screenshot(page, `page-${width}`);
  }
});

test("all text has a contrast of 4.5 at least, in both themes", async (t) => {
  const page = await open(t);
  await playTo(page, 0.3);
  await page.click(".open-parameters");
  for (const theme of THEMES) {
    await page.emulateMedia({ colorScheme: theme });
    await until(page, `(data) => data.theme === "${theme}"`);
    await drawn(page);
    await settled(page);
    const poor = await page.evaluate((least) => {
      const parse = (colour) => colour.match(/[\d.]+/g).map(Number);
      const luminance = ([r, g, b]) => {
        const [x, y, z] = [r, g, b].map((c) =>
          c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4,
        );
        return 0.2126 * x + 0.7152 * y + 0.0722 * z;
      };
      const background = (node) => {
        for (let at = node; at; at = at.parentElement) {
          const colour = parse(getComputedStyle(at).backgroundColor);
          if (colour.length < 4 || colour[3] > 0.99) {
            return colour;
          }
        }
        return [255, 255, 255];
      };
      const out = [];
      for (const node of document.querySelectorAll("body *")) {
        const own = [...node.childNodes].some(
          (child) => child.nodeType === 3 && child.textContent.trim(),
        );
        const style = getComputedStyle(node);
        if (
          !own ||
          !node.checkVisibility() ||
          node.closest("svg, .hidden, .skip, :disabled, .katex, option") ||
          style.clipPath !== "none"
        ) {
          continue;
        }
        const [a, b] = [luminance(parse(style.color)), luminance(background(node))].sort(
          (x, y) => y - x,
        );
        const ratio = (a + 0.05) / (b + 0.05);
        if (ratio < least) {
          out.push(
            `${node.className || node.tagName} "${node.textContent.trim().slice(0, 20)}" ${ratio.toFixed(2)}`,
          );
        }
      }
      return out;
    }, TEXT_CONTRAST);
    assert.deepEqual(poor, [], theme);
  }
});

test("the page's surfaces are those of the look table", async (t) => {
  const page = await open(t);
  for (const theme of THEMES) {
    const [css, look] = await page.evaluate((name) => {
      document.documentElement.dataset.theme = name;
      const style = getComputedStyle(document.documentElement);
      const surface = globalThis.holonom.data.look.surfaces[name];
      return [
        Object.fromEntries(
          Object.keys(surface).map((key) => [
            key,
            style.getPropertyValue(`--${key}`).trim().toUpperCase(),
          ]),
        ),
        surface,
      ];
    }, theme);
    assert.deepEqual(css, look);
  }
});

test("every control has a name and room, every reference a target, every id one owner", async (t) => {
  const page = await open(t);
  await page.click(".open-parameters");
  const report = await page.evaluate((least) => {
    const name = (node) =>
      node.getAttribute("aria-label") ||
      [...(node.labels ?? [])].map((label) => label.textContent).join(" ") ||
      node.textContent.trim() ||
      node.title;
    const shown = [...document.querySelectorAll("button, select, input, summary, a")].filter(
      (node) => node.checkVisibility() && !node.closest(".skip"),
    );
    const ids = [...document.querySelectorAll("[id]")].map((node) => node.id);
    const references = [
      ...document.querySelectorAll("[aria-labelledby], [aria-describedby], label[for]"),
    ].flatMap((node) =>
      ["aria-labelledby", "aria-describedby", "for"].flatMap((attribute) =>
        (node.getAttribute(attribute) ?? "").split(" ").filter(Boolean),
      ),
    );
    return {
      nameless: shown.filter((node) => !name(node)).map((node) => node.outerHTML.slice(0, 80)),
      small: shown
        .map((node) => ({ node, box: node.getBoundingClientRect() }))
        .filter(
          ({ node, box }) =>
            (box.width < least || box.height < least) &&
            !(node.type === "checkbox" && box.width + 6 >= least),
        )
        .map(({ node, box }) => `${node.outerHTML.slice(0, 60)} ${box.width}x${box.height}`),
      twice: ids.filter((id, i) => ids.indexOf(id) !== i),
      dangling: references.filter((id) => !document.getElementById(id)),
      headings: [...document.querySelectorAll("h1, h2")].map((node) => node.tagName)[0],
      language: document.documentElement.lang,
    };
  }, SMALLEST_TARGET);
  assert.deepEqual(report, {
    nameless: [],
    small: [],
    twice: [],
    dangling: [],
    headings: "H1",
    language: "en",
  });
});

test("a slider tells its value with the unit; Home is the least, End the most", async (t) => {
  const page = await open(t);
  const slider = page.locator("#set-h-slider");
  await soon(async () => assert.equal(await slider.getAttribute("aria-valuetext"), "0.02 s"));
  await slider.focus();
  await page.keyboard.press("Home");
  await soon(async () => assert.equal(await slider.getAttribute("aria-valuetext"), "0.0001 s"));
  await soon(async () => assert.equal(await slider.inputValue(), await slider.getAttribute("min")));
  await page.keyboard.press("End");
  await soon(async () => assert.equal(await slider.getAttribute("aria-valuetext"), "0.1 s"));
  await soon(async () => assert.equal(await slider.inputValue(), await slider.getAttribute("max")));
  await soon(async () => assert.equal(await read(page, (data) => data.state), "paused"));
});

test("everything is reached by Tab, and the first stop leads to Play", async (t) => {
  const page = await open(t);
  await page.evaluate(() => {
    document.body.tabIndex = -1;
    document.body.focus();
  });
  const stops = [];
  for (let k = 0; k < 34; k++) {
    await page.keyboard.press("Tab");
    stops.push(
      await page.evaluate(
        () => document.activeElement.id || document.activeElement.textContent.trim(),
      ),
    );
  }
  assert.deepEqual(stops.slice(0, 2), ["Skip to play and pause", "Skip to the methods"]);
  assert.ok(stops.includes("play") && stops.includes("scrub"), stops.join(" | "));
  await page.locator(".skip a").first().focus();
  await page.keyboard.press("Enter");
  await soon(async () =>
    assert.equal(await page.evaluate(() => document.activeElement.id), "play"),
  );
});

test("digits select, signs change the speed, and single characters can be switched off", async (t) => {
  const page = await open(t);
  await page.keyboard.press("3");
  await until(page, (data) => data.view.selected === 2);
  await soon(async () =>
    assert.equal(await page.getAttribute("tbody tr:nth-child(3) .select", "aria-pressed"), "true"),
  );
  await page.keyboard.press("=");
  await until(page, (data) => data.speed === 2);
  await page.keyboard.press("-");
  await until(page, (data) => data.speed === 1);
  await page.keyboard.press("F1");
  await page.locator("table.keys").waitFor();
  await page.uncheck("#letters");
  await page.locator("dialog[open]").getByRole("button", { name: "Close" }).click();
  await page.focus("#play");
  await page.keyboard.press("1");
  await page.keyboard.press("=");
  await page.keyboard.press("ArrowRight");
  await until(page, (data) => data.latest.frame === 1);
  await soon(async () => assert.equal(await read(page, (data) => data.view.selected), 2));
  await soon(async () => assert.equal(await read(page, (data) => data.speed), 1));
});

test("keys typed into a field stay in the field", async (t) => {
  const page = await open(t);
  await page.focus("#set-h");
  await page.keyboard.press("3");
  await page.keyboard.press("Space");
  await page.keyboard.press("Backspace");
  await soon(async () =>
    assert.deepEqual(await read(page, (data) => [data.view.selected, data.state]), [0, "paused"]),
  );
});

test("the option of a coordinate says which number is which", async (t) => {
  const page = await open(t);
  await page.getByRole("button", { name: "Change or remove reduced" }).click();
  await page
    .getByText(/number of the joint coordinate to keep, here 1 th1, 2 a2, 3 th3;/)
    .waitFor();
});

test("each curve has a table with the same numbers", async (t) => {
  const page = await open(t, { viewport: { width: 1366, height: 768 } });
  await playTo(page, 1);
  const plots = page.locator("figure.plot");
  await soon(async () => assert.equal(await plots.count(), 2));
  for (let k = 0; k < 2; k++) {
    const plot = plots.nth(k);
    await plot.getByRole("button", { name: "table" }).click();
    await soon(async () => assert.ok((await plot.locator("thead th").count()) >= 4, "some times"));
    await soon(async () =>
      assert.equal(await plot.locator("tbody tr").count(), 5, "a row per method"),
    );
    const cut = await plot.locator(".twin").evaluate((el) => el.scrollWidth - el.clientWidth);
    assert.ok(cut <= 0, `${cut} px are cut off`);
  }
  await soon(async () => {
    const last = await plots.nth(1).locator("tbody tr").first().locator("td").last().textContent();
    assert.match(last, /^[\d.]+ [pnµm]m$/);
    assert.equal(last, await page.textContent("tbody tr:nth-child(1) td.gap .number"));
  });
});

test("a click on a curve shows that time, and the table, the drawing and the clock follow", async (t) => {
  const page = await open(t);
  await playTo(page, 1);
  const before = await page.getAttribute(".ghost.selected .outline", "d");
  const box = await screenBox(page.locator(".u-over").first());
  await page.mouse.click(box.x + 0.05 * box.width, box.y + 20);
  await until(page, (data) => data.view.shown >= 0);
  await drawn(page);
  await soon(async () =>
    assert.notEqual(await page.getAttribute(".ghost.selected .outline", "d"), before),
  );
  const shown = await read(page, (data) => data.history.t[data.view.shown]);
  await soon(async () =>
    assert.equal(await page.textContent(".time"), `t ${shown.toFixed(2)} s / 10 s`),
  );
});

test("the axes of time are those of the scene shown, after another one as well", async (t) => {
  const page = await open(t);
  await page.selectOption("#scene", "seven-body-squeezer");
  await until(page, (data) => data.scene.id === "seven-body-squeezer" && data.history.count > 0);
  await page.focus("#play");
  await page.keyboard.press("Space");
  await until(page, (data) => data.latest?.t > 0.01);
  await page.keyboard.press("ArrowRight");
  await stood(page);
  const { x, y, width } = await screenBox(page.locator(".u-over").first());
  await page.mouse.click(x + 0.1 * width, y + 20);
  await until(page, (data) => data.view.shown >= 0);
  const shown = await read(page, (data) => data.history.t[data.view.shown] / data.duration);
  assert.ok(shown > 0.05 && shown < 0.3, `a tenth of the axis is ${shown} of the run`);
});

test("a server that is lost is told in sight of the mechanism", async (t) => {
  const line = await bench.line(t);
  const page = await open(t, { url: line.url, viewport: { width: 1280, height: 720 } });
  await soon(async () => assert.equal(await page.evaluate(() => scrollY), 0));
  line.cut();
  const told = page.locator(".lost");
  await told.getByText("goes on by itself when the server is back").waitFor();
  const { y, height } = await screenBox(told);
  assert.ok(y > 0 && y + height <= 720, `at ${y} px of 720`);
});

test("the drawing is described in one sentence on demand", async (t) => {
  const page = await open(t);
  await page.getByRole("button", { name: "describe" }).click();
  await soon(async () =>
    assert.match(
      await page.textContent(".spoken"),
      /^Four-bar.* at 0\.00 s, drawn by index-1,.*loop gap .*\.$/,
    ),
  );
});

test("the equations of the scene are set as mathematics", async (t) => {
  const page = await open(t);
  await page.click(".equation-panel summary");
  await page.waitForSelector(".term-block .katex");
  await soon(async () => assert.ok((await page.locator(".term-block").count()) >= 4));
  await soon(async () => assert.equal(await page.locator(".katex-error").count(), 0));
  await screenshot(page, "page-1280-light-equations");
});

test("the numbers beside the entries are those of the state shown: with them J v = 0, and v'Mv is the kinetic energy", async (t) => {
  const page = await open(t);
  await page.click(".equation-panel summary");
  await page.waitForSelector(".term-block .katex");
  const { answer, terms, state } = await page.evaluate(async () => {
    const post = (path, body) =>
      fetch(`/api/v1/${path}`, {
        method: "POST",
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify(body),
      }).then((response) => response.json());
    const { latest, scene } = globalThis.holonom.data;
    const { q, v } = latest.methods[0];
    return {
      answer: await post("equations", { scene: "four-bar", format: "json" }),
      terms: await post("terms", { scene: "four-bar" }),
      state: { scene, q, v },
    };
  });
  const values = valuesAt(answer, state.scene, { t: 0, ...state });
  const rates = answer.speeds.map((name) => values.get(name));
  const of = (name) =>
    answer.entries
      .filter(({ term }) => term === name)
      .map((one) => ({ ...one, value: evaluate(one.text, values) }));
  const Jv = [0, 0];
  of("J").forEach(({ row, column, value }) => (Jv[row - 1] += value * rates[column - 1]));
  assert.ok(Math.max(...Jv.map(Math.abs)) < 1e-12, `J v = ${Jv}`);
  const twice = of("M").reduce(
    (total, { row, column, value }) =>
      total + (row === column ? 1 : 2) * value * rates[row - 1] * rates[column - 1],
    0,
  );
  assert.ok(Math.abs(twice / 2 - terms.kinetic) < 1e-12 * terms.kinetic, `${twice / 2} J`);

  const shown = () => page.locator(".equation-body > .terms .line .value").allTextContents();
  let first = [];
  await soon(async () => {
    first = await shown();
    assert.ok(
      first.length > 0 && first.every((text) => /^= −?[\d.]+(e[+−]?\d+)?$/.test(text)),
      String(first),
    );
  });
  const M21 = of("M").find(({ row, column }) => row === 2 && column === 1).value;
  assert.ok(first.includes(`= ${Number(M21.toPrecision(4))}`));
  await page.focus("#play");
  await playTo(page, 0.4);
  await soon(async () => assert.notDeepEqual(await shown(), first, "they follow the time shown"));
});

for (const [theme, width] of [
  ["light", 1280],
  ["dark", 360],
]) {
  test(`${theme}, ${width} wide: the reduced terms unfold, with names, and follow the time shown`, async (t) => {
    const page = await open(t, { colorScheme: theme, viewport: { width, height: 780 } });
    await page.click(".equation-panel summary");
    await page.waitForSelector(".reduced-panel summary");
    await soon(async () => assert.equal(await page.locator(".reduced-tables").isVisible(), false));
    await page.click(".reduced-panel summary");
    await page.waitForSelector(".reduced-tables table");
    await soon(async () =>
      assert.match(await page.textContent(".reduced-panel"), /Independent: th1 \(the motors\)/),
    );
    const acceleration = () =>
      page.textContent(".reduced-tables table:first-child tbody tr:nth-child(2) td");
    const [M, C, g, tau, a] = await page.evaluate(() => {
      const numbers = [...document.querySelectorAll(".reduced-tables table")].map((one) =>
        [...one.querySelectorAll("tbody td")].map((td) => Number(td.textContent.replace("−", "-"))),
      );
      const [[v, a, g, tau], [M], [C]] = numbers;
      return [M, C * v, g, tau, a];
    });
    // four digits of each are shown
    assert.ok(Math.abs(M * a + C + g - tau) < 2e-3 * (Math.abs(g) + Math.abs(C)));
    // the closed form is set: four parts, and the two coordinates of the dyad
    await soon(async () =>
      assert.equal(await page.locator(".reduced-panel .term-block .katex").count(), 6),
    );
    await soon(async () => assert.equal(await page.locator(".katex-error").count(), 0));
    await soon(async () =>
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width),
    );
    const before = await acceleration();
    await page.locator(".reduced-panel").scrollIntoViewIfNeeded();
    await screenshot(page, `page-${width}-${theme}-reduced`);
    await page.evaluate(() => document.activeElement?.blur());
    await page.keyboard.press("Space");
    await until(page, (data) => data.latest?.t > 0.3);
    await page.waitForFunction(
      (old) =>
        document.querySelector(".reduced-tables table tbody tr:nth-child(2) td").textContent !==
        old,
      before,
    );
  });
}

test("where no coordinates can be independent, the reduced terms say so", async (t) => {
  const page = await open(t, { hash: "#heavy-top" });
  await page.click(".equation-panel summary");
  await page.click(".reduced-panel summary");
  await page.waitForFunction(() =>
    /no set of independent coordinates at t = 0 s: the rotation of \w+ would have/.test(
      document.querySelector(".reduced-panel").textContent,
    ),
  );
});

test("a formula too long to be read is not set, and said where it is printed", async (t) => {
  const page = await open(t, { hash: "#stewart-6-6" });
  await page.click(".equation-panel summary");
  await page.waitForFunction(() =>
    /thousand characters: "holonom equations" prints it/.test(
      document.querySelector(".equation-body").textContent,
    ),
  );
  await soon(async () => assert.equal(await page.locator(".katex-error").count(), 0));
  await soon(async () =>
    assert.match(
      await page.textContent(".equation-body"),
      /rotation vector of the unit quaternion/,
    ),
  );
});

for (const width of [360, 768]) {
  test(`${width} wide, in space, with forces and the dialog open: no horizontal scroll`, async (t) => {
    const page = await open(t, { viewport: { width, height: 780 }, hash: "#delta-robot" });
    await page.click("#reactions summary");
    await page.waitForSelector("#reactions tbody tr");
    await soon(async () =>
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width),
    );
    await page.getByRole("button", { name: "add a method" }).click();
    await page.selectOption("#pick-formulation", "ggl");
    await page.click(".misfits summary");
    const [dialog, inner] = await page.evaluate(() => {
      const node = document.querySelector(".dialog");
      return [node.clientWidth, node.scrollWidth];
    });
    assert.equal(inner, dialog);
    await screenshot(page, `dialog-${width}`);
  });
}

test("every shipped scene opens, moves and draws no NaN", async (t) => {
  const page = await open(t);
  const ids = await read(page, (data) => data.scenes.map(({ id }) => id));
  assert.ok(ids.length >= 6, ids.join(", "));
  for (const id of ids) {
    await page.selectOption("#scene", id);
    await until(page, `(data) => data.scene.id === "${id}" && data.history.count > 0`);
    await playTo(page, await read(page, (data) => Math.min(0.4, 0.1 * data.duration)));
    assert.doesNotMatch(await page.textContent("main"), /NaN|Infinity|undefined/, id);
    assert.doesNotMatch(
      await page.evaluate(() => document.querySelector(".picture").outerHTML),
      /NaN|Infinity/,
      id,
    );
    await screenshot(page, `scene-${id}`, { seen: true });
  }
});

test("who wants less motion gets steps until he asks for more", async (t) => {
  const page = await open(t, { reducedMotion: "reduce" });
  await soon(async () => assert.match(await page.textContent("#play"), /Step/));
  await page.keyboard.press("Space");
  await until(page, (data) => data.latest?.t > 0.09);
  await soon(async () => assert.equal(await read(page, (data) => data.state), "paused"));
  await page.getByRole("button", { name: "animate" }).click();
  await until(page, (data) => data.state === "running");
});

test("the theme can be chosen and is remembered", async (t) => {
  const page = await open(t, { colorScheme: "light" });
  await page.getByRole("button", { name: "dark theme" }).click();
  await soon(async () =>
    assert.equal(
      await page.evaluate(() => getComputedStyle(document.body).backgroundColor),
      "rgb(20, 23, 27)",
    ),
  );
  await page.reload();
  await page.waitForFunction(() => document.documentElement.dataset.theme === "dark");
});

test("without script there is a picture, an explanation and the way to the JSON", async (t) => {
  const page = await open(t, { javaScriptEnabled: false, wait: false });
  await soon(async () => assert.ok(await page.locator(".still img").isVisible()));
  await soon(async () => assert.ok((await page.locator(".still img").boundingBox()).height > 100));
  await soon(async () =>
    assert.equal(await page.locator(".still a").first().getAttribute("href"), "api/v1/"),
  );
  await soon(async () => assert.equal(await page.locator("main").isVisible(), false));
  await screenshot(page, "page-no-script");
});
