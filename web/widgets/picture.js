// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A drawing of the page as a file of its own: its styles are written into it.

/** Properties that decide how SVG looks. */
const STYLES = [
  "fill",
  "fill-opacity",
  "fill-rule",
  "stroke",
  "stroke-width",
  "stroke-dasharray",
  "stroke-linejoin",
  "stroke-linecap",
  "opacity",
  "paint-order",
  "display",
  "visibility",
  "font-family",
  "font-size",
  "font-weight",
  "text-anchor",
];

const ROW = 22; // [px] of a line of words under the picture
const EDGE = 12; // [px] around them
const SAMPLE = 34; // [px] of a line as the method is drawn
const SIZE = 14; // [px] of the words, where they have room
const LETTER = 0.56; // width of a letter, of its size
const GAP = 8; // [px] between a line and its words
const MIDDLE = 5; // [px] from the foot of the letters to their middle

/**
 * @param {string} tag
 * @param {Record<string, string | number>} attributes
 * @param {string} [text]
 */
function shape(tag, attributes, text = "") {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  Object.entries(attributes).forEach(([name, value]) => node.setAttribute(name, String(value)));
  node.textContent = text;
  return node;
}

/**
 * Words under a picture: its title, and what each line in it is.
 * @typedef {{title: string, lines: {words: string, colour: string, dash: number[]}[]}} Caption
 * @param {Caption} caption @param {number} width [px] of the picture @param {number} top [px]
 */
function captionShape({ title, lines }, width, top) {
  const start = EDGE + SAMPLE + GAP;
  const longest = Math.max(title.length, ...lines.map(({ words }) => words.length));
  const words = {
    fill: getComputedStyle(document.body).color,
    "font-size": Math.min(SIZE, (width - start - EDGE) / (LETTER * longest)),
    "font-family": "system-ui, sans-serif",
  };
  const base = (i) => top + EDGE + ROW * i + SIZE;
  const group = shape("g", {});
  group.append(shape("text", { ...words, x: EDGE, y: base(0), "font-weight": 600 }, title));
  lines.forEach((line, i) => {
    const dash = line.dash.join(" ") || "none";
    const look = { stroke: line.colour, "stroke-width": 2.5, "stroke-dasharray": dash };
    group.append(
      shape("path", { d: `M${EDGE} ${base(i + 1) - MIDDLE}h${SAMPLE}`, ...look }),
      shape("text", { ...words, x: start, y: base(i + 1) }, line.words),
    );
  });
  return group;
}

/** @param {Caption | undefined} caption */
const captionHeight = (caption) => (caption ? 2 * EDGE + ROW * (1 + caption.lines.length) : 0);

/**
 * @param {SVGSVGElement} svg as it is drawn now
 * @param {{paper?: boolean, below?: string, caption?: Caption}} [how] below: address of a picture
 *   under it; caption: words below its lower edge
 * @returns {{text: string, width: number, height: number}} the same picture, alone
 */
export function standAlone(svg, { paper: onPaper = true, below = "", caption } = {}) {
  const copy = /** @type {SVGSVGElement} */ (svg.cloneNode(true));
  const originals = [svg, ...svg.querySelectorAll("*")];
  [copy, ...copy.querySelectorAll("*")].forEach((node, i) => {
    const style = getComputedStyle(originals[i]);
    STYLES.forEach((name) => node.setAttribute(name, style.getPropertyValue(name)));
    ["class", "role", "tabindex", "aria-labelledby"].forEach((name) => node.removeAttribute(name));
  });
  const { clientWidth: width, clientHeight } = svg;
  const height = clientHeight + captionHeight(caption);
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.setAttribute("width", String(width));
  copy.setAttribute("height", String(height));
  if (copy.hasAttribute("viewBox") && caption) {
    const [x, y, w, h] = String(copy.getAttribute("viewBox")).split(/[ ,]+/).map(Number);
    copy.setAttribute("viewBox", `${x} ${y} ${w} ${(h * height) / clientHeight}`);
  }
  const paper = document.createElementNS("http://www.w3.org/2000/svg", "rect");
  paper.setAttribute("width", "100%");
  paper.setAttribute("height", "100%");
  paper.setAttribute("fill", getComputedStyle(document.body).backgroundColor);
  if (below) {
    const image = document.createElementNS("http://www.w3.org/2000/svg", "image");
    image.setAttribute("href", below);
    image.setAttribute("width", String(width));
    image.setAttribute("height", String(clientHeight));
    copy.prepend(image);
  }
  if (caption) {
    copy.append(captionShape(caption, width, clientHeight));
  }
  if (onPaper) {
    copy.prepend(paper);
  }
  return { text: new XMLSerializer().serializeToString(copy), width, height };
}

/**
 * @param {{text: string, width: number, height: number}} picture
 * @param {number} scale pixels of the file per pixel of the page
 * @returns {Promise<Blob>} a PNG
 */
export async function toPng({ text, width, height }, scale = 2) {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = scale * width;
  canvas.height = scale * height;
  const context = canvas.getContext("2d");
  context?.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((resolve, reject) =>
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("no picture was made")))),
  );
}
