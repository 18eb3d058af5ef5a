// SPDX-License-Identifier: GPL-3.0-or-later
// The bench itself: a test that is the end of server or browser is not that of the other tests.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { ROOT } from "./support.mjs";

const SUPPORT = pathToFileURL(join(ROOT, "tests/browser/support.mjs")).href;

/** Four tests: the first kills its server, the third one its browser. */
const FILE = `import { test } from "node:test";
import { createBench, read } from "${SUPPORT}";
const bench = createBench();
const serves = async (t) => read(await bench.open(t), (data) => data.id);
test("kills the server", async (t) => {
  await serves(t);
  process.kill(bench.serverId, "SIGKILL");
  const lives = () => {
    try {
      return process.kill(bench.serverId, 0);
    } catch {
      return false;
    }
  };
  while (lives()) {
    await new Promise((done) => setTimeout(done, 5));
  }
});
test("has another server", serves);
test("kills the browser", async (t) => {
  const page = await bench.open(t);
  await page.context().browser().close();
});
test("has another browser", serves);
`;

test("a test that is the end of server or browser fails, and the next ones do not", (t) => {
  const folder = mkdtempSync(join(tmpdir(), "bench-"));
  t.after(() => rmSync(folder, { recursive: true }));
  const file = join(folder, "four.mjs");
  writeFileSync(file, FILE);
  const env = { ...process.env };
  delete env.NODE_TEST_CONTEXT; // it is a run of its own, not a part of this one
  const run = spawnSync(process.execPath, ["--test-reporter=tap", file], { cwd: ROOT, env });
  const lines = String(run.stdout).split("\n");
  assert.deepEqual(
    lines.filter((line) => /^(not )?ok /.test(line)),
    [
      "not ok 1 - kills the server",
      "ok 2 - has another server",
      "not ok 3 - kills the browser",
      "ok 4 - has another browser",
    ],
    String(run.stdout) + String(run.stderr),
  );
  assert.ok(lines.some((line) => line.includes("the server ended with SIGKILL")));
});
