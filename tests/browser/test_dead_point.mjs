// SPDX-License-Identifier: GPL-3.0-or-later
// Dead points: found in the recording, listed while a method is right, in words.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
  deadPointAt,
  deadPointLines,
  deadPointsOf,
  noDeadPointWords,
} from "../../web/state/dead-point.js";
import { seconds } from "../../web/state/format.js";
import { createHistory } from "../../web/state/history.js";

const frame = (k, gap, extra = {}) => ({
  frame: k,
  t: k / 60,
  methods: [
    {
      state: "running",
      t: k / 60,
      points: [k, 0, 0],
      gap,
      velocity_gap: gap,
      energy_change: 0,
      ops: k,
      evals: k,
      cpu: k,
      steps: k,
      ...extra,
    },
  ],
});

test("a dead point is a coordinate that turns back while another one moves on", () => {
  const history = createHistory(1, 1, 2);
  for (let k = 0; k <= 60; k++) {
    history.push(frame(k, 0, { q: [k, 0], v: [10, Math.cos(k / 10)] }));
  }
  const coordinates = [
    { name: "th1", kind: "angle", actuated: true },
    { name: "x", kind: "length", actuated: false },
  ];
  const data = {
    history,
    duration: 10,
    scene: { dof: 1, m: 2, coordinates },
    methods: [
      {
        label: "reduced",
        formulation: "reduced",
        integrator: "rk4",
        spelling: "reduced@rk4:h=0.01",
      },
    ],
    incidents: [],
    catalogue: { formulations: [{ name: "reduced", integrators: ["rk4"] }], integrators: [] },
  };
  assert.deepEqual(deadPointsOf(data, 0, 15), [], "cos has no zero before pi/2");
  const [found, ...more] = deadPointsOf(data, 0, 40);
  assert.equal(found.coordinate, 1);
  assert.deepEqual(more, []);
  const [line] = deadPointLines(data, 60); // the second zero of cos is at 47.1 frames
  assert.deepEqual([line.name, line.count, line.first], ["x", 2, found.t]);
  assert.match(line.words, /^x turns back there while the mechanism moves on\. A force along x /);
  assert.ok(Math.abs(found.t - (history.t[1] - history.t[0]) * 5 * Math.PI) < 1e-3);
  const { title, words, tries, isNear } = deadPointAt(data, 0, 40);
  assert.equal(isNear, history.t[40] - found.t < 0.5);
  assert.match(title, /^Dead point of x at 0\.26 s$/);
  assert.match(words, /^x turns back there while th1 moves on at 10 rad\/s\./);
  assert.deepEqual(
    tries.map(({ method }) => method),
    ["reduced:coordinate=2@rk4:h=0.01"],
  );
  data.methods[0].integrator = "genalpha";
  assert.deepEqual(deadPointAt(data, 0, 40).tries, [], "no method that cannot be");

  // a swing: all coordinates turn back at once, and the mechanism has no dead point
  const swing = createHistory(1, 1, 2);
  for (let k = 0; k <= 60; k++) {
    swing.push(frame(k, 1, { q: [0, 0], v: [Math.cos(k / 10), 2 * Math.cos(k / 10)] }));
  }
  assert.deepEqual(deadPointsOf({ ...data, history: swing }, 0, 60), []);

  // frames that were looked at are not looked at again
  let asked = 0;
  const counted = Object.create(history, {
    stateAt: { value: (m, i) => (asked++, history.stateAt(m, i)) },
  });
  const until = (shown) => deadPointsOf({ ...data, history: counted }, 0, shown).length;
  assert.deepEqual([until(40), asked], [1, 80]);
  assert.deepEqual([until(60), asked], [2, 120]);
  assert.deepEqual([until(40), until(15), asked], [1, 0, 120], "an earlier frame is shown");

  // where none is listed the record says why
  const why = (change) => noDeadPointWords({ ...data, ...change }, 15);
  assert.match(why({}), /^No dead point until 0\.25 s: no coordinate turned back/);
  assert.match(why({ history: swing }), /^No dead point until 0\.08 s: /);
  const left = "None is listed after that: the method has left the true motion since.";
  assert.ok(why({ history: swing }).includes(left));
  assert.match(why({ scene: { dof: 2, m: 2, coordinates } }), /; this one has 2\.$/);
  assert.equal(why({ scene: { dof: 1, m: 0, coordinates } }), "", "no loop, no dead point");
});

test("where every method is wrong the dead points of the time before are listed", () => {
  // zeros of cos at frames 15.7 and 47.1; the loop is open from frame 30 on
  const history = createHistory(1, 1, 2);
  for (let k = 0; k <= 60; k++) {
    const gap = k < 30 ? 1e-9 : 0.5;
    history.push(frame(k, gap, { q: [0, 0], v: [10, Math.cos(k / 10)] }));
  }
  const data = {
    history,
    duration: 10,
    scene: {
      dof: 1,
      m: 2,
      coordinates: [
        { name: "th1", kind: "angle", actuated: true },
        { name: "x", kind: "length", actuated: false },
      ],
    },
    methods: [{ label: "index-1", spelling: "index1@rk4:h=0.01" }],
    incidents: [],
  };
  const [line, ...more] = deadPointLines(data, 60);
  assert.deepEqual([line.name, line.count, more.length], ["x", 1, 0]);
  const end = seconds(history.t[29], 10);
  const since = "the method has left the true motion since.";
  assert.ok(line.words.includes(`Dead points are listed until ${end}: ${since}`), line.words);
});

test("methods that stopped are told from methods that are wrong", () => {
  // zeros of cos at frames 15.7 and 47.1; the first `stops` methods end at frame 31, the loops of
  // the others are open from frame 30 on
  const recorded = (count, stops) => {
    const history = createHistory(count, 1, 2);
    for (let k = 0; k <= 60; k++) {
      const { t, methods } = frame(k, k < 30 ? 1e-9 : 0.5, {
        q: [0, 0],
        v: [10, Math.cos(k / 10)],
      });
      const ended = { state: "failed", t: 31 / 60 };
      const list = Array.from({ length: count }, (_, m) =>
        m < stops && k > 30 ? ended : { ...methods[0], gap: m < stops ? 1e-9 : methods[0].gap },
      );
      history.push({ frame: k, t, methods: list });
    }
    const coordinates = [
      { name: "th1", kind: "angle", actuated: true },
      { name: "x", kind: "length", actuated: false },
    ];
    const methods = Array.from({ length: count }, (_, m) => ({ label: `method ${m + 1}` }));
    return { history, duration: 10, scene: { dof: 1, m: 2, coordinates }, methods, incidents: [] };
  };
  for (const [count, stops, words] of [
    [3, 2, "of 3 methods 2 have stopped and 1 has left the true motion since."],
    [3, 1, "of 3 methods 1 has stopped and 2 have left the true motion since."],
    [3, 3, "every method has stopped since."],
    [1, 1, "the method has stopped since."],
    [2, 0, "every method has left the true motion since."],
  ]) {
    const data = recorded(count, stops);
    const [line] = deadPointLines(data, 60);
    assert.ok(line.words.endsWith(`: ${words}`), line.words);
    const none = noDeadPointWords(data, 60);
    assert.ok(none.includes(`None is listed after that: ${words}`), none);
  }
});

test("dead points are those of the methods that are right, with their names where they differ", () => {
  // zeros of cos until frame 60, at these velocities: 2 or 4; the third one's loop is open
  const history = createHistory(3, 1, 2);
  for (let k = 0; k <= 60; k++) {
    const methods = [
      [0, 10],
      [1e-6, 10],
      [1, 3],
    ].map(([gap, slow]) => frame(k, gap, { q: [k, 0], v: [10, Math.cos(k / slow)] }).methods[0]);
    history.push({ ...frame(k, 0), methods });
  }
  const coordinates = [
    { name: "th1", kind: "angle", actuated: true },
    { name: "x", kind: "length", actuated: false },
  ];
  const data = {
    history,
    duration: 10,
    scene: { dof: 1, m: 2, coordinates },
    methods: [{ label: "reduced" }, { label: "projection" }, { label: "index-1" }],
  };
  const lines = () => deadPointLines(data, 60).map(({ name, of, count }) => [name, of, count]);
  assert.deepEqual(deadPointsOf(data, 2, 60).length, 6, "the torn one turns back as well");
  assert.deepEqual(lines(), [["x", "", 2]]);

  // a second method that is right finds another number
  const other = createHistory(3, 1, 2);
  for (let k = 0; k <= 60; k++) {
    const methods = [10, 10, 3].map(
      (slow) => frame(k, 0, { q: [k, 0], v: [10, Math.cos(k / slow)] }).methods[0],
    );
    other.push({ ...frame(k, 0), methods });
  }
  data.history = other;
  assert.deepEqual(lines(), [
    ["x", "reduced and projection", 2],
    ["x", "index-1", 6],
  ]);
});
