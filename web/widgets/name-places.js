// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Where a name stands beside its point: of twelve places near it and twelve farther off the one
// with the most room, kept until another is clearly better, so that names neither cover the parts
// nor jump.

const PLACES = 12;
const ENOUGH = 5; // [px] of room; more is no better
const KEEP = 4; // [px] that another place must have more
const OFF = 15; // [px] from the point to the middle of the line
const LETTER = 7.4; // [px] of a bold 13 px font
const HALF_HEIGHT = 7;
const CLOSE = 16; // [px] between points of which only the first is named
const MOST_WORK = 12000; // names times obstacles
const FARTHER = 12; // [px] of the second ring
const NEARER = 3; // [px] that a place of the second ring must have more
/** places in the order of preference: to the upper right first, near before far */
const ANGLES = [1, 2, 0, 11, 3, 10, 4, 5, 9, 6, 7, 8].map((k) => (2 * Math.PI * k) / PLACES);
const SPOTS = [0, FARTHER].flatMap((more) => ANGLES.map((angle) => ({ angle, more })));

/** @param {number} x @param {number} y @param {number[]} line [x, y, x, y, half a width] */
function roomTo(x, y, [ax, ay, bx, by, r]) {
  const [dx, dy] = [bx - ax, by - ay];
  const square = dx * dx + dy * dy;
  const along = square > 0 ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / square)) : 0;
  return Math.hypot(x - ax - along * dx, y - ay - along * dy) - r;
}

const LINE = 14; // [px] from one number to the next
const SPACE = 4; // [px] between two numbers in a line

/**
 * Numbers at the tips of arrows, moved up or down where two would overlap; the first stays.
 * @template {{x: number, y: number, text: string}} Label
 * @param {Label[]} labels with the middle of their lines [px]
 * @returns {Label[]}
 */
export function spread(labels) {
  /** @type {Label[]} */
  const placed = [];
  const width = ({ text }) => LETTER * text.length + SPACE;
  for (const label of labels) {
    const near = placed.filter(
      (other) => 2 * Math.abs(other.x - label.x) < width(other) + width(label),
    );
    const isFree = (y) => near.every((other) => Math.abs(other.y - y) >= LINE - 1e-9);
    const places = near.flatMap((other) => [other.y - LINE, other.y + LINE]).filter(isFree);
    const nearest = places.sort((a, b) => Math.abs(a - label.y) - Math.abs(b - label.y))[0];
    placed.push(isFree(label.y) ? label : { ...label, y: nearest });
  }
  return placed;
}

/** @param {{width: number, height: number}} size [px] */
export function createNamePlaces(size) {
  /** @type {Map<number, number>} place of each point's name in the frame before */
  const kept = new Map();

  function placeAt([x, y], width, k) {
    const half = width / 2;
    const { angle, more } = SPOTS[k];
    return [x + Math.cos(angle) * (OFF - 3 + half + more), y - Math.sin(angle) * (OFF + more)];
  }

  /** @param {number[]} middle @param {number} width @param {number[][]} lines */
  function score(middle, width, lines) {
    const [x, y] = middle;
    const half = width / 2;
    const outside =
      x - half < 2 || x + half > size.width - 2 || y < 10 || y > size.height - 10 ? 40 : 0;
    const room = lines.reduce(
      (least, line) =>
        Math.min(least, ...[-half, 0, half].map((dx) => roomTo(x + dx, y, line) - HALF_HEIGHT)),
      ENOUGH,
    );
    return room - outside;
  }

  return {
    /**
     * @param {{i: number, text: string, at: [number, number]}[]} names
     * @param {number[][]} obstacles
     * @returns {{text: string, x: number, y: number}[]} middles of the names, as far as they fit
     */
    place(names, obstacles) {
      /** @type {[number, number][]} */
      const taken = [];
      const lines = [...obstacles];
      const cheap = names.length * obstacles.length > MOST_WORK;
      return names.flatMap(({ i, text, at }) => {
        if (taken.some((other) => Math.hypot(other[0] - at[0], other[1] - at[1]) < CLOSE)) {
          return [];
        }
        taken.push(at);
        const width = LETTER * text.length;
        let best = kept.get(i) ?? 0;
        if (!cheap) {
          const scores = SPOTS.map(
            ({ more }, k) => score(placeAt(at, width, k), width, lines) - (more ? NEARER : 0),
          );
          scores[best] += kept.has(i) ? KEEP : 0;
          best = scores.indexOf(Math.max(...scores));
          kept.set(i, best);
        }
        const [x, y] = placeAt(at, width, best);
        lines.push([x - width / 2, y, x + width / 2, y, HALF_HEIGHT]);
        return [{ text, x, y }];
      });
    },
  };
}
