// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A lesson's tree of blocks as elements. Live blocks (exhibits, predictions, exercises) are made by
// those who know what they do.
import { h } from "../../widgets/dom.js";

/**
 * @typedef {{kind: string, children?: Block[], [key: string]: any}} Block
 * @typedef {{
 *   katex: any, picture: (src: string) => string,
 *   live: Record<string, (block: Block, kit: Kit) => Node>,
 * }} Kit katex: null until it is here; live: makers of live blocks, by kind
 */

const LINES = new Set(["text", "mono", "math", "strong", "em", "link", "break"]);

/** Does a tree hold formulas? @param {Block} block @returns {boolean} */
export const hasMath = (block) =>
  block.kind === "math" ||
  [block.children, block.after, ...(block.choices ?? []).map(({ children }) => children)]
    .flatMap((list) => list ?? [])
    .some(hasMath);

/** @param {Block} block @param {Kit} kit */
function formula({ tex, display }, kit) {
  const node = h(display ? "div" : "span", { class: display ? "display math" : "math" });
  if (kit.katex) {
    kit.katex.render(tex, node, {
      displayMode: Boolean(display),
      throwOnError: false,
      output: "htmlAndMathml",
      strict: false,
    });
  } else {
    node.textContent = tex;
  }
  if (display) {
    node.tabIndex = 0; // a long formula scrolls
  }
  return node;
}

/** @param {Block} block @param {Kit} kit @returns {Node} */
function link({ href, children }, kit) {
  const safe = /^(https?:|#)/.test(href);
  return safe
    ? h(
        "a",
        { href, rel: "noopener", target: /^#/.test(href) ? null : "_blank" },
        ...make(children, kit),
      )
    : h("span", {}, ...make(children, kit));
}

/** @param {Block} block @param {Kit} kit */
function table({ children }, kit) {
  const cells = (row) =>
    row.children.map((cell) =>
      h(
        row.head ? "th" : "td",
        {
          style: null,
          class: cell.align ? `align-${cell.align}` : null,
          scope: row.head ? "col" : null,
        },
        ...make(cell.children, kit),
      ),
    );
  const rows = (children ?? []).map((row) => ({ row, node: h("tr", {}, ...cells(row)) }));
  return h(
    "div",
    { class: "lesson-table", tabindex: "0", role: "region", "aria-label": "Table" },
    h(
      "table",
      {},
      h("thead", {}, ...rows.filter(({ row }) => row.head).map(({ node }) => node)),
      h("tbody", {}, ...rows.filter(({ row }) => !row.head).map(({ node }) => node)),
    ),
  );
}

/** @type {Record<string, (block: any, kit: Kit) => Node>} */
const MAKERS = {
  text: ({ text }) => document.createTextNode(text),
  mono: ({ text }) => h("code", {}, text),
  math: formula,
  strong: ({ children }, kit) => h("strong", {}, ...make(children, kit)),
  em: ({ children }, kit) => h("em", {}, ...make(children, kit)),
  link,
  break: () => h("br"),
  heading: ({ level, children }, kit) =>
    h(/** @type {"h3"} */ (`h${Math.min(6, level + 1)}`), {}, ...make(children, kit)),
  paragraph: ({ children }, kit) => h("p", {}, ...make(children, kit)),
  list: ({ ordered, start, children }, kit) =>
    h(
      ordered ? "ol" : "ul",
      { start: ordered && start !== 1 ? start : null },
      ...make(children, kit),
    ),
  item: ({ children }, kit) => h("li", {}, ...make(children, kit)),
  quote: ({ children }, kit) => h("blockquote", {}, ...make(children, kit)),
  table,
  code: ({ text }) => h("pre", { tabindex: "0" }, h("code", {}, text)),
  rule: () => h("hr"),
  figure: ({ src, children }, kit) =>
    h(
      "figure",
      {},
      h("img", { src: kit.picture(src), alt: wordsOf(children ?? []), loading: "lazy" }),
      h("figcaption", {}, ...make(children, kit)),
    ),
};

/** The plain words of blocks. @param {Block[]} blocks @returns {string} */
export const wordsOf = (blocks) =>
  blocks.map(({ text, tex, children }) => text ?? tex ?? wordsOf(children ?? [])).join("");

/** The mark with which a text begins: it stays with the formula before it. */
const MARK = /^[.,;:!?)\]]+/;
/** Characters of TeX up to which a formula and its mark surely have room on one line. */
const SHORT = 40;

/** The mark that stays with the formula `block`, "" for none. @param {Block} block @param {Block} [next] */
const markBehind = (block, next) =>
  block.kind === "math" && !block.display && block.tex.length <= SHORT && next?.kind === "text"
    ? (MARK.exec(next.text)?.[0] ?? "")
    : "";

/**
 * @param {Block[] | undefined} blocks
 * @param {Kit} kit
 * @returns {Node[]}
 */
export function make(blocks, kit) {
  let taken = "";
  return (blocks ?? []).map((block, k, list) => {
    const own = taken ? { ...block, text: block.text.slice(taken.length) } : block;
    const maker = kit.live[own.kind] ?? MAKERS[own.kind];
    const node = maker
      ? maker(own, kit)
      : h(LINES.has(own.kind) ? "span" : "div", {}, ...make(own.children, kit));
    taken = markBehind(own, list[k + 1]);
    return taken ? h("span", { class: "kept" }, node, taken) : node;
  });
}
