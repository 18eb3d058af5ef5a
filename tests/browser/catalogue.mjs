// SPDX-License-Identifier: GPL-3.0-or-later
// A small catalogue of methods, in place of the server's.

export const CATALOGUE = {
  formulations: [
    { name: "index1", options: [] },
    {
      name: "baumgarte",
      options: [
        { key: "alpha", default: 5 },
        { key: "beta", default: 5 },
      ],
    },
  ],
  integrators: [{ name: "rk4", options: [{ key: "h", default: 1e-3 }] }],
};
