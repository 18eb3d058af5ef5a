// SPDX-License-Identifier: GPL-3.0-or-later
// The equations left on the free motion, at random closed states of every shipped scene.
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "formulations/chart/reduced_terms.h"

#include "dynamics/assembly/project.h"
#include "support/model.h"
#include "support/near.h"

#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct probe {
    char name[64];
    hn_model model;
    hn_arena *arena;
    hn_reduced_terms terms;
    hn_accel *accel;
    hn_projector *projector;
    double t, *q, *v, *a, *dq;
    unsigned seed;
} probe;

static double noise(probe *p) {
    p->seed = p->seed * 1664525u + 1013904223u;
    return 2 * (double)(p->seed >> 8) / 16777216.0 - 1;
}

static void open_probe(probe *p, const char *name) {
    memset(p, 0, sizeof *p);
    snprintf(p->name, sizeof p->name, "%s", name);
    p->seed = 7;
    hn_model_begin(&p->model, name, NULL);
    p->arena = hn_arena_create(0);
    const hn_accel_opts opts = {0};
    hn_diag diag = {0};
    assert_int_equal(hn_reduced_terms_init(&p->terms, p->model.sys, p->arena, &diag), HN_OK);
    assert_int_equal(hn_accel_create(p->model.sys, &opts, p->arena, &p->accel), HN_OK);
    assert_int_equal(hn_projector_create(p->model.sys, HN_WEIGHT_MASS, p->arena, &p->projector),
                     HN_OK);
    double **const vectors[] = {&p->q, &p->v, &p->a, &p->dq};
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++) {
        *vectors[k] = hn_arena_doubles(p->arena, (size_t)p->model.info.nq + 1);
        assert_non_null(*vectors[k]);
    }
}

static void close_probe(probe *p) {
    hn_reduced_terms_destroy(&p->terms);
    hn_accel_free(p->accel);
    hn_projector_free(p->projector);
    hn_arena_free(p->arena);
    hn_model_close(&p->model);
}

static void close_loops(probe *p) {
    hn_status status = hn_project_position(p->projector, p->t, p->q, 0, NULL);
    status = status == HN_OK ? hn_project_velocity(p->projector, p->t, p->q, p->v, NULL) : status;
    if (status != HN_OK) {
        fail_msg("%s: a state near the start cannot be closed", p->name);
    }
}

/// The start disturbed by up to 0.05 in positions and 1 in speeds, then closed again.
static void next_state(probe *p) {
    const int nv = p->model.info.nv;
    for (int i = 0; i < nv; i++) {
        p->dq[i] = 0.05 * noise(p);
        p->v[i] = p->model.v[i] + noise(p);
    }
    memcpy(p->q, p->model.q, (size_t)p->model.info.nq * sizeof *p->q);
    hn_system_move(p->model.sys, p->q, p->dq);
    p->t = 0.1 + 0.1 * noise(p);
    close_loops(p);
}

/// The next state with its terms; 0 where they do not exist, and the reason then names a ball:
/// nothing else stands in the way of the shipped scenes near their starts.
static int next_terms(probe *p) {
    next_state(p);
    const hn_status status =
        hn_reduced_terms_eval(&p->terms, p->t, p->q, p->v, p->model.assembly.freedoms);
    if (status == HN_OK) {
        return 1;
    }
    const char *why = hn_reduced_terms_why(&p->terms);
    if (status != HN_ERR_UNSUPPORTED || !why ||
        !strstr(why, "the entries of an orientation cannot be")) {
        fail_msg("%s: %s", p->name, why ? why : hn_status_text(status));
    }
    return 0;
}

typedef void (*scene_check)(probe *p);

/// Returns how many of the shipped scenes have these terms, each checked at so many states.
static int for_shipped_scenes(scene_check check, int states) {
    glob_t found;
    int n = 0;
    assert_int_equal(glob("lessons/*/scenes/*.json", 0, NULL, &found), 0);
    for (size_t i = 0; i < found.gl_pathc; i++) {
        char name[64];
        const char *file = strrchr(found.gl_pathv[i], '/') + 1;
        snprintf(name, sizeof name, "%.*s", (int)(strlen(file) - strlen(".json")), file);
        probe p;
        open_probe(&p, name);
        int has = 1;
        for (int k = 0; k < states && has; k++) {
            has = next_terms(&p);
            if (has) {
                check(&p);
            }
        }
        n += has;
        close_probe(&p);
    }
    globfree(&found);
    return n;
}

static double largest(const double *x, int n) {
    double most = 0;
    for (int i = 0; i < n; i++) {
        most = fmax(most, fabs(x[i]));
    }
    return most;
}

/// Phi a_r + c = a with c = Phi_dot v_r: two states of the motion apart by a small step would tell
/// the same to fewer digits, so the independent rows are compared, where c is 0, and the equation
/// itself.
static void accelerations_agree(probe *p) {
    const hn_reduced_terms *w = &p->terms;
    hn_accel_info info;
    double *user = p->dq;
    assert_int_equal(hn_accel_eval(p->accel, p->t, p->q, p->v, 0, 0, p->a, NULL, &info), HN_OK);
    hn_system_rates_to_user(p->model.sys, p->a, user);
    const double scale = 1 + largest(user, w->nv);
    for (int j = 0; j < w->r; j++) {
        if (!(fabs(w->a_r[j] - user[w->ind[j]]) <= 1e-11 * scale)) {
            fail_msg("%s: a_r[%d] = %.17g, the saddle system says %.17g (largest %.3g)", p->name, j,
                     w->a_r[j], user[w->ind[j]], scale);
        }
    }
    for (int i = 0; i < w->r; i++) {
        double left = w->d_r[i] + w->g_r[i] - w->tau_r[i];
        double size = fabs(w->d_r[i]) + fabs(w->g_r[i]) + fabs(w->tau_r[i]);
        for (int j = 0; j < w->r; j++) {
            const double m = w->M_r[i * w->r + j] * user[w->ind[j]],
                         c = w->C_r[i * w->r + j] * w->v_r[j];
            left += m + c;
            size += fabs(m) + fabs(c);
        }
        if (!(fabs(left) <= 1e-11 * (1 + size))) {
            fail_msg("%s: row %d of the reduced equation is open by %.3g of %.3g", p->name, i, left,
                     size);
        }
    }
}

static void the_reduced_equation_gives_the_acceleration_of_the_saddle_system(void **state) {
    (void)state;
    // 35 scenes, of which four have orientations that cannot follow from plain coordinates
    assert_true(for_shipped_scenes(accelerations_agree, 20) >= 28);
}

/// M_r where the mechanism is `h` later on its way; 0 when other coordinates are independent there.
static int mass_after(probe *p, double h, double *M_r) {
    hn_reduced_terms *w = &p->terms;
    const int nv = p->model.info.nv, r = w->r;
    int ind[64];
    double q[128], v[128];
    memcpy(ind, w->ind, (size_t)r * sizeof *ind);
    memcpy(q, p->q, (size_t)p->model.info.nq * sizeof *q);
    memcpy(v, p->v, (size_t)nv * sizeof *v);
    for (int i = 0; i < nv; i++) {
        p->dq[i] = h * v[i];
    }
    hn_system_move(p->model.sys, p->q, p->dq);
    close_loops(p);
    assert_int_equal(hn_reduced_terms_eval(w, p->t, p->q, p->v, r), HN_OK);
    memcpy(M_r, w->M_r, (size_t)r * (size_t)r * sizeof *M_r);
    memcpy(p->q, q, (size_t)p->model.info.nq * sizeof *q);
    memcpy(p->v, v, (size_t)nv * sizeof *v);
    return memcmp(ind, w->ind, (size_t)r * sizeof *ind) == 0;
}

static void coriolis_is_skew(probe *p) {
    enum { MOST = 32 };
    double C[MOST * MOST], up[MOST * MOST], down[MOST * MOST];
    hn_reduced_terms *w = &p->terms;
    const int r = w->r;
    assert_true(r <= MOST);
    if (w->is_moved) {
        return; // M_r then changes with t too
    }
    memcpy(C, w->C_r, (size_t)r * (size_t)r * sizeof *C);
    const double h = 1e-5 / (1 + largest(p->v, p->model.info.nv));
    if (!mass_after(p, h, up) || !mass_after(p, -h, down)) {
        return;
    }
    // differences of M_r over 1e-5 keep ten digits of M_r times the speed
    const double scale = (1e-5 / h) * (largest(up, r * r) + 1e-3);
    for (int i = 0; i < r; i++) {
        for (int j = 0; j < r; j++) {
            const double rate = (up[i * r + j] - down[i * r + j]) / (2 * h);
            if (!(fabs(rate - C[i * r + j] - C[j * r + i]) <= 1e-7 * scale)) {
                fail_msg("%s: M_r' - 2 C_r is not skew in (%d, %d): %.9g against %.9g", p->name, i,
                         j, rate, C[i * r + j] + C[j * r + i]);
            }
        }
    }
}

static void the_rate_of_the_reduced_mass_minus_twice_coriolis_is_skew(void **state) {
    (void)state;
    assert_true(for_shipped_scenes(coriolis_is_skew, 5) >= 28);
}

static double kinetic_after(probe *p, hn_eval *energy, double h) {
    const hn_system_info info = p->model.info;
    double q[128], v[128];
    memcpy(q, p->q, (size_t)info.nq * sizeof *q);
    for (int i = 0; i < info.nv; i++) {
        p->dq[i] = h * p->v[i] + h * h / 2 * p->a[i];
        v[i] = p->v[i] + h * p->a[i];
    }
    hn_system_move(p->model.sys, q, p->dq);
    hn_eval_run(energy, p->t + h, q, v);
    return hn_eval_get(energy, HN_TERM_ENERGY)[0];
}

/// d/dt (v_r' M_r v_r / 2) = v_r' (tau_r - g_r), the left side along the motion that the saddle
/// system gives.
static void power_balances(probe *p) {
    hn_reduced_terms *w = &p->terms;
    hn_eval *energy = NULL;
    hn_accel_info info;
    assert_int_equal(hn_accel_eval(p->accel, p->t, p->q, p->v, 0, 0, p->a, NULL, &info), HN_OK);
    assert_int_equal(hn_eval_create(p->model.sys, HN_TERM_ENERGY, p->arena, &energy), HN_OK);
    double kinetic = 0, power = 0, size = 0;
    for (int i = 0; i < w->r; i++) {
        power += w->v_r[i] * (w->tau_r[i] - w->g_r[i]);
        size += fabs(w->v_r[i]) * (fabs(w->tau_r[i]) + fabs(w->g_r[i]));
        for (int j = 0; j < w->r; j++) {
            kinetic += w->v_r[i] * w->M_r[i * w->r + j] * w->v_r[j] / 2;
        }
    }
    if (!w->is_moved) {
        const double rates = 1 + largest(p->v, w->nv) + largest(p->a, w->nv);
        const double now = kinetic_after(p, energy, 0), h = 1e-5 / rates;
        assert_near(kinetic, now, 1e-12 * (1 + now));
        const double rate = (kinetic_after(p, energy, h) - kinetic_after(p, energy, -h)) / (2 * h);
        // rounding of the energy over 2 h, and h^2 of its third rate
        if (!(fabs(rate - power) <= 1e-9 * rates * (1 + now) + 1e-9 * size)) {
            fail_msg("%s: the kinetic energy grows by %.12g W, the forces give %.12g W", p->name,
                     rate, power);
        }
    }
    hn_eval_free(energy);
}

static void the_reduced_forces_account_for_the_kinetic_energy(void **state) {
    (void)state;
    assert_true(for_shipped_scenes(power_balances, 5) >= 28);
}

/// Without motors and dampers nothing is left of f + h + g, although h and g come from the energies
/// and f from the bodies.
static void without_loads_no_force_is_left(void **state) {
    (void)state;
    static const char *const names[] = {"fb0",  "fb0-lagrangian",   "bennett",
                                        "ring", "oblique-four-bar", "watt-six-bar"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        probe p;
        open_probe(&p, names[k]);
        for (int n = 0; n < 10; n++) {
            assert_true(next_terms(&p));
            for (int i = 0; i < p.terms.r; i++) {
                assert_true(p.terms.tau_r[i] == 0);
            }
        }
        close_probe(&p);
    }
}

static void a_singular_pose_has_no_reduced_terms_and_says_why(void **state) {
    (void)state;
    probe p;
    open_probe(&p, "parallelogram");
    // all links along one line: the rows of the loop are parallel
    memset(p.q, 0, (size_t)p.model.info.nq * sizeof *p.q);
    assert_int_equal(hn_reduced_terms_eval(&p.terms, 0, p.q, p.v, 1), HN_ERR_CHART);
    assert_non_null(strstr(hn_reduced_terms_why(&p.terms), "2 degrees of freedom instead of 1"));
    close_probe(&p);
}

static void motors_are_the_independent_coordinates_where_they_serve(void **state) {
    (void)state;
    probe p;
    open_probe(&p, "five-bar");
    assert_true(next_terms(&p));
    assert_int_equal(p.terms.choice, HN_REDUCED_BY_MOTORS);
    for (int j = 0; j < p.terms.r; j++) {
        const int user = hn_system_user_coordinate(p.model.sys, p.terms.ind[j]);
        assert_true(p.model.scene->coordinates[user].actuated);
    }
    close_probe(&p);
}

/// FB0 by hand: with the crank's angle independent, theta_coupler' and theta_rocker' over
/// theta_crank' follow from closing the loop.
static double parameter(const probe *p, const char *name) {
    const int i = hn_scene_find_param(p->model.scene, name);
    assert_true(i >= 0);
    return p->model.scene->params[i].value;
}

static void phi_of_the_four_bar_is_its_textbook_form(void **state) {
    (void)state;
    probe p;
    open_probe(&p, "fb0-lagrangian"); // absolute angles: crank, coupler, rocker
    assert_true(next_terms(&p));
    assert_int_equal(p.terms.r, 1);
    const double l1 = parameter(&p, "l1"), l2 = parameter(&p, "l2"), l3 = parameter(&p, "l3");
    const double a = p.q[0], b = p.q[1], c = p.q[2];
    assert_int_equal(p.terms.ind[0], 0);
    assert_near(p.terms.Phi[1], l1 * sin(c - a) / (l2 * sin(b - c)), 1e-12);
    assert_near(p.terms.Phi[2], l1 * sin(b - a) / (l3 * sin(b - c)), 1e-12);
    close_probe(&p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_rate_of_the_reduced_mass_minus_twice_coriolis_is_skew),
        cmocka_unit_test(the_reduced_forces_account_for_the_kinetic_energy),
        cmocka_unit_test(without_loads_no_force_is_left),
        cmocka_unit_test(a_singular_pose_has_no_reduced_terms_and_says_why),
        cmocka_unit_test(motors_are_the_independent_coordinates_where_they_serve),
        cmocka_unit_test(phi_of_the_four_bar_is_its_textbook_form),
        cmocka_unit_test(the_reduced_equation_gives_the_acceleration_of_the_saddle_system),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
