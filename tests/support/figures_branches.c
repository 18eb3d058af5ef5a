// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures_sets.h"

#include "support/near.h"

#include "dynamics/evaluate/eval.h"
#include "linalg/svd.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Poses where J loses rank, passed, landed on and started from: the ladder with its tips as
// coordinates, parallelograms, a platform on six rods.

#define PI 3.14159265358979323846

// ---- the ladder of two four-bars ----

/// Uniform bars of 1 kg and 1 m; coordinates are the tips of three verticals; upright, 1 m/s to the
/// right.
static const char ladder[] =
    "{\"holonom\": 1, \"name\": \"ladder\", \"lagrangian\": {\"coordinates\": ["
    "{\"name\": \"x0\", \"rate\": \"u0\", \"unit\": \"m\"}, {\"name\": \"y0\", \"rate\": \"v0\", "
    "\"unit\": \"m\"}, {\"name\": \"x1\", \"rate\": \"u1\", \"unit\": \"m\"}, {\"name\": \"y1\", "
    "\"rate\": \"v1\", \"unit\": \"m\"}, {\"name\": \"x2\", \"rate\": \"u2\", \"unit\": \"m\"}, "
    "{\"name\": \"y2\", \"rate\": \"v2\", \"unit\": \"m\"}],"
    "\"kinetic\": \"(2*u0^2 + 3*u1^2 + 2*u2^2 + u0*u1 + u1*u2 + 2*v0^2 + 3*v1^2 + 2*v2^2 + v0*v1 + "
    "v1*v2)/6\", \"potential\": \"9.81*(y0 + 1.5*y1 + y2)\","
    "\"constraints\": [{\"name\": \"a\", \"formula\": \"(x0^2 + y0^2 - 1)/2\"}, {\"name\": \"b\", "
    "\"formula\": \"((x1 - 1)^2 + y1^2 - 1)/2\"}, {\"name\": \"c\", \"formula\": \"((x2 - 2)^2 + "
    "y2^2 "
    "- 1)/2\"}, {\"name\": \"d\", \"formula\": \"((x1 - x0)^2 + (y1 - y0)^2 - 1)/2\"}, {\"name\": "
    "\"e\", \"formula\": \"((x2 - x1)^2 + (y2 - y1)^2 - 1)/2\"}]},"
    "\"start\": {\"positions\": {\"x0\": 0, \"y0\": {\"guess\": 1}, \"x1\": {\"guess\": 1}, "
    "\"y1\": "
    "{\"guess\": 1}, \"x2\": {\"guess\": 2}, \"y2\": {\"guess\": 1}}, \"rates\": {\"x0\": 1}}}";

#define ENERGY(method, figure)                                        \
    {                                                                 \
        method, 10, HN_FIGURE_ENERGY_WORST, {                         \
            .what = "largest change of energy [J]", .printed = figure \
        }                                                             \
    }
#define FINE(method)                                                                   \
    {                                                                                  \
        method, 10, HN_FIGURE_ENERGY_WORST, {                                          \
            .what = "largest change of energy [J]", .printed = "9e-10", .factor = 1.4, \
            .note = "at any step; at the full seconds alone 9.5e-10"                   \
        }                                                                              \
    }
#define DIFFERS(method, figure, found, why)                                              \
    {                                                                                    \
        method, 10, HN_FIGURE_ENERGY_WORST, {                                            \
            .what = "largest change of energy [J]", .printed = figure, .instead = found, \
            .note = why                                                                  \
        }                                                                                \
    }

void hn_figures_ladder(hn_figures *f) {
    static const char
        refined[] = "turns here go on until the rows are met to rounding, there one was made",
        reach[] =
            "least norm counts rows as dependent that the gap inside a step could have parted";
    static const hn_figure_run runs[] = {
        ENERGY("projection:solver=range-space@rk4:h=1e-2", "4.6e-5"),
        FINE("projection:solver=range-space@rk4:h=1e-3"),
        ENERGY("projection@rk4:h=1e-2", "4.6e-5"),
        FINE("projection@rk4:h=1e-3"),
        ENERGY("projection:solver=proximal@rk4:h=1e-2", "4.6e-5"),
        DIFFERS("projection:solver=proximal@rk4:h=1e-3", "2.1e-6", "1.2e-9", refined),
        DIFFERS("projection:solver=least-norm@rk4:h=1e-2", "4.6e-5", "<2e-3", reach),
        DIFFERS("projection:solver=least-norm@rk4:h=1e-3", "9e-10", "<1e-5", reach),
        {"index1:solver=range-space@rk4:h=1e-3",
         10,
         HN_FIGURE_STOP,
         {.what = "without projection it ends [s]", .printed = "3.17"}},
    };
    hn_model m;
    hn_model_open_text(&m, ladder, NULL);
    assert_int_equal(m.status, HN_OK);
    hn_figure_runs(f, &m, "two four-bars, tips as coordinates", runs,
                   (int)(sizeof runs / sizeof *runs));
    hn_model_close(&m);
}

// ---- six rods ----

static double rods_sigma(const char *settings) {
    double sigma[6], v[8] = {0};
    hn_model m;
    hn_eval *e = NULL;
    hn_model_begin(&m, "stewart-rods", settings);
    assert_int_equal(hn_eval_create(m.sys, HN_TERM_J, m.arena, &e), HN_OK);
    hn_eval_run(e, 0, m.q, v);
    assert_int_equal(hn_singular_values(6, 6, hn_eval_get(e, HN_TERM_J), sigma, m.arena), HN_OK);
    hn_eval_free(e);
    hn_model_close(&m);
    return sigma[5];
}

void hn_figures_rods(hn_figures *f) {
    static const struct {
        double degrees;
        const char *how, *printed;
    } rows[] = {{0, "six rods, 15 and 45 degrees, yaw 0", "0.64"},
                {60, "six rods, 15 and 45 degrees, yaw 60 degrees", "0.25"},
                {80, "six rods, 15 and 45 degrees, yaw 80 degrees", "0.077"},
                {89, "six rods, 15 and 45 degrees, yaw 89 degrees", "0.0074"},
                {90, "six rods, 15 and 45 degrees, yaw 90 degrees", "<1e-14"}};
    for (int k = 0; k < 5; k++) {
        char settings[80];
        (void)snprintf(settings, sizeof settings, "rp=0.6 yaw=%.17g", rows[k].degrees * PI / 180);
        hn_figure_put(f, "smallest singular value of J", rows[k].how, rows[k].printed,
                      rods_sigma(settings));
    }
    char hexagons[120];
    (void)snprintf(hexagons, sizeof hexagons, "rp=0.6 ab=%.17g ap=%.17g yaw=0.3", PI / 6, PI / 6);
    hn_figure_put(f, "smallest singular value of J",
                  "six rods between similar hexagons, yaw 0.3 rad", "<1e-14", rods_sigma(hexagons));
}

// ---- parallelograms and their neighbours ----

static hn_figure_links parallelogram(void) {
    hn_figure_links l = hn_figure_fb0();
    l.l3 = l.m3 = 1;
    l.d = 2;
    l.th2 = 0;
    l.th3 = l.th1;
    return l;
}

static void open_links(hn_model *m, const hn_figure_links *l) {
    hn_figure_open_links(m, l);
    assert_int_equal(m->status, HN_OK);
}

/// Angle between the two cranks at t, in -pi .. pi; 0 on the parallel branch.
static double apart(const hn_model *m, const char *method, double t) {
    hn_run *run = hn_motion_start(m, method);
    const hn_sample s = hn_motion_at(run, t);
    const double angle = fabs(remainder(s.q[0] - s.q[2], 2 * PI));
    hn_run_free(run);
    return angle;
}

static void swinging_through(hn_figures *f) {
    hn_figure_links l = parallelogram();
    hn_model m;
    open_links(&m, &l);
    static const hn_figure luck = {
        .what = "change of energy on the other branch [J]",
        .how = "parallelogram from 1 rad, index1@rk4:h=1e-3, 5 s",
        .printed = "5",
        .instead = ">1",
        .note =
            "luck: where it leaves follows from rounding, and from the start, which is not told"};
    static const hn_figure_run stays = {"projection@rk4:h=1e-3",
                                        5,
                                        HN_FIGURE_ENERGY_WORST,
                                        {.what = "largest change of energy [J]",
                                         .printed = "2e-11",
                                         .factor = 3,
                                         .note = "the start is not told"}};
    hn_figure_put(f, "cranks apart at the end, h = 1e-3 [rad]",
                  "parallelogram from 1 rad, index1@rk4, 5 s", ">0.5",
                  apart(&m, "index1@rk4:h=1e-3", 5));
    hn_figure_add(f, &luck, hn_figure_measure(&m, "index1@rk4:h=1e-3", 5, HN_FIGURE_ENERGY_WORST));
    hn_figure_put(f, "cranks apart at the end, h = 1e-2 [rad]",
                  "parallelogram from 1 rad, index1@rk4, 5 s", "<1e-3",
                  apart(&m, "index1@rk4:h=1e-2", 5));
    hn_figure_put(f, "cranks apart at the end, h = 1e-3 [rad]",
                  "parallelogram from 1 rad, projection@rk4, 5 s", "<1e-13",
                  apart(&m, "projection@rk4:h=1e-3", 5));
    hn_figure_runs(f, &m, "parallelogram from 1 rad", &stays, 1);
    hn_model_close(&m);
}

/// Without gravity it turns at a constant rate, and 250 steps of 1e-3 s end flat to the last bit or
/// two.
static void landing(hn_figures *f) {
    hn_figure_links l = parallelogram();
    hn_model m;
    l.g = 0;
    l.th1 = l.th3 = 0.5;
    l.w1 = -2;
    open_links(&m, &l);
    static const hn_figure_run runs[] = {
        {"baumgarte:alpha=10,beta=10@rk4:h=1e-3",
         0.5,
         HN_FIGURE_STOP,
         {.what = "ends where it lands flat [s]", .printed = "0.25"}},
        {"index1@rk4:h=1e-3",
         0.5,
         HN_FIGURE_ENERGY_WORST,
         {.what = "passes: largest change of energy [J]", .printed = "<1e-14"}},
        {"projection@rk4:h=1e-3",
         0.5,
         HN_FIGURE_ENERGY_WORST,
         {.what = "passes: largest change of energy [J]", .printed = "<1e-14"}},
        {"projection:solver=proximal@rk4:h=1e-3",
         0.5,
         HN_FIGURE_ENERGY_WORST,
         {.what = "passes: largest change of energy [J]",
          .printed = "2e-11",
          .instead = "<1e-13",
          .note = "without gravity nothing but the landing is measured"}},
        {"index3@genalpha:h=1e-2",
         0.5,
         HN_FIGURE_ENERGY_WORST,
         {.what = "lands: change of energy [J]",
          .printed = "fails",
          .instead = "<1e-9",
          .note = "rows that depend on others are left out here"}},
    };
    hn_figure_runs(f, &m, "parallelogram at constant speed", runs, 5);
    hn_model_close(&m);
}

static void starting_flat(hn_figures *f) {
    hn_figure_links l = parallelogram();
    hn_model m;
    l.th1 = l.th3 = 0;
    l.pinned = 1; // of all speeds that fit, those of the parallel branch
    l.w1 = l.w3 = 2;
    open_links(&m, &l);
    static const hn_figure_run runs[] = {
        {"projection:solver=proximal@rk4:h=1e-3",
         0.5,
         HN_FIGURE_ENERGY_WORST,
         {.what = "largest change of energy [J]", .printed = "1e-11"}},
        {"udwadia-kalaba@rk4:h=1e-3",
         0.5,
         HN_FIGURE_ENERGY_WORST,
         {.what = "largest change of energy [J]", .printed = "<1e-10"}},
        {"index3@genalpha:h=1e-2",
         0.5,
         HN_FIGURE_ENERGY_WORST,
         {.what = "passes: largest change of energy [J]", .printed = "<1e-2"}},
        {"index3@genalpha:h=7.1e-3",
         0.5,
         HN_FIGURE_ENERGY_WORST,
         {.what = "change of energy [J]",
          .printed = "fails",
          .instead = "<1e-2",
          .note = "rows that depend on others are left out here"}},
    };
    hn_figure_runs(f, &m, "parallelogram from flat", runs, 4);
    hn_model_close(&m);
}

/// Ground longer than the coupler by `more`: no change point, but almost.
static void nearly_flat(hn_figures *f) {
    static const struct {
        double more;
        const char *scene;
    } rows[] = {{1e-4, "ground of 2.0001 m"}, {1e-5, "ground of 2.00001 m"}};
    static const hn_figure_run lost[] = {
        {"projection@rk4:h=1e-3",
         2,
         HN_FIGURE_ENERGY_WORST,
         {.what = "largest change of energy [J]", .printed = ">0.2"}},
        {"index1@rk4:h=1e-3",
         2,
         HN_FIGURE_ENERGY_WORST,
         {.what = "largest change of energy [J]", .printed = ">0.2"}},
        {"index3@genalpha:h=1e-3",
         2,
         HN_FIGURE_ENERGY_WORST,
         {.what = "largest change of energy [J]", .printed = ">0.2"}},
        {"projection@dopri5:rtol=1e-8",
         2,
         HN_FIGURE_ENERGY_WORST,
         {.what = "adaptive steps: largest change of energy [J]", .printed = "<1e-5"}},
    };
    for (int k = 0; k < 2; k++) {
        hn_figure_links l = parallelogram();
        hn_model m;
        l.d += rows[k].more;
        open_links(&m, &l);
        hn_figure_runs(f, &m, rows[k].scene, lost, 4);
        hn_model_close(&m);
    }
}

/// A crank that cannot turn: it ends where coupler and rocker are in line.
static void fold(hn_figures *f) {
    hn_figure_links l = parallelogram();
    hn_model m;
    l.d = 2.5;
    l.th2 = 0.3;
    l.th3 = 2;
    open_links(&m, &l);
    hn_run *run = hn_motion_start(&m, "reduced@rk4:h=1e-4");
    const hn_status status = hn_run_advance(run, 10);
    hn_sample s = {0};
    assert_int_equal(hn_run_sample(run, hn_run_time(run), &s), HN_OK);
    const hn_figure angle = {.what = "crank at its dead point [rad]",
                             .how = "links 1, 2, 1 on 2.5 m, reduced@rk4:h=1e-4",
                             .printed = "1.9284",
                             .note = "acos((l1^2 + d^2 - (l2 + l3)^2) / (2 l1 d))",
                             .units = 2};
    hn_figure_add(f, &angle, status == HN_OK ? nan("") : s.q[0]);
    hn_run_free(run);
    static const hn_figure_run through = {
        "partitioning@rk4:h=1e-4",
        10,
        HN_FIGURE_ENERGY_WORST,
        {.what = "runs through: largest change of energy [J]", .printed = "<1e-6"}};
    hn_figure_runs(f, &m, "links 1, 2, 1 on 2.5 m", &through, 1);
    hn_model_close(&m);
}

void hn_figures_change_points(hn_figures *f) {
    swinging_through(f);
    landing(f);
    starting_flat(f);
    nearly_flat(f);
    fold(f);
}
