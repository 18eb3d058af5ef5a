// SPDX-License-Identifier: GPL-3.0-or-later
// The page beside the workbench in the terminal: the same methods at the same time have the same
// names, the same verdicts and the same numbers.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { test } from "node:test";
import { createBench, playTo, PROGRAM, read, ROOT, soon } from "./support.mjs";

const bench = createBench();
const SMALL = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** A number of the page as the terminal writes it: "9×10⁻¹⁷ m" is "9e-17 m". */
const plain = (text) =>
  text
    .replace(/×10⁻([⁰¹²³⁴⁵⁶⁷⁸⁹]+)/g, (_, digits) => {
      const power = [...digits].map((digit) => SMALL.indexOf(digit)).join("");
      return `e-${power.padStart(2, "0")}`;
    })
    .replace(/\u2212/g, "-")
    .replace(/\s+/g, " ")
    .trim();

/** Rows of the page's table: [name, verdict, gap, error, energy, operations of a step]. */
const rowsOfPage = (page) =>
  page.$$eval(".method-table tbody tr", (rows) =>
    rows
      .map((row) =>
        ["who", "verdict", "gap", "off", "energy", "cost"].map((cell) =>
          row.querySelector(`.${cell}`),
        ),
      )
      .filter((cells) => cells.every(Boolean))
      .map((cells) => cells.map((cell) => cell.innerText)),
  );

/** The same of the terminal's. It has no sliders: alpha and beta stand behind the name there. */
function rowsOfTerminal(scene, t, methods) {
  const words = ["tui", scene, "--once", "--size", "200x40", "--t", String(t), "--methods"];
  const frame = execFileSync(PROGRAM, [...words, ...methods], {
    cwd: ROOT,
    encoding: "utf8",
    env: { ...process.env, LC_ALL: "C.UTF-8" },
  });
  const length = String.raw`(\S+ [mµnk]?m|-)`;
  const row = new RegExp(
    String.raw`^│\d\S (.+?) +${length} +${length} +(\S+ [mµnk]?J|-) +(\S+) +[→↗↘] (.*?) +│$`,
    "gmu",
  );
  return [...frame.matchAll(row)].map(([, name, gap, error, energy, cost, verdict]) => [
    name.replace(/ [\d.]+\/[\d.]+$/, ""),
    verdict,
    gap,
    error,
    energy,
    `${cost}/step`,
  ]);
}

for (const [scene, time] of [
  ["four-bar", 3.5],
  ["slider-crank", 1],
]) {
  test(`${scene}: the page and the terminal say the same at ${time} s`, async (t) => {
    const page = await bench.open(t, { hash: `#${scene}` });
    await playTo(page, time);
    const at = await read(page, (data) => ({
      t: data.latest.t,
      methods: data.methods.map(({ spelling }) => spelling),
    }));
    const terminal = rowsOfTerminal(scene, at.t, at.methods);
    assert.equal(terminal.length, at.methods.length);
    await soon(async () => {
      const shown = (await rowsOfPage(page)).map((row) => row.map(plain));
      assert.deepEqual(shown, terminal);
    });
  });
}
