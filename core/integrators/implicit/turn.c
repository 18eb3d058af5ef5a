// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/implicit/turn.h"

#include <math.h>

void hn_turn_rate(const double *x, double *u) {
    const double a = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    // the series where the quotient cancels: its next term is a^4 / 30240
    const double k = a < 1e-2 ? 1.0 / 12 + a * a / 720 : (1 - a / 2 / tan(a / 2)) / (a * a);
    const double once[3] = {x[1] * u[2] - x[2] * u[1], x[2] * u[0] - x[0] * u[2],
                            x[0] * u[1] - x[1] * u[0]};
    const double twice[3] = {x[1] * once[2] - x[2] * once[1], x[2] * once[0] - x[0] * once[2],
                             x[0] * once[1] - x[1] * once[0]};
    for (int i = 0; i < 3; i++) {
        u[i] += once[i] / 2 + k * twice[i];
    }
}
