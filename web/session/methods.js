// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Actions on the methods, their options and the scene's parameters.
import { sentenceOf } from "../api/client.js";
import { limits } from "../state/catalogue.js";
import { cardOf, parseSpelling, withSetting } from "../state/spelling.js";

const FALLS_APART = ["index1", "baumgarte:alpha=5,beta=5", "projection", "nullspace", "reduced"];
const HOLDS_TOGETHER = ["baumgarte:alpha=20,beta=20", "projection", "nullspace", "reduced"];

/** A step at which differences between methods can be seen: twice the scene's own. */
const telling = (scene) => Number((2 * (scene?.step || 0.01)).toPrecision(3));

/**
 * @param {import("../state/store.js").Store} store
 * @param {import("./exchange.js").Exchange} exchange
 * @param {(text: string) => void} notice
 */
export function createMethodActions(store, exchange, notice) {
  const data = store.data;
  const spellings = () => data.methods.map(({ spelling }) => spelling);

  /** Changes one option of every method that has it. @returns {string[]} the spellings then */
  function withOption(key, value, and) {
    const change = (spelling) => withSetting(data.catalogue, spelling, key, String(value));
    const changeBoth = (spelling) =>
      and ? withSetting(data.catalogue, change(spelling), and, String(value)) : change(spelling);
    return spellings().map(changeBoth);
  }

  /**
   * Runs other methods, which move even where the old ones stood still. Where nothing moves by
   * itself, they are computed to the frame at which the old ones stood.
   * @param {string[]} methods
   */
  async function showAttempt(methods) {
    const frame = data.latest?.frame ?? 0;
    if (!data.view.stepped) {
      await exchange.change({ methods, state: "running" });
      return;
    }
    await exchange.change({ methods });
    await exchange.compute(frame);
  }

  const actions = {
    /** @param {string[]} wanted */
    async setMethods(wanted) {
      await exchange.restart({ methods: wanted });
      actions.forgetRefused();
    },
    /** Those that run now were not refused. */
    forgetRefused() {
      const there = spellings();
      actions.setRefused(data.refused.filter(({ spelling }) => !there.includes(spelling)));
    },
    /** @param {import("../state/store.js").Refused[]} refused */
    setRefused(refused) {
      data.refused = refused;
      store.emit("view");
    },
    /** Changes one option of every method that has it. @param {string} key @param {number} value */
    setSetting: (key, value) => actions.setMethods(withOption(key, value)),
    /** @param {string} name @param {number} value */
    setParameter: (name, value) =>
      exchange.restart({ parameters: { ...data.settings, [name]: value } }),
    resetParameters: () => exchange.restart({ parameters: {} }),
    /**
     * Carries out a suggestion of a card: an option, or a method in place of its kind.
     * @param {import("../state/cards.js").Try} item
     */
    async attempt(item) {
      const list = spellings();
      let place = -1;
      if (item.method) {
        const wanted = parseSpelling(item.method).formulation.name;
        const same = data.methods.findIndex(({ formulation }) => formulation === wanted);
        place = same >= 0 ? same : Math.min(list.length, limits().methods - 1);
        list[place] = item.method;
      }
      try {
        await showAttempt(item.key ? withOption(item.key, Number(item.value), item.and) : list);
        actions.forgetRefused();
        actions.select(place >= 0 ? place : data.view.selected);
      } catch (error) {
        notice(sentenceOf(error));
      }
    },
    /** Runs the methods without stabilisation, at a step where the loop visibly opens. */
    fallApart: () => actions.demonstrate(FALLS_APART),
    /** Runs methods that hold the loop closed, at the same step. */
    holdTogether: () => actions.demonstrate(HOLDS_TOGETHER),
    /** @param {string[]} formulations with their options */
    async demonstrate(formulations) {
      const known = formulations.filter((text) =>
        cardOf(data.catalogue, "formulation", parseSpelling(text).formulation.name),
      );
      const integrator = `rk4:h=${telling(data.scene)}`;
      try {
        await exchange.change({
          methods: known.map((text) => `${text}@${integrator}`),
          state: data.view.stepped ? "paused" : "running",
        });
      } catch (error) {
        notice(sentenceOf(error));
      }
    },
    /** @param {number} m */
    select(m) {
      if (m < data.methods.length) {
        data.view.selected = m;
        data.view.hidden.delete(m);
        store.emit("view");
      }
    },
    cycle: () => actions.select((data.view.selected + 1) % data.methods.length),
    /** @param {number} m @param {boolean} visible */
    setVisible(m, visible) {
      data.view.hidden[visible ? "delete" : "add"](m);
      store.emit("view");
    },
    /** @param {Partial<typeof data.view>} change */
    setView(change) {
      Object.assign(data.view, change);
      store.emit("view");
    },
  };
  return actions;
}
