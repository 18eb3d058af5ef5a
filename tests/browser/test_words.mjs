// SPDX-License-Identifier: GPL-3.0-or-later
// The words of the page, without a browser: what explains itself, what studies say, counts.
import assert from "node:assert/strict";
import { test } from "node:test";
import { triesOfIncident } from "../../web/state/cards.js";
import { counted, gapWords } from "../../web/state/format.js";
import { GLOSSARY, termsIn } from "../../web/state/glossary.js";
import { markWords } from "../../web/state/reactions.js";
import { QUANTITIES } from "../../web/state/quantities.js";
import { ERRORS, byName, leftOutOf } from "../../web/state/study-documents.js";
import { createHistory } from "../../web/state/history.js";
import { beforeAndAfter } from "../../web/state/words.js";
import { isOpen, markerOf } from "../../web/widgets/markers.js";

const keysIn = (text) =>
  termsIn(text)
    .map(({ key }) => key)
    .filter(Boolean);

test("special words of a text are found where they first stand, and the text stays whole", () => {
  const cases = [
    ["|λ| grows as the pivot ratio falls", ["multipliers", "pivot"]],
    ["σ_min is 0 on this branch", ["sigma", "branch"]],
    ["four evaluations, and evaluations again", ["evaluations"]],
    ["the cut joint opens; the cut is drawn", ["cut"]],
    ["J loses rank in a singular configuration", ["rank", "singular"]],
    ["the executive branched off", []],
  ];
  for (const [text, keys] of cases) {
    assert.deepEqual(keysIn(text), keys, text);
    assert.equal(
      termsIn(text)
        .map((piece) => piece.text)
        .join(""),
      text,
    );
  }
});

test("every definition begins with its own word, and every plotted quantity is explained", () => {
  for (const { word, means } of Object.values(GLOSSARY)) {
    assert.ok(means.length > 40 && /[.]$/.test(means), word);
  }
  const columns = QUANTITIES.filter(({ about }) => about.length < 20);
  assert.deepEqual(columns, []);
});

test("the axis of errors says its unit, by what the coordinates of the scene are", () => {
  const position = byName(ERRORS, "q");
  const scene = (...kinds) => ({ length: 1.2, coordinates: kinds.map((kind) => ({ kind })) });
  assert.equal(position.unit(scene("angle", "angle")), "rad");
  assert.equal(position.unit(scene("length")), "share of 1.2 m");
  assert.equal(position.unit(scene("angle", "length")), "rad, lengths as share of 1.2 m");
  assert.ok(ERRORS.every(({ unit }) => unit(scene("angle")) !== ""));
});

test("points that were not run are counted with the reason, and are drawn as rings, not as failures", () => {
  const points = [
    { state: "done", reason: "", size: 0.1 },
    { state: "skipped", reason: "the time limit of 20 s", size: 0.05 },
    { state: "pending", reason: "", size: 0.02 },
  ];
  const study = { methods: [{ size: "h", points }] };
  assert.equal(
    leftOutOf(study, (m) => `method ${m}`),
    "2 of 3 points were not run: the time limit of 20 s. Left out: method 0 at h = 50 ms, h = 20 ms.",
  );
  assert.equal(leftOutOf({ methods: [{ points: points.slice(0, 1) }] }), "");
  const failed = markerOf({ error: Infinity, state: "failed" }, "disc");
  const skipped = markerOf({ error: Infinity, state: "skipped" }, "square");
  assert.notEqual(failed, skipped);
  assert.ok(isOpen({ error: Infinity, state: "skipped" }, "disc"));
  assert.ok(!isOpen({ error: 1, state: "done" }, "disc"));
});

test("what a mark says of multipliers is a sentence; a sound one says nothing", () => {
  assert.equal(markWords("determined"), "");
  assert.equal(markWords(undefined), "");
  const marks = ["one of many", "no digit left", "no solution", "of open loops"];
  for (const mark of marks) {
    assert.match(markWords(mark), /^[A-Z].{30,}\.$/, mark);
  }
  assert.match(markWords("of open loops"), /A loop stands open/);
});

test("a dead point, a magnification and a multiplier have their sentence", () => {
  assert.deepEqual(keysIn("it stands at a dead point"), ["singular"]);
  assert.deepEqual(keysIn("the mechanism passed a change point"), ["singular"]);
  assert.match(GLOSSARY.magnified.means, /×20/);
  assert.match(GLOSSARY.multipliers.means, /force/);
});

test("one is one, and a gap of rounding has one digit", () => {
  assert.equal(counted(1, "note"), "1 note");
  assert.equal(counted(0, "note"), "0 notes");
  assert.equal(counted(1.5, "point"), "1.5 points");
  assert.equal(gapWords(1.1e-16), "1×10⁻¹⁶ m");
  assert.equal(gapWords(-3.2e-13, "J"), "−3×10⁻¹³ J");
  assert.equal(gapWords(0.0123), "12 mm");
});

test("a remedy stands beside what its trial gave", () => {
  const remedies = ["h=0.01", "ggl@radau5:rtol=1e-06"];
  const incident = { remedies, tried: ["", "tried until t = 2 s: gap 7e-16 m"] };
  assert.deepEqual(
    triesOfIncident(incident).map(({ said }) => said),
    ["", "tried until t = 2 s: gap 7e-16 m"],
  );
});

/** A history of one method whose gap grows by 1 mm a second; it stops at a time if one is given. */
function growing(count, stop = Infinity) {
  const history = createHistory(1, 1);
  for (let k = 0; k < count; k++) {
    const t = k / 10;
    const state = t > stop ? "failed" : "running";
    const now = Math.min(t, stop);
    const method = { state, t: now, points: [0, 0, 0], gap: 1e-3 * now, energy_change: now };
    history.push({ frame: k, t, generation: 0, methods: [method] });
  }
  return history;
}

test("before and after are compared over the time that both ran, and where one stopped is said", () => {
  const method = (spelling) => ({ formulation: "index1", label: "index-1", spelling });
  const data = (stop) => ({
    before: { methods: [method("index1@rk4:h=0.02")], history: growing(101) },
    history: growing(101, stop),
    methods: [method("index1@rk4:h=0.04")],
    duration: 10,
  });
  assert.deepEqual(beforeAndAfter(data(Infinity), 100), [
    "index-1 until 10.00 s: worst gap 10 mm before, 10 mm now; energy change 10 J before, 10 J now",
  ]);
  assert.match(
    beforeAndAfter(data(5.55), 100)[0],
    /^index-1 until 5\.55 s, where it stopped: worst gap 5\.[56] mm before, 5\.[56] mm now/,
  );
});
