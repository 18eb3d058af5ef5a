// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Exhibits that run in the page, predictions to be made before a run, slips of printed lessons.
import { api, sentenceOf } from "../../api/client.js";
import { exhibitOf } from "../../state/exhibit.js";
import { h, say, set } from "../../widgets/dom.js";
import { makeThumbnail } from "../../widgets/thumbnail.js";
import { make } from "./blocks.js";

/** What the button of an exhibit says, by what it does. */
const WORDS = { run: "Run it", scene: "Open this scene", study: "Open this study" };

/**
 * @param {import("./blocks.js").Block} block
 * @param {import("./blocks.js").Kit} kit
 * @param {import("../../session/session.js").Session} actions
 * @param {{
 *   number: number, whenSeen: (seen: HTMLElement, show: () => Promise<void>) => void,
 * }} place number: in the lesson
 */
export function makeExhibit(block, kit, actions, { number, whenSeen }) {
  const { command, children } = block;
  const { scene, methods, settings, time, act, study } = exhibitOf(block);
  const picture = h("div", { class: "exhibit-picture" });
  const said = h("p", { role: "status", class: "about" });

  async function run() {
    say(said, "opening");
    try {
      await actions.loadScene(scene, { settings, methods, end: time });
      if (act === "run") {
        say(said, `runs beside this text${time > 0 ? `; look at it until ${time} s` : ""}`);
        await actions.play();
      } else {
        say(said, study ? "the study is open" : "the scene stands beside this text");
        actions.setView({ study });
      }
    } catch (error) {
      say(said, sentenceOf(error));
    }
  }

  if (scene) {
    whenSeen(picture, () =>
      api.scene(scene).then(
        (document) => picture.replaceChildren(makeThumbnail(document)),
        (error) => say(said, sentenceOf(error)),
      ),
    );
  }
  return h(
    "section",
    { class: "live exhibit", "aria-label": `Exhibit ${number}${scene ? `: ${scene}` : ""}` },
    scene ? picture : "",
    h(
      "div",
      { class: "exhibit-words" },
      ...make(children, kit),
      command
        ? h("pre", { tabindex: "0" }, h("code", {}, `holonom ${command.replace(/^holonom /, "")}`))
        : "",
      act
        ? h(
            "div",
            { class: "choices" },
            h("button", { type: "button", class: "primary", onclick: run }, WORDS[act]),
            said,
          )
        : "",
    ),
  );
}

/**
 * The answer is shown once a choice is made.
 * @param {import("./blocks.js").Block} block
 * @param {import("./blocks.js").Kit} kit
 * @param {{number: number, made: number, choose: (choice: number) => void}} place number: in the
 *   lesson, from 0; made: the choice that was made earlier, or -1
 */
export function makePrediction(
  { children, choices = [], right, after },
  kit,
  { number, made, choose },
) {
  const told = h("div", { class: "prediction-after", hidden: true }, ...make(after, kit));
  const verdict = h("p", { role: "status" });
  const buttons = choices.map((choice, i) =>
    h(
      "button",
      { type: "button", class: "plain", "aria-pressed": "false", onclick: () => pick(i, true) },
      ...make(choice.children, kit),
    ),
  );

  /** @param {number} i @param {boolean} now by a press, not remembered */
  function pick(i, now) {
    buttons.forEach((button, k) => {
      set(button, { "aria-pressed": String(k === i) });
      button.classList.toggle("right", k === right);
    });
    told.hidden = false;
    say(verdict, i === right ? "Yes." : "No: the marked answer is right.");
    if (now) {
      choose(i);
    }
  }
  if (made >= 0) {
    pick(made, false);
  }
  return h(
    "section",
    { class: "live predict", "aria-label": `Predict first, question ${number + 1}` },
    h("p", { class: "live-title" }, "Predict first"),
    ...make(children, kit),
    h("div", { class: "choices predictions" }, ...buttons),
    verdict,
    told,
  );
}

/** @param {import("./blocks.js").Block} block @param {import("./blocks.js").Kit} kit */
export const makeSlip = ({ number, children }, kit) =>
  h(
    "section",
    { class: "live slip", "aria-label": `Slip ${number} of the printed lesson` },
    h("p", { class: "live-title" }, `Slip ${number} of the printed lesson`),
    ...make(children, kit),
  );
