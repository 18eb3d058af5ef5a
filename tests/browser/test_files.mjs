// SPDX-License-Identifier: GPL-3.0-or-later
// The page's files: inline scripts, addresses.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { createHash } from "node:crypto";
import { test } from "node:test";

const ROOT = join(import.meta.dirname ?? new URL(".", import.meta.url).pathname, "../..");

test("the page allows its own import map and no other inline script", () => {
  const html = readFileSync(join(ROOT, "web/index.html"), "utf8");
  const inline = [...html.matchAll(/<script(?![^>]*\bsrc=)[^>]*>([\s\S]*?)<\/script>/g)].map(
    ([, text]) => text,
  );
  assert.equal(inline.length, 1);
  const hash = createHash("sha256").update(inline[0]).digest("base64");
  assert.ok(html.includes(`'sha256-${hash}'`));
  assert.doesNotMatch(html, /https?:\/\//);
});

test("the lock files name no address to download from", () => {
  for (const folder of ["web", "tests/browser"]) {
    assert.doesNotMatch(
      readFileSync(join(ROOT, folder, "package-lock.json"), "utf8"),
      /"resolved"|https?:\/\/registry/,
    );
  }
});
