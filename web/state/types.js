// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// Shapes of the server's answers, as far as the page reads them. Types only, no code.

/**
 * A number of the scene that can be changed.
 * @typedef {{
 *   name: string, unit: string, about: string, value: number, initial: number,
 *   min: number, max: number, integer: boolean,
 * }} Parameter
 */

/**
 * A drawn shape: `p`, `q` are indices of points, `n` a number of corners, `body` an index or -1.
 * @typedef {{kind: string, p: number, q: number, n: number, width: number, body: number}} Shape
 * @typedef {{p: number, q: number, name: string}} Tear the two halves of a cut joint
 * @typedef {{points: number, labels: (string | null)[], shapes: Shape[], tears: Tear[]}} Drawing
 */

/**
 * Where a joint sits in its two bodies (-1: the ground) and along which axes.
 * @typedef {{
 *   name: string, type: string, parent: number, child: number,
 *   parent_at: number[], child_at: number[], parent_axis: number[], child_axis: number[],
 *   parent_ref: number[], child_ref: number[],
 * }} Joint
 */

/**
 * `n` coordinates, `m` constraints of rank `rank`, `dof` degrees of freedom; `length`, `points`
 * and `envelope` in m; `duration` and `step` in s. `start_parameter` and `rate_parameter`: the
 * parameters that are the start of a coordinate and of its rate.
 * @typedef {{
 *   id: string, title: string, about: string, look_for: string, exhibit: string, caption: string,
 *   parameters: Parameter[], n: number, m: number, rank: number, dof: number, length: number,
 *   drawing: Drawing,
 *   coordinates: {name: string, rate: string, kind: string, joint: string, actuated: boolean,
 *     pinned?: boolean,
 *     value: number, rate_value: number, start_parameter: string | null,
 *     rate_parameter: string | null}[],
 *   bodies: {name: string, com: number[]}[], joints: Joint[],
 *   rows: {name: string, loop: string, unit: string}[],
 *   points: number[], ground_points: number[], envelope: number[], extremes?: number[],
 *   view: {spatial: boolean, vertical: "y" | "z", right: number[], up: number[]},
 *   methods: string[], duration: number, step: number,
 * }} Scene
 */

/**
 * A method of the comparison; `slot` gives colour, dash and marker, `label` is unique.
 * @typedef {{
 *   slot: number, short: string, label: string, rule: string, drift: string,
 *   model_error: boolean, keeps_gap: boolean, order: number | null,
 *   spelling: string, formulation: string, integrator: string, title: string,
 * }} Method
 */

/**
 * A hand that holds a drawn point from a place of the world [m].
 * @typedef {{point: number, to: number[]}} Hand
 */

/**
 * One method in one frame. `worst_` are the largest values since the start.
 * @typedef {{
 *   state: string, status: string, reason: string, t: number,
 *   points?: number[], q?: number[], v?: number[],
 *   gap?: number, velocity_gap?: number, energy_change?: number,
 *   steps: number, rejected: number, evals: number, ops: number, cpu: number,
 *   work?: number, sigma_min?: number, lambda_max?: number, condition?: number,
 *   energy?: number, pull_force?: number[],
 *   error_estimate?: {
 *     q: number | null, v: number | null, reaction: number | null, own: number | null,
 *     coordinate: string, off: number | null, unit: string, t: number | null, reason: string,
 *   },
 *   step_cpu: {median: number | null, low: number | null, high: number | null, frames: number},
 *   failure?: {code: string, t: number, message: string} | null,
 *   worst_gap: number, worst_velocity_gap: number, worst_energy_change: number,
 * }} MethodFrame
 * @typedef {{
 *   generation: number, frame: number, t: number, finished: boolean, methods: MethodFrame[],
 *   pull?: Hand & {stiffness: number, damping: number} | null,
 * }} Frame
 */

/**
 * @typedef {{spelling: string, reason: string}} Refused a method that the scene cannot serve
 * @typedef {{id: string, title: string, scenes: string[], problems: string[]}} Lesson
 * @typedef {{
 *   method: number, code: string, t: number, quantity: string, value: number, limit: number,
 *   message: string, remedies: string[], tried?: string[], times?: number,
 * }} Incident times: how often its code has come so far, listed or not
 */

export {};
