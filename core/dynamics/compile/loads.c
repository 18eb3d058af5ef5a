// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/loads.h"

#include "dynamics/compile/formula.h"
#include "dynamics/compile/system_build.h"
#include "expr/construct.h"
#include "expr/diff.h"

/// Kept to report the wrenches of loads.
static void note_value(hn_system *sys, const hn_load *load, hn_vec3 value) {
    hn_load_value *out = &sys->load_values[load - sys->scene->loads];
    for (int i = 0; i < 3; i++) {
        out->x[i] = value.x[i];
    }
}

static hn_status read_law(hn_system *sys, const hn_load *load, hn_ex *k, hn_ex *rest, hn_ex *c) {
    HN_TRY(hn_system_quantity(sys, &load->stiffness, k));
    HN_TRY(hn_system_quantity(sys, &load->rest, rest));
    return hn_system_quantity(sys, &load->damping, c);
}

/// A spring whose law changes with the state has no potential.
static void add_spring_energy(hn_system *sys, const hn_load *load, hn_ex k, hn_ex stretch_squared) {
    if (!load->stiffness.varies && !load->rest.varies) {
        sys->potential =
            hn_add(sys->g, sys->potential, hn_scale(0.5, hn_mul(sys->g, k, stretch_squared)));
    }
}

static hn_status add_spring(hn_system *sys, const hn_geometry *geometry, const hn_load *load) {
    hn_graph *g = sys->g;
    hn_ex k, rest, c;
    hn_span span;
    HN_TRY(read_law(sys, load, &k, &rest, &c));
    HN_TRY(geometry->span(geometry->self, load->p, load->q, &span));

    // the elastic part
    hn_ex l2 = hn_vec3_dot(g, span.delta, span.delta);
    hn_ex pull = k; // force over length
    hn_ex stretch2 = l2;
    if (!hn_is_zero(rest)) {
        hn_ex l = hn_sqrt(g, l2);
        hn_ex stretch = hn_sub(g, l, rest);
        pull = hn_mul(g, k, hn_sub(g, hn_num(1), hn_div(g, rest, l)));
        stretch2 = hn_mul(g, stretch, stretch);
    }

    // the damper along the same line
    if (!hn_is_zero(c)) {
        hn_ex l_rate = hn_num(0); // l l'
        for (int i = 0; i < span.n; i++) {
            hn_ex e = hn_vec3_dot(g, span.delta, span.coefficient[i]);
            l_rate = hn_add(g, l_rate, hn_mul(g, e, sys->v[span.coordinate[i]]));
        }
        pull = hn_add(g, pull, hn_mul(g, c, hn_div(g, l_rate, l2)));
    }

    // by virtual work
    note_value(sys, load, (hn_vec3){{pull, hn_num(0), hn_num(0)}});
    for (int i = 0; i < span.n; i++) {
        hn_ex e = hn_vec3_dot(g, span.delta, span.coefficient[i]);
        hn_ex *f = &sys->f[span.coordinate[i]];
        *f = hn_sub(g, *f, hn_mul(g, pull, e));
    }
    add_spring_energy(sys, load, k, stretch2);
    return HN_OK;
}

static hn_status add_on_coordinate(hn_system *sys, const hn_load *load, hn_ex tau) {
    if (!sys->user_known[load->coordinate]) {
        return hn_diags_add(hn_system_faults(sys), HN_ERR_UNSUPPORTED, load->pointer,
                            "cut another joint of its loop",
                            "a load on '%s' is not supported: its joint is cut between bodies that "
                            "do not turn about parallel axes",
                            sys->scene->coordinates[load->coordinate].name);
    }
    hn_ex *gradient = hn_arena_get(sys->arena, (size_t)sys->nv * sizeof *gradient);
    if (!gradient) {
        return HN_ERR_MEMORY;
    }
    note_value(sys, load, (hn_vec3){{tau, hn_num(0), hn_num(0)}});
    hn_diff_reverse(sys->g, sys->user_v[load->coordinate], sys->v_symbols, sys->nv, gradient);
    for (int i = 0; i < sys->nv; i++) {
        sys->f[i] = hn_add(sys->g, sys->f[i], hn_mul(sys->g, tau, gradient[i]));
    }
    return HN_OK;
}

static hn_status refuse_position(hn_system *sys, const hn_load *load, const char *what) {
    return hn_diags_add(hn_system_faults(sys), HN_ERR_UNSUPPORTED, load->pointer,
                        "give it damping only, or use springs between points",
                        "%s on '%s' is not supported: an entry of an orientation jumps where the "
                        "rotation passes half a revolution",
                        what, sys->scene->coordinates[load->coordinate].name);
}

static hn_status add_joint_spring(hn_system *sys, const hn_geometry *geometry,
                                  const hn_load *load) {
    (void)geometry;
    hn_ex k, rest, c;
    HN_TRY(read_law(sys, load, &k, &rest, &c));
    if (sys->user_known[load->coordinate] == HN_KNOWN_RATE && !hn_is_zero(k)) {
        return refuse_position(sys, load, "a spring");
    }
    hn_graph *g = sys->g;
    hn_ex stretch = hn_sub(g, sys->user_q[load->coordinate], rest);
    hn_ex tau = hn_add(g, hn_mul(g, k, stretch), hn_mul(g, c, sys->user_v[load->coordinate]));
    HN_TRY(add_on_coordinate(sys, load, hn_neg(tau)));
    add_spring_energy(sys, load, k, hn_mul(g, stretch, stretch));
    return HN_OK;
}

static hn_status add_coordinate(hn_system *sys, const hn_geometry *geometry, const hn_load *load) {
    (void)geometry;
    hn_ex tau;
    HN_TRY(hn_system_quantity(sys, &load->value[0], &tau));
    return add_on_coordinate(sys, load, tau);
}

static void add_power(hn_system *sys, hn_vec3 wrench, const hn_span *span) {
    for (int i = 0; i < span->n; i++) {
        hn_ex *f = &sys->f[span->coordinate[i]];
        *f = hn_add(sys->g, *f, hn_vec3_dot(sys->g, wrench, span->coefficient[i]));
    }
}

static hn_status add_force(hn_system *sys, const hn_geometry *geometry, const hn_load *load) {
    hn_vec3 force;
    hn_span span;
    HN_TRY(hn_system_vector(sys, load->value, &force));
    HN_TRY(geometry->span(geometry->self, load->p, -1, &span));
    note_value(sys, load, force);
    add_power(sys, force, &span);
    return HN_OK;
}

/// A hand's spring with its damper: force = k (hand - p) - c p'.
static hn_status add_pull(hn_system *sys, const hn_geometry *geometry, const hn_load *load) {
    hn_graph *g = sys->g;
    hn_span span;
    HN_TRY(geometry->span(geometry->self, load->p, -1, &span));
    const hn_ex *in = sys->pull_inputs + HN_PULL_INPUTS * hn_pull_log_find(sys->pulls, load->p);
    hn_vec3 force, rate = hn_vec3_zero();
    for (int i = 0; i < span.n; i++) {
        const hn_vec3 part = hn_vec3_scale(g, sys->v[span.coordinate[i]], span.coefficient[i]);
        rate = hn_vec3_add(g, rate, part);
    }
    for (int i = 0; i < 3; i++) {
        const hn_ex elastic = hn_mul(g, in[0], hn_sub(g, in[2 + i], span.delta.x[i]));
        force.x[i] = hn_sub(g, elastic, hn_mul(g, in[1], rate.x[i]));
    }
    note_value(sys, load, force);
    add_power(sys, force, &span);
    return HN_OK;
}

static hn_status add_moment(hn_system *sys, const hn_geometry *geometry, const hn_load *load) {
    hn_vec3 moment;
    hn_span span;
    if (!geometry->spin) {
        return hn_diags_add(hn_system_faults(sys), HN_ERR_UNSUPPORTED, load->pointer, NULL,
                            "a moment needs a body to act on");
    }
    HN_TRY(hn_system_vector(sys, load->value, &moment));
    HN_TRY(geometry->spin(geometry->self, load->p, &span));
    note_value(sys, load, moment);
    add_power(sys, moment, &span);
    return HN_OK;
}

/// e, but no more than `limit` either way.
static hn_ex clamp(hn_graph *g, hn_ex e, hn_ex limit) {
    hn_ex below = hn_apply(g, HN_OP_MIN, (hn_ex[2]){e, limit});
    return hn_apply(g, HN_OP_MAX, (hn_ex[2]){below, hn_neg(limit)});
}

/// The target is a formula of t, so its rate is its derivative.
static hn_status add_follow(hn_system *sys, const hn_geometry *geometry, const hn_load *load) {
    (void)geometry;
    hn_graph *g = sys->g;
    hn_ex k, rest, c, target, limit, target_rate;
    HN_TRY(read_law(sys, load, &k, &rest, &c));
    HN_TRY(hn_system_quantity(sys, &load->value[0], &target));
    HN_TRY(hn_system_quantity(sys, &load->value[1], &limit));
    if (sys->user_known[load->coordinate] == HN_KNOWN_RATE) {
        return refuse_position(sys, load, "a follower");
    }

    // the target is a formula of t, so its rate is its derivative
    hn_diff(g, target, &sys->t_symbol, 1, &target_rate);
    hn_ex off = hn_sub(g, target, sys->user_q[load->coordinate]);
    hn_ex slow = hn_sub(g, target_rate, sys->user_v[load->coordinate]);
    hn_ex tau = hn_add(g, hn_mul(g, k, off), hn_mul(g, c, slow));

    if (load->value[1].value > 0) {
        tau = clamp(g, tau, limit);
    }
    return add_on_coordinate(sys, load, tau);
}

/// The table as a sum over its stretches, each a number between 0 and 1 times its change of value:
/// past its end a stretch is 1 exactly, so the sum stays right to rounding for ever.
static hn_status profile(hn_system *sys, const hn_profile *table, hn_ex *out) {
    hn_graph *g = sys->g;
    hn_ex *terms = hn_arena_get(sys->arena, ((size_t)table->n + 1) * sizeof *terms);
    if (!terms) {
        return HN_ERR_MEMORY;
    }

    // from value to value, each stretch a number between 0 and 1
    terms[0] = hn_num(table->value[0]);
    for (int i = 1; i < table->n; i++) {
        hn_ex part;
        if (table->steps) {
            hn_ex since = hn_sub(g, sys->t, hn_num(table->t[i]));
            part = hn_apply(g, HN_OP_STEP, &since);
        } else {
            hn_ex since = hn_sub(g, sys->t, hn_num(table->t[i - 1]));
            part = hn_scale(1 / (table->t[i] - table->t[i - 1]), since);
            part = hn_apply(g, HN_OP_MAX, (hn_ex[2]){part, hn_num(0)});
            part = hn_apply(g, HN_OP_MIN, (hn_ex[2]){part, hn_num(1)});
        }
        terms[i] = hn_scale(table->value[i] - table->value[i - 1], part);
    }

    *out = hn_sum(g, terms, table->n);
    return HN_OK;
}

static hn_status add_table(hn_system *sys, const hn_geometry *geometry, const hn_load *load) {
    (void)geometry;
    hn_ex tau;
    HN_TRY(profile(sys, &load->table, &tau));
    return add_on_coordinate(sys, load, tau);
}

typedef hn_status (*load_adder)(hn_system *sys, const hn_geometry *geometry, const hn_load *load);
static const load_adder ADDERS[] = {
    [HN_LOAD_SPRING] = add_spring,         [HN_LOAD_JOINT_SPRING] = add_joint_spring,
    [HN_LOAD_COORDINATE] = add_coordinate, [HN_LOAD_FORCE] = add_force,
    [HN_LOAD_MOMENT] = add_moment,         [HN_LOAD_FOLLOW] = add_follow,
    [HN_LOAD_TABLE] = add_table,           [HN_LOAD_PULL] = add_pull,
};

hn_status hn_loads_compile(hn_system *sys, const hn_geometry *geometry) {
    for (int i = 0; i < sys->scene->n_loads; i++) {
        const hn_load *load = &sys->scene->loads[i];
        if (load->kind >= sizeof ADDERS / sizeof *ADDERS) {
            return hn_diags_add(hn_system_faults(sys), HN_ERR_UNSUPPORTED, load->pointer, NULL,
                                "a load of this kind cannot be compiled");
        }
        HN_TRY(ADDERS[load->kind](sys, geometry, load));
    }
    return HN_OK;
}
