// SPDX-License-Identifier: GPL-3.0-or-later
// Joints of every type, in the tree and closing loops, against plain body-by-body mechanics and
// against differentiation.
#include "support/near.h"

#include "dynamics/compile/compile.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"
#include "expr/construct.h"
#include "expr/diff.h"
#include "support/mechanism.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_N = 48, MAX_Q = 64, MAX_M = 24, SEEDS = 60 };

typedef struct setup {
    hn_arena *arena;
    hn_scene *scene;
    hn_system *sys;
    hn_eval *eval;
    int n, nq, m;
    double q[MAX_Q], v[MAX_N], user_q[MAX_N], user_v[MAX_N];
} setup;

static void begin(setup *s, const mechanism_opts *o) {
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
    assert_true(s->n <= MAX_N && s->nq <= MAX_Q && s->m <= MAX_M);
    assert_int_equal(hn_eval_create(s->sys, (1u << HN_TERM_COUNT) - 1, s->arena, &s->eval), HN_OK);
}

static void end(setup *s) {
    hn_eval_free(s->eval);
    hn_system_free(s->sys);
    hn_arena_free(s->arena);
}

/// A random state, or the pose of the scene's own q0 with random rates.
static void set_state(setup *s, unsigned seed, int closed) {
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
static void user_mass(const setup *s, const double *M, double *out) {
    static double S[MAX_N * MAX_N], MS[MAX_N * MAX_N];
    double unit[MAX_N] = {0}, column[MAX_N];
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

static void check_tree(const mechanism_opts *o) {
    static double M[MAX_N * MAX_N], ours[MAX_N * MAX_N];
    setup s;
    begin(&s, o);
    int n = s.n;
    for (unsigned k = 1; k <= 2; k++) {
        double h[MAX_N], T, V, f[MAX_N];
        set_state(&s, 100 * o->seed + k, 0);
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
    end(&s);
}

static void trees_of_all_joints_have_the_mass_bias_and_energy_of_plain_mechanics(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {.seed = seed,
                            .n_bodies = 1 + (int)seed % 5,
                            .parallel = 0.5,
                            .prismatic = 0.2,
                            .mixed = seed % 2 ? 1 : 0.6};
        check_tree(&o);
    }
}

/// q' as expressions: what each symbol of q changes by, for rates v.
static void flow(setup *s, hn_ex *out) {
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

static void check_closure_derivatives(setup *s) {
    hn_graph *g = hn_system_graph(s->sys);
    hn_system_exprs x = hn_system_get_exprs(s->sys);
    int n = s->n, m = s->m;
    hn_ex seed[MAX_Q], rate[MAX_M], gamma[MAX_M], row[MAX_N];
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

static const int ROWS[HN_JOINT_TYPE_COUNT] = {5, 5, 4, 4, 3, 3, 6, 0};

static void jacobian_and_gamma_are_the_derivatives_of_any_closure(void **state) {
    (void)state;
    int seen[HN_JOINT_TYPE_COUNT] = {0}, rows = 0;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {.seed = 3000 + seed,
                            .n_bodies = 2 + (int)seed % 3,
                            .n_cuts = 1 + (int)seed % 2,
                            .parallel = 0.4,
                            .prismatic = 0.2,
                            .mixed = 1};
        setup s;
        begin(&s, &o);
        set_state(&s, seed, 0);
        check_closure_derivatives(&s);
        set_state(&s, seed, 1);
        rows += s.m; // none where both bodies hang on fixed joints
        double zero[MAX_M] = {0};
        assert_all_near(hn_eval_get(s.eval, HN_TERM_PHI), zero, (size_t)s.m, 1e-12);
        for (int loop = 0; loop < o.n_cuts; loop++) {
            seen[s.scene->joints[hn_system_loop_joint(s.sys, loop)].type]++;
        }
        end(&s);
    }
    assert_true(rows > 4 * SEEDS);
    for (int type = 0; type < HN_JOINT_FREE; type++) {
        assert_true(seen[type] > 0);
    }
}

static void every_type_closes_with_the_rows_it_takes_away(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {.seed = 5000 + seed, .n_bodies = 3, .n_cuts = 1, .mixed = 1};
        setup s;
        begin(&s, &o);
        const hn_joint *joint = &s.scene->joints[hn_system_loop_joint(s.sys, 0)];
        assert_int_equal(hn_system_get_info(s.sys).rows_before, ROWS[joint->type]);
        end(&s);
    }
}

/// The place of the loop's half-joint on the body, as drawn, is where plain mechanics has it.
static void half_joints_are_drawn_where_they_are(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 20; seed++) {
        mechanism_opts o = {.seed = 6000 + seed, .n_bodies = 4, .n_cuts = 1, .mixed = 1};
        setup s;
        begin(&s, &o);
        set_state(&s, seed, 0);
        body_motion bodies[4];
        mechanism_move(s.scene, s.user_q, s.user_v, bodies);
        const hn_joint *j = &s.scene->joints[hn_system_loop_joint(s.sys, 0)];
        const double *points = hn_eval_get(s.eval, HN_TERM_POINTS);
        double x[3], v[3], a[3];
        mechanism_point(bodies, j->parent, j->parent_at, x, v, a);
        assert_all_near(points, x, 3, 1e-12);
        mechanism_point(bodies, j->child, j->child_at, x, v, a);
        assert_all_near(points + 3, x, 3, 1e-12);
        end(&s);
    }
}

// ---- positions and speeds ----

static void user_coordinates_there_and_back_and_power_is_the_same(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 20; seed++) {
        mechanism_opts o = {.seed = 7000 + seed, .n_bodies = 6, .parallel = 0.6, .mixed = 0.7};
        setup s;
        begin(&s, &o);
        set_state(&s, seed, 0); // entries below 1.7, so rotation vectors below pi
        double q[MAX_N], v[MAX_N], f[MAX_N], user_f[MAX_N], power = 0, user_power = 0;
        hn_system_to_user(s.sys, s.q, q);
        hn_system_rates_to_user(s.sys, s.v, v);
        assert_all_near(q, s.user_q, (size_t)s.n, 1e-14);
        assert_all_near(v, s.user_v, (size_t)s.n, 1e-14);
        for (int i = 0; i < s.n; i++) {
            f[i] = i - 2.5;
            power += f[i] * s.v[i];
        }
        hn_system_forces_to_user(s.sys, f, user_f);
        for (int i = 0; i < s.n; i++) {
            user_power += user_f[i] * s.user_v[i];
        }
        assert_near(user_power, power, 1e-12);
        end(&s);
    }
}

static void a_difference_is_what_moves_one_pose_to_the_other(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 20; seed++) {
        mechanism_opts o = {.seed = 8000 + seed, .n_bodies = 5, .mixed = 1};
        setup s;
        begin(&s, &o);
        set_state(&s, seed, 0);
        double to[MAX_Q], delta[MAX_N], back[MAX_N], rate[MAX_Q], ahead[MAX_Q], behind[MAX_Q];
        for (int i = 0; i < s.n; i++) {
            delta[i] = 1.2 * random_signed(&seed); // a turn below pi
        }
        memcpy(to, s.q, sizeof to);
        hn_system_move(s.sys, to, delta);
        hn_system_difference(s.sys, s.q, to, back);
        assert_all_near(back, delta, (size_t)s.n, 4e-15);
        // and kinematics is its slope: central difference, error of eps^2 and of rounding over eps
        const double eps = 1e-5;
        for (int i = 0; i < s.n; i++) {
            delta[i] = eps * s.v[i];
            back[i] = -delta[i];
        }
        memcpy(ahead, s.q, sizeof ahead);
        memcpy(behind, s.q, sizeof behind);
        hn_system_move(s.sys, ahead, delta);
        hn_system_move(s.sys, behind, back);
        hn_system_kinematics(s.sys, s.q, s.v, rate);
        for (int i = 0; i < s.nq; i++) {
            assert_near((ahead[i] - behind[i]) / (2 * eps), rate[i], 1e-9);
        }
        assert_int_equal(hn_system_normalise(s.sys, s.q), 0);
        end(&s);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trees_of_all_joints_have_the_mass_bias_and_energy_of_plain_mechanics),
        cmocka_unit_test(jacobian_and_gamma_are_the_derivatives_of_any_closure),
        cmocka_unit_test(every_type_closes_with_the_rows_it_takes_away),
        cmocka_unit_test(half_joints_are_drawn_where_they_are),
        cmocka_unit_test(user_coordinates_there_and_back_and_power_is_the_same),
        cmocka_unit_test(a_difference_is_what_moves_one_pose_to_the_other),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
