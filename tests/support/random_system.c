// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/random_system.h"

#include "dynamics/compile/compile.h"
#include "dynamics/compile/coordinates.h"
#include "expr/construct.h"
#include "expr/diff.h"
#include "support/near.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void hn_random_begin(hn_random_system *s, const mechanism_opts *o) {
    hn_diags diags = {0};
    memset(s, 0, sizeof *s);
    s->arena = hn_arena_create(0);
    s->scene = mechanism_random(s->arena, o);
    hn_status status = hn_system_compile(s->scene, NULL, &s->sys, &diags);
    if (status != HN_OK) {
        fail_msg("seed %u: %s", o->seed, diags.item[0].message);
    }
    const hn_system_info info = hn_system_get_info(s->sys);
    s->n = info.nv;
    s->nq = info.nq;
    s->m = info.nc;
    assert_int_equal(s->n, mechanism_coordinates(s->scene));
    assert_true(s->n <= HN_RANDOM_N && s->nq <= HN_RANDOM_Q && s->m <= HN_RANDOM_M);
    assert_int_equal(hn_eval_create(s->sys, (1u << HN_TERM_COUNT) - 1, s->arena, &s->eval), HN_OK);
}

void hn_random_end(hn_random_system *s) {
    hn_eval_free(s->eval);
    hn_system_free(s->sys);
    hn_arena_free(s->arena);
}

void hn_random_state(hn_random_system *s, unsigned seed, bool closed) {
    for (int i = 0; i < s->n; i++) {
        s->user_q[i] = closed ? s->scene->coordinates[i].q0 : 1.7 * random_signed(&seed);
        s->user_v[i] = 2 * random_signed(&seed);
    }
    hn_system_from_user(s->sys, s->user_q, s->q);
    hn_system_rates_from_user(s->sys, s->user_v, s->v);
    hn_eval_run(s->eval, 0, s->q, s->v);
}

static double largest(const double *x, int n) {
    double top = 1;
    for (int i = 0; i < n; i++) {
        top = fmax(top, fabs(x[i]));
    }
    return top;
}

/// M in user rates: S' M S with v = S user_v.
static void user_mass(const hn_random_system *s, const double *M, double *out) {
    static double S[HN_RANDOM_N * HN_RANDOM_N], MS[HN_RANDOM_N * HN_RANDOM_N];
    double unit[HN_RANDOM_N] = {0}, column[HN_RANDOM_N];
    int n = s->n;
    for (int j = 0; j < n; j++) {
        unit[j] = 1;
        hn_system_rates_from_user(s->sys, unit, column);
        unit[j] = 0;
        for (int i = 0; i < n; i++) {
            S[i * n + j] = column[i];
        }
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            MS[i * n + j] = 0;
            for (int k = 0; k < n; k++) {
                MS[i * n + j] += M[i * n + k] * S[k * n + j];
            }
        }
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            out[i * n + j] = 0;
            for (int k = 0; k < n; k++) {
                out[i * n + j] += S[k * n + i] * MS[k * n + j];
            }
        }
    }
}

void hn_random_check_tree(const mechanism_opts *o) {
    static double M[HN_RANDOM_N * HN_RANDOM_N], ours[HN_RANDOM_N * HN_RANDOM_N];
    hn_random_system s;
    hn_random_begin(&s, o);
    int n = s.n;
    for (unsigned k = 1; k <= 2; k++) {
        double h[HN_RANDOM_N], T, V, f[HN_RANDOM_N];
        hn_random_state(&s, 100 * o->seed + k, false);
        mechanism_terms(s.scene, s.user_q, s.user_v, M, h, &T, &V);
        user_mass(&s, hn_eval_get(s.eval, HN_TERM_M), ours);
        assert_all_near(ours, M, (size_t)(n * n), 1e-12 * largest(M, n * n));
        hn_system_forces_to_user(s.sys, hn_eval_get(s.eval, HN_TERM_F), f);
        for (int i = 0; i < n; i++) {
            f[i] = -f[i];
        }
        assert_all_near(f, h, (size_t)n, 1e-12 * largest(h, n));
        const double *energy = hn_eval_get(s.eval, HN_TERM_ENERGY);
        assert_near(energy[0], T, 1e-12 * fmax(1, T));
        assert_near(energy[1], V, 1e-12 * fmax(1, fabs(V)));
    }
    hn_random_end(&s);
}

/// q' as expressions: what each symbol of q changes by, for rates v.
static void flow(hn_random_system *s, hn_ex *out) {
    hn_graph *g = hn_system_graph(s->sys);
    hn_system_exprs x = hn_system_get_exprs(s->sys);
    for (int i = 0, at = 0; i < s->n; i++) {
        hn_ex v = hn_graph_symbol_expr(g, x.v_symbols[i]);
        if (hn_system_position_of(s->sys, i) >= 0) {
            assert_int_equal(hn_system_position_of(s->sys, i), at);
            out[at++] = v;
            continue;
        }
        hn_ex e[4], w[3];
        for (int k = 0; k < 4; k++) {
            e[k] = hn_graph_symbol_expr(g, x.q_symbols[at + k]);
        }
        for (int k = 0; k < 3; k++) {
            w[k] = hn_scale(0.5, hn_graph_symbol_expr(g, x.v_symbols[i + k]));
        }
        out[at] = hn_num(0);
        for (int k = 0; k < 3; k++) {
            int b = (k + 1) % 3, c = (k + 2) % 3;
            out[at] = hn_sub(g, out[at], hn_mul(g, e[k + 1], w[k]));
            hn_ex parts[3] = {hn_mul(g, e[0], w[k]), hn_mul(g, e[b + 1], w[c]),
                              hn_neg(hn_mul(g, e[c + 1], w[b]))};
            out[at + k + 1] = hn_sum(g, parts, 3);
        }
        at += 4;
        i += 2;
    }
}

void hn_random_check_closure(hn_random_system *s) {
    hn_graph *g = hn_system_graph(s->sys);
    hn_system_exprs x = hn_system_get_exprs(s->sys);
    int n = s->n, m = s->m;
    hn_ex seed[HN_RANDOM_Q], rate[HN_RANDOM_M], gamma[HN_RANDOM_M], row[HN_RANDOM_N];
    flow(s, seed);
    hn_diff_forward(g, x.phi, m, x.q_symbols, seed, s->nq, rate);
    hn_diff_forward(g, rate, m, x.q_symbols, seed, s->nq, gamma);
    double *values = calloc((size_t)hn_graph_n_symbols(g), sizeof *values);
    for (int i = 0; i < s->nq; i++) {
        values[x.q_symbols[i]] = s->q[i];
    }
    for (int i = 0; i < n; i++) {
        values[x.v_symbols[i]] = s->v[i];
    }
    const double *J = hn_eval_get(s->eval, HN_TERM_J), *ours = hn_eval_get(s->eval, HN_TERM_GAMMA);
    double scale = largest(ours, m);
    for (int i = 0; i < m; i++) {
        hn_diff(g, rate[i], x.v_symbols, n, row);
        for (int j = 0; j < n; j++) {
            assert_near(J[i * n + j], hn_graph_eval(g, row[j], values), 1e-12 * scale);
        }
        assert_near(ours[i], hn_graph_eval(g, gamma[i], values), 1e-12 * scale);
    }
    free(values);
}

void hn_random_check_halves(const mechanism_opts *o, unsigned seed) {
    hn_random_system s;
    hn_random_begin(&s, o);
    hn_random_state(&s, seed, false);
    body_motion bodies[HN_RANDOM_N];
    mechanism_move(s.scene, s.user_q, s.user_v, bodies);
    const hn_joint *j = &s.scene->joints[hn_system_loop_joint(s.sys, 0)];
    const double *points = hn_eval_get(s.eval, HN_TERM_POINTS);
    double x[3], v[3], a[3];
    mechanism_point(bodies, j->parent, j->parent_at, x, v, a);
    assert_all_near(points, x, 3, 1e-12);
    mechanism_point(bodies, j->child, j->child_at, x, v, a);
    assert_all_near(points + 3, x, 3, 1e-12);
    hn_random_end(&s);
}

void hn_random_check_user(const mechanism_opts *o, unsigned seed) {
    hn_random_system s;
    hn_random_begin(&s, o);
    hn_random_state(&s, seed, false); // entries below 1.7, so rotation vectors below pi
    double q[HN_RANDOM_N], v[HN_RANDOM_N], f[HN_RANDOM_N], user_f[HN_RANDOM_N];
    hn_system_to_user(s.sys, s.q, q);
    hn_system_rates_to_user(s.sys, s.v, v);
    assert_all_near(q, s.user_q, (size_t)s.n, 1e-14);
    assert_all_near(v, s.user_v, (size_t)s.n, 1e-14);

    // any force has the same power in both kinds of rates
    double power = 0, user_power = 0;
    for (int i = 0; i < s.n; i++) {
        f[i] = i - 2.5;
        power += f[i] * s.v[i];
    }
    hn_system_forces_to_user(s.sys, f, user_f);
    for (int i = 0; i < s.n; i++) {
        user_power += user_f[i] * s.user_v[i];
    }
    assert_near(user_power, power, 1e-12);
    hn_random_end(&s);
}
