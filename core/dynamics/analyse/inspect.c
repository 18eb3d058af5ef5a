// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/analyse/inspect.h"

#include "dynamics/compile/system_impl.h"
#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "dynamics/evaluate/factor.h"
#include "dynamics/evaluate/solve_rows.h"
#include "expr/print.h"
#include "linalg/newton_matrix.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

// ---- tree, loops, groups ----

static const char *link_name(const hn_system *sys, int link) {
    const int body = sys->tree.links[link].body;
    return body < 0 ? "ground" : sys->scene->bodies[body].name;
}

static void put_branch(hn_strbuf *b, const hn_system *sys, int link) {
    const hn_link *l = &sys->tree.links[link];
    hn_strbuf line;
    hn_strbuf_init(&line);
    for (int i = hn_tree_depth(&sys->tree, l->body); i > 0; i--) {
        hn_strbuf_add(&line, "  ");
    }
    hn_strbuf_add(&line, link_name(sys, link));
    if (l->joint >= 0) {
        const hn_joint *joint = &sys->scene->joints[l->joint];
        if (!joint->is_formal) {
            hn_strbuf_printf(&line, " by %s %s", hn_joint_type_name(joint->type), joint->name);
        }
    }
    hn_json_string(b, hn_strbuf_text(&line));
    b->failed |= line.failed;
    hn_strbuf_reset(&line);
}

/// Depth first without recursion: a chain may be as deep as there are bodies.
static void put_tree(hn_strbuf *b, const hn_system *sys) {
    const hn_link *links = sys->tree.links;
    hn_json_key(b, "tree");
    hn_json_array(b);
    int at = sys->tree.ground;
    while (at >= 0) {
        // a joint of several degrees of freedom is reported at its end, as the joint it is
        if (!links[at].is_virtual) {
            put_branch(b, sys, at);
        }
        if (links[at].first_child >= 0) {
            at = links[at].first_child;
            continue;
        }
        while (at >= 0 && links[at].next_sibling < 0) {
            at = links[at].parent;
        }
        at = at >= 0 ? links[at].next_sibling : -1;
    }
    hn_json_end_array(b);
}

static void put_loops(hn_strbuf *b, const hn_system *sys) {
    hn_json_key(b, "loops");
    hn_json_array(b);
    for (int k = 0; k < sys->n_loops; k++) {
        const hn_loop *loop = &sys->loops[k];

        hn_json_object(b);
        hn_json_put_string(b, "name", loop->name);
        hn_json_put_string(b, "joint",
                           loop->joint >= 0 ? sys->scene->joints[loop->joint].name : NULL);
        hn_json_put_string(b, "why", loop->why);

        // its rows, by name
        hn_json_key(b, "rows");
        hn_json_array(b);
        for (int row = 0; row < sys->nc; row++) {
            if (sys->rows[row].loop == k) {
                hn_json_string(b, sys->rows[row].name);
            }
        }
        hn_json_end_array(b);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

static void put_groups(hn_strbuf *b, const hn_system *sys) {
    const hn_tree *tree = &sys->tree;
    hn_json_key(b, "groups");
    hn_json_array(b);
    for (int k = 0; k < tree->n_groups; k++) {
        if (tree->groups[k].n_links == 0) {
            continue;
        }

        // the base, and the bodies that turn in the group by themselves
        hn_json_object(b);
        hn_json_put_string(b, "base", link_name(sys, tree->groups[k].base));
        hn_json_put_bool(b, "base_rotates", tree->groups[k].moving);
        hn_json_key(b, "bodies");
        hn_json_array(b);
        for (int i = 0; i < tree->n_links; i++) {
            if (tree->links[i].group == k && tree->links[i].root == i && i != tree->ground) {
                hn_json_string(b, link_name(sys, i));
            }
        }
        hn_json_end_array(b);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

// ---- coordinates ----

static const char *meaning_of(const hn_system *sys, int i) {
    if (sys->scene->is_lagrangian) {
        return "as in the scene";
    }
    const hn_link *l = &sys->tree.links[sys->tree.link_of[i]];
    if (l->type == HN_JOINT_PRISMATIC) {
        return "displacement along the joint";
    }
    if (l->type == HN_JOINT_SPHERICAL) {
        return "orientation: a unit quaternion, moved by the angular velocity in the child's axes";
    }
    if (l->angle_ref >= 0) {
        return "absolute angle in its group";
    }
    return "angle of the joint";
}

static void put_coordinates(hn_strbuf *b, const hn_system *sys) {
    hn_json_key(b, "coordinates");
    hn_json_array(b);
    for (int i = 0; i < sys->nv; i++) {
        // the scene's coordinate in terms of the system's
        int user = hn_system_user_coordinate(sys, i);
        hn_strbuf text;
        hn_strbuf_init(&text);
        hn_strbuf_printf(&text, "%s = ", sys->scene->coordinates[user].name);
        const int place = hn_system_position_of(sys, i);
        if (place >= 0) {
            hn_print(&text, sys->g, sys->user_q[user], HN_PRINT_TEXT, 6);
        } else {
            hn_strbuf_add(&text, "entry of the rotation vector of the quaternion");
        }
        const int symbol = place >= 0 ? sys->q_symbols[place] : -1;

        // the system's coordinate by the name of its symbol
        hn_json_object(b);
        hn_json_put_string(b, "name",
                           symbol >= 0 ? hn_graph_symbol_name(sys->g, symbol)
                                       : sys->scene->coordinates[user].name);
        hn_json_put_string(b, "rate", hn_graph_symbol_name(sys->g, sys->v_symbols[i]));
        hn_json_put_string(b, "meaning", meaning_of(sys, i));
        hn_json_put_string(b, "scene", hn_strbuf_text(&text));
        hn_json_end_object(b);
        b->failed |= text.failed;
        hn_strbuf_reset(&text);
    }
    hn_json_end_array(b);
}

static void put_limits(hn_strbuf *b, const hn_system *sys) {
    hn_json_key(b, "limits");
    hn_json_array(b);
    for (int i = 0; i < sys->scene->n_coordinates; i++) {
        const hn_coordinate *c = &sys->scene->coordinates[i];
        if (c->max == c->min || (!isfinite(c->min) && !isfinite(c->max))) {
            continue; // both 0 where a scene was not read from a file
        }
        hn_json_object(b);
        hn_json_put_string(b, "name", c->name);
        if (isfinite(c->min)) {
            hn_json_put_number(b, "min", c->min);
        }
        if (isfinite(c->max)) {
            hn_json_put_number(b, "max", c->max);
        }
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

/// Returns whether something beside motors drives the scene: a follower, a table, or a formula of
/// time.
static bool is_driven(const hn_system *sys) {
    bool driven = sys->info.has_time;
    for (int k = 0; k < sys->scene->n_loads; k++) {
        const hn_load_kind kind = sys->scene->loads[k].kind;
        driven |= kind == HN_LOAD_FOLLOW || kind == HN_LOAD_TABLE;
    }
    return driven;
}

void hn_system_actuation_put(hn_strbuf *b, const hn_system *sys, int freedoms) {
    int n = 0;
    for (int i = 0; i < sys->scene->n_coordinates; i++) {
        n += sys->scene->coordinates[i].actuated != 0;
    }

    // motors against degrees of freedom
    const char *reading = "fully actuated: as many actuated coordinates as degrees of freedom";
    if (n == 0 && is_driven(sys)) {
        reading = "no motors: driven by loads or motions that are given over time";
    } else if (n == 0) {
        reading = "passive: nothing is driven";
    } else if (n < freedoms) {
        reading = "under-actuated: fewer actuated coordinates than degrees of freedom";
    } else if (n > freedoms) {
        reading = "over-actuated: more actuated coordinates than degrees of freedom, so motors can "
                  "work against "
                  "each other";
    }

    hn_json_key(b, "actuation");
    hn_json_object(b);
    hn_json_put_int(b, "actuated", n);
    hn_json_put_int(b, "dof", freedoms);
    hn_json_put_string(b, "reading", reading);
    hn_json_end_object(b);
}

static void put_sizes(hn_strbuf *b, const hn_system *sys) {
    hn_json_key(b, "sizes");
    hn_json_object(b);
    int formal = 0;
    for (int k = 0; k < sys->scene->n_joints; k++) {
        formal += sys->scene->joints[k].is_formal;
    }
    hn_json_put_int(b, "bodies", sys->scene->n_bodies - formal);
    hn_json_put_int(b, "speeds", sys->nv);
    hn_json_put_int(b, "rows", sys->nc);
    hn_json_put_int(b, "loops", sys->n_loops);
    hn_json_put_int(b, "freedoms_by_count", sys->nv - sys->nc);
    hn_json_end_object(b);
}

// ---- counts ----

typedef struct counts {
    int M, f, phi, J, gamma, together;
    hn_tape_info solve, baumgarte, motion; ///< motion: accelerations alone
    hn_factor_info factor;
    int M_entries; ///< of the whole matrix
    int legs_save; ///< operations, by rows seen from legs
} counts;

static hn_status count_terms(const hn_system *sys, unsigned terms, hn_arena *arena, int *ops) {
    hn_eval *eval;
    HN_TRY(hn_eval_create(sys, terms, arena, &eval));
    *ops = hn_eval_info(eval).ops;
    hn_eval_free(eval);
    return HN_OK;
}

static hn_status count_solve(const hn_system *sys, hn_accel_opts opts, hn_arena *arena,
                             hn_tape_info *info) {
    hn_accel *accel;
    HN_TRY(hn_accel_create(sys, &opts, arena, &accel));
    *info = hn_accel_tape_info(accel);
    hn_accel_free(accel);
    return HN_OK;
}

static hn_status count_all(const hn_system *sys, hn_arena *arena, counts *c) {
    const struct {
        unsigned terms;
        int *ops;
    } list[] = {
        {HN_TERM_M, &c->M},
        {HN_TERM_F, &c->f},
        {HN_TERM_PHI, &c->phi},
        {HN_TERM_J, &c->J},
        {HN_TERM_GAMMA, &c->gamma},
        {HN_TERM_M | HN_TERM_F | HN_TERM_PHI | HN_TERM_J | HN_TERM_GAMMA, &c->together},
    };

    // terms by themselves and together
    for (size_t k = 0; k < sizeof list / sizeof *list; k++) {
        HN_TRY(count_terms(sys, list[k].terms, arena, list[k].ops));
    }

    // whole solves
    HN_TRY(hn_solve_rows_saved(sys, &c->legs_save));
    const hn_accel_opts full = {.want_lambda = 1}, bare = {0};
    const hn_accel_opts baumgarte = {.baumgarte = 1, .want_lambda = 1};
    HN_TRY(count_solve(sys, full, arena, &c->solve));
    HN_TRY(count_solve(sys, baumgarte, arena, &c->baumgarte));
    HN_TRY(count_solve(sys, bare, arena, &c->motion));

    // the sparse factor
    hn_factor *factor;
    HN_TRY(hn_factor_create(sys, HN_FACTOR_MASS, arena, &factor));
    c->factor = hn_factor_get_info(factor);
    hn_factor_free(factor);

    for (int k = 0; k < sys->M.n; k++) {
        c->M_entries += sys->M.at[k].row == sys->M.at[k].col ? 1 : 2;
    }
    return HN_OK;
}

/// The solver of the matrices of Newton's method: [M -J'; J 0], to which implicit integrators add
/// terms in the same places.
static void put_newton(hn_strbuf *b, const hn_system *sys, const counts *c) {
    const int n = sys->nv + sys->nc;
    const long long entries = c->M_entries + 2LL * sys->J.n;
    const int sparse = hn_newton_matrix_wants_sparse(n, entries);
    hn_json_put_string(b, "newton",
                       sparse ? "sparse LU (SuiteSparse KLU)" : "dense LU, equilibrated");
    hn_json_put_int(b, "newton_size", n);
    hn_json_put_int(b, "newton_entries", entries);
}

static void put_solver(hn_strbuf *b, const hn_system *sys, const counts *c) {
    hn_json_key(b, "solver");
    hn_json_object(b);
    hn_json_put_string(b, "answers",
                       c->factor.available ? "sparse LDL' in the compiled instructions"
                                           : "dense least-norm");
    hn_json_put_string(b, "why",
                       c->factor.available
                           ? "an order of elimination without a zero pivot was found when compiling"
                           : "every order of elimination meets a zero pivot");
    if (c->factor.available) {
        hn_json_put_string(b, "behind_it",
                           "iterative refinement where the pivot ratio is below 1e-3; where it is "
                           "below 1e-8 or a row is zero, the dense least-norm solver, which "
                           "finds the rank and allows dependent rows");
        hn_json_put_int(b, "pivots", c->factor.n_blocks);
    }
    put_newton(b, sys, c);
    hn_json_end_object(b);
}

static void put_nonzeros(hn_strbuf *b, const hn_system *sys, const counts *c) {
    int below = (c->M_entries - sys->M.n) + sys->J.n; // entries of K below its diagonal
    hn_json_key(b, "nonzeros");
    hn_json_object(b);
    hn_json_put_int(b, "M", c->M_entries);
    hn_json_put_int(b, "M_of", (long long)sys->nv * sys->nv);
    hn_json_put_int(b, "J", sys->J.n);
    hn_json_put_int(b, "J_of", (long long)sys->nv * sys->nc);
    if (c->factor.available) {
        hn_json_put_int(b, "L", c->factor.nnz);
        hn_json_put_int(b, "fill_in", c->factor.nnz - below);
    }
    hn_json_end_object(b);
}

static void put_operations(hn_strbuf *b, const counts *c) {
    hn_json_key(b, "operations");
    hn_json_object(b);
    hn_json_put_int(b, "M", c->M);
    hn_json_put_int(b, "f", c->f);
    hn_json_put_int(b, "phi", c->phi);
    hn_json_put_int(b, "J", c->J);
    hn_json_put_int(b, "gamma", c->gamma);
    hn_json_put_int(b, "together", c->together);

    // a whole solve on the tape
    if (c->factor.available) {
        hn_json_put_int(b, "solve", c->solve.ops);
        hn_json_put_int(b, "solve_baumgarte", c->baumgarte.ops);
    } else { // the tape gives the terms, a dense solve does the rest
        hn_json_key(b, "solve");
        hn_json_null(b);
        hn_json_key(b, "solve_baumgarte");
        hn_json_null(b);
    }
    hn_json_end_object(b);

    // the tape itself
    hn_json_key(b, "tape");
    hn_json_object(b);
    hn_json_put_int(b, "instructions", c->solve.instructions);
    hn_json_put_int(b, "slots", c->solve.slots);
    hn_json_put_int(b, "additions", c->solve.add);
    hn_json_put_int(b, "products", c->solve.mul);
    hn_json_put_int(b, "divisions", c->solve.div);
    hn_json_put_int(b, "sincos", c->solve.sincos);
    hn_json_end_object(b);
}

// ---- what was left out ----

static void put_absence(hn_strbuf *b, const char *what, long long count, int operations) {
    hn_json_object(b);
    hn_json_put_string(b, "what", what);
    if (count >= 0) {
        hn_json_put_int(b, "count", count);
    }
    if (operations >= 0) {
        hn_json_put_int(b, "operations", operations);
    }
    hn_json_end_object(b);
}

static bool all_zero(const hn_ex *e, int n) {
    for (int i = 0; i < n; i++) {
        if (!hn_is_zero(e[i])) {
            return false;
        }
    }
    return true;
}

static bool has_gravity(const hn_scene *scene) {
    return scene->gravity[0].value != 0 || scene->gravity[1].value != 0 ||
           scene->gravity[2].value != 0;
}

static void put_left_out(hn_strbuf *b, const hn_system *sys, const counts *c) {
    long long M_zeros = (long long)sys->nv * sys->nv - c->M_entries;
    long long J_zeros = (long long)sys->nv * sys->nc - sys->J.n;
    hn_json_key(b, "left_out");
    hn_json_array(b);

    // terms that vanish identically
    if (sys->info.rows_dropped) {
        put_absence(b, "closure rows that vanish identically", sys->info.rows_dropped, -1);
    }
    if (M_zeros) {
        put_absence(b, "entries of M that vanish identically", M_zeros, -1);
    }
    if (J_zeros) {
        put_absence(b, "entries of J that vanish identically", J_zeros, -1);
    }

    // what the scene does not have
    if (!sys->scene->is_lagrangian && !has_gravity(sys->scene)) {
        put_absence(b, "gravity: there is none", -1, -1);
    }
    if (sys->nc && all_zero(sys->phi_t, sys->nc)) {
        put_absence(b, "phi_t: no closure depends on time", -1, -1);
    }

    // what is computed for methods that ask for it, and for no other
    if (sys->nc && c->factor.available) {
        put_absence(b, "phi and its rate, where a method does not need them", -1,
                    c->baumgarte.ops - c->solve.ops);
        put_absence(b, "multipliers, where a method does not need them", -1,
                    c->solve.ops - c->motion.ops);
    }
    if (c->legs_save > 0) {
        put_absence(b,
                    "in solving for accelerations: spatial loops closed in the axes of their last "
                    "link, not of the body where their ends part",
                    sys->n_legs, c->legs_save);
    }
    hn_json_end_array(b);
}

// ---- the whole ----

hn_status hn_system_inspect_put(hn_strbuf *b, const hn_system *sys) {
    hn_arena *arena = hn_arena_create(0);
    counts c = {0};
    hn_status status = arena ? count_all(sys, arena, &c) : HN_ERR_MEMORY;
    hn_arena_free(arena);
    if (status != HN_OK) {
        return status;
    }

    // what the scene is: bodies, loops, coordinates
    int lagrangian = sys->scene->is_lagrangian;
    hn_json_put_string(b, "kind",
                       lagrangian                 ? "Lagrangian"
                       : sys->scene->has_formulas ? "bodies, joints and formulas"
                                                  : "bodies and joints");
    put_sizes(b, sys);
    if (!lagrangian) {
        put_tree(b, sys);
    }
    put_loops(b, sys);
    if (!lagrangian) {
        put_groups(b, sys);
    }
    put_coordinates(b, sys);
    put_limits(b, sys);

    // what solving it takes
    put_solver(b, sys, &c);
    put_nonzeros(b, sys, &c);
    put_operations(b, &c);
    hn_json_put_int(b, "graph_nodes", hn_graph_size(sys->g));
    put_left_out(b, sys, &c);
    return b->failed ? HN_ERR_MEMORY : HN_OK;
}
