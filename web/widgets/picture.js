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

/**
 * @param {SVGSVGElement} svg as it is drawn now
 * @param {{paper?: boolean, below?: string}} [how] below: address of a picture under it
 * @returns {{text: string, width: number, height: number}} the same picture, alone
 */
export function standAlone(svg, { paper: onPaper = true, below = "" } = {}) {
  const copy = /** @type {SVGSVGElement} */ (svg.cloneNode(true));
  const originals = [svg, ...svg.querySelectorAll("*")];
  [copy, ...copy.querySelectorAll("*")].forEach((node, i) => {
    const style = getComputedStyle(originals[i]);
    STYLES.forEach((name) => node.setAttribute(name, style.getPropertyValue(name)));
    ["class", "role", "tabindex", "aria-labelledby"].forEach((name) => node.removeAttribute(name));
  });
  const { clientWidth: width, clientHeight: height } = svg;
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.setAttribute("width", String(width));
  copy.setAttribute("height", String(height));
  const paper = document.createElementNS("http://www.w3.org/2000/svg", "rect");
  paper.setAttribute("width", "100%");
  paper.setAttribute("height", "100%");
  paper.setAttribute("fill", getComputedStyle(document.body).backgroundColor);
  if (below) {
    const image = document.createElementNS("http://www.w3.org/2000/svg", "image");
    image.setAttribute("href", below);
    image.setAttribute("width", String(width));
    image.setAttribute("height", String(height));
    copy.prepend(image);
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
