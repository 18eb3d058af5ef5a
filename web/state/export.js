// SPDX-License-Identifier: GPL-3.0-or-later
// @ts-check
// The recording as text: CSV and NDJSON, one row per kept frame and method, numbers with 17 digits.
// The head of the CSV gives units. The error is the distance from the reference solution, empty
// where no reference is known.
import { errorsOf } from "./errors.js";
import { COLUMNS } from "./history.js";

/** Units of what is kept by method; the rest are counts and ratios. */
const UNITS = {
  error: "m",
  gap: "m",
  velocity_gap: "m/s",
  energy_change: "J",
  cpu: "s",
  work: "J",
  lambda_max: "N or N m",
};
const KINDS = { angle: "rad", length: "m" };

/** Numbers as they are; what is not finite is left empty. @param {number} value */
const number = (value) => (Number.isFinite(value) ? value : null);

/**
 * The columns after time and method; `unit`: "" where there is none.
 * @param {import("./store.js").Data} data
 * @returns {{name: string, unit: string}[]}
 */
export function columnsOf({ scene }) {
  const { coordinates } = scene;
  return [
    ...coordinates.map(({ name, kind }) => ({ name, unit: KINDS[kind] ?? "" })),
    ...coordinates.map(({ rate, kind }) => ({
      name: rate,
      unit: kind in KINDS ? `${KINDS[kind]}/s` : "1/s",
    })),
    ...["error", ...COLUMNS].map((name) => ({ name, unit: UNITS[name] ?? "" })),
  ];
}

/**
 * One row per frame and method, in the order of time.
 * @param {import("./store.js").Data} data
 * @returns {{t: number, method: string, values: (number | null)[]}[]}
 */
export function rowsOf({ history, methods, reference }) {
  const errors = errorsOf({ history, reference });
  return Array.from({ length: history.count }, (_, i) =>
    methods.flatMap(({ spelling }, m) => {
      if (history.ended[m] < history.t[i]) {
        return []; // it has stopped: there is nothing to report of this time
      }
      const { q, v } = history.stateAt(m, i);
      const kept = COLUMNS.map((name) => history.columns[m][name][i]);
      const values = [...q, ...v, errors[m].off[i], ...kept];
      return [{ t: history.t[i], method: spelling, values: values.map(number) }];
    }),
  ).flat();
}

/** @param {string} text */
const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/** @param {import("./store.js").Data} data */
export function toCsv(data) {
  const titles = columnsOf(data).map(({ name, unit }) => (unit ? `${name} [${unit}]` : name));
  const head = ["t [s]", "method", ...titles].map(quoted).join(",");
  const lines = rowsOf(data).map(({ t, method, values }) =>
    [t, quoted(method), ...values.map((value) => value ?? "")].join(","),
  );
  return `${[head, ...lines].join("\n")}\n`;
}

/** @param {import("./store.js").Data} data */
export function toNdjson(data) {
  const names = columnsOf(data).map(({ name }) => name);
  const lines = rowsOf(data).map(({ t, method, values }) =>
    JSON.stringify({
      t,
      method,
      ...Object.fromEntries(names.map((name, k) => [name, values[k]])),
    }),
  );
  return `${lines.join("\n")}\n`;
}
