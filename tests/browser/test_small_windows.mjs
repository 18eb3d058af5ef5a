// SPDX-License-Identifier: GPL-3.0-or-later
// Small windows and long content must not do this: hide buttons below an edge, cut off names, lay
// words over a scale or a panel over the mechanism.
import assert from "node:assert/strict";
import { test } from "node:test";
import { createBench, drawn, playTo, screenBox, soon } from "./support.mjs";

const { open } = createBench();
const NARROW = { width: 360, height: 740 };
const TABLET = { width: 768, height: 1024 };
const LAPTOP = { width: 1366, height: 768 };

/** The box of the first element that a selector finds. */
const boxOf = (page, selector) =>
  page.evaluate((wanted) => {
    const { left, top, right, bottom } = document.querySelector(wanted).getBoundingClientRect();
    return { left, top, right, bottom };
  }, selector);

for (const viewport of [LAPTOP, NARROW]) {
  test(`the buttons of a long dialog are in sight, ${viewport.width} wide`, async (t) => {
    const page = await open(t, { viewport });
    const { height } = viewport;
    const isInSight = async (name) => {
      const button = page.locator("dialog[open]").getByRole("button", { name, exact: true });
      const box = await screenBox(button);
      assert.ok(box && box.y >= 0 && box.y + box.height <= height, `${name}: ${box?.y}`);
      await button.click({ trial: true });
    };
    await page.getByRole("button", { name: "add a method" }).click();
    await soon(() => isInSight("Add"));
    await soon(() => isInSight("Cancel"));
    await page.keyboard.press("Escape");
    await page.focus("#play");
    await page.keyboard.press("F1");
    await soon(() => isInSight("Close"));
  });
}

test("the caption of a scene is there in full beside its buttons", async (t) => {
  for (const hash of ["", "#bennett", "#parallelogram"]) {
    const page = await open(t, { viewport: LAPTOP, hash });
    await soon(async () => {
      const cut = await page.evaluate(() => {
        const { scrollWidth, clientWidth } = document.querySelector(".caption");
        return scrollWidth > clientWidth;
      });
      assert.equal(cut, false, hash);
      const [caption, over] = [await boxOf(page, ".caption"), await boxOf(page, ".over")];
      assert.ok(caption.bottom <= over.bottom + 1 && over.bottom - over.top <= 54, hash);
    });
  }
});

test("the name of the coordinate of a phase plot can be read", async (t) => {
  for (const viewport of [LAPTOP, NARROW]) {
    const page = await open(t, { viewport });
    await playTo(page, 0.5);
    await page.selectOption("#plot-lower", "phase");
    const menu = page.getByLabel("Coordinate of the phase plot").last();
    await soon(async () => {
      // the text and the arrow of the menu: "th1" takes some 20 px
      const { width } = await screenBox(menu);
      assert.ok(width >= 56, `${width} px`);
    });
  }
});

test("at 1024 px the names of the plotted quantities can be read", async (t) => {
  const page = await open(t, { viewport: { width: 1024, height: 768 } });
  for (const id of ["upper", "lower"]) {
    const { words, room } = await page.evaluate((at) => {
      const menu = document.querySelector(`#plot-${at}`);
      const { fontSize, fontFamily } = getComputedStyle(menu);
      const pen = document.createElement("canvas").getContext("2d");
      pen.font = `${fontSize} ${fontFamily}`;
      const words = pen.measureText(menu.selectedOptions[0].textContent).width;
      return { words, room: menu.clientWidth - 8 - 16 }; // its padding, and its arrow
    }, id);
    assert.ok(words <= room, `${id}: ${words} px of words in ${room} px`);
  }
  await page.getByRole("button", { name: "table" }).first().click();
  await page.locator(".twin .numbers").first().waitFor();
});

test("at 360 px the buttons of the page share one line", async (t) => {
  const page = await open(t, { viewport: NARROW });
  const tops = await page.evaluate(() =>
    [...document.querySelectorAll(".top > .choices button")].map(
      (button) => button.getBoundingClientRect().top,
    ),
  );
  assert.equal(new Set(tops).size, 1, tops.join(" "));
});

test("the scale bar ends before the words beside the lens begin", async (t) => {
  for (const hash of ["", "#stewart-6-6"]) {
    const page = await open(t, { viewport: NARROW, hash });
    await playTo(page, 0.5);
    await drawn(page);
    await soon(async () => {
      const scale = await boxOf(page, ".picture .scale");
      const words = await boxOf(page, ".tear-inset figcaption");
      assert.ok(scale.right <= words.left + 1, `${scale.right} to ${words.left}`);
    });
  }
});

test("joints keep clear of the buttons that lie over the drawing", async (t) => {
  for (const viewport of [NARROW, TABLET, LAPTOP]) {
    const page = await open(t, { viewport });
    await drawn(page);
    await soon(async () => {
      const pins = await boxOf(page, ".ghosts .ghost.selected .pins");
      const tools = await boxOf(page, ".undo-tools .quiet");
      assert.ok(pins.top >= tools.bottom, `${viewport.width}: ${pins.top} to ${tools.bottom}`);
    });
  }
});

test("names of joints in space keep clear of the buttons over the drawing", async (t) => {
  for (const viewport of [TABLET, { width: 1024, height: 768 }]) {
    const page = await open(t, { viewport, hash: "#rssr" });
    await page.waitForSelector(".stage.solid");
    await playTo(page, 1); // B is highest here
    await drawn(page);
    await soon(async () => {
      const [name, tools] = await page.evaluate(() => {
        const names = [...document.querySelectorAll(".picture .labels text")];
        const highest = names.find(({ textContent }) => textContent === "B");
        const button = [...document.querySelectorAll("button")].find(
          ({ textContent }) => textContent === "perspective",
        );
        return [highest, button].map((one) => one.getBoundingClientRect().toJSON());
      });
      assert.ok(name.top >= tools.bottom, `${viewport.width}: ${name.top} to ${tools.bottom}`);
    });
  }
});

test("a panel over the lower half leaves the mechanism and the transport in sight", async (t) => {
  for (const viewport of [NARROW, TABLET]) {
    const page = await open(t, { viewport });
    for (const [button, panel] of [
      ["lessons", ".lesson-panel"],
      ["edit", ".editor"],
    ]) {
      await page.getByRole("button", { name: button, exact: true }).click();
      await page.locator(panel).waitFor();
      await soon(async () => {
        const over = await boxOf(page, panel);
        const ghost = await boxOf(page, ".ghosts .ghost.selected");
        const transport = await boxOf(page, "#transport");
        const said = `${viewport.width}, ${button}: ${JSON.stringify([ghost, over, transport])}`;
        assert.ok(ghost.top > 0 && ghost.bottom <= over.top, said);
        assert.ok(over.bottom <= transport.top + 1 && over.bottom >= transport.top - 1, said);
      });
      await page.locator(panel).getByRole("button", { name: "close" }).click();
      await page.locator(panel).waitFor({ state: "hidden" });
    }
  }
});

test("at 200 % the guide leaves the mechanism in sight, above the transport", async (t) => {
  // 1366x768 and 1920x1080 at 200 %
  for (const viewport of [
    { width: 683, height: 384 },
    { width: 960, height: 540 },
  ]) {
    const page = await open(t, { viewport });
    await page.locator(".guide").waitFor();
    await drawn(page);
    await soon(async () => {
      const guide = await boxOf(page, ".guide");
      const picture = await boxOf(page, ".ghosts .ghost.selected");
      const transport = await boxOf(page, ".transport");
      const said = `${viewport.width}: ${JSON.stringify([guide, picture, transport])}`;
      assert.ok(guide.bottom <= picture.top && picture.bottom <= transport.top, said);
      assert.ok(picture.right - picture.left > 60, said); // [px] links can be told apart
    });
  }
});

test("the offer of the last session covers neither the lens nor the scale", async (t) => {
  for (const viewport of [LAPTOP, TABLET, NARROW]) {
    const page = await open(t, { viewport });
    await page.getByRole("button", { name: "Close the guide" }).click();
    await page.evaluate(() => (document.querySelector(".offer").hidden = false));
    const offer = await boxOf(page, ".offer");
    for (const part of [".tear-inset .glass", ".tear-inset figcaption", ".picture .scale"]) {
      const box = await boxOf(page, part);
      const apart =
        offer.right <= box.left ||
        box.right <= offer.left ||
        offer.bottom <= box.top ||
        box.bottom <= offer.top;
      assert.ok(apart, `${viewport.width}, ${part}: ${JSON.stringify([offer, box])}`);
    }
  }
});

for (const viewport of [LAPTOP, { width: 1024, height: 768 }]) {
  test(`beside the editor the verdicts are there in full, ${viewport.width} wide`, async (t) => {
    const page = await open(t, { viewport });
    await playTo(page, 0.5);
    await page.getByRole("button", { name: "edit", exact: true }).click();
    await page.locator("#editor-text").waitFor();
    await soon(async () => {
      const verdict = await boxOf(page, ".verdict-bar");
      const editor = await boxOf(page, ".editor");
      assert.ok(verdict.right <= editor.left, `${verdict.right} to ${editor.left}`);
      assert.ok(verdict.right > editor.left - 40, "and use the room beside it"); // [px] two margins
    });
  });
}

test("the letters of a lesson lie beside the ring of its focus", async (t) => {
  const page = await open(t, { viewport: LAPTOP });
  await page.getByRole("button", { name: "lessons" }).click();
  await page.locator(".lesson-text h2").first().waitFor();
  const text = await boxOf(page, ".lesson-text");
  const heading = await boxOf(page, ".lesson-text h2");
  assert.ok(heading.left - text.left >= 4, "the ring is 2 px wide"); // and as much of paper
});

test("on a telephone the first verdict is in sight above the transport", async (t) => {
  const page = await open(t, { viewport: NARROW });
  await page.getByRole("button", { name: "Close the guide" }).click();
  await playTo(page, 3);
  await soon(async () => {
    assert.match(await page.locator(".method-table tbody .words").first().innerText(), /^open by/);
    const words = await boxOf(page, ".method-table tbody .words");
    const transport = await boxOf(page, "#transport");
    assert.ok(words.bottom <= transport.top, `${words.bottom} to ${transport.top}`);
  });
});

test("the numbers of a method stand apart from each other", async (t) => {
  for (const viewport of [LAPTOP, { width: 1024, height: 768 }, NARROW]) {
    // where gap, error and energy are near rounding, and the longest
    for (const hash of ["#bennett", "#n-four-bar", "#stewart-6-6"]) {
      const page = await open(t, { viewport, hash });
      await playTo(page, 0.6);
      await soon(async () => {
        const rooms = await page.evaluate(() => {
          const names = [".gap", ".off", ".energy", ".cost"];
          return [...document.querySelectorAll(".method-table tbody tr")].flatMap((row) => {
            const boxes = names.map((name) => {
              const range = document.createRange();
              range.selectNodeContents(row.querySelector(`td${name}`));
              return range.getBoundingClientRect();
            });
            return boxes.slice(1).map((box, i) => box.left - boxes[i].right);
          });
        });
        assert.ok(Math.min(...rooms) >= 4, `${viewport.width} ${hash}: ${rooms}`); // [px] a space
      });
    }
  }
});

test("at 320 px buttons keep one line, and above a lesson the mechanism has its room", async (t) => {
  const page = await open(t, { viewport: { width: 320, height: 640 }, hash: "#four-bar" });
  const heights = await page
    .locator("#method-list .title button")
    .evaluateAll((list) => list.map((one) => one.getBoundingClientRect().height));
  assert.ok(heights.length >= 3 && Math.max(...heights) < 40, String(heights));
  const title = await boxOf(page, "#methods-title");
  const cheapest = await boxOf(page, "#method-list .title button");
  assert.ok(cheapest.top >= title.bottom || cheapest.left >= title.right + 4);

  await page.getByRole("button", { name: "lessons" }).click();
  await page.locator(".lesson-panel").waitFor();
  await soon(async () => {
    const stage = await boxOf(page, ".stage");
    const tools = await boxOf(page, ".undo-tools");
    assert.equal(tools.bottom - tools.top, 0, "no line of buttons over it");
    const names = await page
      .locator(".picture .labels text")
      .evaluateAll((list) => list.map((one) => one.getBoundingClientRect().top));
    assert.ok(
      names.every((top) => top >= stage.top),
      `${names} below ${stage.top}`,
    );
  });
});

test("where no joint is cut the words stand at the edge, clear of the mechanism", async (t) => {
  const page = await open(t, { viewport: LAPTOP, hash: "#planetary-gear" });
  await page.locator(".tear-inset.none").waitFor();
  await soon(async () => {
    const [stage, words] = [await boxOf(page, ".stage"), await boxOf(page, ".tear-inset")];
    assert.ok(Math.abs(stage.right - words.right) <= 1, `${words.right} of ${stage.right}`);
    const ring = await boxOf(page, ".picture .fixed .base");
    assert.ok(
      words.top >= ring.bottom - 1,
      `the words begin at ${words.top}, the ring ends at ${ring.bottom}`,
    );
  });
});

test("six methods have room at 1366x768: their list does not scroll", async (t) => {
  const asked = ["index1", "baumgarte", "projection", "nullspace", "reduced", "partitioning"]
    .map((name) => `&method=${name}@rk4:h=0.02`)
    .join("");
  const page = await open(t, {
    hash: `#scene=four-bar${asked}`,
    viewport: LAPTOP,
  });
  await playTo(page, 3.6);
  await soon(async () => {
    const { list, last } = await page.evaluate(() => {
      const scroll = document.querySelector(".method-scroll");
      const row = document.querySelector("tbody tr:nth-child(6)").getBoundingClientRect();
      return {
        list: scroll.scrollHeight - scroll.clientHeight,
        last: scroll.getBoundingClientRect().bottom - row.bottom,
      };
    });
    assert.equal(list, 0, "nothing of the list is out of sight");
    assert.ok(last >= 0, `the sixth row ends ${-last} px below the list`);
  });
});

test("a long verdict is in its row in full, in fewer words where it must be", async (t) => {
  const hash = "#scene=four-bar&method=baumgarte:alpha=20,beta=20@rk4:h=0.02";
  const page = await open(t, { hash, viewport: LAPTOP });
  await playTo(page, 6.4);
  const words = page.locator("tbody .words").first();
  await soon(async () =>
    assert.match(await words.innerText(), /^closed to 6\d0 µm, but \d+ mm off$/),
  );
  assert.equal(await words.evaluate((node) => node.scrollWidth > node.clientWidth), false);
  assert.match(await page.textContent("#verdict"), /but \d+ mm from the true motion/);
});
