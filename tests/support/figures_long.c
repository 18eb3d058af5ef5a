// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/figures_sets.h"

#include "support/near.h"

#include <math.h>
#include <stdio.h>

// Long runs of a pendulum let go level. The energy is watched at every step.

typedef struct long_row {
    const char *method;
    double h;
    const char *printed;   ///< largest change of the energy at the end [J]
    const char *a_million; ///< what that makes after a million steps by its law
    double tenth,
        /// growth over the last nine tenths and what it may be off: 1 flat, 10 linear, 100
        /// quadratic
        units;
    const char *law;
} long_row;

static const long_row rows[] = {
    {"index3@rattle", 1e-2, "3.6e-3", "3.6e-3", 1, 0.01, "flat"},
    {"index3@rattle", 1e-3, "3.6e-5", "3.6e-5", 1, 0.01, "flat"},
    {"projection@rk4", 1e-2, "1.6e-2", "1.6e-3", 10, 0.9,
     "linear; the first swings show in the early part"},
    {"projection@rk4", 1e-3, "1.6e-8", "1.6e-9", 10, 0.9,
     "linear; the first swings show in the early part"},
    {"baumgarte:alpha=10,beta=10@rk4", 1e-2, "0.24", "0.024", 10, 0.9,
     "linear; the first swings show in the early part"},
    {"baumgarte:alpha=10,beta=10@rk4", 1e-3, "2.8e-6", "2.8e-7", 10, 0.9,
     "linear; the first swings show in the early part"},
    {"index1@rk4", 1e-3, "4.9e-2", "4.9e-4", 100, 20, "quadratic"},
};

static void put_row(hn_figures *f, const hn_model *m, const long_row *r, const char *energy,
                    double steps) {
    char method[96], how[160];
    (void)snprintf(method, sizeof method, "%s:h=%g", r->method, r->h);
    (void)snprintf(how, sizeof how, "pendulum from level, %s, %g steps", method, steps);
    hn_run *run = hn_motion_start(m, method);
    (void)hn_motion_at(run, steps / 10 * r->h);
    const double early = fabs(hn_run_get_summary(run).worst_energy_change);
    (void)hn_motion_at(run, steps * r->h);
    const hn_run_summary s = hn_run_get_summary(run);
    hn_run_free(run);
    hn_figure_put(f, "largest change of energy [J]", how, energy, fabs(s.worst_energy_change));
    char printed[16];
    (void)snprintf(printed, sizeof printed, "%g", r->tenth);
    const hn_figure growth = {.what = "growth over the last nine tenths",
                              .how = how,
                              .printed = printed,
                              .units = r->units,
                              .note = r->law};
    hn_figure_add(f, &growth, fabs(s.worst_energy_change) / early);
}

void hn_figures_long_runs(hn_figures *f) {
    hn_model m;
    hn_model_open_text(&m, hn_figure_bob, NULL);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        put_row(f, &m, &rows[i], rows[i].printed, 1e7);
    }
    hn_model_close(&m);
}

void hn_figures_million_steps(hn_figures *f) {
    hn_model m;
    hn_model_open_text(&m, hn_figure_bob, NULL);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        put_row(f, &m, &rows[i], rows[i].a_million, 1e6);
    }
    hn_model_close(&m);
}
