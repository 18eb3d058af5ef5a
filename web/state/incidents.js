// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// What each kind of incident is called, and the rule behind it; the codes are the engine's.

/** @type {Record<string, {name: string, rule: string}>} */
export const INCIDENTS = {
  "near-singular": {
    name: "close to a singular pose",
    rule: "Near a pose where constraint rows become dependent the multipliers grow without bound and small errors with them.",
  },
  "rank-loss": {
    name: "constraint rows depend on each other",
    rule: "Where rows of J depend on each other only their sum of forces is determined; the least one is taken and the motion is the same.",
  },
  "branch-flip": {
    name: "jumped to the other way of assembling",
    rule: "The same lengths close in more than one way. A step that is too large can land on another one.",
  },
  "gap-open": {
    name: "the loop has opened",
    rule: "A constraint kept only as an acceleration leaves the errors of two integrations unopposed: the gap grows with time squared.",
  },
  "energy-jump": {
    name: "energy jumped",
    rule: "A closed mechanism without loads keeps its energy. A jump means the step misses the motion, closed or not.",
  },
  "energy-drift": {
    name: "energy drifted",
    rule: "A closed mechanism without loads keeps its energy. What a method loses or gains little by little is its own error, and the motion slows or speeds up with it.",
  },
  "chart-change": {
    name: "changed its coordinates",
    rule: "Minimal coordinates serve one part of the motion. At a turning point of the chosen one another must take over.",
  },
  "chart-lost": {
    name: "its coordinates no longer serve",
    rule: "Minimal coordinates serve one part of the motion. At a turning point of the chosen one the rest cannot be found from it.",
  },
  "step-limit": {
    name: "the step is at its limit",
    rule: "A step times the fastest rate must stay within the stability region of the integrator.",
  },
  "projection-failed": {
    name: "projection did not close the loop",
    rule: "Projection looks for the nearest closed pose; from too far away, or where none exists, it does not arrive.",
  },
  "newton-failed": {
    name: "Newton's method found no step",
    rule: "An implicit step is found by iteration. From a step that is too long, or near a pose where the loop loses rank, it does not arrive.",
  },
  stiff: {
    name: "held back by a stiff part",
    rule: "Something dies away much faster than the mechanism moves. An explicit step must follow it although nothing of it is left to see; an implicit one need not.",
  },
  diverged: {
    name: "diverged",
    rule: "An explicit step beyond its stability limit multiplies errors at every step.",
  },
  "step-underflow": {
    name: "the step became too small",
    rule: "The tolerance cannot be met at any step the arithmetic can still tell apart.",
  },
  budget: {
    name: "took too long",
    rule: "One frame may take a bounded time, so that the other methods are not held up.",
  },
  "rank-ahead": {
    name: "a singular pose lies ahead",
    rule: "The smallest singular value of J falls towards zero. Where it gets there constraint rows become dependent and the motion may branch or lock.",
  },
  "ill-conditioned": {
    name: "few digits of the multipliers are left",
    rule: "Accelerations and multipliers lose as many of their sixteen digits as the condition number of K has; near a singular pose it has no bound.",
  },
  "multipliers-grow": {
    name: "the multipliers grow",
    rule: "Where the rows of J become dependent ever larger multipliers balance the same loads. They are large numbers that cancel, not loads the mechanism feels.",
  },
  "solver-fallback": {
    name: "another solver took over",
    rule: "The sparse solve keeps one order of its pivots. Where one of them vanishes a dense least-norm solve answers instead: slower, and as right.",
  },
  "order-lost": {
    name: "starts again after every step",
    rule: "A multistep method earns its order from the steps before. Where the state is corrected after each step they count no more: it stays at order 1 and its steps stay short.",
  },
  "mass-singular": {
    name: "a mass that is divided by is zero",
    rule: "A link without mass leaves M without an inverse. The loops may still settle the motion, but only for methods that never form that inverse.",
  },
  "joint-limit": {
    name: "went beyond a limit",
    rule: "A limit in a scene is a mark that is watched, not a stop: no force holds the coordinate there.",
  },
};
