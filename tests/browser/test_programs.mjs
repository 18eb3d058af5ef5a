// SPDX-License-Identifier: GPL-3.0-or-later
// A program of one's own beside the other methods in the page.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { createBench, soon, until } from "./support.mjs";

const bench = createBench();

// a bob on a rod, without numpy: a = -g/l sin(th)
const PENDULUM = `import json, math, sys
sys.stdin.readline()
print(json.dumps({"holonom": 1, "provides": "accelerations"}), flush=True)
for line in sys.stdin:
    ask = json.loads(line)
    print(json.dumps({"id": ask["id"], "a": [-9.81 * math.sin(ask["q"][0])]}), flush=True)
`;

test("a server that allows programs offers them in the dialog of methods, and one runs", async (t) => {
  const folder = mkdtempSync(join(tmpdir(), "programs-"));
  writeFileSync(join(folder, "mine.py"), PENDULUM);
  writeFileSync(join(folder, "notes.txt"), "no program");
  const server = await bench.server(t, ["--programs", folder]);
  t.after(async () => {
    await server.stop(); // and its program, which stands in the folder
    rmSync(folder, { recursive: true });
  });
  const page = await bench.open(t, { url: server.url, hash: "#pendulum" });
  await page.getByRole("button", { name: "add a method" }).click();
  // the list of methods may still be on its way
  await page.locator("#pick-program option").nth(2).waitFor({ state: "attached" });
  const offered = await page.locator("#pick-program option").allTextContents();
  assert.deepEqual(offered, ["none", "mine.py, accelerations", "mine.py, its own steps"]);
  await page.selectOption("#pick-program", { label: "mine.py, accelerations" });
  // with the step of the methods beside it
  const steps = await page.evaluate(() =>
    globalThis.holonom.data.methods.map(({ spelling }) => spelling.match(/h=([^,]+)/)?.[1]),
  );
  await soon(async () =>
    assert.equal(await page.inputValue("#pick-spelling"), `program:mine.py@rk4:h=${steps[0]}`),
  );

  // another integrator and another step keep the program
  await page.selectOption("#pick-integrator", "heun");
  await page.fill("#pick-integrator-h", "0.005");
  await page.locator("#pick-integrator-h").blur();
  await soon(async () =>
    assert.equal(await page.inputValue("#pick-spelling"), "program:mine.py@heun:h=0.005"),
  );
  await page.getByRole("button", { name: "Add", exact: true }).click();
  await until(page, (data) =>
    data.methods.some((m) => m.spelling === "program:mine.py@heun:h=0.005"),
  );
});

test("a server that allows none shows no list of programs", async (t) => {
  const page = await bench.open(t, { hash: "#pendulum" });
  await page.getByRole("button", { name: "add a method" }).click();
  await page.waitForSelector("#pick-spelling"); // visible: the dialog is open
  await soon(async () => assert.equal(await page.isVisible("#pick-program"), false));
});
