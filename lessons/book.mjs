// SPDX-License-Identifier: GPL-3.0-or-later
// All lessons as one printable page: node lessons/book.mjs PROGRAM OUT.html
//
// The text comes from `holonom lesson N --json`, the exercises from `holonom problem ID --json`;
// formulas are set by KaTeX, its style, its fonts and all pictures are put into the file, figures
// are numbered.
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { typeset } from "../web/state/typeset.js";

const [program, out] = process.argv.slice(2);
const require = createRequire(new URL("../web/package.json", import.meta.url));
const katex = require("katex");
const ask = (...words) => JSON.parse(execFileSync(program, [...words, "--json"], { maxBuffer: 1 << 26 }));
const plain = (text) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");
const faults = [];
const embedded = (path, type) => `data:${type};base64,${readFileSync(path).toString("base64")}`;
let lesson, figures, answers;
/** More pictures than this stand in five columns, without their legends; fewer one below the other. */
const GALLERY = 4;
/** Of all lessons, for the end of the book. */
const seen = [];

function math(node) {
  try {
    return katex.renderToString(node.tex, { displayMode: node.display, throwOnError: true });
  } catch (error) {
    faults.push(`${lesson.id}: ${node.tex}: ${error.message}`);
    return plain(node.tex);
  }
}

const inline = {
  text: (n) => plain(n.text),
  mono: (n) => `<code>${plain(n.text)}</code>`,
  math,
  strong: (n) => `<strong>${all(n.children)}</strong>`,
  em: (n) => `<em>${all(n.children)}</em>`,
  link: (n) => (n.href.includes("://") ? `<a href="${plain(n.href)}">${all(n.children)}</a>` : all(n.children)),
  break: () => "<br>",
};

function figure(node) {
  const path = `lessons/${lesson.id}/${node.src}`;
  if (!existsSync(path)) {
    faults.push(`${lesson.id}: there is no picture ${path}`);
    return "";
  }
  const image = embedded(path, path.endsWith(".svg") ? "image/svg+xml" : "image/png");
  const caption = all(node.children);
  return `<figure><img src="${image}" alt="${caption.replace(/<[^>]*>/g, "").replace(/"/g, "")}"><figcaption>Figure ${lesson.number}.${++figures}. ${caption}</figcaption></figure>`;
}

function predict(node) {
  const letters = "abcdefgh";
  const choices = node.choices.map((c) => `<li>${all(c.children)}</li>`).join("");
  answers.push(`<li><strong>(${letters[node.right]})</strong> ${all(node.after)}</li>`);
  return `<div class="box"><b>Predict first, ${answers.length}.</b> ${all(node.children)}<ol type="a">${choices}</ol></div>`;
}

/** The text of an exercise with its letters, indices and powers. */
const set = (text) =>
  typeset(text).map(({ text: words, place }) => (place ? `<${place}>${plain(words)}</${place}>` : plain(words))).join("");

const points = (n) => `${n} point${n === 1 ? "" : "s"}`;

/** The plot that is to be read, without its own style, which would be that of the whole book. */
const plot = (part) => (part.figure?.svg ?? "").replace(/<style>.*?<\/style>/s, "");

/** The question of a part, and the form of its answer with what can be chosen: the options and the reasons, each on one page. */
function question(part) {
  const choices = (line) => (/^ +\(/.test(line) ? set(line) : plain(line)); // what is typed stays as it is typed
  const form = (part.answer_form ?? "").split("\n").map(choices).join("\n").split("\n  because");
  const written = form.map((text, k) => `<div class="form">${k ? "because" : ""}${text.replace(/\n/g, "<br>")}</div>`).join("");
  return `<li><div class="asked"><b>${part.id}</b> ${set(part.ask ?? "")} (${points(part.points)})</div>${written}<div class="plot">${plot(part)}</div></li>`;
}

/** Paragraphs of a statement; lines that are indented keep their places. */
function paragraphs(text) {
  const indented = (p) => p.split("\n").every((line) => line.startsWith("    "));
  return text
    .split(/\n\s*\n/)
    .map((p) => (indented(p) ? `<pre>${set(p.replace(/^ {4}/gm, ""))}</pre>` : `<p>${set(p)}</p>`))
    .join("");
}

/** The exercise as everybody gets it without a name; a student's own has other numbers. */
function exercise(node) {
  const e = ask("problem", node.id);
  const statement = paragraphs([e.statement ?? []].flat().join("\n"));
  const parts = (e.parts ?? []).map(question).join("");
  return `<div class="box exercise"><p><b>Exercise ${node.id}: ${plain(e.title)}</b> (${points(e.points)}) ${all(node.children)}</p>${statement}<ul>${parts}</ul><pre>holonom problem ${node.id} --student NAME</pre></div>`;
}

const cell = (tag) => (c) => `<${tag} style="text-align:${c.align || "left"}">${all(c.children ?? [])}</${tag}>`;

const block = {
  heading: (n) => `<h${n.level + 1}>${all(n.children)}</h${n.level + 1}>`,
  paragraph: (n) => `<p>${all(n.children)}</p>`,
  list: (n) => (n.ordered ? `<ol start="${n.start}">${all(n.children)}</ol>` : `<ul>${all(n.children)}</ul>`),
  item: (n) => `<li>${all(n.children)}</li>`,
  quote: (n) => `<blockquote>${all(n.children)}</blockquote>`,
  table: (n) => `<table>${all(n.children)}</table>`,
  row: (n) => `<tr>${n.children.map(cell(n.head ? "th" : "td")).join("")}</tr>`,
  code: (n) => `<pre>${plain(n.text)}</pre>`,
  rule: () => "<hr>",
  figure,
  exhibit: (n) => `<div class="box"><b>Run it.</b><pre>holonom ${plain(n.command)}</pre>${all(n.children)}</div>`,
  predict,
  slip: (n) => `<div class="slip"><b>Slip ${n.number} of the printed lesson.</b> ${all(n.children)}</div>`,
  exercise,
};

/** @param {{kind: string}[]} nodes */
function all(nodes = []) {
  return joined(nodes.map((n) => [n, (inline[n.kind] ?? block[n.kind])(n)]));
}

/** Puts nodes together; a formula in a line keeps the mark that follows it: no line begins with a comma. */
function joined(nodes) {
  let text = "";
  for (let k = 0; k < nodes.length; k++) {
    const [node, own] = nodes[k];
    const next = nodes[k + 1]?.[0].kind === "text" ? nodes[k + 1] : null;
    const mark = node.kind === "math" && !node.display && next ? next[1].match(/^[.,;:!?)\]]+/)?.[0] : "";
    text += mark ? `<span class="kept">${own}${mark}</span>` : own;
    if (mark) {
      next[1] = next[1].slice(mark.length);
    }
  }
  return text;
}

/** The blocks of a lesson; pictures that follow each other, in a paragraph or not, stand together. */
function page(nodes) {
  const runs = [];
  const picturesOf = (n) => (n.kind === "paragraph" ? n.children.filter((c) => c.kind === "figure") : []);
  for (const node of nodes.flatMap((n) => (picturesOf(n).length ? picturesOf(n) : [n]))) {
    const last = runs.at(-1);
    if (node.kind === "figure" && last?.[0].kind === "figure") {
      last.push(node);
    } else {
      runs.push([node]);
    }
  }
  const side = (run) => `<div class="pictures${run.length > GALLERY ? " gallery" : ""}">${all(run)}</div>`;
  return runs.map((run) => (run.length > 1 ? side(run) : all(run))).join("");
}

/** The headings that the contents list under each lesson, by its id; those of every lesson are left out. */
const EVERYWHERE = ["Exercises", "Summary", "Sources", "Pictures"];
const sections = new Map();

function chapter(id) {
  lesson = ask("lesson", id);
  figures = 0;
  answers = [];
  const text = page(lesson.blocks);
  const headings = lesson.blocks.filter((n) => n.kind === "heading" && n.level === 2);
  const words = headings.map((n) => all(n.children).replace(/^\d+\. /, ""));
  sections.set(lesson.id, words.filter((w) => !EVERYWHERE.includes(w)).join(" · "));
  if (answers.length) {
    seen.push(`<h3>${plain(lesson.title)}</h3><ol class="answers">${answers.join("")}</ol>`);
  }
  return `<section id="${lesson.id}">${text}</section>`;
}

const STYLE = `
@page { size: A4; margin: 22mm 20mm 20mm; @bottom-center { content: counter(page); font: 9pt "DejaVu Sans", sans-serif; } }
@page :first { @bottom-center { content: none; } }
body { font: 10.5pt/1.42 "DejaVu Serif", Georgia, serif; max-width: 42em; margin: 2em auto; color: #1a1a1a; }
h1, h2, h3, h4 { font-family: "DejaVu Sans", sans-serif; line-height: 1.2; break-after: avoid; }
section { break-before: page; } section h2 { margin-top: .8em; } p, li { orphans: 3; widows: 3; } pre, pre code { orphans: 6; widows: 4; }
pre, code { font: 8.5pt/1.35 "DejaVu Sans Mono", monospace; }
pre { white-space: pre-wrap; background: #f5f5f2; padding: .5em .7em; margin: .5em 0; }
.box { border: 1px solid #9aa5b1; border-radius: 3px; padding: .5em .8em; margin: 1em 0; break-inside: avoid; }
.slip { border-left: 3px solid #b5472f; padding: .1em .8em; margin: 1em 0; break-inside: avoid; }
.box p, .slip p { margin: .3em 0; display: inline; } .box li p, .box ol { margin: .2em 0; }
.exercise { break-inside: auto; box-decoration-break: clone; } .exercise > p { display: block; break-inside: avoid; break-after: avoid; } .exercise > pre:last-child { break-before: avoid; }
 .exercise ul { list-style: none; padding-left: .5em; margin: .3em 0; }
sub, sup { line-height: 0; font-size: .75em; }
.form { font-size: 9pt; color: #444; padding-left: 1.2em; } .exercise svg { width: 70%; height: auto; }
.exercise svg text { font: 13px "DejaVu Sans", sans-serif; } .exercise svg path { fill: none; stroke: #1a1a1a; } .exercise svg .grid { opacity: .25; } .exercise svg .curve { stroke-width: 2; }
.exercise li { margin: .25em 0; } .asked { break-inside: avoid; break-after: avoid; } .form { break-inside: avoid; } .plot { break-inside: avoid; break-before: avoid; } .kept { white-space: nowrap; } .answers { font-size: 9.5pt; margin: .3em 0; } .answers p { display: inline; } .answers p + p { display: block; margin: .4em 0; }
p:has(+ .pictures), p:has(+ p > .katex-display) { break-after: avoid; } h3 + ul { break-inside: avoid; }
.gallery { display: grid; grid-template-columns: repeat(5, 1fr); gap: 0 .8em; } .gallery figure { margin: .4em 0; }
.gallery figure img { width: 100%; max-width: none; aspect-ratio: 1.1; object-fit: cover; object-position: left; }
.contents > li { margin: .45em 0; } .contents div { font-size: 9pt; color: #444; }
.katex { font-size: 1.08em; } .katex-display { margin: .7em 0; }
figure { margin: 1em 0; text-align: center; break-inside: avoid; } figure img { max-width: 80%; max-height: 88mm; }
figcaption { font-size: 9pt; color: #444; }
table { border-collapse: collapse; margin: 1em 0; font-size: 9.5pt; break-inside: avoid; }
th, td { border-bottom: 1px solid #ccc; padding: .25em .7em; } th { border-bottom: 1px solid #333; }
`;

/** KaTeX's style with its fonts in it. */
function formulaStyle() {
  const folder = require.resolve("katex/dist/katex.min.css").replace("katex.min.css", "");
  const style = readFileSync(`${folder}katex.min.css`, "utf8");
  return style.replace(/src:url\((fonts\/[^)]*\.woff2)\)[^;}]*/g, (_, font) => `src:url(${embedded(folder + font, "font/woff2")})`);
}

const lessons = ask("list", "lessons").lessons;
const chapters = lessons.map((l) => chapter(l.id));
const entry = (l) => `<li><a href="#${l.id}">${plain(l.title.replace(/^\d+\. /, ""))}</a><div>${sections.get(l.id)}</div></li>`;
const contents = lessons.map(entry).join("");
writeFileSync(
  out,
  `<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>Mechanisms with closed loops</title><style>${formulaStyle()}${STYLE}</style>
<h1>Mechanisms with closed loops</h1><p>A course with the workbench holonom: text, exhibits to run, and exercises that are marked.</p>
<ol class="contents">${contents}<li><a href="#answers">Answers to the predictions</a></li></ol>${chapters.join("\n")}
<section id="answers"><h2>Answers to the predictions</h2>${seen.join("")}</section></html>\n`,
);
for (const fault of faults) {
  console.error(fault);
}
process.exit(faults.length ? 1 : 0);
