// SPDX-License-Identifier: GPL-3.0-or-later
// Terms of random spatial mechanisms against plain body-by-body mechanics, and against
// differentiation.
#include "support/near.h"

#include "dynamics/compile/compile.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"
#include "expr/diff.h"
#include "support/mechanism.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_N = 10, MAX_M = 40, SEEDS = 40 };

typedef struct setup {
    hn_arena *arena;
    hn_scene *scene;
    hn_system *sys;
    hn_eval *eval;
    int n, m;
    double q[MAX_N], v[MAX_N], user_q[MAX_N], user_v[MAX_N];
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
    s->n = hn_system_get_info(s->sys).nv;
    s->m = hn_system_get_info(s->sys).nc;
    assert_int_equal(s->n, o->n_bodies);
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
        s->user_q[i] = closed ? s->scene->coordinates[i].q0 : 3 * random_signed(&seed);
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

/// M in scene coordinates: S' M S with v = S user_v.
static void user_mass(const setup *s, const double *M, double *out) {
    double S[MAX_N * MAX_N], unit[MAX_N] = {0}, column[MAX_N];
    int n = s->n;
    for (int j = 0; j < n; j++) {
        unit[j] = 1;
        hn_system_rates_from_user(s->sys, unit, column);
        unit[j] = 0;
        for (int i = 0; i < n; i++) {
            S[i * n + j] = column[i];
        }
    }
    for (int a = 0; a < n; a++) {
        for (int b = 0; b < n; b++) {
            out[a * n + b] = 0;
            for (int i = 0; i < n; i++) {
                for (int j = 0; j < n; j++) {
                    out[a * n + b] += S[i * n + a] * M[i * n + j] * S[j * n + b];
                }
            }
        }
    }
}

static void check_tree(const mechanism_opts *o) {
    setup s;
    begin(&s, o);
    int n = s.n;
    for (unsigned k = 1; k <= 3; k++) {
        double M[MAX_N * MAX_N], h[MAX_N], T, V, ours[MAX_N * MAX_N], f[MAX_N];
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

static void spatial_trees_have_the_mass_bias_and_energy_of_plain_mechanics(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {
            .seed = seed, .n_bodies = 1 + (int)seed % 7, .parallel = 0.5, .prismatic = 0.3};
        check_tree(&o);
    }
}

static void groups_on_moving_bases_have_it_too(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {.seed = 1000 + seed, .n_bodies = 8, .parallel = 0.75, .prismatic = 0.2};
        check_tree(&o);
    }
}

static void planar_trees_have_it_too(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {.seed = 2000 + seed, .n_bodies = 6, .prismatic = 0.3, .planar = 1};
        check_tree(&o);
    }
}

// ---- closures ----

/// J and gamma by differentiating phi itself.
static void check_closure_derivatives(setup *s) {
    hn_graph *g = hn_system_graph(s->sys);
    hn_system_exprs x = hn_system_get_exprs(s->sys);
    int n = s->n, m = s->m;
    hn_ex seed[MAX_N], rate[MAX_M], gamma[MAX_M], row[MAX_N];
    for (int i = 0; i < n; i++) {
        seed[i] = hn_graph_symbol_expr(g, x.v_symbols[i]);
    }
    hn_diff_forward(g, x.phi, m, x.q_symbols, seed, n, rate);
    hn_diff_forward(g, rate, m, x.q_symbols, seed, n, gamma);
    double values[3 * MAX_N + 8] = {0};
    for (int i = 0; i < n; i++) {
        values[x.q_symbols[i]] = s->q[i];
        values[x.v_symbols[i]] = s->v[i];
    }
    const double *J = hn_eval_get(s->eval, HN_TERM_J), *ours = hn_eval_get(s->eval, HN_TERM_GAMMA);
    double scale = largest(ours, m);
    for (int i = 0; i < m; i++) {
        hn_diff(g, x.phi[i], x.q_symbols, n, row);
        for (int j = 0; j < n; j++) {
            assert_near(J[i * n + j], hn_graph_eval(g, row[j], values), 1e-12);
        }
        assert_near(ours[i], hn_graph_eval(g, gamma[i], values), 1e-12 * scale);
    }
}

static void jacobian_and_gamma_are_the_derivatives_of_the_closure(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {.seed = 3000 + seed,
                            .n_bodies = 2 + (int)seed % 5,
                            .n_cuts = 2,
                            .parallel = 0.5,
                            .prismatic = 0.4,
                            .planar = seed % 3 == 0};
        setup s;
        begin(&s, &o);
        assert_true(s.m > 0);
        set_state(&s, seed, 0);
        check_closure_derivatives(&s);
        end(&s);
    }
}

static double norm(const double *x, int n) {
    double sum = 0;
    for (int i = 0; i < n; i++) {
        sum += x[i] * x[i];
    }
    return sqrt(sum);
}

static void world_axis(const body_motion *bodies, const hn_joint *j, double out[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] = 0;
        for (int k = 0; k < 3; k++) {
            out[i] += bodies[j->parent].R[i][k] * j->parent_axis[k];
        }
    }
}

/// Velocity of the child's half of the joint as seen from axes that turn with w about the parent's
/// half; across the axis if the joint slides along it.
static double relative_speed(const hn_joint *j, const body_motion *bodies, const double w[3]) {
    double x[2][3], v[2][3], a[2][3], axis[3], relative[3], slide = 0;
    mechanism_point(bodies, j->parent, j->parent_at, x[0], v[0], a[0]);
    mechanism_point(bodies, j->child, j->child_at, x[1], v[1], a[1]);
    world_axis(bodies, j, axis);
    for (int i = 0; i < 3; i++) {
        int b = (i + 1) % 3, c = (i + 2) % 3;
        relative[i] = v[1][i] - v[0][i] - w[b] * (x[1][c] - x[0][c]) + w[c] * (x[1][b] - x[0][b]);
        slide += relative[i] * axis[i];
    }
    for (int i = 0; i < 3 && j->type == HN_JOINT_PRISMATIC; i++) {
        relative[i] -= slide * axis[i];
    }
    return norm(relative, 3);
}

/// In a closed pose the rates of the length rows of a loop are the relative velocity of the two
/// halves, in other axes. Of a sliding joint: in the axes of the body that carries the rows'
/// directions, which may be either.
static void check_loop_rates(setup *s, const body_motion *bodies, int loop) {
    const hn_joint *j = &s->scene->joints[hn_system_loop_joint(s->sys, loop)];
    static const double none[3] = {0, 0, 0};
    double rates[MAX_M], by_parent = relative_speed(j, bodies, bodies[j->parent].w);
    double by_child = relative_speed(j, bodies, j->child == HN_GROUND ? none : bodies[j->child].w);
    int n = 0;
    for (int row = 0; row < s->m; row++) {
        if (hn_system_row_loop(s->sys, row) == loop && hn_system_row_is_length(s->sys, row)) {
            rates[n] = 0;
            for (int k = 0; k < s->n; k++) {
                rates[n] += hn_eval_get(s->eval, HN_TERM_J)[row * s->n + k] * s->v[k];
            }
            n++;
        }
    }
    double speed = norm(rates, n),
           off = fabs(speed - by_parent) < fabs(speed - by_child) ? by_parent : by_child;
    assert_near(speed, off, 1e-11);
}

static void a_closed_pose_has_no_gap_and_the_relative_velocity_of_the_halves(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        mechanism_opts o = {.seed = 4000 + seed,
                            .n_bodies = 3 + (int)seed % 4,
                            .n_cuts = 2,
                            .parallel = 0.5,
                            .prismatic = 0.4};
        setup s;
        begin(&s, &o);
        set_state(&s, seed, 1);
        for (int i = 0; i < s.m; i++) {
            assert_near(hn_eval_get(s.eval, HN_TERM_PHI)[i], 0, 1e-12);
        }
        body_motion bodies[MAX_N];
        mechanism_move(s.scene, s.user_q, s.user_v, bodies);
        for (int loop = 0; loop < 2; loop++) {
            check_loop_rates(&s, bodies, loop);
        }
        end(&s);
    }
}

static void half_joints_are_drawn_where_they_are(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 10; seed++) {
        mechanism_opts o = {
            .seed = 5000 + seed, .n_bodies = 4, .n_cuts = 1, .parallel = 0.5, .prismatic = 0.3};
        setup s;
        begin(&s, &o);
        set_state(&s, seed, 0);
        body_motion bodies[MAX_N];
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

static void planar_loops_keep_the_rows_of_the_plane(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 20; seed++) {
        mechanism_opts o = {.seed = 6000 + seed, .n_bodies = 3, .n_cuts = 1, .planar = 1};
        setup s;
        begin(&s, &o);
        assert_int_equal(s.m, 2);
        assert_int_equal(hn_system_get_info(s.sys).rows_dropped, 3);
        end(&s);
    }
}

static void user_coordinates_there_and_back(void **state) {
    (void)state;
    for (unsigned seed = 1; seed <= 10; seed++) {
        mechanism_opts o = {.seed = 7000 + seed, .n_bodies = 7, .parallel = 0.8, .prismatic = 0.2};
        setup s;
        begin(&s, &o);
        set_state(&s, seed, 0);
        double q[MAX_N], v[MAX_N], f[MAX_N], user_f[MAX_N], power = 0, user_power = 0;
        hn_system_to_user(s.sys, s.q, q);
        hn_system_rates_to_user(s.sys, s.v, v);
        assert_all_near(q, s.user_q, 7, 1e-14);
        assert_all_near(v, s.user_v, 7, 1e-14);
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spatial_trees_have_the_mass_bias_and_energy_of_plain_mechanics),
        cmocka_unit_test(groups_on_moving_bases_have_it_too),
        cmocka_unit_test(planar_trees_have_it_too),
        cmocka_unit_test(jacobian_and_gamma_are_the_derivatives_of_the_closure),
        cmocka_unit_test(a_closed_pose_has_no_gap_and_the_relative_velocity_of_the_halves),
        cmocka_unit_test(half_joints_are_drawn_where_they_are),
        cmocka_unit_test(planar_loops_keep_the_rows_of_the_plane),
        cmocka_unit_test(user_coordinates_there_and_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
