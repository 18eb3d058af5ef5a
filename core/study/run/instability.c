// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/run/instability.h"

#include "base/units.h"
#include "dynamics/compile/coordinates.h"
#include "study/spectrum/load_share.h"
#include "study/spectrum/region.h"

#include <math.h>
#include <stdio.h>

enum { MOST_SPEEDS = 60 }; // of a mechanism whose spectrum is computed

/// The fastest part of the motion at a state.
typedef struct fastest_part {
    double limit; ///< largest stable step [s]; HUGE_VAL: none, or none that can be computed
    hn_eigenvalue value;
    const hn_load *load; ///< that makes it fast; NULL: none alone
    bool at_rest;        ///< the mechanism would be as fast at rest: no matter of its velocities
} fastest_part;

/// At rest the fastest part has another rate: by this share where velocities are what makes it.
static const double SLOWER_AT_REST = 0.5;
/// A link turns this many times as fast as the one whose speed is given only near a dead point.
static const double FAR_ABOVE = 50;

static bool is_decay(hn_eigenvalue s) {
    return fabs(s.re) > fabs(s.im);
}

/// The load that makes the mode of an eigenvalue fast, NULL where that is none alone.
static const hn_load *find_load(const hn_stepping *s, hn_spectrum *spectrum, hn_arena *arena,
                                const hn_state_at *at, hn_eigenvalue value) {
    double *x = hn_arena_doubles(arena, (size_t)s->info.nv);
    if (!x || hn_spectrum_mode(spectrum, value, x) != HN_OK) {
        return NULL;
    }
    const double size = hypot(value.re, value.im);
    const hn_mode_at mode = {at->t, at->q, at->v, x, is_decay(value)};
    return hn_load_share_find(s->sys, &mode, is_decay(value) ? size : size * size);
}

/// Returns whether the mechanism at rest in this configuration has a part as fast as `rate` [1/s].
static bool is_fast_at_rest(const hn_stepping *s, hn_spectrum *spectrum, hn_arena *arena,
                            const hn_state_at *at, double rate) {
    const double *rest = hn_arena_doubles(arena, (size_t)s->info.nv); // zeros
    const hn_eigenvalue *found = NULL;
    int n = 0;
    return !rest || hn_spectrum_calc(spectrum, at->t, at->q, rest, &found, &n) != HN_OK ||
           (n > 0 && hypot(found[0].re, found[0].im) > SLOWER_AT_REST * rate);
}

static fastest_part find_fastest(const hn_stepping *s, const hn_state_at *at) {
    hn_arena *arena = hn_arena_create(0);
    hn_spectrum *spectrum = NULL;
    const hn_eigenvalue *found = NULL;
    fastest_part out = {.limit = HUGE_VAL, .at_rest = true};
    int n = 0;
    if (arena && hn_spectrum_create(s->sys, arena, &spectrum) == HN_OK &&
        hn_spectrum_calc(spectrum, at->t, at->q, at->v, &found, &n) == HN_OK && n > 0) {
        out.value = found[0];
        const double limit = hn_stability_limit(s->spec.stepper, found, n);
        out.limit = isfinite(limit) ? limit : HUGE_VAL;
        out.load = find_load(s, spectrum, arena, at, out.value);
        out.at_rest =
            out.load || is_fast_at_rest(s, spectrum, arena, at, hypot(out.value.re, out.value.im));
    }
    hn_spectrum_free(spectrum);
    hn_arena_free(arena);
    return out;
}

/// The coordinate of an angle that turns fastest at a state, *rate [rad/s]; NULL where none turns.
static const hn_coordinate *find_fastest_turn(const hn_stepping *s, const hn_state_at *at,
                                              double *rate) {
    const hn_scene *scene = hn_system_scene(s->sys);
    const hn_coordinate *fastest = NULL;
    double rates[MOST_SPEEDS];
    *rate = 0;
    hn_system_rates_to_user(s->sys, at->v, rates);
    for (int i = 0; i < s->info.n_user; i++) {
        const hn_coordinate *c = &scene->coordinates[hn_system_user_coordinate(s->sys, i)];
        if (c->kind == HN_ANGLE && fabs(rates[i]) > fabs(*rate)) {
            *rate = rates[i];
            fastest = c;
        }
    }
    return fastest;
}

/// The angle of a mechanism with one freedom whose speed the scene gives, where a link turns
/// FAR_ABOVE times as fast at the start: the mechanism starts near a dead point of it. Else NULL.
static const hn_coordinate *find_dead_start(const hn_stepping *s) {
    const hn_scene *scene = hn_system_scene(s->sys);
    double most = 0;
    if (s->info.nc == 0 || s->info.nv - s->info.nc != 1 ||
        !find_fastest_turn(s, &s->start, &most)) {
        return NULL;
    }
    for (int i = 0; i < s->info.n_user; i++) {
        const hn_coordinate *c = &scene->coordinates[hn_system_user_coordinate(s->sys, i)];
        if (c->kind == HN_ANGLE && c->v0_pinned && c->v0 != 0) {
            return fabs(most) > FAR_ABOVE * fabs(c->v0) ? c : NULL;
        }
    }
    return NULL;
}

/// "the links turn fast, w3 = 3.3e+03 rad/s, as the start is near a dead point of th1 (w1 =
/// 4)". Returns false where nothing turns.
static bool describe_speed(const hn_stepping *s, const hn_state_at *at, char *out, size_t size) {
    double rate;
    const hn_coordinate *fastest = find_fastest_turn(s, at, &rate), *dead = find_dead_start(s);
    char why[96] = "";
    if (!fastest) {
        return false;
    }
    if (dead) {
        snprintf(why, sizeof why, ", as the start is near a dead point of %.16s (%.16s = %.3g)",
                 dead->name, dead->rate, dead->v0);
    }
    snprintf(out, size, "the links turn fast, %.16s = %.2g rad/s%s", fastest->rate, rate, why);
    return true;
}

/// "the damping of load 'left motor' decays", "a vibration of the mechanism oscillates"; where the
/// motion itself is what is fast: how fast the links turn.
static void describe_part(const hn_stepping *s, const fastest_part *part, char *out, size_t size) {
    char speed[160];
    const bool decays = is_decay(part->value);
    const char *verb = decays ? "decays" : "oscillates";
    if (part->load) {
        snprintf(out, size, "the %s of '%.60s' %s", decays ? "damping" : "stiffness",
                 part->load->name, verb);
    } else if (!part->at_rest && describe_speed(s, &s->earlier, speed, sizeof speed)) {
        snprintf(out, size, "%s; a deviation from this motion %s", speed, verb);
    } else {
        snprintf(out, size, "a %s %s",
                 decays ? "deviation from the motion" : "vibration of the mechanism", verb);
    }
}

bool hn_instability_explain(const hn_stepping *s, double *limit, char *out, size_t size) {
    const double h = hn_method_option(&s->spec, "h", 0);
    const bool is_ode = hn_method_form(s->spec.formulation, s->spec.stepper) == HN_FORM_ODE;
    char what[208];

    // methods and mechanisms for which a limit cannot be computed
    if (s->adaptive || !is_ode || s->info.nv > MOST_SPEEDS ||
        hn_stability_why_not(s->spec.stepper) ||
        (s->spec.formulation->traits & HN_TRAIT_ADDS_VIBRATIONS)) {
        return false;
    }

    const fastest_part part = find_fastest(s, &s->earlier);
    if (!(h > part.limit)) {
        return false;
    }
    *limit = part.limit;
    describe_part(s, &part, what, sizeof what);
    const bool decays = is_decay(part.value);
    const int digits = hn_digits_apart(h, part.limit, 3);
    snprintf(out, size,
             "h = %.*g s is above the stability limit of %s here, %.*g s (%s at %.2g %s)", digits,
             h, s->spec.stepper->name, digits, part.limit, what,
             decays ? fabs(part.value.re) : fabs(part.value.im), decays ? "1/s" : "rad/s");
    return true;
}
