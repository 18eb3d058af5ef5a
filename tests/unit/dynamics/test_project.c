// SPDX-License-Identifier: GPL-3.0-or-later
// Projection: the nearest closed state, what it costs in energy, redundancy, lost rank, and its
// cost on long ladders.

#include "dynamics/assembly/project.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/eval.h"
#include "linalg/dense.h"
#include "support/alloc.h"
#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <string.h>

enum { MAX_NV = 64 };

typedef struct fixture {
    hn_model m;
    hn_projector *p;
    hn_eval *terms;
    double q[MAX_NV], v[MAX_NV];
} fixture;

static void open_scene(fixture *f, const char *name, const char *settings, hn_weight weight) {
    hn_model_open_closed(&f->m, name, settings);
    assert_int_equal(hn_projector_create(f->m.sys, weight, f->m.arena, &f->p), HN_OK);
    unsigned mask = HN_TERM_M | HN_TERM_J | HN_TERM_PHI | HN_TERM_PHI_T | HN_TERM_ENERGY;
    assert_int_equal(hn_eval_create(f->m.sys, mask, f->m.arena, &f->terms), HN_OK);
    int n = f->m.info.nv < MAX_NV ? f->m.info.nv : MAX_NV;
    memcpy(f->q, f->m.q, (size_t)n * sizeof *f->q);
    memcpy(f->v, f->m.v, (size_t)n * sizeof *f->v);
}

static void close_scene(fixture *f) {
    hn_projector_free(f->p);
    hn_eval_free(f->terms);
    hn_model_close(&f->m);
}

static double gap_of(fixture *f, const double *q) {
    hn_eval_run(f->terms, 0, q, f->m.v);
    return hn_norm2(f->m.info.nc, hn_eval_get(f->terms, HN_TERM_PHI));
}

static double velocity_gap_of(fixture *f, const double *q, const double *v) {
    double gap[MAX_NV];
    hn_eval_run(f->terms, 0, q, v);
    hn_mat_vec(f->m.info.nc, f->m.info.nv, hn_eval_get(f->terms, HN_TERM_J), v, gap);
    return hn_norm2(f->m.info.nc, gap);
}

static double kinetic_of(fixture *f, const double *q, const double *v) {
    hn_eval_run(f->terms, 0, q, v);
    return hn_eval_get(f->terms, HN_TERM_ENERGY)[0];
}

static void disturb(double *x, int n, double size) {
    for (int i = 0; i < n; i++) {
        x[i] += size * cos(1 + 2.3 * i);
    }
}

static void positions_close_to_rounding(void **state) {
    (void)state;
    for (int weight = 0; weight < 2; weight++) {
        for (double size = 1e-8; size < 0.05; size *= 10) {
            fixture f;
            open_scene(&f, "fb0", NULL, weight ? HN_WEIGHT_EUCLIDEAN : HN_WEIGHT_MASS);
            disturb(f.q, 3, size);
            double before = gap_of(&f, f.q);
            hn_project_info info;
            assert_int_equal(hn_project_position(f.p, 0, f.q, 1e-14, &info), HN_OK);
            assert_true(gap_of(&f, f.q) < 3e-14);
            assert_near(info.gap_before, before, 1e-15);
            assert_int_equal(info.rank, 2);
            assert_true(info.iterations <= (size < 1e-5 ? 3 : 8));
            close_scene(&f);
        }
    }
}

/// A rate that the loops allow: the assembled speeds.
static double part_along_motion(fixture *f, const double *dq, hn_weight weight) {
    double product[3];
    hn_eval_run(f->terms, 0, f->m.q, f->m.v);
    hn_mat_vec(3, 3, hn_eval_get(f->terms, HN_TERM_M), dq, product);
    return hn_dot(3, weight == HN_WEIGHT_MASS ? product : dq, f->m.v);
}

static void the_move_has_no_part_along_the_motion(void **state) {
    (void)state;
    for (int weight = 0; weight < 2; weight++) {
        fixture f;
        open_scene(&f, "fb0", NULL, (hn_weight)weight);
        disturb(f.q, 3, 1e-5);
        double dq[3];
        memcpy(dq, f.q, sizeof dq);
        assert_int_equal(hn_project_position(f.p, 0, f.q, 1e-14, NULL), HN_OK);
        for (int i = 0; i < 3; i++) {
            dq[i] = f.q[i] - dq[i];
        }
        assert_true(hn_norm2(3, dq) > 1e-6);
        // to first order in the disturbance, hence its square
        assert_near(part_along_motion(&f, dq, (hn_weight)weight), 0, 1e-8);
        assert_true(fabs(part_along_motion(&f, dq, (hn_weight)!weight)) > 1e-7);
        close_scene(&f);
    }
}

static void speeds_close_and_exactly_the_told_energy_goes(void **state) {
    (void)state;
    fixture f;
    open_scene(&f, "fb0", NULL, HN_WEIGHT_MASS);
    disturb(f.v, 3, 0.1);
    double before = kinetic_of(&f, f.q, f.v);
    hn_project_info info;
    assert_int_equal(hn_project_velocity(f.p, 0, f.q, f.v, &info), HN_OK);
    assert_true(velocity_gap_of(&f, f.q, f.v) < 2e-14);
    assert_true(info.energy_removed > 1e-4);
    assert_near(before - kinetic_of(&f, f.q, f.v), info.energy_removed, 1e-13);
    close_scene(&f);
}

static void speeds_follow_positions_with_the_same_factor(void **state) {
    (void)state;
    fixture f;
    open_scene(&f, "fb0", NULL, HN_WEIGHT_MASS);
    disturb(f.q, 3, 1e-6);
    disturb(f.v, 3, 1e-5);
    assert_int_equal(hn_project_position(f.p, 0, f.q, 1e-14, NULL), HN_OK);
    assert_int_equal(hn_project_velocity(f.p, 0, f.q, f.v, NULL), HN_OK);
    assert_int_equal(hn_projector_factorisations(f.p), 1);
    assert_int_equal(hn_projector_fallbacks(f.p), 0);
    assert_true(velocity_gap_of(&f, f.q, f.v) < 2e-14);
    close_scene(&f);
}

static void redundant_rows_give_the_same_state(void **state) {
    (void)state;
    fixture plain, twice;
    open_scene(&plain, "fb0", NULL, HN_WEIGHT_MASS);
    open_scene(&twice, "fb0-redundant", NULL, HN_WEIGHT_MASS);
    fixture *both[] = {&plain, &twice};
    for (int i = 0; i < 2; i++) {
        disturb(both[i]->q, 3, 1e-3);
        disturb(both[i]->v, 3, 1e-2);
        hn_project_info info;
        assert_int_equal(hn_project_position(both[i]->p, 0, both[i]->q, 1e-14, &info), HN_OK);
        assert_int_equal(info.rank, 2);
        assert_int_equal(hn_project_velocity(both[i]->p, 0, both[i]->q, both[i]->v, &info), HN_OK);
        assert_int_equal(info.rank, 2);
    }
    assert_all_near(twice.q, plain.q, 3, 1e-12);
    assert_all_near(twice.v, plain.v, 3, 1e-12);
    assert_true(hn_projector_fallbacks(twice.p) > 0);
    close_scene(&plain);
    close_scene(&twice);
}

/// The parallelogram with all bars on one line, where J has rank 1 of 2.
static void make_flat(const hn_model *m, double *q) {
    double user[3];
    user[hn_model_user(m, "th0")] = 0;
    user[hn_model_user(m, "b1")] = 0;
    user[hn_model_user(m, "th1")] = 0;
    hn_system_from_user(m->sys, user, q);
}

static void a_pose_of_lost_rank_gives_a_least_step_and_no_nan(void **state) {
    (void)state;
    fixture f;
    open_scene(&f, "n-four-bar", "N=1", HN_WEIGHT_MASS);
    make_flat(&f.m, f.q);
    hn_project_info info;
    assert_int_equal(hn_project_position(f.p, 0, f.q, 1e-13, &info), HN_OK); // closed as it stands

    // turning all bars alike keeps the gap closed, so these speeds need nothing; others lose what
    // does not fit
    disturb(f.v, 3, 0.5);
    assert_int_equal(hn_project_velocity(f.p, 0, f.q, f.v, &info), HN_OK);
    assert_int_equal(info.rank, 1);
    assert_true(velocity_gap_of(&f, f.q, f.v) < 1e-14);
    assert_true(hn_all_finite(3, f.v));

    disturb(f.q, 3, 1e-9);
    double before = gap_of(&f, f.q);
    assert_int_equal(hn_project_position(f.p, 0, f.q, 1e-13, &info), HN_OK);
    assert_true(hn_all_finite(3, f.q) && info.gap <= before);
    close_scene(&f);
}

static void failures_leave_the_state_alone(void **state) {
    (void)state;
    fixture f;
    hn_model_begin(&f.m, "fb0", "d=4.9 l3=1.7"); // no pose closes: the bars reach 4.7 m
    assert_int_equal(f.m.status, HN_ERR_UNREACHABLE);
    assert_int_equal(hn_projector_create(f.m.sys, HN_WEIGHT_MASS, f.m.arena, &f.p), HN_OK);
    double q[3] = {0.3, 0.2, 2.5}, kept[3];
    memcpy(kept, q, sizeof kept);
    assert_int_equal(hn_project_position(f.p, 0, q, 1e-14, NULL), HN_ERR_NO_CONVERGENCE);
    assert_memory_equal(kept, q, sizeof kept);
    hn_projector_free(f.p);
    hn_model_close(&f.m);
}

static void what_is_not_finite_is_refused(void **state) {
    (void)state;
    fixture f;
    open_scene(&f, "fb0", NULL, HN_WEIGHT_MASS);
    f.v[1] = (double)NAN;
    assert_int_equal(hn_project_velocity(f.p, 0, f.q, f.v, NULL), HN_ERR_DIVERGED);
    f.q[2] = (double)INFINITY;
    assert_int_equal(hn_project_position(f.p, 0, f.q, 1e-14, NULL), HN_ERR_DIVERGED);
    assert_true(isinf(f.q[2]) && isnan(f.v[1]));
    close_scene(&f);
}

static void angles_after_many_turns_still_project(void **state) {
    (void)state;
    fixture f;
    open_scene(&f, "fb0", NULL, HN_WEIGHT_MASS);
    for (int i = 0; i < 3; i++) {
        f.q[i] += 2 * 3.14159265358979323846 * 1e6; // rounding of q is 1e-9 rad now
    }
    assert_int_equal(hn_project_position(f.p, 0, f.q, 1e-14, NULL), HN_OK);
    assert_true(gap_of(&f, f.q) < 1e-8);
    close_scene(&f);
}

static void without_loops_there_is_nothing_to_do(void **state) {
    (void)state;
    fixture f;
    open_scene(&f, "double-pendulum", NULL, HN_WEIGHT_MASS);
    hn_project_info info;
    assert_int_equal(hn_project_position(f.p, 0, f.q, 1e-14, &info), HN_OK);
    assert_int_equal(hn_project_velocity(f.p, 0, f.q, f.v, &info), HN_OK);
    assert_memory_equal(f.q, f.m.q, sizeof(double) * (size_t)f.m.info.nq);
    close_scene(&f);
}

static void no_allocation_inside(void **state) {
    (void)state;
    static const char *const scenes[] = {"fb0", "fb0-redundant"};
    for (int i = 0; i < 2; i++) {
        fixture f;
        open_scene(&f, scenes[i], NULL, HN_WEIGHT_MASS);
        disturb(f.q, 3, 1e-3);
        disturb(f.v, 3, 1e-3);
        long before = hn_alloc_count();
        assert_int_equal(hn_project_position(f.p, 0, f.q, 1e-14, NULL), HN_OK);
        assert_int_equal(hn_project_velocity(f.p, 0, f.q, f.v, NULL), HN_OK);
        assert_int_equal(hn_alloc_count(), before);
        close_scene(&f);
    }
}

/// Makes a projector with the n-th allocation failing. 0 when there was no n-th one any more.
static int create_with_failure(long n) {
    hn_model m;
    hn_projector *p = NULL;
    hn_model_open_closed(&m, "fb0", NULL);
    hn_alloc_fail_at(n);
    hn_status status = hn_projector_create(m.sys, HN_WEIGHT_EUCLIDEAN, m.arena, &p);
    int failed = hn_alloc_has_failed();
    hn_alloc_fail_at(0);
    assert_int_equal(status, failed ? HN_ERR_MEMORY : HN_OK);
    hn_projector_free(p);
    hn_model_close(&m);
    return failed;
}

static void every_allocation_of_its_making_may_fail(void **state) {
    (void)state;
    long live = hn_alloc_live(), n = 1;
    while (create_with_failure(n)) {
        assert_int_equal(hn_alloc_live(), live);
        n++;
    }
    assert_true(n > 4);
}

/// Operations of one projection of a slightly open ladder of n loops.
static double ladder_ops(const char *settings, int n) {
    hn_model m;
    hn_projector *p;
    hn_model_open_closed(&m, "n-four-bar", settings);
    assert_int_equal(hn_projector_create(m.sys, HN_WEIGHT_MASS, m.arena, &p), HN_OK);
    // away from upright: all verticals at 1 rad, couplers level
    for (int i = 0; i < m.info.n_user; i++) {
        const hn_coordinate *c = &m.scene->coordinates[hn_system_user_coordinate(m.sys, i)];
        m.user_q[i] = (c->name[0] == 'b' ? -1 : 1) + 1e-7 * cos(i);
    }
    hn_system_from_user(m.sys, m.user_q, m.q);
    hn_project_info info;
    assert_int_equal(hn_project_position(p, 0, m.q, 1e-13, &info), HN_OK);
    assert_true(info.gap < 1e-12); // pivots stand up to 200 m away
    assert_int_equal(hn_project_velocity(p, 0, m.q, m.v, &info), HN_OK);
    assert_int_equal(hn_projector_fallbacks(p), 0);
    double per_evaluation = hn_projector_ops(p) / (double)hn_projector_evals(p);
    hn_projector_free(p);
    hn_model_close(&m);
    return per_evaluation / n;
}

static void cost_per_loop_of_a_ladder_stays_the_same(void **state) {
    (void)state;
    double ten = ladder_ops("N=10", 10), most = ladder_ops("N=200", 200);
    assert_true(most < 1.3 * ten && ten < 1.3 * most);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(positions_close_to_rounding),
        cmocka_unit_test(the_move_has_no_part_along_the_motion),
        cmocka_unit_test(speeds_close_and_exactly_the_told_energy_goes),
        cmocka_unit_test(speeds_follow_positions_with_the_same_factor),
        cmocka_unit_test(redundant_rows_give_the_same_state),
        cmocka_unit_test(a_pose_of_lost_rank_gives_a_least_step_and_no_nan),
        cmocka_unit_test(failures_leave_the_state_alone),
        cmocka_unit_test(what_is_not_finite_is_refused),
        cmocka_unit_test(angles_after_many_turns_still_project),
        cmocka_unit_test(without_loops_there_is_nothing_to_do),
        cmocka_unit_test(no_allocation_inside),
        cmocka_unit_test(every_allocation_of_its_making_may_fail),
        cmocka_unit_test(cost_per_loop_of_a_ladder_stays_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
