// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The lessons, predictions and exercises done; kept in this browser alone.

const KEY = "holonom-lessons";

/** @typedef {{read?: boolean, predicted?: Record<string, number>}} Read */

function load() {
  try {
    const kept = JSON.parse(localStorage.getItem(KEY) ?? "{}");
    return { lessons: kept.lessons ?? {}, solved: kept.solved ?? {} };
  } catch {
    return { lessons: {}, solved: {} };
  }
}

export function createProgress() {
  /**
   * @type {{
   *   lessons: Record<string, Read>, solved: Record<string, {score: number, most: number}>,
   * }}
   */
  const kept = load();
  const keep = () => localStorage.setItem(KEY, JSON.stringify(kept));
  const of = (id) => (kept.lessons[id] ??= {});
  return {
    isRead: (id) => Boolean(kept.lessons[id]?.read),
    setRead(id) {
      of(id).read = true;
      keep();
    },
    /** The choice that was made for a question; -1: none. @param {string} id @param {number} k */
    predicted: (id, k) => kept.lessons[id]?.predicted?.[k] ?? -1,
    setPredicted(id, k, choice) {
      const lesson = of(id);
      lesson.predicted = { ...lesson.predicted, [k]: choice };
      keep();
    },
    /** @param {string} problem */
    solved: (problem) => kept.solved[problem] ?? null,
    /** The best score stays. @param {string} problem @param {number} score @param {number} most */
    setSolved(problem, score, most) {
      if (score >= (kept.solved[problem]?.score ?? 0)) {
        kept.solved[problem] = { score, most };
        keep();
      }
    },
  };
}

/** @typedef {ReturnType<typeof createProgress>} Progress */
