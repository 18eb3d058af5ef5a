// SPDX-License-Identifier: GPL-3.0-or-later
// Runs axe on a page and returns its findings.
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

/** Rules that are broken, with the places. */
export async function violations(page) {
  await page.evaluate(AXE);
  const found = await page.evaluate(async () => {
    const { violations: list } = await globalThis.axe.run(document, {
      resultTypes: ["violations"],
    });
    return list.flatMap(({ id, impact, nodes }) =>
      nodes.map(({ target }) => `${id} (${impact}): ${target.join(" ")}`),
    );
  });
  return found;
}
