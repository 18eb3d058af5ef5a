// SPDX-License-Identifier: GPL-3.0-or-later
// The spectrum of the motion on the loops, and what integrators make of its eigenvalues.
#include "integrators/list/stepper_list.h"
#include "study/spectrum/region.h"
#include "study/spectrum/spectrum.h"

#include "support/model.h"
#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static double modulus(const hn_eigenvalue *s) {
    return hypot(s->re, s->im);
}

// spectrum at the assembled start; copies at most `max` of them
static int start_spectrum(const hn_model *m, hn_eigenvalue *out, int max) {
    hn_spectrum *s;
    const hn_eigenvalue *values;
    int n = -1;
    assert_int_equal(hn_spectrum_create(m->sys, m->arena, &s), HN_OK);
    assert_int_equal(hn_spectrum_calc(s, 0, m->q, m->v, &values, &n), HN_OK);
    assert_in_range(n, 0, max);
    memcpy(out, values, (size_t)n * sizeof *out);
    hn_spectrum_free(s);
    return n;
}

// FB0 with a torsion spring k between coupler and rocker, at rest there at the start
static void open_sprung_fb0(hn_model *m, double k) {
    static const char text[] =
        "{\"holonom\": 1, \"name\": \"sprung\", \"parameters\": {\"g\": {\"value\": 0, \"unit\": "
        "\"m/s^2\"}}, \"lagrangian\": {\"coordinates\": [{\"name\": \"th1\", \"rate\": \"w1\"}, "
        "{\"name\": \"th2\", \"rate\": \"w2\"}, {\"name\": \"th3\", \"rate\": \"w3\"}],"
        "\"kinetic\": \"(1/3 + 2)*w1^2/2 + 8/3*w2^2/2 + 1.8^3/3*w3^2/2 + 2*cos(th1 - th2)*w1*w2\","
        "\"potential\": \"%.17g/2*(th2 - th3 - %.17g)^2\", \"constraints\": ["
        "{\"name\": \"x\", \"formula\": \"cos(th1) + 2*cos(th2) - 1.8*cos(th3) - 2.2\"},"
        "{\"name\": \"y\", \"formula\": \"sin(th1) + 2*sin(th2) - 1.8*sin(th3)\"}]},"
        "\"start\": {\"positions\": {\"th1\": 1, \"th2\": {\"guess\": 0.5}, \"th3\": {\"guess\": "
        "1.5}}, \"rates\": {\"th1\": 0}}}";
    char filled[sizeof text + 60];
    snprintf(filled, sizeof filled, text, 0.0, 0.0);
    hn_model_open_text(m, filled, NULL);
    const double rest = m->q[1] - m->q[2];
    hn_model_close(m);
    snprintf(filled, sizeof filled, text, k, rest);
    hn_model_open_text(m, filled, NULL);
    assert_int_equal(m->status, HN_OK);
}

static void a_stiff_spring_on_the_loop_vibrates_as_the_loop_lets_it(void **state) {
    (void)state;
    hn_model m;
    hn_eigenvalue s[2];
    open_sprung_fb0(&m, 1e6);
    assert_int_equal(start_spectrum(&m, s, 2), 2);

    // one freedom: w^2 = k (th2' - th3')^2 / (v' M v) along the one motion v that the loop allows,
    // th1' = 1
    const double a1 = m.q[0], a2 = m.q[1], a3 = m.q[2], det = -2 * 1.8 * sin(a2 - a3);
    const double w2 = -1 * 1.8 * sin(a3 - a1) / det, w3 = -2 * sin(a2 - a1) / det;
    const double inertia = (1.0 / 3 + 2) + 8.0 / 3 * w2 * w2 + 1.8 * 1.8 * 1.8 / 3 * w3 * w3 +
                           2 * 2 * cos(a1 - a2) * w2;
    assert_rel(s[0].im, sqrt(1e6 / inertia) * fabs(w2 - w3), 1e-9);
    assert_near(s[0].im, 459, 0.5);
    assert_near(s[0].re, 0, 1e-9 * modulus(s));
    assert_near(s[1].im, -s[0].im, 1e-9 * modulus(s));
    hn_model_close(&m);
}

// |1 + z + z^2/2 + z^3/6 + z^4/24| by Horner's rule, z = re + i im
static double modulus_of_rk4(double re, double im) {
    double x = 1, y = 0;
    for (int k = 4; k >= 1; k--) {
        const double next = 1 + (x * re - y * im) / k;
        y = (x * im + y * re) / k;
        x = next;
    }
    return hypot(x, y);
}

static void growth_is_the_modulus_of_the_stability_function(void **state) {
    (void)state;
    static const double z[][2] = {{-0.3, 0.4}, {-2, 1.5}, {0, 2.8}, {0.7, 0}};
    for (size_t k = 0; k < sizeof z / sizeof *z; k++) {
        const double re = z[k][0], im = z[k][1];
        assert_rel(hn_stability_growth(hn_stepper_find("rk4"), re, im), modulus_of_rk4(re, im),
                   1e-14);
        // Newton's method ends at the default tolerance, far below 1e-8
        assert_rel(hn_stability_growth(hn_stepper_find("midpoint"), re, im),
                   hypot(1 + re / 2, im / 2) / hypot(1 - re / 2, im / 2), 1e-8);
        assert_rel(hn_stability_growth(hn_stepper_find("implicit-euler"), re, im),
                   1 / hypot(1 - re, im), 1e-8);
    }
    // symplectic Euler keeps areas: on x'' = -x its two conjugate factors have the product 1
    assert_near(hn_stability_growth(hn_stepper_find("symplectic-euler"), 0, 1), 1, 1e-15);
}

static void limits_on_the_axes_are_those_on_the_cards(void **state) {
    (void)state;
    int served = 0;
    for (int k = 0; k < hn_stepper_count(); k++) {
        const hn_stepper *stepper = hn_stepper_at(k);
        const hn_eigenvalue gap[2] = {{-1, 0}, {-1, 0}}, ring[2] = {{0, 1}, {0, -1}};
        const double real = hn_stability_limit(stepper, gap, 2),
                     imag = hn_stability_limit(stepper, ring, 2);
        assert_int_equal(isnan(real), hn_stability_why_not(stepper) != NULL);
        assert_int_equal(isnan(imag), isnan(real));
        if (isnan(real)) {
            assert_true(isnan(hn_stability_growth(stepper, -1, 0)));
            continue;
        }
        served++;
        if (isinf(stepper->real_limit)) {
            assert_true(isinf(real) && isinf(imag));
            continue;
        }
        assert_rel(real, stepper->real_limit, 1e-6);
        assert_near(imag, stepper->imag_limit, 1e-6 * stepper->imag_limit);
    }
    assert_int_equal(served, 13); // 7 explicit, 6 collocation and implicit Euler
}

static void
a_limit_scales_with_the_fastest_eigenvalue_and_leaves_growth_of_the_motion_out(void **state) {
    (void)state;
    const hn_stepper *rk4 = hn_stepper_find("rk4"), *euler = hn_stepper_find("euler"),
                     *symplectic = hn_stepper_find("symplectic-euler");
    const hn_eigenvalue mixed[] = {{0, 1000}, {0, -1000}, {-50, 0}, {-1, 0}};
    assert_rel(hn_stability_limit(rk4, mixed, 4), rk4->imag_limit / 1000, 1e-9);
    assert_near(hn_stability_limit(euler, mixed, 4), 0, 0);
    const hn_eigenvalue toppling[] = {{3, 0}, {-3, 0}};
    assert_rel(hn_stability_limit(rk4, toppling, 2), rk4->real_limit / 3, 1e-9);
    const hn_eigenvalue only_growing[] = {{3, 0}};
    assert_true(isinf(hn_stability_limit(rk4, only_growing, 1)));
    assert_true(isinf(hn_stability_limit(rk4, NULL, 0)));

    // light damping gives explicit Euler a limit: |1 + h s| = 1 at h = -2 re / |s|^2
    const hn_eigenvalue light[] = {{-0.5, 100}, {-0.5, -100}};
    assert_rel(hn_stability_limit(euler, light, 2), 1 / (0.25 + 1e4), 1e-6);
    // a damper alone, v' = -c v: v (1 - h c) though a double root would end at 0.828
    const hn_eigenvalue damper[] = {{-1e6, 0}, {-1e-3, 0}};
    assert_rel(hn_stability_limit(symplectic, damper, 2), 2e-6, 1e-8);
    // a stiff spring whose links turn: its growth belongs to the motion
    const hn_eigenvalue turning[] = {{1, 1000}, {1, -1000}};
    assert_rel(hn_stability_limit(rk4, turning, 2), rk4->imag_limit / 1000, 1e-9);
}

static void stabilisation_adds_the_roots_of_its_equation(void **state) {
    (void)state;
    hn_eigenvalue s[2];
    hn_stability_baumgarte(5, 13, s);
    assert_near(s[0].re, -5, 0);
    assert_near(s[0].im, 12, 1e-14);
    assert_near(s[1].im, -12, 1e-14);
    hn_stability_baumgarte(1e6, 1, s); // s^2 + 2e6 s + 1: the small root is -1/2e6 to 12 digits
    assert_rel(s[0].re, -2e6, 1e-12);
    assert_rel(s[1].re, -5e-7, 1e-12);
    hn_stability_baumgarte(0, 0, s);
    assert_near(modulus(&s[0]) + modulus(&s[1]), 0, 0);
    hn_stability_baumgarte(50, 50, s);
    assert_rel(hn_stability_limit(hn_stepper_find("rk4"), s, 2), 2.785293563405282 / 50, 1e-9);
}

static void spectra_are_those_known_and_do_not_depend_on_how_the_loop_is_written(void **state) {
    (void)state;
    hn_model m;
    hn_eigenvalue s[12], t[12];
    // x'' + 2 z w x' + w^2 x and y'' = -c y': roots known
    hn_model_open_text(
        &m,
        "{\"holonom\": 1, \"name\": \"two\", \"lagrangian\": {\"coordinates\": [{\"name\": \"x\", "
        "\"rate\": \"u\"}, {\"name\": \"y\", \"rate\": \"w\"}], \"kinetic\": \"(u^2 + 2*w^2)/2\", "
        "\"potential\": \"50*x^2\", \"forces\": {\"x\": \"-12*u\", \"y\": \"-2e6*w\"}}, "
        "\"start\": {\"positions\": {\"x\": 1, \"y\": 0}, \"rates\": {\"x\": 0, \"y\": 0}}}",
        NULL);
    assert_int_equal(start_spectrum(&m, s, 12), 4);
    assert_rel(s[0].re, -1e6, 1e-12);
    assert_near(s[0].im, 0, 0);
    assert_near(s[1].re, -6, 1e-8); // rounding of 1e6
    assert_near(s[1].im, 8, 1e-8);
    assert_near(s[2].im, -8, 1e-8);
    assert_near(modulus(&s[3]), 0, 1e-8);
    hn_model_close(&m);

    // rows that depend on each other change nothing; a loop described as bodies or by formulas is
    // the same loop
    const char *const same[] = {"fb0-redundant", "fb0-lagrangian", "fb0-tilted"};
    hn_model_open_closed(&m, "fb0", NULL);
    assert_int_equal(start_spectrum(&m, s, 12), 2);
    hn_model_close(&m);
    for (size_t k = 0; k < sizeof same / sizeof *same; k++) {
        hn_model_open_closed(&m, same[k], NULL);
        assert_int_equal(start_spectrum(&m, t, 12), 2);
        assert_near(t[0].re, s[0].re, 1e-8 * modulus(s));
        assert_near(t[0].im, s[0].im, 1e-8 * modulus(s));
        hn_model_close(&m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stiff_spring_on_the_loop_vibrates_as_the_loop_lets_it),
        cmocka_unit_test(growth_is_the_modulus_of_the_stability_function),
        cmocka_unit_test(limits_on_the_axes_are_those_on_the_cards),
        cmocka_unit_test(
            a_limit_scales_with_the_fastest_eigenvalue_and_leaves_growth_of_the_motion_out),
        cmocka_unit_test(stabilisation_adds_the_roots_of_its_equation),
        cmocka_unit_test(spectra_are_those_known_and_do_not_depend_on_how_the_loop_is_written),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
