// SPDX-License-Identifier: GPL-3.0-or-later
// The page reads the documents of studies, and asks for them.
import assert from "node:assert/strict";
import { test } from "node:test";
import { read } from "./support.mjs";
import {
  barsOf,
  boundaryOf,
  dotsOf,
  floorOf,
  frameOf,
  labelsIn,
  leftOutOf,
  meaningOf,
  missingIn,
  sentencesOf,
} from "../../web/state/study-documents.js";
import { readIndex } from "../../web/state/catalogue.js";
import {
  baumgarteLimit,
  axesWith,
  contourOf,
  heatRange,
  heatSentences,
  HEATS,
  placeOnAxis,
  valueOnAxis,
} from "../../web/state/heat.js";
import { orderOf, presetsOf, signatureOf } from "../../web/state/studies.js";
import { cheapestFor, rankingOf, sizeToRun, wantedError } from "../../web/state/wanted.js";
import { costText } from "../../web/state/cost-words.js";
import { decodeLink, encodeLink } from "../../web/state/link.js";
import { CATALOGUE } from "./catalogue.mjs";

const point = (size, state, more = {}) => ({
  method: `a@rk4:h=${size}`,
  size,
  state,
  reason: state === "done" ? "" : "it fell apart",
  operations: state === "done" ? 100 / size : undefined,
  evaluations: 4 / size,
  worst: { q: size ** 4 },
  bounds: [],
  cpu: { median: null },
  ...more,
});
const STUDY = {
  reference: { error: { q: 1e-13, gap: 0 } },
  methods: [
    {
      size: "h",
      points: [point(1, "failed"), point(0.1, "done"), point(0.01, "done", { bounds: ["q"] })],
    },
  ],
  pareto: [],
  wanted: { margin: 0.5, above_reference: 10 },
};

test("a point that failed stands on the upper edge, at what it would have cost", () => {
  const [dots] = dotsOf(STUDY, "q", "operations");
  assert.deepEqual(
    dots.map(({ error, bound }) => [error, bound]),
    [
      [Infinity, false],
      [0.1 ** 4, false],
      [0.01 ** 4, true],
    ],
  );
  assert.ok(Math.abs(dots[0].cost - 100) < 1e-9, "a tenth of what a tenth of the step costs");
  assert.equal(dots[0].reason, "it fell apart");
  assert.equal(
    dotsOf(STUDY, "q", "time")[0].length,
    1,
    "what was not measured is not drawn, the failure is",
  );
});

test("an accuracy is read as a length, an angle, a share or the number of the axis", () => {
  const value = (text, error = "q") => wantedError(text, error, 2)?.value;
  assert.equal(value("1 mm"), 0.5e-3);
  assert.equal(value("2 mrad"), 2e-3);
  assert.equal(value("0.1 %", "energy"), 1e-3);
  assert.equal(value("1e-3", "v"), 1e-3);
  assert.equal(value("1 mm", "v"), undefined, "a velocity is no length");
  assert.equal(value("0"), undefined);
  assert.equal(value("-1 mm"), undefined);
  assert.equal(value("much"), undefined);
});

test("the cheapest method for an accuracy lies between its measured points, by the study's own rule", () => {
  const dot = (m, size, error, cost, more = {}) => ({
    ...{ m, k: 0, size, error, cost, sizeName: "h", spelling: "", state: "done" },
    ...{ reason: "", bound: false, ...more },
  });
  const rule = { margin: 0.5, floor: 0 };
  const steep = [dot(0, 1, Infinity, 1), dot(0, 0.1, 1e-2, 10), dot(0, 0.01, 1e-6, 100)];
  const near = (value, other) => assert.ok(Math.abs(value / other - 1) < 1e-9, `${value}`); // roundings
  const [first] = cheapestFor([steep], 2e-4, rule);
  near(first.cost, Math.sqrt(1000)); // half-way in decades, for half the error
  near(first.size, Math.sqrt(1e-3));
  near(cheapestFor([steep], 1e-4, { ...rule, margin: 1 })[0].cost, Math.sqrt(1000));
  const dear = [dot(1, 0.1, 1e-2, 30), dot(1, 0.01, 1e-6, 300)];
  const far = [dot(2, 0.1, 1e-9, 1, { away: true })];
  const order = (list) => cheapestFor(list, 2e-4, rule).map(({ m }) => m);
  assert.deepEqual(order([dear, steep, far]), [0, 1], "what converges elsewhere reaches nothing");
  const [coarse] = cheapestFor([[dot(0, 1, 1e-5, 2), dot(0, 0.1, 1e-7, 20)]], 1e-2, rule);
  assert.deepEqual([coarse.cost, coarse.atMost], [2, true]);
  const [measured] = cheapestFor([steep], 1.5e-6, rule);
  assert.deepEqual([measured.size, measured.cost], [0.01, 100], "no finer than what is measured");
  assert.deepEqual(
    cheapestFor([steep], 1.5e-6, { margin: 0.5, floor: 1e-5 }),
    [],
    "an error below the resolution of the reference is claimed as that",
  );
});

test("the step that is told has two digits and is never larger than what was found", () => {
  const told = (size) => sizeToRun(/** @type {any} */ ({ size, measured: false }));
  assert.deepEqual([0.01499, 0.0148, 0.0999, 1.24e-5].map(told), [0.014, 0.014, 0.099, 1.2e-5]);
  assert.equal(sizeToRun(/** @type {any} */ ({ size: 0.01499, measured: true })), 0.01499);
});

test("times that cannot be told apart are not ranked, counts are", () => {
  const reach = (m, cost, range, halves) => ({
    m,
    cost,
    size: 1,
    atMost: false,
    dot: /** @type {any} */ (range ? { range, halves } : {}),
  });
  const steady = [0.99, 1.01];
  const close = (list) => rankingOf(list).close.map(({ m }) => m);
  assert.deepEqual(close([reach(0, 1, steady, 1), reach(1, 1.05, steady, 1)]), [0, 1]);
  assert.deepEqual(close([reach(0, 1, steady, 1), reach(1, 1.14, steady, 1)]), [0]);
  assert.deepEqual(close([reach(0, 1, [0.9, 1.2], 1), reach(1, 1.14, steady, 1)]), [0, 1]);
  assert.deepEqual(close([reach(0, 1), reach(1, 1.01)]), [0], "counts are exact");
  const shaken = { ...reach(0, 1, steady, 1), coarser: reach(0, 1, steady, 1.3).dot };
  assert.deepEqual(rankingOf([shaken, reach(1, 2, steady, 1)]).unsteady, true);
  assert.deepEqual(rankingOf([reach(0, 1, steady, 1), reach(1, 2, steady, 1)]).unsteady, false);
});

test("a method of a document keeps its name where the page has others before it", () => {
  const page = [
    { spelling: "index1@rk4:h=0.01", label: "index-1" },
    { spelling: "baumgarte:alpha=5,beta=5@rk4:h=0.01", label: "Baumgarte" },
  ];
  const of = (method) => labelsIn({ methods: [{ method }] }, page)(0);
  assert.equal(of("baumgarte:alpha=7,beta=5@rk4:h=0.02"), "Baumgarte");
  assert.equal(of("index1@rk4:h=0.02"), "index-1");
  assert.equal(of("penalty@rk4:h=0.01"), "penalty@rk4:h=0.01", "it is no longer on the page");
});

test("the step that runs has two digits and is not larger than what was found", () => {
  const of = (size, measured) =>
    sizeToRun({ m: 0, cost: 1, size, dot: null, atMost: measured, measured });
  assert.equal(of(2.86e-3, false), 2.8e-3);
  assert.equal(of(0.0625, true), 0.0625, "a measured step is run as it is");
});

test("a study that was cut short names what it left out", () => {
  const study = {
    methods: [
      {
        size: "h",
        points: [
          { state: "done", size: 1 },
          { state: "skipped", size: 1e-3 },
        ],
      },
      { size: "h", points: [{ state: "done", size: 1 }] },
    ],
  };
  const label = (m) => ["index-1", "reduced"][m];
  assert.match(
    leftOutOf(study, label),
    /^1 of 3 points was not run: .* Left out: index-1 at h = 1/,
  );
  assert.equal(missingIn(study, label), "index-1 1 point");
  const map = { methods: [{ rows: [[{ class: "stable" }, { class: "skipped" }]] }] };
  assert.equal(missingIn(map, label), "index-1 1 cell");
  assert.equal(missingIn({ methods: [{ state: "pending" }, { state: "done" }] }, label), "index-1");
  assert.equal(missingIn({ methods: [{ state: "left out" }] }, label), "index-1", "of a budget");
});

test("the frame holds every finite error in whole decades, and the band of the reference where it is near", () => {
  const box = frameOf(dotsOf(STUDY, "q", "operations"), floorOf(STUDY, "q"));
  assert.deepEqual([box.y0, box.y1], [-8, -4]);
  assert.ok(box.x0 < 2 && box.x1 > 4);
  assert.equal(frameOf(dotsOf(STUDY, "q", "operations"), 1e-9).y0, -9);
  assert.equal(frameOf([[]], 0), null);
});

test("bars add up: what is negative goes to the left, what is positive to the right", () => {
  const bars = barsOf(
    { a: 3, b: -1, c: 0, d: null, e: 1 },
    [..."abcde"].map((name) => ({ name })),
  );
  assert.deepEqual(
    bars.map(({ name, from, to }) => [name, from, to]),
    [
      ["a", 0, 0.75],
      ["b", -0.25, 0],
      ["e", 0.75, 1],
    ],
  );
});

test("the predicted boundary lies between cells on either side of the limit, or at the step itself", () => {
  const cells = {
    rows: [
      [0.5, 2],
      [2, 2],
    ].map((row) => row.map((margin) => ({ margin }))),
    columns: [],
  };
  const grid = { x: { values: [1, 2] }, y: { values: [1, 2], scale: "lin", kind: "setting" } };
  assert.deepEqual(boundaryOf(grid, cells), [
    [
      [1, 0],
      [1, 1],
    ],
    [
      [0, 1],
      [1, 1],
    ],
  ]);
  const steps = { x: null, y: { values: [1e-3, 1e-1], scale: "log", kind: "step" } };
  const [line] = boundaryOf(steps, { rows: [], columns: [{ predicted: [1e-2] }] });
  assert.ok(Math.abs(line[0][1] - 1) < 1e-12, "half-way between the middles of two cells");
});

/** The part of the server's index that tells of studies. */
const STUDIES = [
  { name: "work-precision", chooses: ["h", "rtol"], presets: [], fields: [] },
  {
    name: "stability",
    chooses: ["h"],
    fields: [{ name: "methods", max: 4 }],
    presets: [
      { name: "limits", about: "the step", chooses: ["h"], stabilised: false, units: [] },
      {
        name: "baumgarte",
        about: "α and β",
        chooses: ["alpha", "beta"],
        stabilised: true,
        units: [],
      },
    ],
  },
  { name: "budget", chooses: [], presets: [], fields: [] },
];
readIndex({ limits: { methods: 8 }, incidents: [], studies: STUDIES });

test("the present α and β are inside the axes of their map, whatever the step", () => {
  const order = (spelling) =>
    orderOf(
      "stability",
      { scene: { id: "a" }, settings: {}, methods: [{ spelling }], catalogue: CATALOGUE },
      "baumgarte",
    );
  assert.equal(order("baumgarte:alpha=5,beta=5@rk4:h=0.02").preset, "baumgarte");
  const { over, preset } = order("baumgarte:alpha=5,beta=9@rk4:h=1e-3");
  assert.equal(preset, undefined);
  assert.equal(over, "alpha=2.5..5000,beta=2.5..5000");
});

test("the heat of a map is that of the cells that ran, and its least is found in words", () => {
  const cell = (gap, state = "inaccurate") => ({ class: state, gap, error: gap, energy: 1 / gap });
  const rows = [
    [cell(1e-3), cell(1e-4)],
    [cell(1e-5), cell(1e-9, "grew")],
  ];
  const { low, high, best } = heatRange(HEATS[0], rows, 2);
  assert.deepEqual([best.i, best.j], [0, 1]);
  assert.ok(Math.abs(low - Math.log10(2e-5)) < 1e-12 && Math.abs(high - Math.log10(2e-3)) < 1e-12);
  const map = { x: { values: [1, 2] }, y: { values: [3, 4] } };
  const said = heatSentences(map, { rows }, 2, (_, value) => String(value));
  assert.equal(said[0], "smallest worst loop gap: 20 µm at 1, 4");

  // energy that is right beside a wrong motion is so by chance, or lost
  const chance = [[{ class: "inaccurate", gap: 1e-5, error: 0.27, energy: 0 }]];
  const one = { x: { values: [1] }, y: { values: [3] } };
  assert.deepEqual(heatSentences(one, { rows: chance }, 2, (_, value) => String(value)).slice(1), [
    "smallest error of velocity: 27 % at 1, 3",
    "smallest energy gained: 1.0×10⁻¹⁵ % at 1, 3, where the velocity is 27 % off",
  ]);
});

test("counts are said in words, and an error of a position as a length", () => {
  const sentences = "Errors of 1e-03: projection@rk4, 606 kop to 1.1 Mop; 817 op before.";
  const study = { pareto: [{ error: "q", cost: "operations", sentences }] };
  assert.deepEqual(sentencesOf(study, "q", "operations"), [
    "Errors of 10⁻³: projection@rk4, 606 thousand operations to 1.1 million operations; 817 operations before.",
  ]);
  assert.deepEqual(sentencesOf(study, "v", "operations"), []);

  // by the names that the page has, of which one spelling may begin with another
  const two = {
    methods: [{ method: "baumgarte@rk4" }, { method: "baumgarte@rk4:h=0.1" }],
    pareto: [
      {
        error: "q",
        cost: "operations",
        sentences: "Errors of 1e-03: baumgarte@rk4:h=0.1, 606 kop; next baumgarte@rk4 at 1.45.",
      },
    ],
  };
  assert.deepEqual(
    sentencesOf(two, "q", "operations", (m) => ["Baumgarte", "Baumgarte h=0.1"][m]),
    ["Errors of 10⁻³: Baumgarte h=0.1, 606 thousand operations; next Baumgarte at 1.45."],
  );
  assert.match(
    meaningOf("q", 1.2),
    /10⁻³ is 1 mrad of an angle: 1\.2 mm at the end of a bar of 1\.2 m/,
  );
  assert.equal(meaningOf("v", 1.2), "");
});

test("a place on an axis and its value agree; contours run along the edges of the cells they part", () => {
  const axis = { scale: "log", values: [1, 10, 100] };
  assert.ok(Math.abs(placeOnAxis(axis, 10) - 1.5) < 1e-12);
  assert.equal(valueOnAxis(axis, placeOnAxis(axis, 31.6)), 31.6);
  assert.equal(valueOnAxis(axis, -4), valueOnAxis(axis, 0), "never beyond the axis");
  const rows = [
    [0, 2],
    [0, 2],
  ];
  assert.deepEqual(contourOf(rows, 1), [
    [
      [1, 0],
      [1, 1],
    ],
    [
      [1, 1],
      [1, 2],
    ],
  ]);
  assert.deepEqual(
    contourOf(
      [
        [0, NaN],
        [0, 2],
      ],
      1,
    ),
    [
      [
        [1, 1],
        [1, 2],
      ],
    ],
    "no edge beside a cell without a value",
  );
  const map = { x: { name: "alpha", values: [40] }, y: { name: "beta", values: [24] } };
  const method = { rows: [[{ margin: (0.02 * 72) / 2.785 }]] };
  assert.ok(Math.abs(baumgarteLimit(map, method, 0.02) - 2.785) < 1e-12);
});

test("axes are widened to present values beyond them, and keep their ends otherwise", () => {
  const x = { name: "k", kind: "parameter", scale: "log", values: [1, 10, 100] };
  const y = { name: "h", kind: "step", scale: "lin", values: [0.01, 0.02] };
  assert.equal(
    axesWith({ x, y }, { x: [50], y: [0.1, 0.001] }),
    "k=1..100:log,step=0.001..0.1:lin",
  );
  assert.match(axesWith({ x, y }, { x: [0], y: [] }), /^k=1\.\.100:log/);
  assert.equal(axesWith({ x: null, y }, { x: [], y: [0.015] }), "step=0.01..0.02:lin");
});

test("a budget is asked for until a time and at a step, where they are given", () => {
  const data = {
    scene: { id: "pendulum" },
    settings: {},
    methods: [{ spelling: "index1@rk4:h=0.02" }, { spelling: "index1@dop853:rtol=1e-6" }],
    catalogue: CATALOGUE,
  };
  const own = orderOf("budget", data, "");
  assert.deepEqual([own.time, own.coordinate], [undefined, undefined]);
  assert.equal(own.methods[0], "index1@rk4:h=0.02");
  const split = orderOf("budget", data, "", { coordinate: "a", time: 1.5, step: 0.005 });
  assert.deepEqual([split.time, split.coordinate], [1.5, "a"]);
  assert.deepEqual(split.methods, ["index1@rk4:h=0.005", "index1@dop853:rtol=1e-6"]);
});

test("a map over alpha and beta is asked for the methods that have them alone", () => {
  const data = {
    scene: { id: "four-bar" },
    settings: {},
    methods: [{ spelling: "index1@rk4" }, { spelling: "baumgarte:alpha=5,beta=5@rk4" }],
    catalogue: CATALOGUE,
  };
  assert.deepEqual(orderOf("stability", data, "baumgarte").methods, [
    "baumgarte:alpha=5,beta=5@rk4",
  ]);
  assert.equal(orderOf("stability", data, "limits").methods.length, 2);
  assert.ok(presetsOf(data).some(({ name }) => name === "baumgarte"));
  assert.ok(
    !presetsOf({ ...data, methods: data.methods.slice(0, 1) }).some(
      ({ name }) => name === "baumgarte",
    ),
  );
});

test("the server chooses the map unless one is chosen, and the menu has those that fit", () => {
  const stability = {
    ...STUDIES[1],
    presets: [
      {
        name: "stiffness",
        about: "",
        chooses: ["h"],
        stabilised: false,
        units: ["N/m", "N*m/rad"],
      },
      { name: "mass-ratio", about: "", chooses: ["h"], stabilised: false, units: ["kg"] },
      ...STUDIES[1].presets,
    ],
  };
  readIndex({ limits: { methods: 8 }, incidents: [], studies: [stability] });
  const names = (units, spelling) =>
    presetsOf({
      catalogue: CATALOGUE,
      methods: [{ spelling }],
      scene: { parameters: units.map((unit) => ({ unit })) },
    })
      .map(({ name }) => name)
      .sort();
  assert.deepEqual(names(["m"], "index1@rk4"), ["limits"]);
  assert.deepEqual(names(["N/m", "kg"], "index1@rk4"), ["limits", "mass-ratio", "stiffness"]);
  assert.ok(names(["N/m"], "baumgarte@rk4").includes("baumgarte"));

  // nothing but the methods is sent, and no option that some map varies makes it another study
  const methods = [{ spelling: "baumgarte:alpha=5,beta=5@rk4:h=1e-3" }];
  const data = { scene: { id: "a" }, settings: {}, methods, catalogue: CATALOGUE };
  const order = orderOf("stability", data, "");
  assert.deepEqual(Object.keys(order).sort(), ["kind", "methods", "parameters", "scene"]);
  const other = [{ spelling: "baumgarte:alpha=9,beta=2@rk4:h=1e-2" }];
  assert.equal(
    signatureOf(order),
    signatureOf(orderOf("stability", { ...data, methods: other }, "")),
  );
  readIndex({ limits: { methods: 8 }, incidents: [], studies: STUDIES });
});

test("a link names the study that is open, and no other word", () => {
  const link = { ...decodeLink("scene=a&method=b@c").link, study: "budget" };
  assert.equal(decodeLink(encodeLink(link)).link.study, "budget");
  const { link: other, faults } = decodeLink("scene=a&study=everything");
  assert.equal(other.study, "");
  assert.match(faults[0], /study is 'everything'/);
});

test("what a study chooses itself makes no other study of it", () => {
  const of = (kind, method, preset) => signatureOf({ kind, methods: [method], preset });
  const same = (kind, a, b, preset) => of(kind, a, preset) === of(kind, b, preset);
  assert.ok(same("work-precision", "index1@rk4:h=1e-3", "index1@rk4:h=1e-2"));
  assert.ok(!same("budget", "index1@rk4:h=1e-3", "index1@rk4:h=1e-2"));
  const [low, high] = [
    "baumgarte:alpha=5,beta=5@rk4:h=1e-3",
    "baumgarte:alpha=9,beta=7@rk4:h=1e-3",
  ];
  assert.ok(same("stability", low, high, "baumgarte"));
  assert.ok(!same("stability", low, high, "limits"));
  assert.ok(!same("stability", low, low.replace("1e-3", "1e-2"), "baumgarte"));
});

test("operations are counted in words, with two digits", () => {
  const said = [817, 5.47e5, 2.2431e6, 9.99e5, 3.1e9].map((n) => costText("operations", n));
  assert.deepEqual(said, [
    "820 operations",
    "550 thousand operations",
    "2.2 million operations",
    "1 million operations",
    "3.1 billion operations",
  ]);
});
