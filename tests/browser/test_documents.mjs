// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes as pictures and as documents: the gallery, the editor, building with the mouse, files of
// other programs.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { offersAt } from "../../web/state/completion.js";
import { caretIn, lineOf, parseText, placeOf, placesOf } from "../../web/state/json-text.js";
import { fitsSearch } from "../../web/state/gallery.js";
import { parseQuantity } from "../../web/state/format.js";
import { addBar, addMotor, addPin, addSlider, writeScene } from "../../web/state/scene-parts.js";
import { violations } from "./axe.mjs";
import { decodeLink, encodeLink } from "../../web/state/link.js";
import { createBench, read, ROOT, screenBox, screenshot, soon, until } from "./support.mjs";

const { open } = createBench();
const SCHEMA = JSON.parse(readFileSync(join(ROOT, "core/scene/scene.schema.json"), "utf8"));
const FOUR_BAR = readFileSync(join(ROOT, "lessons/01-closed-loops/scenes/four-bar.json"), "utf8");

/** Returns what is offered where a bar stands in the text. */
function offered(text) {
  const at = text.indexOf("|");
  const whole = text.replace("|", "");
  return offersAt(SCHEMA, JSON.parse(FOUR_BAR), caretIn(whole, at)).map((one) => one.text);
}

test("the caret's place in a document decides what is offered", () => {
  assert.ok(offered('{"|').includes("gravity"));
  assert.ok(!offered('{"holonom": 1, "|').includes("holonom"), "each name once");
  assert.deepEqual(offered('{"joints": [{"type": "pri|'), ["prismatic"]);
  assert.ok(offered('{"joints": [{"name": "A", "par|').includes("parent"));
  assert.deepEqual(offered('{"joints": [{"parent": {"body": "cra|'), ["crank"]);
  assert.ok(offered('{"loads": [{"torque": {"joint": "|').includes("O1"));
  assert.ok(offered('{"start": {"positions": {"|').includes("th1"));
  assert.deepEqual(offered('{"joints": [{"cut": tr|'), ["true"]);
});

test("a fault is found at its line, in a whole text and in a broken one", () => {
  const places = placesOf(FOUR_BAR);
  const scene = JSON.parse(FOUR_BAR);
  const at = placeOf(places, "/joints/2/type");
  assert.equal(JSON.parse(FOUR_BAR.slice(at, at + 10)), scene.joints[2].type);
  assert.equal(placeOf(places, "/bodies/0/nothing"), placeOf(places, "/bodies/0"));
  const { fault } = parseText('{\n  "a": 1,\n  "b" 2\n}');
  assert.equal(lineOf('{\n  "a": 1,\n  "b" 2\n}', fault.offset).line, 3);
});

test("parts are added with new names, and the document stays readable", () => {
  const scene = JSON.parse(FOUR_BAR);
  const ground = { body: -1, at: [0.3, 0.7, 0], world: [0.3, 0.7, 0] };
  const tip = { body: 0, at: [0.5, 0, 0], world: [0.4, 0.3, 0] };
  const more = addBar(scene, tip, null, [1.4, 0.3, 0], 0.2);
  assert.equal(scene.bodies.length, 3, "the old document is not touched");
  assert.equal(more.bodies[3].name, "bar1");
  assert.deepEqual(more.joints[4].parent, { body: "crank", at: [0.5, 0] });
  assert.equal(more.start.positions[more.joints[4].coordinate], -0.2);
  const closed = addBar(scene, tip, ground, [0.3, 0.7, 0], 0);
  assert.equal(closed.joints.length, 6);
  assert.equal(closed.joints[5].cut, true);
  assert.equal(new Set(closed.joints.map(({ name }) => name)).size, 6);
  assert.equal(addPin(scene, tip, ground).joints[4].parent.body, "ground");
  assert.deepEqual(addSlider(scene, tip).constraints[0].line.direction, [1, 0]);
  assert.equal(addMotor(scene, "O1").loads[0].torque.joint, "O1");
  const text = writeScene(closed);
  assert.deepEqual(JSON.parse(text), closed);
  assert.ok(text.split("\n").length > 30 && text.includes('{"body": "ground"'));
});

test("filters of the gallery ask the scene, the search its words", () => {
  const entry = { id: "x", title: "Stiff thing", about: "has a change point" };
  const scene = { view: { spatial: false }, loops: 2, coordinates: [{ actuated: false }] };
  const fits = (words, ...chosen) => fitsSearch(entry, scene, { words, chosen: new Set(chosen) });
  assert.ok(fits("thing stiff") && fits("", "plane", "several loops", "stiff", "singular"));
  assert.ok(!fits("fourbar") && !fits("", "space") && !fits("", "actuated"));
});

test("quantities are read in the units that people type", () => {
  const near = (text, unit, value) =>
    assert.ok(Math.abs(parseQuantity(text, unit) - value) < 1e-9 * Math.abs(value), text);
  near("45 cm", "m", 0.45);
  near("30 deg", "rad", Math.PI / 6);
  near("5 lb in", "N·m", 0.5649241450138);
  near("2 N/mm", "N/m", 2000);
  assert.ok(Number.isNaN(parseQuantity("5 lb in", "m")));
  assert.ok(Number.isNaN(parseQuantity("5 6", "m")));
});

test("the gallery draws every scene, filters, and opens the chosen one", async (t) => {
  const page = await open(t, { viewport: { width: 1366, height: 768 }, bypassCSP: true });
  await page.getByRole("button", { name: "gallery" }).click();
  const all = await read(page, (data) => data.scenes.length);
  await page.waitForFunction((n) => document.querySelectorAll(".thumbnail").length === n, all);
  assert.doesNotMatch(await page.innerHTML(".gallery .cards"), /NaN|undefined/);
  await screenshot(page, "gallery-1366", { seen: true });
  await soon(async () => assert.deepEqual(await violations(page), []));
  await page.getByRole("button", { name: "space", exact: true }).last().click();
  const shown = page.locator(".gallery .cards li:visible");
  await soon(async () => assert.ok((await shown.count()) > 4 && (await shown.count()) < all));
  await page.fill("#gallery-search", "bennett");
  await soon(async () => assert.equal(await shown.count(), 1));
  await shown.first().getByRole("button").click();
  await until(page, (data) => data.scene.id === "bennett");
  await soon(async () => assert.equal(await page.locator(".gallery").isVisible(), false));
});

/** Opens the editor with the document of the scene in it. */
async function edit(page) {
  await page.getByRole("button", { name: "edit", exact: true }).click();
  await page.waitForFunction(() => document.querySelector("#editor-text")?.value.length > 100);
  await page.waitForFunction(() => document.querySelector("#editor-text").scrollTop === 0);
}
const says = (page, text) =>
  page.waitForFunction(
    (words) => document.querySelector("#editor-state").textContent.includes(words),
    text,
  );

/** Replaces a piece of the document as if it were typed. */
const replace = (page, from, to) =>
  page.evaluate(
    ([a, b]) => {
      const field = document.querySelector("#editor-text");
      field.value = field.value.replace(a, b);
      field.dispatchEvent(new Event("input"));
    },
    [from, to],
  );

for (const [theme, width] of [
  ["light", 1366],
  ["dark", 360],
]) {
  test(`an edited document runs; a fault keeps the last good one: ${theme}, ${width} wide`, async (t) => {
    const page = await open(t, {
      viewport: { width, height: 780 },
      colorScheme: theme,
      bypassCSP: true,
    });
    await edit(page);
    await replace(page, '"value": 0.5,', '"value": 0.45,');
    await says(page, "runs:");
    const crank = (data) => data.scene.parameters.find(({ name }) => name === "l1").value;
    await soon(async () => assert.equal(await read(page, crank), 0.45));
    await soon(async () => assert.match(await page.textContent("#scene option:checked"), /yours/));

    await replace(page, '"type": "revolute"', '"type": "revolving"');
    await says(page, "not a scene yet");
    const fault = await page.textContent(".editor-faults li");
    assert.match(fault, /line \d+.*revolving/s);
    const line = Number(/line (\d+)/.exec(fault)[1]);
    const typed = await page.evaluate(() => document.querySelector("#editor-text").value);
    assert.match(typed.split("\n")[line - 1], /revolving/);
    await soon(async () => assert.equal(await read(page, crank), 0.45));
    await screenshot(page, `editor-${theme}-${width}`, { seen: true });
    await soon(async () => assert.deepEqual(await violations(page), []));

    await replace(page, '"revolving"', '"revolute"');
    await replace(page, '"gravity"', 'gravity"');
    await page.waitForFunction(() =>
      document.querySelector(".editor-faults").textContent.includes("not JSON"),
    );
    await soon(async () =>
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width),
    );
  });
}

test("keys complete what is typed", async (t) => {
  const page = await open(t);
  await edit(page);
  await page.evaluate(() => {
    const field = document.querySelector("#editor-text");
    const at = field.value.indexOf('"revolute"') + 1;
    field.focus();
    field.setSelectionRange(at, at + 8);
  });
  await page.keyboard.type("fix");
  await page.waitForSelector(".offers [role=option]");
  await page.keyboard.press("Enter");
  await soon(async () => assert.match(await page.inputValue("#editor-text"), /"type": "fixed"/));
});

test("bars, pins and motors are put with the mouse, and the document follows", async (t) => {
  const page = await open(t, { viewport: { width: 1366, height: 768 } });
  await edit(page);
  await page.getByRole("button", { name: "new", exact: true }).click();
  await until(page, (data) => data.scene.id === "mine");
  const tip = async () => {
    const box = await screenBox(page.locator(".ghost.selected .outline").first());
    return [box.x + box.width - 9, box.y + 9];
  };
  await page.getByRole("button", { name: "bar", exact: true }).click();
  const [x, y] = await tip();
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 60, y - 110, { steps: 4 });
  await page.mouse.up();
  await until(page, (data) => data.scene.bodies.length === 2);
  const text = () => page.inputValue("#editor-text").then(JSON.parse);
  await soon(async () => assert.equal((await text()).joints[1].parent.body, "bar1"));
  // the lines that are new are in sight
  await soon(async () => {
    const { first, last, from } = await page.evaluate(() => {
      const field = document.querySelector("#editor-text");
      const line = field.value.split("\n").findIndex((one) => /"name": "bar2"/.test(one));
      const [first, last] = [line * 20, (line + 1) * 20];
      return { first: first - field.scrollTop, last: last - field.scrollTop, from: line };
    });
    assert.ok(from > 0 && first >= 0, `line ${from} at ${first} px`);
    const height = await page.locator("#editor-text").evaluate((field) => field.clientHeight);
    assert.ok(last <= height, `line ${from} ends at ${last} of ${height} px`);
  });
  await soon(async () => assert.equal(await read(page, (data) => data.scene.dof), 2));

  await page.getByRole("button", { name: "motor", exact: true }).click();
  const pin = await page.evaluate(() => {
    const {
      x: px,
      y: py,
      width,
    } = document.querySelector(".picture .ground").getBoundingClientRect();
    return [px + width / 2, py + 2];
  });
  await page.mouse.click(...pin);
  await until(page, (data) => data.document.loads?.length === 1);
  await page.getByRole("button", { name: "undo", exact: true }).first().click();
  await until(page, (data) => !data.document.loads);

  // away from the start nothing is added where the part stands only for a moment
  await page.getByRole("button", { name: "bar", exact: true }).click();
  await page.focus("#play");
  await page.keyboard.press("Space");
  await until(page, (data) => data.latest?.t > 0.1);
  await page.getByRole("button", { name: "pin", exact: true }).click();
  await soon(async () =>
    assert.match(
      await page.textContent("#editor-state"),
      /^the motion is shown at its start again/,
    ),
  );
  await page.getByRole("button", { name: "bar", exact: true }).click();
  await page.focus("#play");
  await page.keyboard.press("Space");
  await until(page, (data) => data.state === "running" || data.view.replaying);
  const [u, v] = await tip();
  await page.mouse.move(u, v);
  await page.mouse.down();
  await page.mouse.move(u - 60, v - 110, { steps: 4 });
  await page.mouse.up();
  await soon(async () =>
    assert.match(await page.textContent("#editor-state"), /added at the start of the motion/),
  );
  await until(page, (data) => data.state !== "running" && data.view.shown === 0);
  assert.equal(await read(page, (data) => data.scene.bodies.length), 2);
});

test("models of other programs are dropped on the page", async (t) => {
  const page = await open(t);
  const drop = (name, text) =>
    page.evaluate(
      ([file, content]) => {
        const transfer = new DataTransfer();
        transfer.items.add(new File([content], file));
        const event = new DragEvent("drop", {
          dataTransfer: transfer,
          bubbles: true,
          cancelable: true,
        });
        document.body.dispatchEvent(event);
      },
      [name, text],
    );
  await drop(
    "arm.xml",
    `<mujoco model="arm"><worldbody><body name="arm"><joint name="j" type="hinge" axis="0 0 1"/>
     <geom type="capsule" fromto="0 0 0 1 0 0" size="0.02" mass="1"/></body></worldbody></mujoco>`,
  );
  await until(page, (data) => data.scene.id === "arm");
  await soon(async () => assert.match(await page.textContent("#editor-state"), /MJCF/));
  await drop("own.json", FOUR_BAR.replace('"name": "four-bar"', '"name": "own"'));
  await until(page, (data) => data.scene.id === "own");
  await drop("broken.urdf", "<robot><link name='a'></robot>");
  await says(page, "was not read");
  await soon(async () => assert.equal(await read(page, (data) => data.scene.id), "own"));
});

test("a URDF is opened with its loop file, chosen or dropped", async (t) => {
  const page = await open(t);
  const file = (name) => ({
    name,
    mimeType: "text/plain",
    buffer: readFileSync(join(ROOT, "tests/import", name)),
  });
  const rubbish = (text) => ({
    name: "rubbish.json",
    mimeType: "text/plain",
    buffer: Buffer.from(text),
  });
  const choose = (...files) => page.setInputFiles(".editor input[type=file]", files);
  const closing = () =>
    page
      .inputValue("#editor-text")
      .then((text) => JSON.parse(text).joints.filter(({ cut }) => cut).length);
  await edit(page);

  // by itself it is a tree; with its loop file its loop is closed
  await choose(file("four-bar.urdf"));
  await until(page, (data) => data.scene.joints.length === 4);
  await says(page, "URDF");
  assert.equal(await closing(), 0);
  await choose(file("four-bar.loops.json"), file("four-bar.urdf"));
  await until(page, (data) => data.scene.joints.length === 5 && data.scene.loops === 1);
  await says(page, "URDF");
  assert.equal(await closing(), 1);

  // what is no loop file is named, and the last good scene stays
  for (const [text, reason] of [
    ["rubbish", "expected a value"],
    ["", "loop file"],
    ['{"a": 1}', "unknown field"],
  ]) {
    await choose(file("four-bar.urdf"), rubbish(text));
    await says(page, "the loop file 'rubbish.json' was not read");
    await says(page, reason);
  }
  await choose(file("four-bar.urdf"), file("double-pendulum.urdf"));
  await says(page, "'four-bar.urdf', 'double-pendulum.urdf': open one file");
  assert.equal(await read(page, (data) => data.scene.joints.length), 5);

  // dropped together
  await choose(file("four-bar.urdf"));
  await until(page, (data) => data.scene.joints.length === 4);
  await page.evaluate(
    (files) => {
      const transfer = new DataTransfer();
      files.forEach(([name, text]) => transfer.items.add(new File([text], name)));
      const how = { dataTransfer: transfer, bubbles: true, cancelable: true };
      document.body.dispatchEvent(new DragEvent("drop", how));
    },
    [file("four-bar.urdf"), file("four-bar.loops.json")].map((one) => [
      one.name,
      String(one.buffer),
    ]),
  );
  await until(page, (data) => data.scene.joints.length === 5 && data.scene.loops === 1);
});

test("a model of another program can be pasted, and what it leaves out is counted", async (t) => {
  const page = await open(t);
  await edit(page);
  const bar = "<joint axis='0 1 0'/><geom type='capsule' fromto='0 0 0 0.5 0 0' size='0.02'/>";
  const arm = `<body name='a'>${bar}<body name='b' pos='0.5 0 0'>${bar}</body></body>`;
  const model = (more) => `<mujoco><worldbody>${more}</worldbody></mujoco>`;
  await page.fill("#editor-text", model(arm));
  await until(page, (data) => data.scene.bodies.length === 2);
  const state = page.locator("#editor-state");
  await page.waitForFunction(() =>
    /^MJCF: 0 notes/.test(document.querySelector("#editor-state").textContent),
  );
  await page.fill("#editor-text", model(`${arm}<body name='c' pos='0 1 0'>${bar}</body>`));
  await until(page, (data) => data.scene.bodies.length === 3);
  await page.waitForFunction(() =>
    /^MJCF: 1 note on/.test(document.querySelector("#editor-state").textContent),
  );
  await soon(async () =>
    assert.match(await page.textContent(".editor-faults"), /can touch one another in MuJoCo/),
  );
  await soon(async () =>
    assert.ok(JSON.parse(await page.inputValue("#editor-text")).bodies.length === 3),
  );

  await page.fill("#editor-text", "<mujoco><worldbody></mujoco>");
  await page.waitForFunction(() =>
    /was not read/.test(document.querySelector("#editor-state").textContent),
  );
  await soon(async () =>
    assert.equal(await read(page, (data) => data.scene.bodies.length), 3, "the last good one runs"),
  );
  assert.doesNotMatch(String(await state.textContent()), /JSON/);
});

test("undo in the editor brings back the shipped scene, its parameters and the step", async (t) => {
  const methods = ["index1@rk4:h=0.005"];
  const settings = { l1: 0.55 };
  const { link } = decodeLink("four-bar");
  const hash = `#${encodeLink({ ...link, methods, settings })}`;
  const page = await open(t, { hash, viewport: { width: 1366, height: 900 } });
  const now = () =>
    read(page, (data) => ({
      methods: data.methods.map(({ spelling }) => spelling),
      settings: data.settings,
    }));
  assert.deepEqual(await now(), { methods, settings });
  await edit(page);
  await page.getByRole("button", { name: "new", exact: true }).click();
  await until(page, (data) => data.document?.name === "mine");
  await page.getByRole("button", { name: "undo", exact: true }).first().click();
  await until(page, (data) => data.document === null && data.scene.id === "four-bar");
  assert.deepEqual(await now(), { methods, settings });

  // the methods on the page stay while its document is edited, though the document has its own
  await replace(page, '"gravity"', ' "gravity"');
  await until(page, (data) => data.document?.name === "four-bar");
  assert.deepEqual((await now()).methods, methods);
});

test("a bar begun on the middle of another is pinned to it, not to the ground", async (t) => {
  const page = await open(t, { viewport: { width: 1366, height: 768 } });
  await edit(page);
  const old = await read(page, (data) => data.scene.joints.length);
  await page.getByRole("button", { name: "bar", exact: true }).click();
  const [x, y] = await page.evaluate(() => {
    const coupler = document.querySelectorAll(".ghost.selected .outline")[1];
    const { x, y, width, height } = coupler.getBoundingClientRect();
    return [x + width / 2, y + height / 2];
  });
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 20, y - 100, { steps: 4 });
  await page.mouse.up();
  await until(page, (data) => data.scene.bodies.length === 4);
  const { parent } = await read(page, (data) => data.document.joints.at(-1));
  assert.equal(await read(page, (data) => data.document.joints.length), old + 1);
  assert.equal(parent.body, "coupler");
  assert.ok(parent.at[0] > 0.3 && parent.at[0] < 0.9, `at ${parent.at[0]} m of 1.2 m`);
});
