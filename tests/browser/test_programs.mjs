// SPDX-License-Identifier: GPL-3.0-or-later
// A program of one's own beside the other methods in the page.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { createBench, read, soon, until } from "./support.mjs";

const bench = createBench();

// a bob on a rod, without numpy: a = -g/l sin(th)
const PENDULUM = `import json, math, sys
sys.stdin.readline()
print(json.dumps({"holonom": 1, "provides": "accelerations"}), flush=True)
for line in sys.stdin:
    ask = json.loads(line)
    print(json.dumps({"id": ask["id"], "a": [-9.81 * math.sin(ask["q"][0])]}), flush=True)
`;

// the same bob, by semi-implicit steps of its own
const STEPS = `import json, math, sys
sys.stdin.readline()
print(json.dumps({"holonom": 1, "provides": "step"}), flush=True)
for line in sys.stdin:
    ask = json.loads(line)
    v = ask["v"][0] - ask["h"] * 9.81 * math.sin(ask["q"][0])
    print(json.dumps({"id": ask["id"], "q": [ask["q"][0] + ask["h"] * v], "v": [v]}), flush=True)
`;

/** A page on a server whose folder has mine.py, other.py and steps.py. */
async function openWithPrograms(t, hash = "#pendulum") {
  const folder = mkdtempSync(join(tmpdir(), "programs-"));
  writeFileSync(join(folder, "mine.py"), PENDULUM);
  writeFileSync(join(folder, "other.py"), PENDULUM);
  writeFileSync(join(folder, "steps.py"), STEPS);
  writeFileSync(join(folder, "notes.txt"), "no program");
  const server = await bench.server(t, ["--programs", folder]);
  t.after(async () => {
    await server.stop(); // and its program, which stands in the folder
    rmSync(folder, { recursive: true });
  });
  return bench.open(t, { url: server.url, hash });
}

const spellingsOf = (page) => read(page, (data) => data.methods.map((m) => m.spelling));

async function openDialog(page) {
  await page.getByRole("button", { name: "add a method" }).click();
  // the list of methods may still be on its way
  await page
    .locator('#pick-formulation option[value="program:mine.py"]')
    .waitFor({ state: "attached" });
}

async function add(page, name) {
  await openDialog(page);
  await page.selectOption("#pick-formulation", name);
  await page.getByRole("button", { name: "Add", exact: true }).click();
  await soon(async () =>
    assert.ok((await spellingsOf(page)).some((text) => text.startsWith(`${name}@`))),
  );
}

test("programs stand among the formulations, each once, with the step of the other methods", async (t) => {
  const page = await openWithPrograms(t);
  const other = (await spellingsOf(page)).at(-1).split("@")[1];
  const step = other.split("h=")[1];
  await openDialog(page);
  const offered = await page.locator("#pick-formulation optgroup option").allTextContents();
  assert.deepEqual(offered, ["mine.py", "other.py", "steps.py"]);
  await page.selectOption("#pick-formulation", "program:mine.py");
  await soon(async () =>
    assert.equal(await page.inputValue("#pick-spelling"), `program:mine.py@${other}`),
  );

  // the rest of the dialog speaks of the program, and changes it
  assert.match(
    await page.locator(".dialog .about").first().textContent(),
    /^Your program computes/,
  );
  await page.selectOption("#pick-integrator", "heun");
  assert.equal(await page.inputValue("#pick-spelling"), `program:mine.py@heun:h=${step}`);
  await page.selectOption("#pick-integrator", "own");
  assert.equal(await page.inputValue("#pick-spelling"), `program:mine.py@own:h=${step}`);
  await page.fill("#pick-integrator-h", "0.005");
  await page.locator("#pick-integrator-h").blur();
  assert.equal(await page.inputValue("#pick-spelling"), "program:mine.py@own:h=0.005");
});

test("a program runs at another step, is changed, named by its file, and stays with another scene", async (t) => {
  const page = await openWithPrograms(t);
  await add(page, "program:mine.py");
  await add(page, "program:other.py");
  const names = await read(page, (data) => data.methods.map((m) => m.label));
  assert.deepEqual(names.slice(-2), ["mine.py", "other.py"]);

  // one step for all
  const field = page.getByRole("textbox", { name: "Step size dt" });
  await field.fill("0.005");
  await field.blur();
  await until(page, (data) => data.methods.every((m) => m.spelling.endsWith("h=0.005")));
  const programs = (await spellingsOf(page)).slice(-2).map((text) => text.split("@")[0]);
  assert.deepEqual(programs, ["program:mine.py", "program:other.py"]);

  // the dialog of a program that runs shows that program
  await page.getByRole("button", { name: "Change or remove mine.py" }).click();
  assert.equal(await page.inputValue("#pick-formulation"), "program:mine.py");
  assert.equal(await page.inputValue("#pick-integrator"), "symplectic-euler");
  await page.getByRole("button", { name: "Cancel" }).click();

  // another scene
  await page.evaluate(() => (location.hash = "#double-pendulum"));
  await until(page, (data) => data.scene.id === "double-pendulum");
  const there = (await spellingsOf(page)).map((text) => text.split("@")[0]);
  assert.ok(there.includes("program:mine.py") && there.includes("program:other.py"), String(there));
});

test("a program is added by the steps that it takes: its own, or those of an integrator", async (t) => {
  const page = await openWithPrograms(t);
  await add(page, "program:steps.py"); // offered with the integrator of the other methods
  const step = (await spellingsOf(page))[0].split("h=")[1];
  await soon(async () =>
    assert.equal((await spellingsOf(page)).at(-1), `program:steps.py@own:h=${step}`),
  );
  await until(page, (data) =>
    data.notice.startsWith('steps.py provides "step", so it makes its own steps'),
  );
  await page.getByRole("button", { name: "Change or remove steps.py" }).click();
  const offered = () => page.locator("#pick-integrator option").allTextContents();
  await soon(async () => assert.deepEqual(await offered(), ["its own steps"]));
  await page.getByRole("button", { name: "Cancel" }).click();

  // a program of accelerations that was asked for steps of its own
  await openDialog(page);
  await page.fill("#pick-spelling", `program:mine.py@own:h=${step}`);
  await page.getByRole("button", { name: "Add", exact: true }).click();
  await until(page, (data) => data.notice.startsWith("mine.py provides accelerations"));
  await soon(async () =>
    assert.match((await spellingsOf(page)).at(-1), /^program:mine\.py@(?!own)/),
  );
});

test("a server that allows none shows no list of programs", async (t) => {
  const page = await bench.open(t, { hash: "#pendulum" });
  await page.getByRole("button", { name: "add a method" }).click();
  await page.waitForSelector("#pick-spelling"); // visible: the dialog is open
  await soon(async () => assert.equal(await page.locator("#pick-formulation optgroup").count(), 0));
});
