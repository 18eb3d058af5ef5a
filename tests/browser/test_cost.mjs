// SPDX-License-Identifier: GPL-3.0-or-later
// The cost column: what a step costs is a property of the method, not of its place in the list.
import assert from "node:assert/strict";
import { test } from "node:test";
import { createBench, playTo, read, soon } from "./support.mjs";

const { open } = createBench();
const METHODS = ["index1", "reduced", "nullspace"];

/** Operations and computing time of a step by method, as the page says them. */
async function costs(t, methods) {
  const asked = methods.map((name) => `&method=${name}@rk4:h=0.01`).join("");
  const page = await open(t, { hash: `#scene=four-bar${asked}`, fresh: true });
  await soon(async () => assert.equal(await read(page, (data) => data.methods.length), 3));
  await playTo(page, 8);
  const words = `[...document.querySelectorAll("[data-tip^='A step costs']")].map(({ textContent, dataset }) =>
    ({ shown: textContent, tip: dataset.tip }))`;
  // the rows are painted on a beat: until they are those of the frame where the motion stands
  const counted = await read(page, ({ history }) =>
    history.columns.map(({ ops, steps }) =>
      Math.round(ops[history.count - 1] / steps[history.count - 1]),
    ),
  );
  let found = [];
  await soon(async () => {
    found = await page.evaluate(words);
    assert.equal(found.length, 3);
    found.forEach(({ tip }, m) =>
      assert.match(tip, new RegExp(`^A step costs ${counted[m]} operations, .* of computing `)),
    );
  });
  return Object.fromEntries(
    found.map(({ shown, tip }, m) => {
      const [, ops, time, unit] =
        /^A step costs (\d+) operations, ([\d.]+) (\S+) of computing/.exec(tip);
      assert.match(shown, new RegExp(`^${ops}/step`));
      return [methods[m], { ops, time: Number(time) * { ns: 1, µs: 1e3, ms: 1e6 }[unit] }];
    }),
  );
}

test("a step costs the same whatever the order of the list", async (t) => {
  const one = await costs(t, METHODS);
  const other = await costs(t, METHODS.toReversed());
  for (const name of METHODS) {
    assert.equal(one[name].ops, other[name].ops, name);
  }

  // the share of one method in the time of another: a busy machine slows both down. Where the first
  // of the list pays for cold caches (three times as much) these differ ninefold
  for (const name of METHODS.slice(1)) {
    const share = one[name].time / one.index1.time;
    const turned = other[name].time / other.index1.time;
    const ratio = share / turned;
    assert.ok(ratio < 3 && ratio > 1 / 3, `${name}: ${share} and ${turned}`);
  }
});
