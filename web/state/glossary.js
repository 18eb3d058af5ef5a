// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Special words of the page, each with the sentence that defines it.

/** What Baumgarte's method demands of the gap φ. */
export const GAP_LAW = "φ̈ + 2α φ̇ + β² φ = 0";

/**
 * `match`: how texts spell the word, where they explain it.
 * @type {Record<string, {word: string, means: string, match?: RegExp}>}
 */
export const GLOSSARY = {
  gap: {
    word: "loop gap",
    means:
      "Loop gap (constraint violation) ‖φ‖: distance between the two halves of the cut joint. A closed mechanism has a gap of zero.",
  },
  error: {
    word: "error",
    means:
      "Error of position: distance of the drawn point that is farthest from the reference solution.",
  },
  reference: {
    word: "reference solution",
    means:
      "Reference solution: the motion computed in two different ways at very tight tolerance. The digits that both agree on count as the truth.",
  },
  energy: {
    word: "energy change",
    means:
      "Change of the total energy since the start, less the work of drives, dampers and loads. The true change is zero.",
  },
  velocity: {
    word: "velocity violation",
    means: "Velocity violation ‖J v + φ_t‖: how fast the loops come apart.",
  },
  ops: {
    word: "operations",
    means:
      "Arithmetic operations per step, counted exactly. Unlike a time they are the same on every machine; 'Studies' measures times as well.",
  },
  dt: {
    word: "step size",
    means:
      "Step size dt (h): time that an integrator advances in one step. Smaller steps are more accurate and cost more.",
  },
  tolerance: {
    word: "tolerance",
    means: "Relative tolerance of the integrators that choose their step by themselves.",
  },
  alpha: {
    word: "α",
    means:
      "Baumgarte's α damps the velocity of the gap (2α in front of φ̇), as a damper would. α = 0: the gap swings; α = β: it closes fastest without swinging (critical damping). Larger than β: dt·(α + √(α² − β²)), nearly dt·2α, must stay below the integrator's stability limit: 2.8 for RK4.",
  },
  beta: {
    word: "β",
    means:
      "Baumgarte's β pulls the gap back like a spring (β² in front of φ). Larger: it closes faster, but dt·β must stay below the integrator's stability limit: 2.8 for RK4.",
  },
  verdict: {
    word: "verdict",
    means:
      "The verdict takes the worst of loop gap, error of position and energy so far. A loop can be closed and the motion still be wrong.",
  },
  freedoms: {
    word: "degrees of freedom",
    means:
      "Degrees of freedom: number of coordinates minus number of independent constraints (the rank of J).",
  },
  singular: {
    word: "singular configuration",
    match: /\bsingular (configurations?|pose)\b|\b(dead|change) points?\b/i,
    means:
      "Singular configuration (change point, flat linkage): links are collinear and J loses rank. Multipliers grow without bound there, and the motion may branch. At a dead point J keeps its rank; there only one coordinate no longer determines the others.",
  },
  multipliers: {
    word: "multipliers",
    match: /\bmultipliers?\b|\|?λ\|?/i,
    means:
      "Multipliers λ: one number for each loop constraint, the force (or moment) with which it holds the loop closed. Jᵀλ are these forces along the coordinates.",
  },
  pivot: {
    word: "distance from singular",
    match: /\bpivot ratio\b/i,
    means:
      "Smallest pivot met in solving for the multipliers, relative to the size of the terms that it is the sum of: 1 is well conditioned, 0 is a singular configuration.",
  },
  sigma: {
    word: "smallest singular value σ",
    match: /σ(_min)?|\bsigma_min\b|\bsmallest singular value\b/i,
    means:
      "Smallest singular value σ of J: the smallest stretch that J gives to any velocity. It is 0 in a singular configuration, where J loses rank.",
  },
  condition: {
    word: "condition number",
    match: /\bcondition number\b/i,
    means:
      "Condition number of J: its largest over its smallest singular value. With 10⁶, six of sixteen digits of the multipliers are lost; in a singular configuration it is infinite.",
  },
  evaluations: {
    word: "evaluations",
    match: /\bevaluations?\b/i,
    means:
      "Evaluations: how often the accelerations (or residuals) were computed. A step of RK4 takes four; an implicit step takes several for each iteration.",
  },
  branch: {
    word: "branch",
    match: /\bbranch(es)?\b|\bassembly modes?\b/i,
    means:
      "Branch (assembly mode): one of the ways in which the same links can be put together. A method can jump from one to another: the loop is closed, the mechanism is the wrong one.",
  },
  drift: {
    word: "drift",
    match: /\bdrifts?\b|\bdrifted\b/i,
    means:
      "Drift: an error that grows a little with every step because nothing in the equations pushes it back.",
  },
  truncation: {
    word: "truncation error",
    match: /\btruncation( errors?)?\b/i,
    means:
      "Truncation error: what a step of finite length leaves out. Half the step makes that of RK4 about 16 times smaller in a run.",
  },
  rank: {
    word: "rank",
    match: /\bloses rank\b|\brank\b/i,
    means:
      "Rank of J: number of independent constraints. Where it falls, some multipliers and velocities are no longer determined.",
  },
  magnified: {
    word: "magnified",
    means:
      "Magnification: at ×20 the circle shows the gap of the cut joint 20 times as large as the drawing beside it.",
  },
  cut: {
    word: "cut joint",
    match: /\bcut joints?\b|\bcuts?\b/i,
    means:
      "Cut joint: the joint at which a loop is opened to write its equations. Its two halves are drawn apart when the loop is open.",
  },
};

/**
 * A text in pieces: plain ones, and special words where each first stands.
 * @param {string} text
 * @returns {{key: string, text: string}[]} key: of the glossary, or ""
 */
export function termsIn(text) {
  const found = Object.entries(GLOSSARY)
    .flatMap(([key, { match }]) => {
      const hit = match?.exec(text);
      return hit ? [{ key, from: hit.index, to: hit.index + hit[0].length }] : [];
    })
    .sort((a, b) => a.from - b.from || b.to - a.to);
  const pieces = [];
  let at = 0;
  for (const { key, from, to } of found) {
    if (from >= at) {
      pieces.push({ key: "", text: text.slice(at, from) }, { key, text: text.slice(from, to) });
      at = to;
    }
  }
  return [...pieces, { key: "", text: text.slice(at) }].filter((piece) => piece.text !== "");
}
