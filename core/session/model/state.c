// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/state.h"

#include "base/suggest.h"
#include "dynamics/compile/coordinates.h"
#include "session/model/model.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_SUGGESTIONS = 400 };
/// A value below LARGE leaves eight digits to what it is added to; a coordinate has lost its digits
/// where it is off by this part of itself.
static const double LARGE = 1e8, LOST = 1e-6;

static const hn_coordinate *user_coordinate(const hn_model *model, int i) {
    return &hn_model_scene(model)
                ->coordinates[hn_system_user_coordinate(hn_model_system(model), i)];
}

static hn_status unknown_entry(const hn_model *model, const char *name, int n, hn_diags *diags) {
    const char *names[2 * MAX_SUGGESTIONS];
    const int told = n < MAX_SUGGESTIONS ? n : MAX_SUGGESTIONS;
    for (int i = 0; i < told; i++) {
        names[2 * i] = user_coordinate(model, i)->name;
        names[2 * i + 1] = user_coordinate(model, i)->rate;
    }
    char hint[HN_DIAG_HINT], pointer[HN_DIAG_POINTER];
    hn_suggest(hint, name, names, 2 * told, "name a coordinate or a rate of the scene");
    snprintf(pointer, sizeof pointer, "/state/%.80s", name);
    return hn_diags_add(diags, HN_ERR_INPUT, pointer, hint,
                        "the scene has no free coordinate or rate '%.80s'", name);
}

/// Puts one entry in its place among the user coordinates.
static hn_status put_entry(const hn_model *model, const hn_state_entry *e, int n, double *uq,
                           double *uv, hn_diags *diags) {
    double *place = NULL;
    for (int i = 0; i < n && !place; i++) {
        const hn_coordinate *c = user_coordinate(model, i);
        place = strcmp(c->name, e->name) == 0   ? &uq[i]
                : strcmp(c->rate, e->name) == 0 ? &uv[i]
                                                : NULL;
    }
    if (!place) {
        return unknown_entry(model, e->name, n, diags);
    }
    if (!isfinite(e->value)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/state", NULL, "'%.80s' is not a finite number",
                            e->name);
    }
    *place = e->value;
    return HN_OK;
}

/// The entry of the largest value; NULL where none is large.
static const hn_state_entry *find_large(const hn_state_entry *entries, int n) {
    const hn_state_entry *large = NULL;
    for (int k = 0; k < n; k++) {
        if (fabs(entries[k].value) > (large ? fabs(large->value) : LARGE)) {
            large = &entries[k];
        }
    }
    return large;
}

/// Refuses a value so large that another coordinate or rate loses its digits: the system adds
/// coordinates of a chain. u: the 2 n values that are wanted; back: those that the system holds.
static hn_status check_digits(const hn_model *model, const hn_state_entry *large, int n,
                              const double *u, const double *back, hn_diags *diags) {
    char pointer[HN_DIAG_POINTER];
    snprintf(pointer, sizeof pointer, "/state/%.80s", large->name);
    for (int i = 0; i < 2 * n; i++) {
        const hn_coordinate *c = user_coordinate(model, i % n);
        const char *name = i < n ? c->name : c->rate;
        if (fabs(back[i] - u[i]) > LOST * (1 + fabs(u[i])) && strcmp(name, large->name) != 0) {
            return hn_diags_add(
                diags, HN_ERR_INPUT, pointer, "take a smaller value",
                "'%.80s' = %g is so large that rounding changes '%.80s' to %g; %g was asked for",
                large->name, large->value, name, back[i], u[i]);
        }
    }
    return HN_OK;
}

hn_status hn_model_state(const hn_model *model, const hn_state_entry *entries, int n_entries,
                         double *q, double *v, hn_diags *diags) {
    const hn_system *sys = hn_model_system(model);
    const int n = hn_system_get_info(sys).n_user;
    double *u = calloc(4 * (size_t)n + 1, sizeof *u);
    if (!u) {
        return HN_ERR_MEMORY;
    }
    double *back = u + 2 * (size_t)n;
    hn_system_to_user(sys, hn_model_q(model), u);
    hn_system_rates_to_user(sys, hn_model_v(model), u + n);
    hn_status status = HN_OK;
    for (int k = 0; k < n_entries; k++) {
        const hn_status one = put_entry(model, &entries[k], n, u, u + n, diags);
        status = status == HN_OK ? one : status;
    }
    hn_system_from_user(sys, u, q);
    hn_system_rates_from_user(sys, u + n, v);
    const hn_state_entry *large = status == HN_OK ? find_large(entries, n_entries) : NULL;
    if (large) {
        hn_system_to_user(sys, q, back);
        hn_system_rates_to_user(sys, v, back + n);
        status = check_digits(model, large, n, u, back, diags);
    }
    free(u);
    return status;
}
