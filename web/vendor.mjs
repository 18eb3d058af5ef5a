// SPDX-License-Identifier: GPL-3.0-or-later
// Copies what the page loads of its libraries into vendor/; run by `npm run vendor`.
import { appendFile, cp, mkdir, readdir, rm } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const web = dirname(fileURLToPath(import.meta.url));

/** [from node_modules/, to vendor/] */
const FILES = [
  ["uplot/dist/uPlot.iife.min.js", "uplot/uPlot.esm.js"], // a third of the size of its module
  ["uplot/dist/uPlot.min.css", "uplot/uPlot.min.css"],
  ["uplot/LICENSE", "uplot/LICENSE"],
  ["katex/dist/katex.mjs", "katex/katex.mjs"],
  ["katex/dist/katex.min.css", "katex/katex.min.css"],
  ["katex/LICENSE", "katex/LICENSE"],
  ["three/build/three.module.min.js", "three/three.module.min.js"],
  ["three/build/three.core.min.js", "three/three.core.min.js"],
  ["three/LICENSE", "three/LICENSE"],
];

await rm(join(web, "vendor"), { recursive: true, force: true });
const fonts = (await readdir(join(web, "node_modules/katex/dist/fonts")))
  .filter((name) => name.endsWith(".woff2"))
  .map((name) => [`katex/dist/fonts/${name}`, `katex/fonts/${name}`]);
for (const [from, to] of [...FILES, ...fonts]) {
  await mkdir(dirname(join(web, "vendor", to)), { recursive: true });
  await cp(join(web, "node_modules", from), join(web, "vendor", to));
}
await appendFile(join(web, "vendor/uplot/uPlot.esm.js"), "\nexport default uPlot;\n");
