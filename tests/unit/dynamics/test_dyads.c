// SPDX-License-Identifier: GPL-3.0-or-later
// Position analysis in closed form: recognised where it exists, equal to what Newton's method
// finds, on the branch of the start.
#include "dynamics/analyse/dyads.h"

#include "dynamics/evaluate/eval.h"
#include "expr/diff.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

typedef struct probe {
    hn_model model;
    hn_dyads *dyads;
    hn_eval *loop;
    int dep[64], n_dep, ind;
} probe;

/// All but this user coordinate (the system's of the same number) depend on it.
static void open_probe(probe *p, const char *name, const char *independent) {
    memset(p, 0, sizeof *p);
    hn_model_open_closed(&p->model, name, NULL);
    p->ind = hn_model_user(&p->model, independent);
    for (int i = 0; i < p->model.info.nv; i++) {
        if (i != p->ind) {
            p->dep[p->n_dep++] = i;
        }
    }
    assert_int_equal(hn_dyads_create(p->model.sys, p->dep, p->n_dep, p->model.arena, &p->dyads),
                     HN_OK);
    assert_int_equal(hn_eval_create(p->model.sys, HN_TERM_PHI, p->model.arena, &p->loop), HN_OK);
}

static void close_probe(probe *p) {
    hn_dyads_free(p->dyads);
    hn_eval_free(p->loop);
    hn_model_close(&p->model);
}

static double gap(probe *p, const double *q) {
    double worst = 0;
    hn_eval_run(p->loop, 0, q, NULL);
    for (int i = 0; i < p->model.info.nc; i++) {
        worst = fmax(worst, fabs(hn_eval_get(p->loop, HN_TERM_PHI)[i]));
    }
    return worst;
}

static void mechanisms_fall_apart_into_the_groups_of_the_textbooks(void **state) {
    (void)state;
    static const struct {
        const char *scene, *independent;
        int steps, dyads;
        hn_dyad_kind first; // of all dyads or, where there are none, of the first step
    } known[] = {{"fb0", "th1", 1, 1, HN_DYAD_RRR},
                 {"fb0-lagrangian", "th1", 1, 1, HN_DYAD_RRR},
                 {"slider-crank", "th1", 2, 0, HN_DYAD_TURN},
                 {"watt-six-bar", "th1", 2, 2, HN_DYAD_RRR},
                 {"stephenson-six-bar", "th1", 2, 2, HN_DYAD_RRR},
                 {"quick-return", "th1", 3, 1, HN_DYAD_RPR},
                 {"seven-body-squeezer", "beta", 3, 3, HN_DYAD_RRR},
                 {"peaucellier", "th", 3, 3, HN_DYAD_RRR}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        probe p;
        open_probe(&p, known[k].scene, known[k].independent);
        assert_null(hn_dyads_refusal(p.dyads));
        assert_int_equal(hn_dyads_count(p.dyads), known[k].steps);
        assert_int_equal(hn_dyads_proper(p.dyads), known[k].dyads);
        assert_int_equal(hn_dyads_at(p.dyads, 0).kind, known[k].first);
        close_probe(&p);
    }
}

static void the_coupler_of_fb0_follows_the_formula_with_the_arc_cosine(void **state) {
    (void)state;
    // th2 = arg e +- acos((l2^2 + |e|^2 - l3^2) / (2 l2 |e|)), e = O3 - A, for an open four-bar the
    // sign is +
    probe p;
    open_probe(&p, "fb0-lagrangian", "th1");
    const hn_scene *scene = p.model.scene;
    const double l1 = scene->params[hn_scene_find_param(scene, "l1")].value,
                 l2 = scene->params[hn_scene_find_param(scene, "l2")].value,
                 l3 = scene->params[hn_scene_find_param(scene, "l3")].value,
                 d = scene->params[hn_scene_find_param(scene, "d")].value;
    assert_int_equal(hn_dyads_take_branch(p.dyads, 0, p.model.q), 1);
    double q[3] = {p.model.q[0], p.model.q[1], p.model.q[2]};
    const double e0x = d - l1 * cos(q[0]), e0y = -l1 * sin(q[0]);
    const double start = atan2(e0y, e0x), L0 = hypot(e0x, e0y);
    const double side =
        cos(q[1] - start - acos((l2 * l2 + L0 * L0 - l3 * l3) / (2 * l2 * L0))) > 1 - 1e-9 ? 1 : -1;
    for (int k = 0; k < 200; k++) { // the crank goes round
        q[0] += 0.05;
        assert_int_equal(hn_dyads_solve(p.dyads, 0, q), -1);
        const double ex = d - l1 * cos(q[0]), ey = -l1 * sin(q[0]), L = hypot(ex, ey);
        const double by_cosine =
            atan2(ey, ex) + side * acos((l2 * l2 + L * L - l3 * l3) / (2 * l2 * L));
        assert_near(remainder(q[1] - by_cosine, 2 * M_PI), 0, 1e-13);
        assert_true(gap(&p, q) < 1e-14);
    }
    close_probe(&p);
}

/// A scene of formulas with the crank's angle a and two unknowns behind it.
#define CRANK_AND(first, unit, second, rows)                                           \
    "{\"holonom\":1,\"name\":\"x\",\"lagrangian\":{\"coordinates\":["                  \
    "{\"name\":\"a\",\"rate\":\"da\"},{\"name\":\"" first "\",\"rate\":\"d" first      \
    "\",\"unit\":\"" unit "\"},{\"name\":\"" second "\",\"rate\":\"d" second           \
    "\",\"unit\":\"m\"}],"                                                             \
    "\"kinetic\":\"(da^2+d" first "^2+d" second "^2)/2\",\"constraints\":[" rows "]}," \
    "\"start\":{\"positions\":{\"a\":0.3,\"" second "\":{\"guess\":2.5}}}}"

static void open_text(probe *p, const char *text) {
    memset(p, 0, sizeof *p);
    hn_model_open_text(&p->model, text, NULL);
    assert_int_equal(p->model.status, HN_OK);
    p->dep[0] = 1;
    p->dep[1] = 2;
    p->n_dep = 2;
    assert_int_equal(hn_dyads_create(p->model.sys, p->dep, 2, p->model.arena, &p->dyads), HN_OK);
    assert_int_equal(hn_eval_create(p->model.sys, HN_TERM_PHI, p->model.arena, &p->loop), HN_OK);
    assert_null(hn_dyads_refusal(p->dyads));
    assert_int_equal(hn_dyads_count(p->dyads), 1);
    assert_int_equal(hn_dyads_take_branch(p->dyads, 0, p->model.q), 1);
}

// a line at the angle g, cos g = 0.8: across it 2 sin(b - g) + 0.8 sin a - 0.6 (cos a + 0.1) = 0
static void a_slide_on_an_oblique_line_follows_the_arc_sine(void **state) {
    (void)state;
    probe p;
    open_text(
        &p, CRANK_AND("b", "rad", "s", "\"cos(a)+0.1+2*cos(b)-0.8*s\",\"sin(a)+2*sin(b)-0.6*s\""));
    assert_int_equal(hn_dyads_at(p.dyads, 0).kind, HN_DYAD_RRP);
    double q[3] = {p.model.q[0], p.model.q[1], p.model.q[2]};
    const double g = atan2(0.6, 0.8);
    assert_true(cos(q[1] - g) > 0); // the slide stands ahead of the crank
    for (int k = 0; k < 200; k++) { // the crank goes round
        q[0] += 0.05;
        assert_int_equal(hn_dyads_solve(p.dyads, 0, q), -1);
        const double x = cos(q[0]) + 0.1, y = sin(q[0]), b = asin((0.6 * x - 0.8 * y) / 2);
        assert_near(remainder(q[1] - g - b, 2 * M_PI), 0, 1e-13);
        assert_near(q[2], 0.8 * x + 0.6 * y + 2 * cos(b), 1e-13);
        assert_true(gap(&p, q) < 1e-14);
    }
    close_probe(&p);
}

// u and w solve two linear equations with the determinant -0.76, in one way
static void two_slides_are_where_two_lines_meet(void **state) {
    (void)state;
    probe p;
    open_text(&p, CRANK_AND("u", "m", "w", "\"cos(a)-0.8*u-0.6*w\",\"sin(a)-0.6*u+0.5*w\""));
    assert_int_equal(hn_dyads_at(p.dyads, 0).kind, HN_DYAD_PRP);
    assert_null(hn_dyads_sign_name(p.dyads, 0));
    double q[3] = {p.model.q[0], p.model.q[1], p.model.q[2]};
    for (int k = 0; k < 200; k++) {
        q[0] += 0.05;
        assert_int_equal(hn_dyads_solve(p.dyads, 0, q), -1);
        assert_near(q[1], (0.5 * cos(q[0]) + 0.6 * sin(q[0])) / 0.76, 1e-14);
        assert_near(q[2], (0.6 * cos(q[0]) - 0.8 * sin(q[0])) / 0.76, 1e-14);
        assert_true(gap(&p, q) < 1e-14);
    }
    close_probe(&p);
}

static void what_cannot_be_closed_is_named_and_leaves_the_pose_alone(void **state) {
    (void)state;
    probe p;
    open_probe(&p, "fb0-lagrangian", "th3");
    double q[3] = {p.model.q[0], p.model.q[1], p.model.q[2]};
    assert_int_equal(hn_dyads_take_branch(p.dyads, 0, q), 1);
    q[2] = 0; // the rocker points away: its tip is 4 m from the crank's pivot, the links reach 3 m
    const double before[3] = {q[0], q[1], q[2]};
    assert_int_equal(hn_dyads_solve(p.dyads, 0, q), 0);
    assert_memory_equal(q, before, sizeof q);
    close_probe(&p);
}

static void what_hangs_together_is_left_to_newton_and_named(void **state) {
    (void)state;
    probe p;
    memset(&p, 0, sizeof p);
    hn_model_open_closed(&p.model, "3-rrr", NULL);
    for (int i = 0; i < p.model.info.nv; i++) {
        const int user = hn_system_user_coordinate(p.model.sys, i);
        if (!p.model.scene->coordinates[user].actuated) {
            p.dep[p.n_dep++] = i;
        }
    }
    assert_int_equal(hn_dyads_create(p.model.sys, p.dep, p.n_dep, p.model.arena, &p.dyads), HN_OK);
    assert_non_null(strstr(hn_dyads_refusal(p.dyads), "4 unknowns appear together"));
    assert_non_null(strstr(hn_dyads_refusal(p.dyads), "theta_platform"));
    hn_dyads_free(p.dyads);
    hn_model_close(&p.model);
}

/// What is told of step k, evaluated at the closed pose whose entries are in x by symbol number.
static void assert_told_is_true(const probe *p, const char *name, int k, double *x) {
    hn_graph *g = hn_system_graph(p->model.sys);
    const hn_dyad d = hn_dyads_at(p->dyads, k);
    if (hn_dyads_sign_name(p->dyads, k)) {
        const double sign = hn_dyads_sign(p->dyads, k);
        assert_near(fabs(sign), 1, 0);
        x[hn_graph_find_symbol(g, hn_dyads_sign_name(p->dyads, k))] = sign;
    }
    for (int i = 0; i < hn_dyads_n_parts(p->dyads, k); i++) {
        const hn_dyad_part part = hn_dyads_part(p->dyads, k, i);
        x[hn_ex_symbol(g, part.name)] = hn_graph_eval(g, part.is, x);
    }
    for (int i = 0; i < d.n; i++) {
        const double q = p->model.q[hn_system_position_of(p->model.sys, d.unknown[i])];
        const double off = hn_graph_eval(g, hn_dyads_expression(p->dyads, k, i), x) - q;
        // an angle is told up to whole turns; sqrt(1 - c^2) loses digits where links are nearly in
        // line
        if (!(fabs(remainder(off, 2 * M_PI)) < 1e-10)) {
            fail_msg("%s, step %d, unknown %d: off by %g", name, k + 1, i + 1, off);
        }
    }
}

static void the_equations_told_to_people_hold_at_the_start(void **state) {
    (void)state;
    static const char *const scenes[][2] = {
        {"four-bar", "th1"},     {"slider-crank", "th1"},         {"watt-six-bar", "th1"},
        {"quick-return", "th1"}, {"seven-body-squeezer", "beta"}, {"peaucellier", "th"},
        {"scott-russell", "th"}};
    for (size_t s = 0; s < sizeof scenes / sizeof *scenes; s++) {
        probe p;
        open_probe(&p, scenes[s][0], scenes[s][1]);
        assert_int_equal(hn_dyads_take_branch(p.dyads, 0, p.model.q), 1);
        const int n = hn_graph_n_symbols(hn_system_graph(p.model.sys));
        const hn_system_exprs exprs = hn_system_get_exprs(p.model.sys);
        double *x = hn_arena_doubles(p.model.arena, (size_t)n);
        for (int i = 0; i < p.model.info.nq; i++) {
            x[exprs.q_symbols[i]] = p.model.q[i];
        }
        for (int k = 0; k < hn_dyads_count(p.dyads); k++) {
            assert_told_is_true(&p, scenes[s][0], k, x);
        }
        close_probe(&p);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mechanisms_fall_apart_into_the_groups_of_the_textbooks),
        cmocka_unit_test(the_coupler_of_fb0_follows_the_formula_with_the_arc_cosine),
        cmocka_unit_test(a_slide_on_an_oblique_line_follows_the_arc_sine),
        cmocka_unit_test(two_slides_are_where_two_lines_meet),
        cmocka_unit_test(what_cannot_be_closed_is_named_and_leaves_the_pose_alone),
        cmocka_unit_test(the_equations_told_to_people_hold_at_the_start),
        cmocka_unit_test(what_hangs_together_is_left_to_newton_and_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
