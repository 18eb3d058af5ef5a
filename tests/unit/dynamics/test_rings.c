// SPDX-License-Identifier: GPL-3.0-or-later
// Spatial linkages of one loop: whichever joint is cut, however the whole is turned in space, the
// mechanism is the same.
#include "support/near.h"

#include "dynamics/compile/compile.h"
#include "dynamics/compile/coordinates.h"
#include "support/model.h"
#include "support/ring.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void open_ring(hn_model *m, const ring *r, int cut) {
    char text[RING_TEXT];
    ring_write(text, r, cut);
    hn_model_open_text(m, text, NULL);
    if (m->status != HN_OK) {
        fail_msg("%s, cut at %d: %s", r->name, cut, m->diags.item[0].message);
    }
}

/// Finds the two values that do not depend on the coordinates: the crank's acceleration and the
/// energy.
static void observe(const hn_model *m, double out[2]) {
    double user_a[32];
    assert_true(m->info.n_user <= 32);
    hn_system_rates_to_user(m->sys, m->a, user_a);
    out[0] = user_a[hn_model_user(m, "J0")];
    out[1] = m->assembly.energy;
}

static void whichever_joint_is_cut_the_crank_accelerates_alike(void **state) {
    (void)state;
    for (int k = 0; k < ring_count(); k++) {
        double first[2] = {0, 0}, now[2];
        for (int cut = 1; cut < ring_at(k)->n; cut++) {
            hn_model m;
            open_ring(&m, ring_at(k), cut);
            assert_int_equal(m.assembly.freedoms, ring_at(k)->freedoms);
            assert_int_equal(m.assembly.redundant, 0);
            observe(&m, now);
            if (ring_at(k)->freedoms >
                1) { // how fast it spins at the start is then a matter of coordinates
                hn_model_close(&m);
                continue;
            }
            if (cut == 1) {
                memcpy(first, now, sizeof first);
                assert_true(fabs(now[0]) > 1e-3);
            }
            assert_all_near(now, first, 2, 1e-11 * fmax(1, fabs(first[0])));
            hn_model_close(&m);
        }
    }
}

// ---- turned in space ----

static void turn(const double R[3][3], const double v[3], double out[3]) {
    double c[3];
    for (int i = 0; i < 3; i++) {
        c[i] = R[i][0] * v[0] + R[i][1] * v[1] + R[i][2] * v[2];
    }
    memcpy(out, c, sizeof c);
}

static void turn_place(const double R[3][3], const double shift[3], hn_quantity at[3]) {
    double x[3] = {at[0].value, at[1].value, at[2].value};
    turn(R, x, x);
    for (int i = 0; i < 3; i++) {
        at[i].value = x[i] + shift[i];
    }
}

/// Everything that stands on the ground, and gravity.
static void turn_scene(hn_scene *s, const double R[3][3], const double shift[3]) {
    for (int j = 0; j < s->n_joints; j++) {
        hn_joint *joint = &s->joints[j];
        if (joint->parent == HN_GROUND) {
            turn_place(R, shift, joint->parent_at);
            turn(R, joint->parent_axis, joint->parent_axis);
            turn(R, joint->parent_ref, joint->parent_ref);
        }
        if (joint->child == HN_GROUND) {
            turn_place(R, shift, joint->child_at);
            turn(R, joint->child_axis, joint->child_axis);
            turn(R, joint->child_ref, joint->child_ref);
        }
    }
    static const double none[3] = {0, 0, 0};
    turn_place(R, none, s->gravity);
}

static void a_mechanism_turned_in_space_as_a_whole_moves_alike(void **state) {
    (void)state;
    for (int k = 0; k < ring_count(); k++) {
        char text[RING_TEXT];
        hn_model plain;
        open_ring(&plain, ring_at(k), ring_at(k)->n / 2);
        ring_write(text, ring_at(k), ring_at(k)->n / 2);
        hn_scene *scene = NULL;
        hn_system *sys = NULL;
        hn_diags diags = {0};
        hn_assembly assembly;
        assert_int_equal(hn_scene_load_json(text, strlen(text), NULL, NULL, 0, &scene, &diags),
                         HN_OK);
        // by the quaternion (1, 2, -3, 4) / sqrt 30, moved aside
        static const double R[3][3] = {{-20 / 30.0, -20 / 30.0, 10 / 30.0},
                                       {-4 / 30.0, -10 / 30.0, -28 / 30.0},
                                       {22 / 30.0, -20 / 30.0, 4 / 30.0}};
        static const double shift[3] = {0.4, -0.7, 1.1};
        turn_scene(scene, R, shift);
        assert_int_equal(hn_system_compile(scene, NULL, &sys, &diags), HN_OK);
        const hn_system_info info = hn_system_get_info(sys);
        double q[40], v[32], a[32], lambda[32], user[32], before[2];
        assert_int_equal(hn_assemble(sys, 0, q, v, a, lambda, &assembly, &diags), HN_OK);
        assert_int_equal(info.nc, plain.info.nc);
        assert_int_equal(assembly.rank, plain.assembly.rank);
        hn_system_rates_to_user(sys, a, user);
        observe(&plain, before);
        assert_near(user[hn_model_user(&plain, "J0")], before[0], 1e-11 * fmax(1, fabs(before[0])));
        hn_system_free(sys);
        hn_scene_free(scene);
        hn_model_close(&plain);
    }
}

// ---- planar loops ----

/// A four-bar of revolutes about one skew axis, closed by a joint of this type about the same axis.
static void write_planar(char text[RING_TEXT], const char *closing) {
    static const double z[3] = {0.36, 0.48, 0.8}, x[3] = {0.8, -0.6, 0}, y[3] = {0.48, 0.64, -0.6};
    static const double at[4][2] = {{0, 0}, {0.3, 0.9}, {2, 1.6}, {2.2, 0.1}};
    size_t used = (size_t)snprintf(
        text, RING_TEXT,
        "{\"holonom\":1,\"name\":\"planar\",\"gravity\":[1,-9,3],\"bodies\":[{\"name\":\"b0\","
        "\"mass\":1,\"inertia\":{\"xx\":1,\"yy\":1,\"zz\":1}},{\"name\":\"b1\",\"mass\":2,"
        "\"inertia\":{\"xx\":1,\"yy\":1,\"zz\":1}},{\"name\":\"b2\",\"mass\":3,\"inertia\":"
        "{\"xx\":1,\"yy\":1,\"zz\":1}}],\"joints\":[");
    static const char *const bodies[5] = {"ground", "b0", "b1", "b2", "ground"};
    for (int j = 0; j < 4; j++) {
        double p[3];
        for (int i = 0; i < 3; i++) {
            p[i] = at[j][0] * x[i] + at[j][1] * y[i];
        }
        const int last = j == 3, universal = last && strcmp(closing, "universal") == 0;
        used += (size_t)snprintf(
            text + used, RING_TEXT - used,
            "%s{\"name\":\"J%d\",\"type\":\"%s\",\"axis\":[%.17g,%.17g,%.17g],\"%s\":[%.17g,%.17g,"
            "%.17g],\"parent\":{\"body\":\"%s\",\"at\":[%.17g,%.17g,%.17g]},\"child\":{\"body\":"
            "\"%s\",\"at\":[%.17g,%.17g,%.17g]}%s}",
            j ? "," : "", j, last ? closing : "revolute", z[0], z[1], z[2],
            universal ? "axis2" : "ref", x[0], x[1], x[2], bodies[j], p[0], p[1], p[2],
            bodies[j + 1], p[0], p[1], p[2], last ? ",\"cut\":true" : "");
    }
    snprintf(text + used, RING_TEXT - used, "]}");
}

static void a_planar_loop_keeps_the_rows_of_its_plane_whatever_closes_it(void **state) {
    static const struct {
        const char *type;
        int rows;
    } cases[] = {{"revolute", 2}, {"spherical", 2}, {"universal", 2}, {"cylindrical", 2},
                 {"planar", 0},   {"prismatic", 3}, {"fixed", 3}};
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[RING_TEXT];
        hn_model m;
        write_planar(text, cases[k].type);
        hn_model_open_text(&m, text, NULL);
        assert_int_equal(m.status, HN_OK);
        assert_int_equal(m.info.nc, cases[k].rows);
        assert_int_equal(m.assembly.freedoms, 3 - cases[k].rows);
        hn_model_close(&m);
    }
}

/// Turned by half a revolution the rows of a fixed joint hold as well, and the guess stands next to
/// that pose.
static void a_loop_is_not_closed_the_wrong_way_round(void **state) {
    static const char text[] =
        "{\"holonom\":1,\"name\":\"twice held\",\"bodies\":[{\"name\":\"b\",\"mass\":1,"
        "\"inertia\":{\"xx\":1,\"yy\":1,\"zz\":1}}],\"joints\":[{\"name\":\"S\",\"type\":"
        "\"spherical\",\"parent\":{\"body\":\"ground\"},\"child\":{\"body\":\"b\"}},{\"name\":"
        "\"W\",\"type\":\"fixed\",\"cut\":true,\"parent\":{\"body\":\"ground\"},\"child\":"
        "{\"body\":\"b\"}}],\"start\":{\"positions\":{\"S_rx\":{\"guess\":3},\"S_ry\":{\"guess\":"
        "0.05},\"S_rz\":{\"guess\":0}}}}";
    static const double none[3] = {0, 0, 0};
    hn_model m;
    (void)state;
    hn_model_open_text(&m, text, NULL);
    assert_int_equal(m.status, HN_OK);
    assert_int_equal(m.assembly.freedoms, 0);
    assert_all_near(m.user_q, none, 3, 1e-12);
    hn_model_close(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whichever_joint_is_cut_the_crank_accelerates_alike),
        cmocka_unit_test(a_planar_loop_keeps_the_rows_of_its_plane_whatever_closes_it),
        cmocka_unit_test(a_loop_is_not_closed_the_wrong_way_round),
        cmocka_unit_test(a_mechanism_turned_in_space_as_a_whole_moves_alike),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
