// SPDX-License-Identifier: GPL-3.0-or-later
// Parses Julia programs with tree-sitter's grammar: node parse-julia.mjs NODE_MODULES FILE...
// One line a file: its name, and the first place that is no Julia, or nothing behind it.
import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [modules, ...files] = process.argv.slice(2);
const { Parser, Language } = await import(
  pathToFileURL(resolve(modules, "web-tree-sitter/tree-sitter.js")).href
);
await Parser.init();
const parser = new Parser();
parser.setLanguage(await Language.load(join(modules, "tree-sitter-julia/tree-sitter-julia.wasm")));

/** The first node that the grammar could not place; null: there is none. */
function firstError(node) {
  if (node.isError || node.isMissing) {
    return node;
  }
  for (const child of node.children) {
    const found = child.hasError || child.isMissing ? firstError(child) : null;
    if (found) {
      return found;
    }
  }
  return null;
}

for (const file of files) {
  const { rootNode } = parser.parse(readFileSync(file, "utf8"));
  const at = rootNode.hasError ? firstError(rootNode) : null;
  console.log(
    `${file}\t${at ? `line ${at.startPosition.row + 1}: ${JSON.stringify(at.text.slice(0, 40))}` : ""}`,
  );
}
