// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Special words of the page, each with the sentence that defines it.

/** @type {Record<string, {word: string, means: string}>} */
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
      "Baumgarte's α damps the velocity of the gap (2α in front of φ̇). Critical damping is α = β.",
  },
  beta: {
    word: "β",
    means:
      "Baumgarte's β pulls the gap back like a spring (β² in front of φ). dt·β must stay below the integrator's stability limit: 2.8 for RK4.",
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
    means:
      "Singular configuration: links are collinear and J loses rank. Multipliers grow without bound there, and the motion may branch.",
  },
  multipliers: {
    word: "multipliers",
    means: "Multipliers λ: the forces with which the constraints hold the loops closed.",
  },
  pivot: {
    word: "distance from singular",
    means:
      "Ratio of the smallest to the largest pivot of J: 1 is well conditioned, 0 is a singular configuration.",
  },
  cut: {
    word: "cut joint",
    means:
      "Cut joint: the joint at which a loop is opened to write its equations. Its two halves are drawn apart when the loop is open.",
  },
};
