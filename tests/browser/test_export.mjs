// SPDX-License-Identifier: GPL-3.0-or-later
// Exports beside data and pictures: a file that plays by itself, a film, programs.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { violations } from "./axe.mjs";
import { createBench, playTo, screenshot, soon } from "./support.mjs";

const { open } = createBench();

/** Presses a button of the dialog and waits for the file. */
async function fileOf(page, word) {
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.locator(".formats").getByRole("button", { name: word, exact: true }).click(),
  ]);
  const path = await download.path();
  return { name: download.suggestedFilename(), path, bytes: readFileSync(path) };
}

test("the recording becomes one file that plays without a server", async (t) => {
  const page = await open(t, { viewport: { width: 1366, height: 768 } });
  await playTo(page, 0.4);
  await page.getByRole("button", { name: "export" }).click();
  const { name, path, bytes } = await fileOf(page, "HTML");
  assert.equal(name, "four-bar.html");
  assert.ok(bytes.length < 2e6, `${bytes.length} bytes`);
  assert.ok(!/ src=| href=|@import|"NaN|null,null/.test(bytes.toString()), "nothing is fetched");

  const alone = await page.context().newPage();
  t.after(() => alone.close());
  const faults = [];
  alone.on("pageerror", (error) => faults.push(error.message));
  alone.on("request", (request) =>
    faults.push(...(/^file:/.test(request.url()) ? [] : [request.url()])),
  );
  await alone.setContent(bytes.toString());
  assert.ok(pathToFileURL(path));
  const drawn = () => alone.locator("svg.drawing path").nth(1).getAttribute("d");
  const first = await drawn();
  await soon(() => alone.waitForSelector("button:focus", { timeout: 1000 }));
  await alone.keyboard.press("Space");
  await alone.waitForFunction(() => Number(document.querySelector("input[type=range]").value) > 3);
  await soon(async () => assert.notEqual(await drawn(), first));
  assert.equal(await alone.locator("li").count(), 5);

  // powers as the page writes them, and an axis of time with its unit
  const marks = await alone.locator("svg.gap text").allTextContents();
  assert.ok(marks.includes("10⁻¹³") && marks.includes("0 s"), String(marks));
  assert.ok(!marks.some((text) => /\de/.test(text)), String(marks));

  // beside each method its state at the time shown, and its dashes as on the page
  const saysAt = async (i) => {
    await alone.locator("input[type=range]").fill(String(i));
    return alone.locator("li").allTextContents();
  };
  await alone.getByRole("button", { name: /Pause|Play/ }).evaluate((button) => {
    if (button.textContent === "Pause") {
      button.click();
    }
  });
  const last = await alone.locator("input[type=range]").getAttribute("max");
  assert.match((await saysAt(0))[0], /^index-1: starts closed /);
  assert.doesNotMatch((await saysAt(last))[0], /starts closed/);
  const dashes = await alone.evaluate(() =>
    [...document.querySelectorAll("li path")].map((line) => line.getAttribute("stroke-dasharray")),
  );
  assert.deepEqual(
    dashes,
    await page.evaluate(() => {
      const { methods, look } = globalThis.holonom.data;
      return methods.map(({ slot }) => look.slots[slot].dash.join(" "));
    }),
  );
  await screenshot(alone, "replay", { seen: true });
  assert.deepEqual(faults, []);
});

/** Returns how many pixels of the film's first and last pictures are not those of a picture. */
const otherPixels = (page, film, picture) =>
  page.evaluate(
    async ([webm, png]) => {
      const image = new Image();
      image.src = `data:image/png;base64,${png}`;
      await image.decode();
      const { width, height } = image;
      const canvas = Object.assign(document.createElement("canvas"), { width, height });
      const pen = canvas.getContext("2d", { willReadFrequently: true });
      const pixelsOf = (source) => {
        pen.clearRect(0, 0, width, height);
        pen.drawImage(source, 0, 0, width, height);
        return pen.getImageData(0, 0, width, height).data;
      };
      const wanted = pixelsOf(image);
      const FAR = 90; // of 255: no loss of the film is as large
      const count = (pixels) => pixels.filter((x, i) => Math.abs(x - wanted[i]) > FAR).length;
      const video = Object.assign(document.createElement("video"), { muted: true });
      const next = (name) => new Promise((resolve) => video.addEventListener(name, resolve));
      const shown = new Promise((resolve) => video.requestVideoFrameCallback(resolve));
      const ended = next("ended");
      video.src = `data:video/webm;base64,${webm}`;
      await video.play();
      await shown;
      const first = count(pixelsOf(video));
      await ended;
      return { first, last: count(pixelsOf(video)) };
    },
    [film, picture].map((bytes) => bytes.toString("base64")),
  );

test("a scene in space is saved with its solids, as a film, and as a program", async (t) => {
  const page = await open(t, { hash: "#rssr", bypassCSP: true });
  await page.waitForSelector(".stage.solid");
  await playTo(page, 0.2);
  await page.getByRole("button", { name: "export" }).click();
  await soon(async () => assert.deepEqual(await violations(page), []));
  const svg = (await fileOf(page, "SVG")).bytes.toString();
  const [, below] = /<image href="data:image\/png;base64,([^"]+)"/.exec(svg) ?? [];
  const [, width] = /<svg[^>]* width="(\d+)"/.exec(svg) ?? [];
  // the width in the head of a PNG file
  assert.equal(
    Buffer.from(below, "base64").readUInt32BE(16),
    2 * Number(width),
    "drawn, not blown up",
  );
  const film = await fileOf(page, "WebM");
  assert.equal(film.bytes.subarray(0, 4).toString("hex"), "1a45dfa3", "the mark of a WebM file");
  assert.ok(film.bytes.length > 1000);
  const [filmed, drawn] = await page.evaluate(async (base64) => {
    const video = document.createElement("video");
    video.src = `data:video/webm;base64,${base64}`;
    await new Promise((resolve, reject) => {
      video.onloadedmetadata = resolve;
      video.onerror = () => reject(new Error("the film cannot be read"));
    });
    return [video.videoHeight, document.querySelector(".picture").clientHeight];
  }, film.bytes.toString("base64"));
  assert.ok(filmed >= 2 * (drawn + 22 * 4), `${filmed} of ${drawn}: the caption is under it`);
  const other = await otherPixels(page, film.bytes, (await fileOf(page, "PNG")).bytes);
  assert.ok(other.last < other.first / 4, `the film goes to the end: ${JSON.stringify(other)}`);
  await page.waitForSelector("#export-language option", { state: "attached" });
  await page.selectOption("#export-language", "python");
  const code = await fileOf(page, "Program");
  assert.equal(code.name, "rssr.py");
  assert.match(code.bytes.toString(), /import numpy/);
  assert.doesNotMatch(code.bytes.toString(), /YOUR PART/);
  await page.check("#export-blanks");
  assert.match((await fileOf(page, "Program")).bytes.toString(), /YOUR PART 4 of 4/);
});

test("a program with another solver and style, and the model for another program", async (t) => {
  const page = await open(t, { hash: "#four-bar" });
  await page.getByRole("button", { name: "export" }).click();
  await page.waitForSelector("#export-language option", { state: "attached" });
  await page.selectOption("#export-language", "cpp");
  await page.waitForSelector("#export-solver option[value=eigen]", { state: "attached" });
  assert.deepEqual(await violations(page), []);
  await page.selectOption("#export-solver", "eigen");
  await page.selectOption("#export-style", "skeleton");
  await screenshot(page, "export-dialog");
  const code = (await fileOf(page, "Program")).bytes.toString();
  assert.match(code, /Eigen/);
  assert.doesNotMatch(code, /CHECK_A/);

  // languages with one solver offer none, and LaTeX is no program that could be bare
  await page.selectOption("#export-language", "latex");
  await page.waitForSelector("#export-solver", { state: "hidden" });
  await page.waitForSelector("#export-style", { state: "hidden" });
  assert.match((await fileOf(page, "Program")).bytes.toString(), /documentclass/);

  for (const [format, name, first] of [
    ["mjcf", "four-bar.xml", /^<mujoco/],
    ["urdf", "four-bar.urdf", /^<\?xml[^]*left out: joint 'B'/],
  ]) {
    await page.selectOption("#export-format", format);
    const model = await fileOf(page, "Model");
    assert.equal(model.name, name);
    assert.match(model.bytes.toString(), first);
  }
});
