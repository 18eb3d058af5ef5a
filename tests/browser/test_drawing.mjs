// SPDX-License-Identifier: GPL-3.0-or-later
// The drawing of the page, without a browser: camera, outlines, order in depth, names, arrows.
import assert from "node:assert/strict";
import { test } from "node:test";
import { coincide } from "../../web/state/between.js";
import { createHistory } from "../../web/state/history.js";
import { arrowScale, namedState, pointAt, zeroOf } from "../../web/state/reactions.js";
import { createNamePlaces, spread } from "../../web/widgets/name-places.js";
import { moveToFreeRows } from "../../web/widgets/plot-labels.js";
import { createPen, piecesOf } from "../../web/widgets/pieces.js";
import { bar, circle, disc } from "../../web/widgets/shapes.js";
import { anglesOf, lookFrom } from "../../web/state/look.js";
import { createCamera, seenBox } from "../../web/widgets/camera.js";

test("y points up, and the envelope lies inside the view", () => {
  const camera = createCamera([-1, -2, 3, 4], 700, 400);
  const [x0, y0] = camera.point([-1, -2, 0], 0);
  const [x1, y1] = camera.point([3, 4, 0], 0);
  assert.ok(x0 < x1 && y0 > y1);
  for (const [value, limit] of [
    [x0, 700],
    [x1, 700],
    [y0, 400],
    [y1, 400],
  ]) {
    assert.ok(value >= 0 && value <= limit);
  }
  assert.ok(Math.abs((x1 - x0) / 4 - (y0 - y1) / 6) < 1e-9);
});

test("a mechanism in space is seen without distortion, from where one asked to", () => {
  const look = lookFrom(0.6, 0.4);
  const [azimuth, elevation] = anglesOf(look);
  assert.ok(Math.abs(azimuth - 0.6) < 1e-12 && Math.abs(elevation - 0.4) < 1e-12);
  for (const vertical of ["y", "z"]) {
    const [a, e] = anglesOf(lookFrom(0.6, 0.4, vertical), vertical);
    assert.ok(Math.abs(a - 0.6) < 1e-12 && Math.abs(e - 0.4) < 1e-12);
  }
  assert.equal(lookFrom(0, 0, "z").up[2], 1);
  const points = [-1, -1, -2, 1, 2, 2, 0, 3, -1, 2, 0, 1];
  const camera = createCamera(seenBox(points, look), 500, 300, look);
  for (let i = 0; i < 4; i++) {
    const [x, y] = camera.point(points, i);
    assert.ok(x >= 0 && x <= 500 && y >= 0 && y <= 300);
  }
  const [a, b, c] = [lookFrom(0, 0), lookFrom(Math.PI / 2, 0), lookFrom(0, Math.PI / 2)];
  assert.ok(a.right[0] === 1 && a.up[1] === 1);
  assert.ok(Math.abs(b.right[2] + 1) < 1e-12); // from the side, z points to the left
  assert.ok(Math.abs(c.up[2] + 1) < 1e-12); // from above, z points down
});

test("outlines are finite even where two points coincide", () => {
  assert.doesNotMatch(bar([5, 5], [5, 5], 3) + circle([1, 2], 3), /NaN|Infinity/);
});

test("a regular polygon is drawn as its circle, from wherever one looks", () => {
  const n = 12;
  const seen = (turn) => [Math.cos(turn) * 40, 0.3 * Math.sin(turn) * 40];
  const corners = Array.from({ length: n }, (_, i) => seen((2 * Math.PI * i) / n));
  const numbers = disc(corners)
    .match(/-?[\d.]+/g)
    .map(Number);
  // the middle of each cubic lies on the ellipse as well
  for (let i = 0; i < n; i++) {
    const at = (k) => numbers.slice(2 + 6 * i + 2 * k, 4 + 6 * i + 2 * k);
    const [a, b, c, d] = [numbers.slice(6 * i, 6 * i + 2), at(0), at(1), at(2)];
    const [x, y] = [0, 1].map((k) => (a[k] + 3 * b[k] + 3 * c[k] + d[k]) / 8);
    assert.ok(Math.abs(Math.hypot(x / 40, y / 12) - 1) < 2e-3); // coordinates carry two decimals
  }
});

test("in space what lies nearer is drawn over what lies farther, and a pin over the bars it holds", () => {
  const bar = (p, q) => ({ kind: "bar", p, q, n: 2, width: 0.1, body: p });
  const scene = {
    length: 1,
    points: [],
    ground_points: [],
    drawing: {
      shapes: [bar(0, 1), bar(1, 2), { kind: "pivot", p: 1, q: 1, n: 1, width: 0, body: 0 }],
    },
  };
  const pose = [0, 0, 0, 1, 0, 0, 1, 0, 2]; // the second bar comes towards the viewer of the front
  const order = (look) => {
    const pen = createPen(scene, createCamera([-1, -1, 2, 2], 400, 300, look), {
      width: 400,
      height: 300,
    });
    return piecesOf(scene, "alone")
      .sort((a, b) => pen.depth(a, pose) - pen.depth(b, pose))
      .map(({ shapes: [shape] }) => `${shape.kind} ${shape.p}`);
  };
  assert.deepEqual(order({ right: [1, 0, 0], up: [0, 1, 0] }), ["bar 0", "bar 1", "pivot 1"]);
  assert.deepEqual(order({ right: [-1, 0, 0], up: [0, 1, 0] }), ["bar 1", "bar 0", "pivot 1"]);
});

test("a name keeps clear of the parts and stays where it is while there is room", () => {
  const places = createNamePlaces({ width: 300, height: 300 });
  const names = [{ i: 0, text: "A", at: [150, 150] }];
  const bar = [150, 150, 250, 60, 6]; // to the upper right, where a name would stand by itself
  const [first] = places.place(names, [bar]);
  const along = ((first.x - 150) * 100 - (first.y - 150) * 90) / Math.hypot(100, 90);
  const aside = Math.abs((first.x - 150) * 90 + (first.y - 150) * 100) / Math.hypot(100, 90);
  assert.ok(along < 0 || aside > 12, JSON.stringify(first));
  const [second] = places.place(names, [[150, 150, 250, 62, 6]]);
  assert.deepEqual(second, first);
});

test("the state goes to the server under the names of coordinates and rates", () => {
  const coordinates = [
    { name: "th1", rate: "w1" },
    { name: "s", rate: "ds" },
  ];
  assert.deepEqual(namedState(coordinates, [1, 2], Float64Array.of(3, 4)), {
    th1: 1,
    w1: 3,
    s: 2,
    ds: 4,
  });
});

test("arrows keep their scale while the largest can be read, and rounding is no force", () => {
  const first = arrowScale(14, 1);
  assert.equal(first, 5);
  assert.equal(arrowScale(9, first), first);
  assert.equal(arrowScale(1400, first), 0.05);
  assert.equal(arrowScale(0, first), first);
  const list = [{ force: [3, 4, 0], moment: [0, 0, 3e-16] }];
  const zero = zeroOf(list, 2);
  assert.ok(zero.moment > 3e-16 && zero.moment < 1e-9 && zero.force < 1e-9);
  assert.equal(pointAt([0, 0, 0, 1, 2, 3], [1, 2, 3 + 1e-9], 1), 1);
  assert.equal(pointAt([0, 0, 0, 1, 2, 3], [1, 2, 3.1], 1), -1);
});

/** A history of one point on a circle, that turns by an angle from frame to frame. */
function turning(angle, count) {
  const history = createHistory(1, 1, 1);
  for (let k = 0; k < count; k++) {
    const points = [Math.cos(k * angle), Math.sin(k * angle), 0];
    const method = { state: "running", t: k / 50, points, q: [k * angle], v: [50 * angle] };
    history.push({ frame: k, t: k / 50, generation: 0, methods: [method] });
  }
  return history;
}

test("between two frames a point goes on along its arc, and what is too quick stays at its frame", () => {
  const slow = turning(0.2, 5);
  for (const place of [1.1, 1.5, 2.5, 3.9]) {
    const [x, y] = slow.pointsAt(0, place);
    const off = Math.hypot(x - Math.cos(0.2 * place), y - Math.sin(0.2 * place));
    assert.ok(off < 0.2 ** 3 / 15, `${off} off at ${place}`); // the bound of a parabola on a circle
    assert.ok(Math.abs(slow.coordinatesAt(0, place)[0] - 0.2 * place) < 1e-12);
    assert.ok(Math.abs(slow.frameAt(place) - place) < 1e-12);
  }
  assert.deepEqual(
    [...slow.pointsAt(0, 3)],
    [Math.cos(0.6000000000000001), Math.sin(0.6000000000000001), 0],
  );

  const quick = turning(1, 5);
  assert.deepEqual([...quick.pointsAt(0, 2.5)], [...quick.pointsAt(0, 2)]);
});

test("the place of a time is between the frames about it, and never beyond the last", () => {
  const history = turning(0.2, 4);
  for (const [time, place] of [
    [-1, 0],
    [0, 0],
    [0.03, 1.5],
    [0.039, 1.95],
    [0.05, 2.5],
    [9, 3],
  ]) {
    const found = history.placeAt(time);
    assert.ok(Math.abs(found - place) < 1e-9, `${time} s is at ${found}`);
  }
});

test("what coincides is told from what does not, and from what is not known", () => {
  assert.ok(coincide([1, 2, 3], [1, 2.0009, 3], 1e-3));
  assert.ok(!coincide([1, 2, 3], [1, 2, 3.0011], 1e-3));
  assert.ok(!coincide([1, NaN], [1, NaN], 1e-3));
});

test("names on a plot move to the nearest rows without a curve or a name, and stay where none is", () => {
  const room = { low: 7, high: 193, height: 14 };
  const band = (from, to) => Array.from({ length: 200 }, (_, row) => row >= from && row < to);
  const names = [{ y: 50 }, { y: 64 }, { y: 150 }];
  moveToFreeRows(names, band(40, 80), room);
  assert.deepEqual(
    names.map(({ y }) => y),
    [33, 87, 150],
    "above and below the band of the curve; a name that is free stays",
  );
  const full = [{ y: 50 }];
  moveToFreeRows(full, band(0, 200), room);
  assert.deepEqual(full, [{ y: 50 }]);
});

test("numbers of arrows at one joint do not lie over each other", () => {
  const at = (x, y, text = "860 mN") => ({ x, y, text });
  const far = [at(0, 0), at(100, 0), at(0, 40)];
  assert.deepEqual(spread(far), far, "what is apart stays");
  const ys = spread([at(0, 0), at(3, 4), at(-3, -2), at(2, 1)]).map(({ y }) => y);
  ys.sort((a, b) => a - b);
  assert.ok(
    ys.slice(1).every((y, i) => y - ys[i] >= 14 - 1e-9), // [px] a line
    ys.join(" "),
  );
});
