// SPDX-License-Identifier: GPL-3.0-or-later
// Lessons in the page: set formulas, exhibits that run, predictions, exercises with hints and a
// check, progress, print.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
  flowing,
  formOf,
  matrixOf,
  readAnswer,
  readChoice,
  summaryOf,
} from "../../web/state/answers.js";
import { exhibitOf } from "../../web/state/exhibit.js";
import { typeset } from "../../web/state/typeset.js";
import { violations } from "./axe.mjs";
import { createBench, read, screenBox, screenshot, soon, until } from "./support.mjs";

const { open } = createBench();
const text = (words) => ({ kind: "text", text: words });
const paragraph = (...children) => ({ kind: "paragraph", children });

/** One block of every kind. */
const LESSON = {
  id: "01-closed-loops",
  title: "Every block",
  scenes: ["four-bar"],
  problems: ["p1", "p3"],
  number: 1,
  blocks: [
    { kind: "heading", level: 1, children: [text("Every block")] },
    paragraph(
      text("The gap is "),
      { kind: "math", tex: "\\varphi(q)", display: false },
      text(", "),
      { kind: "strong", children: [text("never")] },
      { kind: "break" },
      { kind: "em", children: [text("praised")] },
      { kind: "mono", text: "index1" },
      { kind: "link", href: "https://example.org/", children: [text("elsewhere")] },
      { kind: "link", href: "javascript:alert(1)", children: [text("nowhere")] },
    ),
    paragraph({ kind: "math", tex: "M\\,a = f + J^{\\mathsf T}\\lambda", display: true }),
    { kind: "heading", level: 2, children: [text("A section")] },
    {
      kind: "list",
      ordered: true,
      start: 1,
      children: [{ kind: "item", children: [text("one")] }],
    },
    { kind: "quote", children: [paragraph(text("quoted"))] },
    {
      kind: "table",
      children: [
        {
          kind: "row",
          head: true,
          children: [{ kind: "cell", align: "right", children: [text("h")] }],
        },
        {
          kind: "row",
          head: false,
          children: [{ kind: "cell", align: "right", children: [text("1")] }],
        },
      ],
    },
    { kind: "code", info: "", text: "holonom run four-bar\n" },
    { kind: "rule" },
    { kind: "figure", src: "pictures/four-bar.png", children: [text("a four-bar")] },
    {
      kind: "exhibit",
      scene: "slider-crank",
      methods: ["index1@rk4:h=0.01", "projection@rk4:h=0.01"],
      set: ["r=0.25"],
      time: 30,
      command: "compare slider-crank --methods index1@rk4:h=0.01 projection@rk4:h=0.01 --time 30",
      children: [paragraph(text("Look at the gap."))],
    },
    {
      kind: "predict",
      children: [paragraph(text("How does the gap grow?"))],
      choices: [{ children: [text("like t")] }, { children: [text("like t squared")] }],
      right: 1,
      after: [paragraph(text("Kicks to the velocity add up."))],
    },
    { kind: "slip", number: 2, children: [paragraph(text("Four angles are no four-bar."))] },
    { kind: "exercise", id: "p3", children: [paragraph(text("The Jacobian."))] },
  ],
};

/** Opens the lesson above. */
async function openLesson(t, options) {
  const page = await open(t, { bypassCSP: true, ...options });
  await page.route("**/api/v1/lessons/01-closed-loops", (route) => route.fulfill({ json: LESSON }));
  await page.getByRole("button", { name: "lessons" }).click();
  await page.waitForSelector(".lesson-text .katex");
  return page;
}

test("lines that were full flow into paragraphs; formulas, short lines and paragraphs stay", () => {
  const full = "a sentence that goes on beyond the end of its line, as the terminal";
  assert.equal(flowing(`${full}\nbreaks it\n\nnext`), `${full} breaks it\n\nnext`);
  assert.equal(
    flowing(`${full}:\n\n    phi = 0,\n    x = 1`),
    `${full}:\n\n    phi = 0,\n    x = 1`,
  );
  assert.equal(flowing("a list:\n- one\n- two"), "a list:\n- one\n- two");
  assert.equal(flowing(`${full}\n${full}\nends`), `${full} ${full} ends`);
});

test("names of an exercise have their letters and indices, and what is typed stays as it is", () => {
  const marks = { "": (text) => text, sub: (text) => `_{${text}}`, sup: (text) => `^{${text}}` };
  const cases = [
    ["l1 cos th1 - l2 cos th_2 = 0", "l_{1} cos θ_{1} − l_{2} cos θ_{2} = 0"],
    ["phi_t + sqrt(x^2 + y^2), M_r(q)", "φ_{t} + sqrt(x^{2} + y^{2}), M_{r}(q)"],
    ["J qdot = 0 and Phidot of Phi", "J q̇ = 0 and Φ̇ of Φ"],
    ["delta v of a delta robot", "δ v of a delta robot"],
    ['write "th1" or "J\' * lambda"', 'write "th1" or "J\' * lambda"'],
    [
      "then the theta\n  holonom run four-bar --set l1=2",
      "then the θ\n  holonom run four-bar --set l1=2",
    ],
    ["at -0.5 m/s^2, 2e-5, lambda_mark", "at -0.5 m/s^{2}, 2e-5, lambda_mark"],
  ];
  for (const [typed, wanted] of cases) {
    const seen = typeset(typed).map(({ text, place }) => marks[place](text));
    assert.equal(seen.join(""), wanted);
  }
});

test("what is asked is read from the exercise, what is typed is a value or a formula", () => {
  const form = '{"choice": "a", "reason": "b"}\n    (a) one\n    (b) two\n  because\n    (a) so';
  const { options, reasons } = readChoice(form);
  assert.deepEqual(options, [
    { letter: "a", text: "one" },
    { letter: "b", text: "two" },
  ]);
  assert.equal(reasons.length, 1);
  assert.deepEqual(readAnswer('["solve", "integrate"]'), ["solve", "integrate"]);
  assert.equal(readAnswer(" 0.5 "), 0.5);
  assert.equal(readAnswer("-J' * lambda"), "-J' * lambda");
  assert.deepEqual(matrixOf('{"J": [["...", "..."], ["...", "..."]]}'), {
    name: "J",
    rows: 2,
    columns: 2,
  });
  assert.equal(matrixOf("none"), null);
});

test("where a choice has a reason, the count says that they are two answers", () => {
  const summary = "4 of 5 answers are right";
  const of = (...names) => summaryOf({ summary, entries: names.map((name) => ({ name })) });
  assert.equal(
    of("a", "d.choice", "d.reason"),
    `${summary} (a choice and its reason are two answers)`,
  );
  assert.equal(of("a", "b", "reasons"), summary);
});

test("a field asks for no quotes: they belong to files of answers", () => {
  const form = (words) =>
    formOf({ id: "e", kind: "formula", points: 1, ask: "", answer_form: words });
  assert.equal(form("a formula in quotes; names: th2"), "a formula; names: th2");
  assert.equal(
    form('a number in m, or with its unit: "... m"; right to 1 %'),
    "a number in m, or with its unit: ... m; right to 1 %",
  );
});

test("an exhibit that gives a command alone has its scene, methods and options from it", () => {
  const of = (command) => exhibitOf({ kind: "exhibit", command });
  const stiff =
    "compare stiff-four-bar --set k=1e4 --set c=1e5 --methods a@b:h=1,c=2 d@e --time 1 --no-color";
  assert.deepEqual(of(stiff), {
    scene: "stiff-four-bar",
    methods: ["a@b:h=1,c=2", "d@e"],
    settings: { k: 1e4, c: 1e5 },
    time: 1,
    act: "run",
    study: "",
  });
  const short = (command) => [of(command).act, of(command).scene, of(command).study];
  assert.deepEqual(short("holonom inspect four-bar"), ["scene", "four-bar", ""]);
  assert.deepEqual(short("terms fb0 --q th1=1 th2=0.5"), ["scene", "fb0", ""]);
  assert.deepEqual(short("study pendulum work-precision --time 1"), [
    "study",
    "pendulum",
    "work-precision",
  ]);
  assert.deepEqual(short("extreme x5"), ["", "", ""], "what the page does not show has no button");
  const own = { scene: "fb0", set: ["k=2"], methods: ["a@b"], time: 3, command: "run pendulum" };
  assert.deepEqual(exhibitOf(own), {
    scene: "fb0",
    methods: ["a@b"],
    settings: { k: 2 },
    time: 3,
    act: "run",
    study: "",
  });
});

test("every comparison of a lesson can be run where it is read", async (t) => {
  const page = await open(t, { hash: "#/lessons/8" });
  const stiff = page.locator(".exhibit", { hasText: "stiff-four-bar" });
  await stiff.getByRole("button", { name: "Run it" }).click();
  await until(page, (data) => data.scene.id === "stiff-four-bar" && data.latest?.t > 0);
  assert.deepEqual(
    await read(page, (data) => [data.methods.map(({ spelling }) => spelling), data.settings]),
    [["projection@dopri5:rtol=1e-06", "ggl@radau5:rtol=1e-06"], { k: 1e4, c: 1e5 }],
  );

  // whatever has a button names what the server has
  const { scenes, lessons, studies } = await read(page, (data) => ({
    scenes: data.scenes.map(({ id }) => id),
    lessons: data.lessons.map(({ id }) => id),
    studies: Object.keys(data.studies),
  }));
  const inside = (blocks) =>
    blocks.flatMap((block) => [
      block,
      ...inside(block.children ?? []),
      ...inside(block.after ?? []),
    ]);
  for (const id of lessons) {
    const answer = await fetch(new URL(`/api/v1/lessons/${id}`, page.url()));
    const { blocks } = await answer.json();
    for (const block of inside(blocks).filter(({ kind }) => kind === "exhibit")) {
      const { act, scene, study } = exhibitOf(block);
      const words = `${id}: ${block.command}`;
      assert.ok(act || /^extreme /.test(block.command), words);
      assert.ok(!act || scenes.includes(scene), words);
      assert.ok(!study || studies.includes(study), words);
    }
  }
});

test("an exhibit runs beside its text, a prediction is kept", async (t) => {
  const page = await openLesson(t, { viewport: { width: 1366, height: 768 } });
  await soon(async () => assert.equal(await page.locator(".katex-error").count(), 0));
  await soon(async () =>
    assert.deepEqual(
      await page
        .locator(".lesson-text p:not(.about) a")
        .evaluateAll((list) => list.map(({ href }) => href)),
      ["https://example.org/"],
    ),
  );
  await page.getByRole("button", { name: "Run it" }).click();
  await until(page, (data) => data.scene.id === "slider-crank" && data.latest?.t > 0);
  await soon(async () =>
    assert.deepEqual(await read(page, (data) => data.methods.map(({ spelling }) => spelling)), [
      "index1@rk4:h=0.01",
      "projection@rk4:h=0.01",
    ]),
  );
  await soon(async () => assert.equal(await read(page, (data) => data.settings.r), 0.25));
  // as long as the text asks for, which is longer than the scene suggests
  await soon(async () =>
    assert.deepEqual(
      await read(page, (data) => [
        data.duration,
        data.scenes.find(({ id }) => id === "slider-crank").duration < 30,
      ]),
      [30, true],
    ),
  );
  // another scene, and undo: the exhibit again, to its own end
  await page.selectOption("#scene", "pendulum");
  await until(page, (data) => data.scene.id === "pendulum" && data.history.count > 0);
  await page.getByRole("button", { name: /^Undo/ }).first().click();
  await until(page, (data) => data.scene.id === "slider-crank" && data.history.count > 0);
  await soon(async () => assert.equal(await read(page, (data) => data.duration), 30));
  await page.waitForSelector(".exhibit .thumbnail");

  const after = page.locator(".prediction-after");
  await soon(async () => assert.equal(await after.isVisible(), false));
  await page.getByRole("button", { name: "like t", exact: true }).click();
  await soon(async () => assert.equal(await after.isVisible(), true));
  await soon(async () =>
    assert.match(await page.textContent(".predict"), /No: the marked answer is right/),
  );
  await page.reload();
  await page.waitForFunction(() => document.querySelector("main")?.ariaBusy === "false");
  await page.getByRole("button", { name: "lessons" }).click();
  await page.waitForSelector(".prediction-after");
  await soon(async () => assert.equal(await after.isVisible(), true));
  await page.emulateMedia({ media: "print" });
  await soon(async () => assert.equal(await page.locator("main").isVisible(), false));
  await soon(async () => assert.equal(await page.locator(".lesson-text").isVisible(), true));
});

for (const [theme, width] of [
  ["light", 1366],
  ["dark", 360],
]) {
  test(`exercises are checked, hints come in steps: ${theme}, ${width} wide`, async (t) => {
    const page = await openLesson(t, { viewport: { width, height: 780 }, colorScheme: theme });
    assert.equal(
      await page.locator(".exercise summary span").first().innerText(),
      "Exercise p3: Constraint Jacobian of the four-bar",
      "a closed exercise says what it is about",
    );
    await page.getByText("Exercise p3").click();
    await page.waitForSelector(".answer-matrix");
    const right = ["-l1*sin(th1)", "-l2*sin(th2)", "l3*sin(th3)", "l4*sin(th4)"];
    const rows = [...right, "l1*cos(th1)", "l2*cos(th2)", "-l3*cos(th3)", "0"];
    for (const [k, formula] of rows.entries()) {
      await page.locator(".answer-matrix input").nth(k).fill(formula);
    }
    await page.getByRole("button", { name: "Check" }).first().click();
    await page.waitForSelector(".verdict-list strong");
    await soon(async () =>
      assert.match(await page.textContent(".verdict-list"), /7 of 8 points.*J24/s),
    );

    await page.getByText("Exercise p1").click();
    await page.waitForSelector(".exercise fieldset");
    const second = page.locator(".exercise").nth(1);
    await second.getByRole("button", { name: "a hint" }).click();
    await second.getByRole("button", { name: /another hint/ }).click();
    await page.waitForFunction(() => document.querySelectorAll(".hints li").length === 2);
    await second
      .getByRole("radio", { name: /M is positive definite on the null space of J/ })
      .check();
    await second.getByRole("button", { name: "Check" }).click();
    await page.waitForFunction(() =>
      /of 9 points.*\(a choice and its reason are two answers\)/.test(
        document.querySelectorAll(".verdict-list")[1].textContent,
      ),
    );
    // p3 belongs to this lesson, p1 to the next
    await soon(async () =>
      assert.match(await page.textContent("#lesson option:checked"), /1 of \d exercises/),
    );
    await page.evaluate(() => document.activeElement.blur());
    await page.mouse.move(5, 5);
    await soon(async () => assert.deepEqual(await violations(page), []));
    await soon(async () =>
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width),
    );
    await page.locator(".exhibit").scrollIntoViewIfNeeded();
    await page.waitForSelector(".exhibit .thumbnail");
    await screenshot(page, `lesson-${theme}-${width}`, { seen: true });
  });
}

for (const width of [1024, 1100, 1199, 1366]) {
  test(`the verdicts end where the lesson begins: ${width} wide`, async (t) => {
    const page = await openLesson(t, { viewport: { width, height: 768 } });
    const [bar, panel] = await Promise.all(
      [".verdict-bar", ".lesson-panel"].map((one) => screenBox(page.locator(one))),
    );
    assert.ok(bar.width > 300, `${bar.width} px are too narrow for a verdict`);
    assert.ok(bar.x + bar.width <= panel.x + 0.5, `${bar.x + bar.width} > ${panel.x}`);
  });
}

test("a plot that is to be read stands above its field, and styles nothing else", async (t) => {
  const page = await open(t, { viewport: { width: 360, height: 780 }, colorScheme: "dark" });
  await page.getByRole("button", { name: "lessons" }).click();
  await page.selectOption("#lesson", "06-drift");
  await page.getByText("Exercise gap-plot").click();
  await page.waitForSelector(".exercise-plot .curve");
  const seen = await page.evaluate(() => {
    const [plot] = document.querySelectorAll(".exercise-plot");
    const text = document.querySelector(".lesson-text p");
    return {
      plots: document.querySelectorAll(".exercise-plot svg").length,
      styles: document.querySelectorAll("svg style").length,
      line: getComputedStyle(plot.querySelector(".curve")).stroke,
      words: getComputedStyle(text).color,
      width: document.documentElement.scrollWidth,
    };
  });
  assert.deepEqual(seen, { plots: 2, styles: 0, line: seen.words, words: seen.words, width: 360 });
  const first = page.locator(".exercise", { has: page.locator(".exercise-plot") });
  await first.locator("textarea").first().fill("21 m");
  const sign = () =>
    first.locator("summary").evaluate((one) => getComputedStyle(one, "::before").content);
  assert.match(await sign(), /▾/, "a box that is open says so");
  await first.getByRole("button", { name: "Check" }).click();
  await until(page, () => /times what the plot shows/.test(document.body.textContent));
});

test("every lesson of the server is shown, with no formula in error", async (t) => {
  const page = await open(t);
  await page.getByRole("button", { name: "lessons" }).click();
  const lessons = await read(page, (data) => data.lessons.map(({ id }) => id));
  const names = await page.locator("#lesson option").allTextContents();
  assert.ok(names.every((name, k) => name.startsWith(`${k + 1}. `) && !/^\d+\. \d/.test(name)));
  for (const id of lessons) {
    await page.selectOption("#lesson", id);
    await page.waitForFunction(
      (title) => document.querySelector(".lesson-text").ariaLabel === title,
      await page.evaluate(async (one) => {
        const { blocks } = await (await fetch(`/api/v1/lessons/${one}`)).json();
        const words = (list) =>
          list.map(({ text: own, tex, children }) => own ?? tex ?? words(children ?? [])).join("");
        return words(blocks.slice(0, 1));
      }, id),
    );
    await soon(async () =>
      assert.equal(await page.locator(".lesson-text .katex-error").count(), 0, id),
    );
    assert.doesNotMatch(await page.textContent(".lesson-text"), /undefined|\[object/, id);
    const loose = await page.locator(".lesson-text .math:not(.display)").evaluateAll(
      (list) =>
        list.filter(({ nextSibling: next, parentNode, textContent }) => {
          const mark = /^[.,;:!?)\]]/.test(next?.nodeType === Node.TEXT_NODE ? next.data : "");
          return mark && !parentNode.classList.contains("kept") && textContent.length < 40;
        }).length,
    );
    assert.equal(loose, 0, `${id}: a mark may begin a line behind its formula`);
    const regions = await page
      .locator(".lesson-text section[aria-label]")
      .evaluateAll((list) => list.map((one) => one.ariaLabel));
    assert.deepEqual(regions, [...new Set(regions)], `${id}: no two regions have one name`);
  }
  await soon(async () =>
    assert.equal(
      await page.getByRole("button", { name: "next", exact: true }).last().isDisabled(),
      true,
    ),
  );
});

test("the address names the lesson that is read; back returns to the one before", async (t) => {
  const page = await open(t, { hash: "#/lessons/3" });
  const reads = (id, shown = id) =>
    soon(async () => {
      assert.equal(new URL(page.url()).hash, `#/lessons/${id}`);
      assert.equal(await page.inputValue("#lesson"), shown);
    });
  const ids = await read(page, (data) => data.lessons.map(({ id }) => id));
  await reads(ids[2]);
  const turn = (name) => page.getByRole("button", { name, exact: true }).last().click();
  await turn("next");
  await reads(ids[3]);
  await turn("next");
  await reads(ids[4]);
  await page.goBack();
  await reads(ids[3]);
  await page.goBack();
  await reads(ids[2]);
  await page.goForward();
  await reads(ids[3]);

  // closed by hand the address is the scene's; the comparison has stayed the same
  const run = await read(page, (data) => data.id);
  await page.keyboard.press("Escape");
  await page.locator(".lesson-panel").waitFor({ state: "hidden" });
  await soon(async () => assert.equal(new URL(page.url()).hash, "#four-bar"));

  // an address that is typed; by number, by name, and one that is none
  for (const [typed, id] of [
    ["7", ids[6]],
    [ids[1].replace(/^\d+-/, ""), ids[1]],
  ]) {
    await page.evaluate((to) => (location.hash = `#/lessons/${to}`), typed);
    await page.locator(".lesson-panel").waitFor();
    await reads(id);
  }
  await page.evaluate(() => (location.hash = "#/lessons/99"));
  await until(page, (data) => /no lesson is called '99'; there are 1 to \d+/.test(data.notice));
  await reads(ids[1]);
  assert.equal(await read(page, (data) => data.id), run);
});

test("several lessons that were read are one step of back once they are closed", async (t) => {
  const page = await open(t, { hash: "#slider-crank" });
  const turn = (name) => page.getByRole("button", { name, exact: true }).last().click();
  const hash = (text) =>
    soon(async () => assert.equal(new URL(page.url()).hash, text, "address of the page"));
  await page.getByRole("button", { name: "lessons" }).click();
  await page.waitForSelector(".lesson-text h2");
  const first = await page.inputValue("#lesson");
  await hash(`#/lessons/${first}`);
  await turn("next");
  await soon(async () => assert.notEqual(await page.inputValue("#lesson"), first));
  await turn("next");
  await turn("close");
  await page.locator(".lesson-panel").waitFor({ state: "hidden" });
  await hash("#slider-crank");
  await page.selectOption("#scene", "pendulum");
  await hash("#pendulum");
  await page.goBack();
  await until(page, (data) => data.scene.id === "slider-crank" && data.view.panel === "");
});

test("a lesson is put on paper with every picture, seen or not", async (t) => {
  const page = await open(t, {
    init: () => {
      globalThis.print = () => {
        const empty = [...document.querySelectorAll(".lesson-text .exhibit-picture")].filter(
          (one) => !one.querySelector("svg"),
        );
        const missing = [...document.querySelectorAll(".lesson-text img")].filter(
          (one) => !(one.complete && one.naturalWidth > 0),
        );
        const folded = [...document.querySelectorAll(".lesson-text .exercise")].filter(
          (one) => !(one.open && one.querySelector(".statement")),
        );
        globalThis.printed = [empty.length, missing.length, folded.length];
      };
    },
  });
  await page.getByRole("button", { name: "lessons" }).click();
  await page.selectOption("#lesson", "01-closed-loops");
  const pictures = page.locator(".lesson-text .exhibit-picture");
  await soon(async () => assert.ok((await pictures.count()) > 1));
  assert.ok(
    await page.evaluate(() =>
      [...document.querySelectorAll(".lesson-text .exhibit-picture")].some(
        (one) => !one.querySelector("svg"),
      ),
    ),
    "some are not drawn before they are seen",
  );
  await page.getByRole("button", { name: "print", exact: true }).click();
  await page.waitForFunction(() => globalThis.printed);
  assert.deepEqual(await page.evaluate(() => globalThis.printed), [0, 0, 0]);

  // on paper a prediction has its choices, pictures keep their captions, and no frame is in focus
  await page.emulateMedia({ media: "print" });
  await soon(async () =>
    assert.equal(await page.locator(".predictions button").first().isVisible(), true),
  );
  assert.deepEqual(
    await page.evaluate(() => {
      const style = (name) => getComputedStyle(document.querySelector(name));
      document.querySelector(".lesson-text").focus();
      return [style(".lesson-text").outlineStyle, style(".lesson-text figure").breakInside];
    }),
    ["none", "avoid"],
  );

  // exercises are whole there, and folded again when that is done
  const exercises = page.locator(".lesson-text .exercise");
  assert.ok((await exercises.count()) > 4);
  assert.equal(await exercises.getByRole("button", { name: "Check" }).first().isVisible(), false);
  await page.evaluate(() => dispatchEvent(new Event("afterprint")));
  await page.emulateMedia({ media: "screen" });
  await soon(async () =>
    assert.equal(await page.locator(".lesson-text .exercise[open]").count(), 0),
  );
});
