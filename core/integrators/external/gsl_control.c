// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/external/gsl_control.h"

#include <gsl/gsl_errno.h>
#include <stdlib.h>

typedef struct control_state {
    hn_tolerance tol;
    gsl_odeiv2_control *own; // the library's
    double *size;            // n: sizes in place of the entries of y
} control_state;

static void *alloc(void) {
    return calloc(1, sizeof(control_state));
}

static int init(void *state, double atol, double rtol, double of_y, double of_slope) {
    control_state *s = state;
    s->tol.atol = atol;
    s->tol.rtol = rtol;
    return gsl_odeiv2_control_init(s->own, atol, rtol, of_y, of_slope);
}

// the library takes |y| for the size of an entry, which therefore gets its size
static int adjust_step(void *state, size_t n, unsigned order, const double *y, const double *err,
                       const double *slope, double *h) {
    const control_state *s = state;
    for (size_t i = 0; i < n; i++) {
        s->size[i] = hn_tolerance_size(&s->tol, (int)i, y[i]);
    }
    return s->own->type->hadjust(s->own->state, n, order, s->size, err, slope, h);
}

static int error_level(void *state, double y, double slope, double h, size_t i, double *level) {
    const control_state *s = state;
    const double size = hn_tolerance_size(&s->tol, (int)i, y);
    return s->own->type->errlevel(s->own->state, size, slope, h, i, level);
}

static int set_driver(void *state, const gsl_odeiv2_driver *driver) {
    const control_state *s = state;
    return gsl_odeiv2_control_set_driver(s->own, driver);
}

static void release(void *state) {
    control_state *s = state;
    if (s->own) {
        gsl_odeiv2_control_free(s->own);
    }
    free(s->size);
    free(s);
}

static const gsl_odeiv2_control_type type = {
    "tolerances of angles", alloc, init, adjust_step, error_level, set_driver, release};

gsl_odeiv2_control *hn_gsl_control_create(const hn_tolerance *tol, int n) {
    gsl_odeiv2_control *c = gsl_odeiv2_control_alloc(&type);
    if (!c) {
        return NULL;
    }
    control_state *s = c->state;
    s->tol = *tol;
    s->size = calloc((size_t)n, sizeof *s->size);
    s->own = tol->unit
                 ? gsl_odeiv2_control_scaled_new(tol->atol, tol->rtol, 1, 0, tol->unit, (size_t)n)
                 : gsl_odeiv2_control_y_new(tol->atol, tol->rtol);
    if (!s->size || !s->own) {
        gsl_odeiv2_control_free(c);
        return NULL;
    }
    return c;
}
