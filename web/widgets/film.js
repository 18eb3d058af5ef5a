// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// A film of the drawing: pictures on a canvas, recorded by the browser as WebM.
import { standAlone } from "./picture.js";

const KINDS = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"];
const BITS = 4e6; // per second
const LONGEST = 20; // [s] of film: a longer recording is shown faster
const SHORTEST = 1; // [s] of film: a shorter one is shown slower
const LEAST_BYTES = 1000; // of a film with pictures: less is the head of the file
const PATIENCE = 10; // [s] to wait for pictures of an encoder that is behind
const PIECE = 250; // [ms] of film that the encoder hands over at once
const LAST = 2; // pieces that must come after the last picture, so that the film ends with it

export const canFilm = () =>
  typeof MediaRecorder !== "undefined" && KINDS.some((kind) => MediaRecorder.isTypeSupported(kind));

/**
 * One picture: solids below, the SVG over them, its caption under both.
 * @param {SVGSVGElement} svg
 * @param {HTMLCanvasElement | null} solids drawn in this very task, or null
 * @param {CanvasRenderingContext2D} context
 * @param {import("./picture.js").Caption} caption
 */
async function paint(svg, solids, context, caption) {
  const { width, height } = context.canvas;
  const below = document.createElement("canvas");
  if (solids) {
    below.width = solids.width;
    below.height = solids.height;
    below.getContext("2d")?.drawImage(solids, 0, 0); // what WebGL drew is gone after this task
  }
  const { text, height: whole } = standAlone(svg, { paper: false, caption });
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
  await image.decode();
  context.fillStyle = getComputedStyle(document.body).backgroundColor;
  context.fillRect(0, 0, width, height);
  if (solids) {
    context.drawImage(below, 0, 0, width, (height * svg.clientHeight) / whole);
  }
  context.drawImage(image, 0, 0, width, height);
}

/**
 * @param {{
 *   svg: SVGSVGElement, solids: () => HTMLCanvasElement | null,
 *   caption: () => import("./picture.js").Caption, duration: number,
 *   show: (t: number) => void, told: (share: number) => void, stopped: () => boolean,
 * }} what caption: of the time that the page draws, always of as many lines; duration [s]; show:
 *   the page draws this time at once; told: how much is done
 * @returns {Promise<Blob>}
 */
export async function makeFilm({ svg, solids, caption, duration, show, told, stopped }) {
  const kind = KINDS.find((one) => MediaRecorder.isTypeSupported(one));
  const canvas = document.createElement("canvas");
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  show(0);
  const { width, height } = standAlone(svg, { caption: caption() });
  canvas.width = 2 * Math.round(width);
  canvas.height = 2 * Math.round(height);
  await paint(svg, solids(), context, caption());

  const recorder = new MediaRecorder(canvas.captureStream(), {
    mimeType: kind,
    videoBitsPerSecond: BITS,
  });
  /** @type {Blob[]} */
  const parts = [];
  let last = 0; // pieces since the last picture
  recorder.ondataavailable = ({ data }) => {
    parts.push(data);
    last += data.size > 0 ? 1 : 0;
  };
  const ended = new Promise((resolve) => {
    recorder.onstop = () => resolve(null);
  });
  recorder.start(PIECE);
  const bytes = () => parts.reduce((sum, { size }) => sum + size, 0);
  const length = Math.max(SHORTEST, Math.min(duration, LONGEST));
  const began = performance.now();
  const goesOn = (share, seconds) =>
    share < 1 || (bytes() < LEAST_BYTES && seconds < length + PATIENCE);
  /** @param {number} until [ms] */
  const isWaiting = (until) => last < LAST && performance.now() < until && !stopped();
  for (let share = 0, seconds = 0; goesOn(share, seconds) && !stopped(); ) {
    seconds = (performance.now() - began) / 1000;
    share = Math.min(1, seconds / length);
    show(share * duration);
    await paint(svg, solids(), context, caption());
    told(share);
    await new Promise((resolve) => requestAnimationFrame(resolve));
  }
  last = 0;
  for (const until = performance.now() + 1000 * PATIENCE; isWaiting(until); ) {
    context.fillRect(0, 0, 1, 1); // a change, or the browser records no picture
    await new Promise((resolve) => requestAnimationFrame(resolve));
  }
  recorder.stop();
  await ended;
  const film = new Blob(parts, { type: "video/webm" });
  if (film.size < LEAST_BYTES) {
    throw new Error("the browser recorded nothing");
  }
  return film;
}
