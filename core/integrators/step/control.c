// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/step/control.h"

#include "dynamics/compile/coordinates.h"

#include <float.h>
#include <math.h>

double hn_tolerance_size(const hn_tolerance *tol, int i, double y) {
    // rounding of an angle and of the few sums that it enters
    static const double ROUNDING = 64 * DBL_EPSILON;
    const double size = fabs(y);
    const bool is_angle = tol->is_angle && i < tol->n_pos && tol->is_angle[i];
    return is_angle && size > M_PI ? fmax(fabs(remainder(y, 2 * M_PI)), ROUNDING * size / tol->rtol)
                                   : size;
}

void hn_whole_turns(const hn_tolerance *tol, int n, const double *y, double *turns) {
    for (int i = 0; i < n; i++) {
        const bool is_angle = tol->is_angle && i < tol->n_pos && tol->is_angle[i];
        turns[i] = is_angle ? 2 * M_PI * round(y[i] / (2 * M_PI)) : 0;
    }
}

double hn_tolerance_of(const hn_tolerance *tol, int i, double y0, double y1) {
    const double size = fmax(hn_tolerance_size(tol, i, y0), hn_tolerance_size(tol, i, y1));
    return tol->atol * (tol->unit ? tol->unit[i] : 1) + tol->rtol * size;
}

double hn_error_norm(int n, const double *err, const double *y0, const double *y1,
                     const hn_tolerance *tol) {
    double sum = 0;
    for (int i = 0; i < n; i++) {
        const double e = err[i] / hn_tolerance_of(tol, i, y0[i], y1[i]);
        if (!isfinite(e) || !isfinite(y1[i])) {
            return HUGE_VAL;
        }
        sum += e * e;
    }
    return n > 0 ? sqrt(sum / n) : 0;
}

double hn_step_factor(hn_step_control *control, double err, int k) {
    // a step that failed outright says nothing about how far to shrink
    if (!isfinite(err)) {
        control->just_rejected = 1;
        return HN_STEP_SHRINK;
    }

    // PI control
    const double floor_err = fmax(err, 1e-10);
    double factor = HN_STEP_SAFETY * pow(floor_err, -0.7 / k) * pow(control->last, 0.4 / k);
    factor = fmin(HN_STEP_GROW, fmax(HN_STEP_SHRINK, factor));
    if (err > 1) {
        // the PI term may ask for growth after a good step; a rejection must shrink
        factor = fmin(factor, HN_STEP_SAFETY);
        control->just_rejected = 1;
        return factor;
    }

    // no growth right after a rejection
    if (control->just_rejected) {
        factor = fmin(1, factor);
    }
    control->just_rejected = 0;
    control->last = fmax(err, 1e-4);
    return factor;
}

static bool is_length(const hn_system *sys, int i) {
    const hn_scene *scene = hn_system_scene(sys);
    return i < hn_system_get_info(sys).n_user &&
           scene->coordinates[hn_system_user_coordinate(sys, i)].kind == HN_LENGTH;
}

// what counts as one for speed i: a radian, or the characteristic length
static double unit_of(const hn_system *sys, int i) {
    return is_length(sys, i) ? hn_system_length(sys) : 1;
}

double hn_drive_norm(const hn_system *sys, const double *q0, const double *q1) {
    const int nv = hn_system_get_info(sys).nv;
    double largest = 0;
    for (int i = 0; i < nv; i++) {
        const int at = hn_system_position_of(sys, i);
        if (at >= 0) {
            largest = fmax(largest, fabs(q1[at] - q0[at]) / unit_of(sys, i));
        }
    }
    return largest / HN_DRIVE_STEP;
}

double hn_drive_first_step(const hn_system *sys, const double *v) {
    const int nv = hn_system_get_info(sys).nv;
    double fastest = 0;
    for (int i = 0; i < nv; i++) {
        fastest = fmax(fastest, fabs(v[i]) / unit_of(sys, i));
    }
    return fastest > 0 ? 0.1 * HN_DRIVE_STEP / fastest : 0;
}

/// A power of ten; 1 where the size is between `least` and `most`, or none is known.
static double round_unit(double size, double least, double most) {
    const bool plain = !(size > 0) || !isfinite(size) || (size >= least && size <= most);
    return plain ? 1 : pow(10, round(log10(size)));
}

static double fastest_rate(const hn_system *sys, const double *v) {
    const hn_quantity *g = hn_system_scene(sys)->gravity;
    const double weight =
        sqrt(g[0].value * g[0].value + g[1].value * g[1].value + g[2].value * g[2].value);
    double rate = sqrt(weight / hn_system_length(sys));
    for (int i = 0; i < hn_system_get_info(sys).nv; i++) {
        rate = fmax(rate, fabs(v[i]) / unit_of(sys, i));
    }
    return rate;
}

void hn_coordinate_units(const hn_system *sys, double *unit) {
    const double length =
        round_unit(hn_system_length(sys), HN_UNIT_LENGTH_LEAST, HN_UNIT_LENGTH_MOST);
    for (int i = 0; i < hn_system_get_info(sys).nv; i++) {
        unit[i] = is_length(sys, i) ? length : 1; // quaternions and angles are of order one
    }
}

void hn_tolerance_units(const hn_system *sys, bool is_chosen, const double *v, double *unit) {
    const hn_system_info info = hn_system_get_info(sys);
    for (int i = 0; i < info.nq + info.nv; i++) {
        unit[i] = 1;
    }
    if (is_chosen) {
        return;
    }
    const double rate = round_unit(fastest_rate(sys, v), HN_UNIT_RATE_LEAST, HN_UNIT_RATE_MOST);
    hn_coordinate_units(sys, unit + info.nq);
    for (int i = 0; i < info.nv; i++) {
        const int at = hn_system_position_of(sys, i);
        const double own = unit[info.nq + i];
        if (at >= 0) {
            unit[at] = own;
        }
        unit[info.nq + i] = own * rate;
    }
}

hn_force_units hn_tolerance_forces(const hn_system *sys, const double *M, const double *v) {
    const size_t nv = (size_t)hn_system_get_info(sys).nv;
    const double length = hn_system_length(sys), rate = fastest_rate(sys, v);
    double energy = 0;
    if (!M) {
        return (hn_force_units){1, 1, 1};
    }
    for (size_t j = 0; j < nv; j++) {
        const double speed = unit_of(sys, (int)j) * rate;
        energy = fmax(energy, M[j * nv + j] * speed * speed);
    }
    return (hn_force_units){
        .force = round_unit(energy / length, HN_UNIT_FORCE_LEAST, HUGE_VAL),
        .moment = round_unit(energy, HN_UNIT_FORCE_LEAST, HUGE_VAL),
        .rate = round_unit(rate, HN_UNIT_RATE_LEAST, HN_UNIT_RATE_MOST),
    };
}

/// [s] of a state in plain numbers 1, else the time in which a velocity of its unit changes a
/// coordinate by its unit.
static double time_unit(const hn_ode *ode) {
    return ode->unit && ode->n_pos > 0 && ode->n_vel > 0 ? ode->unit[0] / ode->unit[ode->n_pos] : 1;
}

hn_status hn_first_step(const hn_ode *ode, double t, const double *y, int order, double rtol,
                        double atol, double hmax, double *f0, double *work, double *work2,
                        double *h) {
    const int n = ode->n_pos + ode->n_vel;
    const hn_tolerance tol = hn_tolerance_for(ode, rtol, atol);
    HN_TRY(ode->rhs(ode->self, t, y, f0));
    for (int i = 0; i < n; i++) {
        work[i] = hn_tolerance_size(&tol, i, y[i]);
    }
    const double d0 = hn_error_norm(n, work, y, y, &tol), d1 = hn_error_norm(n, f0, y, y, &tol);
    const double least = 1e-6 * time_unit(ode);
    double h0 = d0 < 1e-5 || d1 < 1e-5 ? least : 0.01 * d0 / d1;
    h0 = fmin(h0, hmax);
    for (int i = 0; i < n; i++) {
        work[i] = y[i] + h0 * f0[i];
    }
    HN_TRY(ode->rhs(ode->self, t + h0, work, work2));
    for (int i = 0; i < n; i++) {
        work2[i] -= f0[i];
    }
    const double d2 = hn_error_norm(n, work2, y, y, &tol) / h0;
    const double steepest = fmax(d1, d2);
    const double h1 =
        steepest <= 1e-15 ? fmax(least, h0 * 1e-3) : pow(0.01 / steepest, 1.0 / order);
    *h = fmin(fmin(100 * h0, h1), hmax);
    return HN_OK;
}
