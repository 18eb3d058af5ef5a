// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/assembly/assemble_state.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/compile/quaternion.h"
#include "linalg/dense.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

bool hn_assemble_evaluate(hn_assembler *s) {
    hn_system_from_user(s->sys, s->x, s->q);
    hn_eval_run(s->eval, s->t, s->q, s->rest);
    const double *phi = hn_eval_get(s->eval, HN_TERM_PHI);
    for (int i = 0; i < s->nc; i++) {
        s->residual[i] = s->row_scale[i] * phi[i];
    }
    int finite = hn_all_finite(s->nc, s->residual);
    s->size = finite ? hn_norm2(s->nc, s->residual) : HUGE_VAL;
    return finite;
}

void hn_assemble_move(const hn_assembler *s, double *x, const double *delta) {
    for (int i = 0; i < s->n; i++) {
        if (s->turn[i] < 0) {
            x[i] += delta[i];
        } else if (s->turn[i] == 0) {
            double turned[4];
            hn_quat_exp(x + i, turned);
            hn_quat_move(turned, delta + i);
            hn_quat_log(turned, x + i);
        }
    }
}

double hn_assemble_moved(const hn_assembler *s, int i) {
    if (s->turn[i] < 0) {
        return fabs(s->x[i] - s->guess[i]);
    }
    double from[4], to[4], delta[3];
    hn_quat_exp(s->guess + i - s->turn[i], from);
    hn_quat_exp(s->x + i - s->turn[i], to);
    hn_quat_difference(from, to, delta);
    return hn_norm2(3, delta);
}

const double *hn_assemble_dense(const hn_assembler *s, hn_term term) {
    double *dense = term == HN_TERM_M ? s->M : s->J;
    hn_eval_spread(s->eval, term, dense);
    return dense;
}

void hn_assemble_user_row(const hn_assembler *s, int row, double *out) {
    const double *J = hn_assemble_dense(s, HN_TERM_J) + (size_t)row * s->n;
    memset(out, 0, (size_t)s->n * sizeof *out);
    for (int i = 0; i < s->n; i++) {
        for (int k = J[i] != 0 ? i : -1; k >= 0; k = s->rates.base[k]) {
            out[k] += J[i] * s->rates.sign[k];
        }
    }
}

double hn_assemble_gap(const hn_assembler *s, int loop) {
    const double *phi = hn_eval_get(s->eval, HN_TERM_PHI);
    double sum = 0;
    for (int i = 0; i < s->nc; i++) {
        if (loop < 0 || hn_system_row_loop(s->sys, i) == loop) {
            sum += phi[i] * phi[i];
        }
    }
    return sqrt(sum);
}
