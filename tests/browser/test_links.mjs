// SPDX-License-Identifier: GPL-3.0-or-later
// Links, without a browser: the same after reading and writing; damaged entries are named.
import assert from "node:assert/strict";
import { test } from "node:test";
import { readIndex } from "../../web/state/catalogue.js";
import { decodeLink, encodeLink, fits } from "../../web/state/link.js";
import { nearest } from "../../web/state/near.js";
import { firstPlots, showLinked, shownOf } from "../../web/state/shown.js";
import { damaged, randomFrom } from "./damage.mjs";

const preset = {
  name: "baumgarte",
  about: "",
  chooses: ["alpha", "beta"],
  stabilised: true,
  units: [],
};
const STUDIES = ["work-precision", "stability", "budget"].map((name) => ({
  name,
  about: "",
  chooses: [],
  fields: [],
  presets: name === "stability" ? [preset] : [],
}));
readIndex({ limits: { methods: 8 }, incidents: [], studies: STUDIES });

test("a link says the same after it was read and written again", () => {
  let seed = 7;
  const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
  const pick = (list) => list.filter(() => random() < 0.5);
  for (let k = 0; k < 2000; k++) {
    const text = encodeLink({
      scene: pick(["four", "bar", "6", "ä b&c=d"]).join("-") || "x",
      settings: Object.fromEntries(
        pick(["l1", "g", "th_0"]).map((name) => [
          name,
          (random() - 0.5) * 10 ** (12 * random() - 6),
        ]),
      ),
      methods: pick(["index1@rk4:h=1e-3", "baumgarte:alpha=5,beta=5@dopri5:rtol=1e-8", "ggl@ida"]),
      frame: Math.floor(random() * 5000),
      selected: Math.floor(random() * 8),
      hidden: pick([0, 1, 2, 3]),
      show: pick(["labels", "traces", "reference", "arrows", "reactions"]),
      study: ["", "work-precision", "stability", "budget"][k % 4],
      map: ["", "baumgarte"][k % 2],
      judged: ["", "th3", "theta_coupler"][k % 3],
      until: [0, 1.25, 1e-3][k % 3],
      step: [0, 0.0028][k % 2],
      budget: ["", "energy"][k % 2],
      look: pick([0.5]).flatMap(() => [0.5, -1.25]),
      camera: pick([1]).flatMap(() => [2.5, 0.1, -3, 1e-4]),
      upper: pick(["off", "energy_change,turned", "phase,of:th1", "work,table"])
        .slice(0, 1)
        .flatMap((text) => text.split(",")),
      zoom: pick([1]).flatMap(() => [0.25, 1.75]),
      why: [-1, 0, 3][k % 3],
      speed: [0, 1, 0.05, 10][k % 4],
      panel: ["", "lessons", "editor"][k % 3],
      lesson: ["", "02-holding-loops"][k % 2],
      pulls: pick([
        [30, 2, 1.25, -0.5, 0, 300.125, 30.5],
        [31, 2, 1.5, -0.5, 0, 300.125, 30.5],
        [40, 1, 0, 0, 0, 0, 0],
      ]),
      note: pick(["why?", "a=b&c", "ü\n2 %", "#"]).join(" "),
      build: "0.1.0 gcc 12.2.0",
    });
    const { link, faults } = decodeLink(text);
    assert.deepEqual(faults, []);
    assert.equal(encodeLink(link), text);
  }
  assert.ok(!fits("x".repeat(5000)));
});

test("what is shown goes into a link and comes back: plots, zoom, camera, panels", () => {
  const view = {
    ...{ labels: false, traces: true, reference: true, arrows: true, reactions: false },
    ...{ equations: true, parameters: true, lengths: false, loop: true, why: 1 },
    look: null,
    space: null,
    plots: {
      ...firstPlots(),
      lower: { of: "phase", turned: false, table: true, coordinate: "a2" },
    },
    zoom: [0.5, 1.5],
    study: "stability",
    map: "baumgarte",
    judged: "th3",
    split: { scene: "a", time: 1.25, step: 0.005 },
    budget: "energy",
    panel: "lessons",
    lesson: "02",
  };
  const scene = { id: "a", view: {}, coordinates: [{ name: "th1" }, { name: "th3" }] };
  const data = { view, scene, speed: 2, methods: [{}, {}], lessons: [{ id: "02" }] };
  const { link, faults } = decodeLink(encodeLink({ scene: "a", ...shownOf(data) }));
  assert.deepEqual(faults, []);
  assert.equal(link.speed, 2);
  const other = { ...data, view: {} };
  assert.deepEqual(showLinked(other, link), []);
  assert.deepEqual(other.view, view);

  // the budget of another scene is none of this one's, and a name that is not here is told
  const elsewhere = { ...data, scene: { id: "b", view: {}, coordinates: [{ name: "x" }] } };
  const { judged, until, step } = shownOf(elsewhere);
  assert.deepEqual([judged, until, step], ["", 0, 0]);
  assert.deepEqual(showLinked({ ...elsewhere, view: {} }, link), ["no coordinate is called 'th3'"]);

  const space = { camera: [2, 0.1, 0, -1], perspective: false, follow: true, frames: false };
  const look = { right: [0, 0, -1], up: [0, 1, 0] };
  const solid = { ...data, scene: { ...scene, view: { spatial: true, vertical: "y" } } };
  solid.view = { ...view, space, look };
  const again = { ...solid, view: {} };
  showLinked(again, decodeLink(encodeLink({ scene: "a", ...shownOf(solid) })).link);
  assert.deepEqual(again.view.space, space);
  again.view.look.right.forEach((x, k) => assert.ok(Math.abs(x - look.right[k]) < 1e-4));
  assert.deepEqual(showLinked({ ...data, view: {}, lessons: [] }, link), [
    "no lesson is called '02'",
  ]);
});

test("a misspelt name finds those that it may stand for", () => {
  const names = ["four-bar", "stewart-6-6", "stewart-6-3", "five-bar", "n-four-bar", "rssr"];
  assert.deepEqual(nearest("stewart", names), ["stewart-6-6", "stewart-6-3"]);
  assert.equal(nearest("four-baar", names)[0], "four-bar");
  assert.deepEqual(nearest("zzzzzz", names), []);
  assert.deepEqual(nearest("", names), []);
});

test("10,000 tampered links: nothing throws, a damaged entry takes no other entry with it", () => {
  const whole = encodeLink({
    scene: "four-bar",
    settings: { l1: 0.52, th1_0: -1e-3 },
    methods: ["index1@rk4:h=0.02", "baumgarte:alpha=5,beta=20@rk4:h=0.02", "ggl@radau5:rtol=1e-6"],
    frame: 120,
    selected: 1,
    hidden: [2],
    show: ["labels", "arrows"],
    study: "stability",
    look: [0.5, 0.25],
    camera: [2, 0.1, 0, 0],
    upper: ["energy_change", "turned"],
    zoom: [1, 2],
    why: 1,
    speed: 2,
    map: "baumgarte",
    note: "predict first & say why: 50 %",
    build: "0.1.0 gcc 12.2.0",
  });
  const entries = whole.split("&");
  const random = randomFrom(11);
  for (let k = 0; k < 10000; k++) {
    const at = random(entries.length);
    const others = entries.filter((_, i) => i !== at);
    const changed = entries.map((entry, i) => (i === at ? damaged(entry, random) : entry));
    const got = decodeLink(changed.join("&"));
    const want = decodeLink(others.join("&")).link;
    const name = entries[at].split("=")[0];
    for (const key of ["scene", "frame", "selected", "study", "note", "build"]) {
      // a damaged name may have become that of another entry, which comes later and counts
      if (key !== name && !changed[at].startsWith(`${key}=`)) {
        assert.equal(got.link[key], want[key], `${changed[at]} changes ${key}`);
      }
    }
    assert.ok(want.methods.every((method) => got.link.methods.includes(method)));
    Object.entries(want.settings).forEach(([key, value]) => {
      if (!changed[at].startsWith(`set.${key}=`)) {
        assert.equal(got.link.settings[key], value);
      }
    });
    assert.ok(got.link.methods.every((method) => method.includes("@")));
    assert.ok(Object.values(got.link.settings).every(Number.isFinite));
    assert.ok([got.link.frame, got.link.selected].every((n) => Number.isInteger(n) && n >= 0));
    assert.ok([0, 2].includes(got.link.look.length) && [0, 4].includes(got.link.camera.length));
    assert.ok(got.link.upper.length === 0 || typeof got.link.upper[0] === "string");
    assert.ok(got.faults.every((fault) => typeof fault === "string" && fault.length > 0));
  }
});

test("a link that was changed or cut off names the field, and the rest is read", () => {
  assert.equal(decodeLink("four-bar").link.scene, "four-bar");
  const { link, faults } = decodeLink(
    "scene=four-bar&set.l1=much&method=index1&method=index1@rk4:h=1e-3&frame=-2&show=labels,sound&colour=red&build=%E2%8",
  );
  assert.equal(link.scene, "four-bar");
  assert.deepEqual(link.methods, ["index1@rk4:h=1e-3"]);
  assert.deepEqual(link.settings, {});
  assert.deepEqual(
    faults.map((fault) => fault.split(" ").slice(0, 2).join(" ")),
    ["l1 is", "method has", "frame is", "show names", "no field", "'build=%E2%8' is"],
  );
  // the server takes no request with a zero character: it would cost the other entries too
  const zero = decodeLink("scene=four-bar&method=index1@rk4:h=1e-3&method=projection@rk4:h%00=1");
  assert.deepEqual(zero.link.methods, ["index1@rk4:h=1e-3"]);
  assert.deepEqual(zero.faults, ["'method=projection@rk4:h%00=1' holds a zero character"]);
});
