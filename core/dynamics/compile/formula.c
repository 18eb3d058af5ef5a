// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/formula.h"

#include "dynamics/compile/system_build.h"
#include "expr/construct.h"
#include "expr/parse.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

typedef struct scope {
    const hn_system *sys;
    int with_state;         ///< coordinates, rates and t may appear
    const hn_ex *positions; ///< of the scene coordinates
    const hn_ex *rates;
    const char *refused; ///< a name that exists but has no expression here
    int refused_ball;    ///< because it is an entry of an orientation
} scope;

static bool find_state(scope *s, const char *name, hn_ex *out) {
    const hn_system *sys = s->sys;
    if (!strcmp(name, "t")) {
        *out = sys->t;
        return true;
    }

    // a coordinate or its rate
    for (int i = 0; i < sys->scene->n_coordinates; i++) {
        const hn_coordinate *c = &sys->scene->coordinates[i];
        int is_position = !strcmp(c->name, name);
        if (!is_position && strcmp(c->rate, name) != 0) {
            continue;
        }

        // a name that exists but has no expression: refused after parsing
        if (sys->user_known[i] == HN_KNOWN_NOTHING ||
            (is_position && sys->user_known[i] == HN_KNOWN_RATE)) {
            s->refused = c->name;
            s->refused_ball = sys->user_known[i] == HN_KNOWN_RATE;
            *out = hn_num(0);
            return true;
        }

        *out = is_position ? s->positions[i] : s->rates[i];
        return true;
    }
    return false;
}

static int find_name(void *user, const char *name, hn_ex *out) {
    scope *s = user;
    for (int i = 0; i < s->sys->scene->n_params; i++) {
        if (!strcmp(s->sys->scene->params[i].name, name)) {
            *out = s->sys->params[i];
            return 1;
        }
    }
    return s->with_state && find_state(s, name, out);
}

hn_status hn_system_quantity(const hn_system *sys, const hn_quantity *quantity, hn_ex *out) {
    return hn_system_quantity_of(sys, quantity, sys->user_q, sys->user_v, out);
}

hn_status hn_system_quantity_of(const hn_system *sys, const hn_quantity *quantity,
                                const hn_ex *positions, const hn_ex *rates, hn_ex *out) {
    *out = hn_num(quantity->value);
    if (!quantity->formula || (!quantity->varies && !sys->opts.symbolic_params)) {
        return HN_OK;
    }

    // parse with the scene's names
    scope s = {.sys = sys, .with_state = quantity->varies, .positions = positions, .rates = rates};
    hn_parse_opts opts = {.lookup = find_name, .user = &s};
    hn_diag diag = {0};
    hn_status status = hn_parse(sys->g, quantity->formula, &opts, out, &diag);

    // say what kept a name from an expression
    if (status != HN_OK) {
        return hn_diags_add(hn_system_faults(sys), status, quantity->pointer, diag.hint,
                            "in '%s': %s", quantity->formula, diag.message);
    }
    if (s.refused && s.refused_ball) {
        return hn_diags_add(hn_system_faults(sys), HN_ERR_UNSUPPORTED, quantity->pointer,
                            "use its rates, or a joint of revolutes in its place",
                            "'%s' is an entry of an orientation, which jumps where the rotation "
                            "passes half a revolution, so no formula can use it",
                            s.refused);
    }
    if (s.refused) {
        return hn_diags_add(
            hn_system_faults(sys), HN_ERR_UNSUPPORTED, quantity->pointer,
            "cut another joint of its loop, or use coordinates of joints that are not cut",
            "'%s' belongs to a cut joint between bodies that do not turn about parallel axes, so "
            "it has no formula",
            s.refused);
    }
    return HN_OK;
}

void hn_system_stand_ins(const hn_system *sys, const char *kind, hn_ex *out, int *symbols) {
    for (int i = 0; i < sys->scene->n_coordinates; i++) {
        char name[160];
        snprintf(name, sizeof name, "%s %s", kind, sys->scene->coordinates[i].name);
        out[i] = hn_symbol(sys->g, name, NULL);
        symbols[i] = hn_ex_symbol(sys->g, out[i]);
    }
}

hn_status hn_system_vector(const hn_system *sys, const hn_quantity *quantity, hn_vec3 *out) {
    for (int i = 0; i < 3; i++) {
        HN_TRY(hn_system_quantity(sys, &quantity[i], &out->x[i]));
    }
    return HN_OK;
}
