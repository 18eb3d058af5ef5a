// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/lagrangian_turns.h"

#include "dynamics/evaluate/eval.h"
#include "linalg/dense.h"
#include "support/motion.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

enum { NV = 3, NC = 2 };

void hn_turns_eigenvalues(const hn_model *m, double s[2]) {
    hn_eval *e = NULL;
    double L[NV * NV], x[NC][NV];
    assert_int_equal(m->info.nv, NV);
    assert_int_equal(m->info.nc, NC);
    assert_int_equal(hn_eval_create(m->sys, HN_TERM_M | HN_TERM_J, m->arena, &e), HN_OK);
    hn_eval_run(e, 0, m->q, m->v);
    const double *J = hn_eval_get(e, HN_TERM_J);
    memcpy(L, hn_eval_get(e, HN_TERM_M), sizeof L);
    assert_int_equal(hn_cholesky(NV, L, NV, 1e-12), HN_OK);
    for (int i = 0; i < NC; i++) {
        memcpy(x[i], J + (size_t)i * NV, sizeof x[i]);
        hn_lower_solve(NV, L, NV, x[i]);
    }
    hn_eval_free(e);
    const double s11 = hn_dot(NV, x[0], x[0]), s22 = hn_dot(NV, x[1], x[1]),
                 s12 = hn_dot(NV, x[0], x[1]), d = hypot((s11 - s22) / 2, s12);
    s[0] = (s11 + s22) / 2 - d;
    s[1] = (s11 + s22) / 2 + d;
}

double hn_turns_error(const hn_model *m, double a, int turns) {
    const double settings[HN_MAX_OPTIONS] = {a, 10, 1, turns};
    return hn_motion_acceleration_error(m, "augmented-lagrangian", settings, m->a);
}
