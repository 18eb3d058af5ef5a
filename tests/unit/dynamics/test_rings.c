// Spatial linkages of one loop: whichever joint is cut, however the whole is turned in space, the mechanism is the same.
// Every body's frame is the world's at the start, so that all joints stand at zero and the ring is closed there.
#include "support/near.h"

#include "support/mechanism.h"
#include "support/model.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TEXT = 6000, MAX_RING = 6 };

typedef struct ring {
    const char *name;
    int n; ///< joints; bodies are one fewer
    const char *types[MAX_RING];
    int freedoms;
} ring;

// the first joint is the crank; freedoms are the joints' less six (spatial mobility), where no leg spins about itself
static const ring RINGS[] = {
    {"RSCR", 4, {"revolute", "spherical", "cylindrical", "revolute"}, 1},
    {"RUSR", 4, {"revolute", "universal", "spherical", "revolute"}, 1},
    {"RCCC", 4, {"revolute", "cylindrical", "cylindrical", "cylindrical"}, 1},
    {"REUR", 4, {"revolute", "planar", "universal", "revolute"}, 1},
    {"RUSP", 4, {"revolute", "universal", "spherical", "prismatic"}, 1},
    {"RSFCR", 5, {"revolute", "spherical", "fixed", "cylindrical", "revolute"}, 1},
    {"RRSU", 4, {"revolute", "revolute", "spherical", "universal"}, 1},
    {"RSSR", 4, {"revolute", "spherical", "spherical", "revolute"}, 2}, // the coupler spins
};
enum { N_RINGS = sizeof RINGS / sizeof *RINGS };

static void add(char *text, const char *more) {
    assert_true(strlen(text) + strlen(more) < TEXT);
    strcat(text, more);
}

/// Joint j between body j - 1 and body j (the ground at both ends), at corners of a skew polygon with skew axes.
static void add_joint(char *text, const ring *r, int j, int cut) {
    static const double at[MAX_RING][3] = {{0, 0, 0},     {0.3, 0.8, 0.2},   {1.7, 1.1, 0.6},
                                           {2.1, 0.2, 0}, {1.1, -0.4, -0.3}, {0.2, 0.2, 0.2}};
    static const double axis[MAX_RING][3] = {{0.1, 0.2, 1},  {0.9, -0.2, 0.4}, {0.2, 1, 0.3},
                                             {-0.3, 0.4, 1}, {1, 0.2, -0.5},   {0, 1, 1}};
    char more[600], parent[32] = "ground", child[32] = "ground";
    if (j > 0) {
        snprintf(parent, sizeof parent, "b%d", j - 1);
    }
    if (j < r->n - 1) {
        snprintf(child, sizeof child, "b%d", j);
    }
    const double *p = at[j], *z = axis[j];
    char second[120] = "";
    if (strcmp(r->types[j], "universal") == 0) {
        snprintf(second, sizeof second, ",\"axis2\":[%.17g,%.17g,0]", z[1], -z[0]);
    }
    snprintf(more, sizeof more,
             "%s{\"name\":\"J%d\",\"type\":\"%s\",\"axis\":[%.17g,%.17g,%.17g]%s,"
             "\"parent\":{\"body\":\"%s\",\"at\":[%.17g,%.17g,%.17g]},"
             "\"child\":{\"body\":\"%s\",\"at\":[%.17g,%.17g,%.17g]}%s}",
             j ? "," : "", j, r->types[j], z[0], z[1], z[2], second, parent, p[0], p[1], p[2],
             child, p[0], p[1], p[2], j == cut ? ",\"cut\":true" : "");
    add(text, more);
}

static void write_ring(char text[TEXT], const ring *r, int cut) {
    strcpy(text, "{\"holonom\":1,\"name\":\"ring\",\"gravity\":[1,-9,3],\"bodies\":[");
    for (int b = 0; b < r->n - 1; b++) {
        char more[300];
        snprintf(more, sizeof more,
                 "%s{\"name\":\"b%d\",\"mass\":%g,\"com\":[%g,0.3,%g],\"inertia\":{\"xx\":0.3,"
                 "\"yy\":0.4,\"zz\":0.5,\"xy\":0.03,\"yz\":-0.05}}",
                 b ? "," : "", b, 1 + 0.4 * b, 0.3 + 0.5 * b, 0.1 * b);
        add(text, more);
    }
    add(text, "],\"joints\":[");
    for (int j = 0; j < r->n; j++) {
        add_joint(text, r, j, cut);
    }
    add(text, "],\"start\":{\"positions\":{\"J0\":0},\"rates\":{\"J0\":1.3}}}");
}

static void open_ring(hn_model *m, const ring *r, int cut) {
    char text[TEXT];
    write_ring(text, r, cut);
    hn_model_open_text(m, text, NULL);
    if (m->status != HN_OK) {
        fail_msg("%s, cut at %d: %s", r->name, cut, m->diags.item[0].message);
    }
}

/// What does not depend on the coordinates chosen: the crank's acceleration and the energy.
static void observe(const hn_model *m, double out[2]) {
    double user_a[32];
    assert_true(m->info.n_user <= 32);
    hn_system_rates_to_user(m->sys, m->a, user_a);
    out[0] = user_a[hn_model_user(m, "J0")];
    out[1] = m->assembly.energy;
}

static void whichever_joint_is_cut_the_crank_accelerates_alike(void **state) {
    (void)state;
    for (int k = 0; k < N_RINGS; k++) {
        double first[2] = {0, 0}, now[2];
        for (int cut = 1; cut < RINGS[k].n; cut++) {
            hn_model m;
            open_ring(&m, &RINGS[k], cut);
            assert_int_equal(m.assembly.freedoms, RINGS[k].freedoms);
            assert_int_equal(m.assembly.redundant, 0);
            observe(&m, now);
            if (RINGS[k].freedoms >
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

// turned in space --------------------------------------------------------------------------------------------------

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
    for (int k = 0; k < N_RINGS; k++) {
        char text[TEXT];
        hn_model plain;
        open_ring(&plain, &RINGS[k], RINGS[k].n / 2);
        write_ring(text, &RINGS[k], RINGS[k].n / 2);
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whichever_joint_is_cut_the_crank_accelerates_alike),
        cmocka_unit_test(a_mechanism_turned_in_space_as_a_whole_moves_alike),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
