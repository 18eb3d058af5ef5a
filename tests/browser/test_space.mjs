// SPDX-License-Identifier: GPL-3.0-or-later
// Mechanisms in space: solids where the browser has WebGL, the flat drawing where it has not.
import assert from "node:assert/strict";
import { test } from "node:test";
import { createKinematics, jointPlace } from "../../web/state/kinematics.js";
import { createPace } from "../../web/views/space/pace.js";
import { violations } from "./axe.mjs";
import {
  createBench,
  drawn,
  playTo,
  read,
  screenBox,
  screenshot,
  soon,
  until,
} from "./support.mjs";

const bench = createBench();
const { open } = bench;
const isSolid = (page) => page.waitForSelector(".stage.solid");

/** Places of the names in the drawing, in pixels of the page. */
const namePlaces = (page) =>
  page.evaluate(() =>
    Object.fromEntries(
      [...document.querySelectorAll(".picture .labels text")].map((node) => {
        const { x, y, width } = node.getBoundingClientRect();
        return [node.textContent, [x + width / 2, y]];
      }),
    ),
  );

/** The middle of the cut joint [px of the drawing]. */
const cutPlace = (page) =>
  page.evaluate(() =>
    document
      .querySelector(".picture .cut")
      .getAttribute("d")
      .slice(1)
      .split("a")[0]
      .split(" ")
      .map(Number),
  );

/** Pixels of the stage that are near to a colour of the page. */
async function countColour(page, colour) {
  const picture = await page.locator(".stage").screenshot();
  return page.evaluate(
    async ([source, name]) => {
      const image = new Image();
      image.src = `data:image/png;base64,${source}`;
      await image.decode();
      const canvas = document.createElement("canvas");
      canvas.width = image.width;
      canvas.height = image.height;
      const context = canvas.getContext("2d");
      const style = getComputedStyle(document.documentElement).getPropertyValue(name);
      context.fillStyle = style.trim();
      context.fillRect(0, 0, 1, 1);
      const [r, g, b] = context.getImageData(0, 0, 1, 1).data;
      context.drawImage(image, 0, 0);
      const { data } = context.getImageData(0, 0, image.width, image.height);
      let count = 0;
      // the same hue, in light and in shade
      const [most, whole] = [Math.max(r, g, b), r + g + b];
      for (let i = 0; i < data.length; i += 4) {
        const sum = data[i] + data[i + 1] + data[i + 2];
        const off =
          Math.abs(data[i] / sum - r / whole) +
          Math.abs(data[i + 1] / sum - g / whole) +
          Math.abs(data[i + 2] / sum - b / whole);
        count += sum > 0.4 * most && off < 0.12;
      }
      return count;
    },
    [picture.toString("base64"), colour],
  );
}

test("a scene in space is drawn with solids, with names where the joints are", async (t) => {
  const page = await open(t, { hash: "#bennett", viewport: { width: 1366, height: 768 } });
  await isSolid(page);
  // this browser draws by software: smooth edges would cost twice as much as they show
  assert.equal(
    await page.evaluate(
      () =>
        document.querySelector(".space canvas").getContext("webgl2").getContextAttributes()
          .antialias,
    ),
    false,
  );
  await until(page, (data) => data.reference?.state === "ready");
  await playTo(page, 0.3);
  await soon(async () => {
    const coloured = await countColour(page, "--slot-0");
    assert.ok(coloured > 400, `${coloured} pixels have the colour of the method`);
  });
  await soon(async () => assert.equal(await page.locator(".picture .ghosts").isVisible(), false));
  await soon(async () => {
    const places = await namePlaces(page);
    assert.deepEqual(Object.keys(places).sort(), ["J1", "J2", "J3", "J4"]);
    const box = await screenBox(page.locator(".stage"));
    for (const [x, y] of Object.values(places)) {
      assert.ok(x > box.x && x < box.x + box.width && y > box.y && y < box.y + box.height);
    }
  });
  await screenshot(page, "space-bennett-light", { seen: true });
});

test("wheel, keys, buttons and the right mouse button move through space", async (t) => {
  const page = await open(t, { hash: "#rssr", viewport: { width: 1366, height: 768 } });
  await isSolid(page);
  await until(page, (data) => data.reference?.state === "ready");
  await drawn(page);
  const apart = async () => {
    const { O1, O3 } = await namePlaces(page);
    return Math.hypot(O1[0] - O3[0], O1[1] - O3[1]);
  };
  const [start, wide] = [await namePlaces(page), await apart()];
  const stage = page.locator(".stage");
  await stage.focus();
  await page.keyboard.press("+");
  await soon(async () => assert.ok((await apart()) > 1.1 * wide, "plus zooms in"));
  await page.keyboard.press("0");
  await soon(async () => assert.deepEqual(await namePlaces(page), start));

  const { x, y } = await screenBox(stage);
  await page.mouse.move(x + 200, y + 200);
  await page.mouse.wheel(0, 400);
  await page.waitForFunction((before) => {
    const at = (name) =>
      [...document.querySelectorAll(".picture .labels text")]
        .find((node) => node.textContent === name)
        .getBoundingClientRect();
    return Math.hypot(at("O1").x - at("O3").x, at("O1").y - at("O3").y) < 0.8 * before;
  }, wide);
  await page.getByRole("button", { name: "fit" }).click();

  await drawn(page);
  const before = await cutPlace(page);
  await page.mouse.move(x + 200, y + 200);
  await page.mouse.down({ button: "right" });
  await page.mouse.move(x + 260, y + 170, { steps: 3 });
  await page.mouse.up({ button: "right" });
  await soon(async () => {
    const byMouse = (await cutPlace(page)).map((place, k) => place - before[k]);
    // nearer things move farther than the middle of the picture
    assert.ok(byMouse[0] > 45 && byMouse[0] < 75, String(byMouse));
    assert.ok(byMouse[1] > -38 && byMouse[1] < -22, String(byMouse));
  });

  const t0 = await read(page, (data) => data.latest.frame);
  await stage.focus();
  await page.keyboard.press("ArrowRight");
  await soon(async () =>
    assert.ok(await read(page, (data) => data.view.look !== null), "arrows turn the view"),
  );
  await soon(async () =>
    assert.equal(await read(page, (data) => data.latest.frame), t0, "and do not step"),
  );

  const perspective = page.getByRole("button", { name: "perspective" });
  await soon(async () => assert.equal(await perspective.getAttribute("aria-pressed"), "true"));
  await page.keyboard.press("p");
  await soon(async () => assert.equal(await perspective.getAttribute("aria-pressed"), "false"));
  await page.getByRole("button", { name: "follow" }).click();
  await page.getByRole("button", { name: "frames" }).click();
  await page.getByRole("button", { name: "paths" }).click();
  await page.focus("#play");
  await playTo(page, 0.3);
});

for (const [theme, width] of [
  ["light", 1366],
  ["dark", 360],
]) {
  test(`axe finds nothing on solids, ${theme}, ${width} wide`, async (t) => {
    const page = await open(t, {
      hash: "#stewart-6-6",
      colorScheme: theme,
      viewport: { width, height: 780 },
      bypassCSP: true,
    });
    await isSolid(page);
    // it has too many joints to name all: the cut ones have their names, where there is room
    await soon(async () => {
      const names = Object.keys(await namePlaces(page));
      assert.ok(names.every((name) => /^S[1-6]$/.test(name)) && names.length >= 4, String(names));
    });
    await soon(async () => {
      const tools = await screenBox(page.locator(".space-tools"));
      const tops = Object.values(await namePlaces(page)).map(([, y]) => y);
      const lowest = tools.y + tools.height - 4; // above it no name has room beside its joint
      assert.ok(width > 639 || Math.min(...tops) > lowest, `${tops} below ${lowest}`);
    });
    assert.equal(
      await page.textContent(".glyphs"),
      "thin rod: axis of a joint · cone: sliding drive",
    );
    await page.getByRole("button", { name: "frames" }).click();
    await page.evaluate(() => document.activeElement.blur());
    await page.mouse.move(width / 2, 300); // away from the button, so that its tip goes
    await page.waitForSelector("#tip", { state: "hidden" });
    await soon(async () => assert.deepEqual(await violations(page), []));
    await soon(async () =>
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width),
    );
    await screenshot(page, `space-stewart-${theme}-${width}`, { seen: true });
  });
}

test("what stands on the ground keeps clear of the words beside the lens", async (t) => {
  for (const viewport of [
    { width: 1366, height: 768 },
    { width: 360, height: 740 },
  ]) {
    for (const hash of ["#bennett", "#stewart-6-6"]) {
      const page = await open(t, { hash, viewport });
      await until(page, (data) => data.reference?.state === "ready");
      await page.locator(".stage.solid").waitFor();
      await soon(async () => {
        const { lowest, words } = await page.evaluate(async () => {
          const { createRig } = await import("/views/space/rig.js");
          const { feetOf } = await import("/views/space/box.js");
          const { data } = globalThis.holonom;
          const box = document.querySelector(".picture").getBoundingClientRect();
          const words = document.querySelector(".tear-inset figcaption").getBoundingClientRect();
          const rig = createRig(data, { width: box.width, height: box.height });
          rig.fitOnce(104); // [px] as the drawing does for the lens
          const { point } = rig.camera();
          const heights = feetOf(data.scene).map((foot) => point(foot, 0)[1]);
          return { lowest: Math.max(...heights), words: words.top - box.top };
        });
        assert.ok(lowest <= words + 4, `${viewport.width} ${hash}: ${lowest} over ${words}`); // [px] of leading
      });
    }
  }
});

test("from space to the plane and back: each is drawn by its own means", async (t) => {
  const page = await open(t, { hash: "#rssr" });
  await isSolid(page);
  await page.selectOption("#scene", "four-bar");
  await page.waitForSelector(".stage:not(.solid)");
  await soon(async () => assert.equal(await page.textContent(".glyphs"), ""));
  await page.waitForFunction(() =>
    document.querySelector(".picture .ghosts path")?.getAttribute("d"),
  );
  await soon(async () => assert.equal(await page.locator(".space-tools").isVisible(), false));
  await page.selectOption("#scene", "bennett");
  await isSolid(page);
});

test("pictures that come late have fewer pixels, and what stands still has all of them", () => {
  const pace = createPace(true);
  let now = 0;
  const play = (pictures, span) => {
    for (let k = 0; k < pictures; k++) {
      pace.drawn(true, (now += span));
    }
    return pace.ratio(true, 2);
  };
  assert.equal(play(1, 5000), 1);
  assert.equal(play(40, 16.7), 1, "in time");
  assert.equal(play(20, 40), 0.75);
  assert.equal(play(20, 40), 0.5);
  assert.equal(play(200, 100), 0.5, "no coarser than half");
  assert.equal(pace.ratio(false, 2), 1, "at rest");
  assert.equal(play(1, 5000), 0.75, "the next movement is tried with more");

  const card = createPace(false);
  assert.equal(card.ratio(true, 2), 2);
  Array.from({ length: 21 }, (_, k) => card.drawn(true, 40 * k));
  assert.deepEqual([card.coarse, card.ratio(true, 2)], [true, 1], "first without shadows");
});

test("late pictures of a run have fewer pixels, the one it stops at has all", async (t) => {
  const page = await open(t, {
    hash: "#bennett",
    fresh: true,
    init: () => {
      const soonest = globalThis.requestAnimationFrame.bind(globalThis);
      globalThis.requestAnimationFrame = (draw) => setTimeout(() => soonest(draw), 40);
    },
  });
  await isSolid(page);
  const pixels = () =>
    page.evaluate(() => {
      const canvas = document.querySelector(".space canvas");
      return canvas.width / canvas.clientWidth;
    });
  const whole = await pixels();
  await page.focus("#play");
  await page.keyboard.press("Space");
  await soon(async () => assert.ok((await pixels()) <= 0.75 * whole));
  await page.keyboard.press("Space");
  await soon(async () => assert.ok(Math.abs((await pixels()) - whole) < 0.01));
});

test("without WebGL the flat drawing stays, and nothing is fetched for solids", async (t) => {
  const page = await open(t, {
    hash: "#bennett",
    fresh: true,
    init: () => {
      const get = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function (kind, ...how) {
        return kind.startsWith("webgl") ? null : get.call(this, kind, ...how);
      };
    },
  });
  await page.waitForFunction(() =>
    document.querySelector(".picture .ghosts path")?.getAttribute("d"),
  );
  const files = await page.evaluate(() =>
    performance.getEntriesByType("resource").map(({ name }) => name),
  );
  assert.deepEqual(
    files.filter((name) => /three|views\/space/.test(name)),
    [],
  );

  // it stays in the picture to its end, where it goes farther than a look ahead at the start knows
  await until(page, (data) => data.reference?.state === "ready");
  await playTo(page, 2);
  const box = (selector) =>
    page.locator(selector).evaluate((one) => one.getBoundingClientRect().toJSON());
  const [seen, picture] = [await box(".picture .ghosts"), await box(".picture")];
  assert.ok(
    seen.left >= picture.left && seen.right <= picture.right,
    `${seen.left} to ${seen.right} in ${picture.left} to ${picture.right}`,
  );
});

/** An answer of the server. */
async function ask(verb, path, body) {
  const answer = await fetch(new URL(path, bench.url), {
    method: verb,
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(body),
  });
  return verb === "DELETE" ? null : answer.json();
}

for (const id of [
  "stewart-6-6",
  "rssr",
  "cardan-shaft",
  "spatial-slider-crank",
  "spinning-block",
]) {
  test(`${id}: frames of the bodies follow from the coordinates`, async () => {
    const made = await ask("POST", "/api/v1/comparisons", {
      scene: id,
      methods: ["index1@rk4:h=1e-3"],
    });
    const address = `/api/v1/comparisons/${made.id}`;
    await ask("PATCH", address, { step: 12 });
    const { scene, latest } = await ask("GET", address);
    await ask("DELETE", address);
    const [{ q, points }] = latest.methods;
    const place = createKinematics(scene);
    const [before, after] = [place(scene.coordinates.map(({ value }) => value)), place(q)];
    const arm = ({ origin, turn }, list, i) => {
      const d = [0, 1, 2].map((k) => list[3 * i + k] - origin[k]);
      return [0, 1, 2].map((k) => turn[k] * d[0] + turn[k + 3] * d[1] + turn[k + 6] * d[2]);
    };
    // a point of a body stays where it is in the frame of the body
    const own = scene.drawing.shapes.filter(({ kind, body }) => body >= 0 && kind !== "trace");
    const pairs = own.flatMap(({ p, q: other, body }) => [
      [p, body],
      [other < 0 ? p : other, body],
    ]);
    assert.ok(latest.t > 0 && pairs.length > 0);
    for (const [i, body] of pairs) {
      const [a, b] = [arm(before[body], scene.points, i), arm(after[body], points, i)];
      // both sides are rounded at each joint of the chain
      a.forEach((x, k) => assert.ok(Math.abs(x - b[k]) < 1e-9, `body ${body}: ${a}, ${b}`));
    }
    for (const { p, q: other, name } of scene.drawing.tears) {
      const joint = scene.joints.find((one) => one.name === name);
      for (const [i, ofChild] of joint
        ? [
            [p, false],
            [other, true],
          ]
        : []) {
        const { at } = jointPlace(joint, after, ofChild);
        at.forEach((x, k) => assert.ok(Math.abs(x - points[3 * i + k]) < 1e-9, name));
      }
    }
  });
}
