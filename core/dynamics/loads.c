// Loads as generalised forces, by virtual work: what a load does is power = force . rate, and the coefficients of the rates
// are those that closures use too.
//     spring between points, D = p - q, l = |D|, e_i = D . dD/dq_i:  l l' = sum e_i u_i
//         Q_i = -(k (1 - l0 / l) + c l'/ l) e_i,   V = k (l - l0)^2 / 2
//     on a coordinate x:  Q_i = tau dx'/du_i
#include "dynamics/system_impl.h"

static hn_status read_law(hn_system *sys, const hn_load *load, hn_ex *k, hn_ex *rest, hn_ex *c) {
    hn_status status = hn_system_quantity(sys, &load->stiffness, k);
    if (status == HN_OK) {
        status = hn_system_quantity(sys, &load->rest, rest);
    }
    return status == HN_OK ? hn_system_quantity(sys, &load->damping, c) : status;
}

/// A spring whose law changes with the state has no potential that could be told.
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
    hn_status status = read_law(sys, load, &k, &rest, &c);
    if (status == HN_OK) {
        status = geometry->span(geometry->self, load->p, load->q, &span);
    }
    if (status != HN_OK) {
        return status;
    }
    hn_ex l2 = hn_vec3_dot(g, span.delta, span.delta);
    hn_ex pull = k; // force over length
    hn_ex stretch2 = l2;
    if (!hn_is_zero(rest)) {
        hn_ex l = hn_sqrt(g, l2);
        hn_ex stretch = hn_sub(g, l, rest);
        pull = hn_mul(g, k, hn_sub(g, hn_num(1), hn_div(g, rest, l)));
        stretch2 = hn_mul(g, stretch, stretch);
    }
    if (!hn_is_zero(c)) {
        hn_ex l_rate = hn_num(0); // l l'
        for (int i = 0; i < span.n; i++) {
            hn_ex e = hn_vec3_dot(g, span.delta, span.coefficient[i]);
            l_rate = hn_add(g, l_rate, hn_mul(g, e, sys->v[span.coordinate[i]]));
        }
        pull = hn_add(g, pull, hn_mul(g, c, hn_div(g, l_rate, l2)));
    }
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
        return hn_diags_add(sys->diags, HN_ERR_UNSUPPORTED, load->pointer,
                            "cut another joint of its loop",
                            "a load on '%s' is not served: its joint is cut between bodies that do "
                            "not turn about parallel axes",
                            sys->scene->coordinates[load->coordinate].name);
    }
    hn_ex *gradient = hn_arena_get(sys->arena, (size_t)sys->nv * sizeof *gradient);
    if (!gradient) {
        return HN_ERR_MEMORY;
    }
    hn_diff_reverse(sys->g, sys->user_v[load->coordinate], sys->v_symbols, sys->nv, gradient);
    for (int i = 0; i < sys->nv; i++) {
        sys->f[i] = hn_add(sys->g, sys->f[i], hn_mul(sys->g, tau, gradient[i]));
    }
    return HN_OK;
}

static hn_status add_joint_spring(hn_system *sys, const hn_geometry *geometry,
                                  const hn_load *load) {
    (void)geometry;
    hn_ex k, rest, c;
    hn_status status = read_law(sys, load, &k, &rest, &c);
    if (status != HN_OK) {
        return status;
    }
    if (sys->user_known[load->coordinate] == HN_KNOWN_RATE && !hn_is_zero(k)) {
        return hn_diags_add(
            sys->diags, HN_ERR_UNSUPPORTED, load->pointer,
            "give it damping only, or use springs between points",
            "a spring on '%s' is not served: an entry of an orientation jumps where "
            "the turn passes half a revolution",
            sys->scene->coordinates[load->coordinate].name);
    }
    hn_graph *g = sys->g;
    hn_ex stretch = hn_sub(g, sys->user_q[load->coordinate], rest);
    hn_ex tau = hn_add(g, hn_mul(g, k, stretch), hn_mul(g, c, sys->user_v[load->coordinate]));
    status = add_on_coordinate(sys, load, hn_neg(tau));
    if (status == HN_OK) {
        add_spring_energy(sys, load, k, hn_mul(g, stretch, stretch));
    }
    return status;
}

static hn_status add_coordinate(hn_system *sys, const hn_geometry *geometry, const hn_load *load) {
    (void)geometry;
    hn_ex tau;
    hn_status status = hn_system_quantity(sys, &load->value[0], &tau);
    return status == HN_OK ? add_on_coordinate(sys, load, tau) : status;
}

static hn_status add_force(hn_system *sys, const hn_geometry *geometry, const hn_load *load) {
    hn_vec3 force;
    hn_span span;
    hn_status status = hn_system_vector(sys, load->value, &force);
    if (status == HN_OK) {
        status = geometry->span(geometry->self, load->p, -1, &span);
    }
    for (int i = 0; status == HN_OK && i < span.n; i++) {
        hn_ex *f = &sys->f[span.coordinate[i]];
        *f = hn_add(sys->g, *f, hn_vec3_dot(sys->g, force, span.coefficient[i]));
    }
    return status;
}

typedef hn_status (*load_adder)(hn_system *sys, const hn_geometry *geometry, const hn_load *load);
static const load_adder ADDERS[] = {
    [HN_LOAD_SPRING] = add_spring,
    [HN_LOAD_JOINT_SPRING] = add_joint_spring,
    [HN_LOAD_COORDINATE] = add_coordinate,
    [HN_LOAD_FORCE] = add_force,
};

hn_status hn_loads_compile(hn_system *sys, const hn_geometry *geometry) {
    hn_status status = HN_OK;
    for (int i = 0; i < sys->scene->n_loads && status == HN_OK; i++) {
        const hn_load *load = &sys->scene->loads[i];
        if (load->kind >= sizeof ADDERS / sizeof *ADDERS) {
            return hn_diags_add(sys->diags, HN_ERR_UNSUPPORTED, load->pointer, NULL,
                                "a load of this kind cannot be compiled");
        }
        status = ADDERS[load->kind](sys, geometry, load);
    }
    return status;
}
