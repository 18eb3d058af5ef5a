// SPDX-License-Identifier: GPL-3.0-or-later
// Checks what neither the formatter nor the compiler looks at: no comment wider than 100 columns,
// no module of the page longer than 400 lines. Ends with status 1 and a line per fault.
import { readFileSync, readdirSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";

const HERE = dirname(fileURLToPath(import.meta.url));
const ROOT = join(HERE, "../..");
const LEFT_OUT = ["node_modules", "vendor", "test-results"];
const WIDEST = 100;
const LONGEST = 400;

/** Paths of all modules below a folder. @param {string} folder @returns {string[]} */
function modulesIn(folder) {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) {
      return LEFT_OUT.includes(entry.name) ? [] : modulesIn(path);
    }
    return /\.m?js$/.test(entry.name) ? [path] : [];
  });
}

/** A line of code may be wider when a string makes it so; nobody can break that. */
const isTooWide = (line) => line.length > WIDEST && !/["'`]/.test(line);

const faults = [join(ROOT, "web"), HERE].flatMap(modulesIn).flatMap((path) => {
  const lines = readFileSync(path, "utf8").split("\n");
  const name = relative(ROOT, path);
  const wide = lines.flatMap((line, i) =>
    isTooWide(line) ? [`${name}:${i + 1}: ${line.length} columns; ${WIDEST} are allowed`] : [],
  );
  const long = name.startsWith("web/") && lines.length - 1 > LONGEST;
  return long ? [...wide, `${name}: ${lines.length - 1} lines; ${LONGEST} are allowed`] : wide;
});

console.error(faults.join("\n"));
process.exitCode = faults.length > 0 ? 1 : 0;
