#include "dynamics/compile/quaternion.h"
#include "dynamics/compile/system_impl.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// A constant closure row smaller than this counts as closed, relative to the length of the
/// mechanism (or 1 for angles) [-].
static const double CLOSED = 1e-9;

hn_system_opts hn_system_opts_default(void) {
    return (hn_system_opts){.symbolic_params = 0};
}

// ---- building blocks for both kinds ----

static int name_is_taken(const hn_system *sys, const char *name) {
    if (hn_graph_find_symbol(sys->g, name) >= 0) {
        return 1;
    }
    return sys->opts.symbolic_params && hn_scene_find_param(sys->scene, name) >= 0;
}

static hn_ex new_symbol(hn_system *sys, const char *stem, int *number) {
    char name[128];
    snprintf(name, sizeof name - 8, "%s", stem);
    for (size_t n = strlen(name); name_is_taken(sys, name) && n < sizeof name - 1; n++) {
        name[n] = '_';
        name[n + 1] = 0;
    }
    hn_ex e = hn_symbol(sys->g, name, NULL);
    *number = hn_ex_symbol(sys->g, e);
    return e;
}

hn_status hn_system_make_symbols(hn_system *sys, const char *const *names,
                                 const char *const *rates) {
    for (int i = 0; i < sys->nq; i++) {
        sys->q[i] = new_symbol(sys, names[i], &sys->q_symbols[i]);
    }
    for (int i = 0; i < sys->nv; i++) {
        sys->v[i] = new_symbol(sys, rates[i], &sys->v_symbols[i]);
    }
    sys->t = new_symbol(sys, "t", &sys->t_symbol);
    sys->alpha = new_symbol(sys, "alpha", &sys->alpha_symbol);
    sys->beta = new_symbol(sys, "beta", &sys->beta_symbol);
    for (int i = 0; i < sys->scene->n_params; i++) {
        const hn_param *param = &sys->scene->params[i];
        sys->params[i] =
            sys->opts.symbolic_params ? hn_symbol(sys->g, param->name, NULL) : hn_num(param->value);
    }
    return hn_graph_failed(sys->g) ? HN_ERR_MEMORY : HN_OK;
}

static hn_ex *get_exprs(hn_system *sys, size_t n) {
    return hn_arena_get(sys->arena,
                        (n ? n : 1) * sizeof(hn_ex)); // zeroed: {0, HN_NODE_ONE} is the number zero
}

hn_status hn_system_allocate(hn_system *sys, int nq, int nv, int max_rows, int n_loops,
                             int n_points) {
    size_t n = (size_t)nv, m = (size_t)max_rows, nu = (size_t)sys->scene->n_coordinates;
    sys->nq = nq;
    sys->nv = nv;
    sys->n_loops = n_loops;
    sys->info.n_points = n_points;
    sys->q = get_exprs(sys, (size_t)nq);
    sys->v = get_exprs(sys, n);
    sys->f = get_exprs(sys, n);
    sys->phi = get_exprs(sys, m);
    sys->phi_t = get_exprs(sys, m);
    sys->gamma = get_exprs(sys, m);
    sys->points = get_exprs(sys, 3 * (size_t)n_points);
    sys->params = get_exprs(sys, (size_t)sys->scene->n_params);
    sys->user_q = get_exprs(sys, nu);
    sys->user_v = get_exprs(sys, nu);
    sys->user_gamma = get_exprs(sys, nu);
    sys->load_values =
        hn_arena_get(sys->arena, ((size_t)sys->scene->n_loads + 1) * sizeof *sys->load_values);
    sys->user_known = hn_arena_get(sys->arena, nu);
    sys->q_symbols = hn_arena_ints(sys->arena, (size_t)nq);
    sys->v_symbols = hn_arena_ints(sys->arena, n);
    sys->rows = hn_arena_get(sys->arena, m * sizeof *sys->rows);
    sys->dropped = hn_arena_get(sys->arena, m * sizeof *sys->dropped);
    sys->loops = hn_arena_get(sys->arena, (size_t)n_loops * sizeof *sys->loops);
    return hn_arena_failed(sys->arena) ? HN_ERR_MEMORY : HN_OK;
}

static hn_status refuse_row(hn_system *sys, const hn_new_row *row, double offset) {
    const char *unit = row->is_length ? " m" : "";
    return hn_diags_add(
        sys->diags, HN_ERR_INPUT, row->pointer,
        row->is_length ? "check where the joint sits on its two bodies, and the axes"
                       : "check the axes of the loop's joints",
        "the loop can never close: '%s' is off by %.6g%s in every pose", row->name, offset, unit);
}

hn_status hn_system_add_row(hn_system *sys, const hn_new_row *row) {
    sys->info.rows_before++;
    int moves = 0;
    for (int k = 0; k < row->n_J; k++) {
        moves |= !hn_is_zero(row->J[k].e);
    }
    double value;
    if (!moves) {
        if (!hn_is_number(row->phi, &value)) {
            return hn_diags_add(sys->diags, HN_ERR_INPUT, row->pointer,
                                "a constraint must contain a coordinate",
                                "'%s' depends on no coordinate", row->name);
        }
        if (fabs(value) > CLOSED * (row->is_length ? sys->length : 1)) {
            return refuse_row(sys, row, value);
        }
        sys->dropped[sys->info.rows_dropped++] = row->name;
        return HN_OK;
    }
    int i = sys->nc++;
    sys->phi[i] = row->phi;
    sys->phi_t[i] = row->phi_t;
    sys->gamma[i] = row->gamma;
    sys->rows[i] = (hn_row){.name = row->name, .loop = row->loop, .is_length = row->is_length};
    if (row->wrench) {
        sys->rows[i].wrench = *row->wrench;
    }
    for (int k = 0; k < row->n_J; k++) {
        hn_entries_add(&sys->J, i, row->J[k].col, row->J[k].e);
    }
    return HN_OK;
}

// ---- compiling ----

/// A coordinate that no mass and no closure touches has no equation.
static hn_status check_freedoms(hn_system *sys) {
    char *touched = hn_arena_get(sys->arena, (size_t)sys->nv + 1);
    if (!touched) {
        return HN_ERR_MEMORY;
    }
    for (int k = 0; k < sys->M.n; k++) {
        touched[sys->M.at[k].row] = touched[sys->M.at[k].col] = 1;
    }
    for (int k = 0; k < sys->J.n; k++) {
        touched[sys->J.at[k].col] = 1;
    }
    for (int i = 0; i < sys->nv; i++) {
        if (!touched[i]) {
            const hn_coordinate *c = &sys->scene->coordinates[hn_system_user_coordinate(sys, i)];
            return hn_diags_add(sys->diags, HN_ERR_INPUT,
                                c->joint >= 0 ? sys->scene->joints[c->joint].pointer : NULL,
                                "give the body a mass or an inertia about the joint",
                                "coordinate '%s' moves nothing that has mass", c->name);
        }
    }
    return HN_OK;
}

static int depends_on_time(const hn_system *sys) {
    for (int i = 0; i < sys->nv; i++) {
        if (hn_depends_on(sys->g, sys->f[i], sys->t_symbol)) {
            return 1;
        }
    }
    for (int i = 0; i < sys->nc; i++) {
        if (hn_depends_on(sys->g, sys->phi[i], sys->t_symbol)) {
            return 1;
        }
    }
    return 0;
}

static hn_status finish(hn_system *sys) {
    size_t n = (size_t)sys->nv, m = (size_t)sys->nc;
    sys->M_dense = get_exprs(sys, n * n);
    sys->J_dense = get_exprs(sys, m * n);
    if (hn_arena_failed(sys->arena) || sys->M.failed || sys->J.failed || sys->efforts.failed ||
        hn_graph_failed(sys->g)) {
        return HN_ERR_MEMORY;
    }
    hn_entries_sort(&sys->M);
    hn_entries_sort(&sys->J);
    for (int k = 0; k < sys->M.n; k++) {
        const hn_entry *e = &sys->M.at[k];
        sys->M_dense[(size_t)e->row * n + (size_t)e->col] = e->e;
        sys->M_dense[(size_t)e->col * n + (size_t)e->row] = e->e;
    }
    for (int k = 0; k < sys->J.n; k++) {
        sys->J_dense[(size_t)sys->J.at[k].row * n + (size_t)sys->J.at[k].col] = sys->J.at[k].e;
    }
    sys->info.nq = sys->nq;
    sys->info.nv = sys->info.n_user = sys->nv;
    sys->info.nc = sys->nc;
    sys->info.n_loops = sys->n_loops;
    sys->info.has_time = depends_on_time(sys);
    return check_freedoms(sys);
}

static const hn_quantity *place_on(const hn_joint *joint, int body) {
    return joint->parent == body ? joint->parent_at : joint->child == body ? joint->child_at : NULL;
}

/// Largest distance between two joints of one body, of the ground only if `grounds`.
static double largest_arm(const hn_scene *scene, int grounds) {
    double largest = 0;
    for (int a = 0; a < scene->n_joints; a++) {
        int bodies[2] = {scene->joints[a].parent, scene->joints[a].child};
        for (int e = 0; e < 2; e++) {
            for (int b = 0; b < a && (bodies[e] == HN_GROUND) == grounds; b++) {
                const hn_quantity *p = place_on(&scene->joints[a], bodies[e]);
                const hn_quantity *q = place_on(&scene->joints[b], bodies[e]);
                double d[3] = {0, 0, 0};
                for (int i = 0; q && i < 3; i++) {
                    d[i] = p[i].value - q[i].value;
                }
                largest = fmax(largest, sqrt(hn_num3_dot(d, d)));
            }
        }
    }
    return largest;
}

static double characteristic_length(const hn_scene *scene) {
    double length = largest_arm(scene, 0);
    if (length <= 0) {
        length = largest_arm(scene, 1);
    }
    return length > 0 ? length : 1;
}

static void forget_faults(hn_diags *diags, int told) {
    if (diags) {
        diags->found = told;
        diags->n = told < diags->n ? told : diags->n;
    }
}

hn_status hn_system_compile(const hn_scene *scene, const hn_system_opts *opts, hn_system **out,
                            hn_diags *diags) {
    HN_ASSERT(scene && out);
    hn_system *sys = calloc(1, sizeof *sys);
    hn_status status = HN_ERR_MEMORY;
    *out = NULL;
    if (!sys) {
        return status;
    }
    sys->scene = scene;
    sys->opts = opts ? *opts : hn_system_opts_default();
    sys->diags = diags;
    int told = diags ? diags->found : 0;
    sys->arena = hn_arena_create(0);
    sys->g = hn_graph_create();
    if (sys->arena && sys->g) {
        sys->length = characteristic_length(scene);
        sys->kinetic = sys->potential = hn_num(0);
        status = scene->is_lagrangian ? hn_lagrangian_compile(sys) : hn_bodies_compile(sys);
    }
    if (status == HN_OK) {
        status = finish(sys);
    }
    if (status != HN_OK && sys->arena && sys->g &&
        (hn_graph_failed(sys->g) || hn_arena_failed(sys->arena))) {
        forget_faults(
            diags,
            // a graph without memory gives zeros, which the checks took for the scene's fault
            told);
        status = HN_ERR_MEMORY;
    }
    sys->diags = NULL;
    if (status != HN_OK) {
        hn_system_free(sys);
        return status;
    }
    *out = sys;
    return HN_OK;
}

void hn_system_free(hn_system *sys) {
    if (!sys) {
        return;
    }
    hn_entries_reset(&sys->M);
    hn_entries_reset(&sys->J);
    hn_entries_reset(&sys->efforts);
    hn_graph_free(sys->g);
    hn_arena_free(sys->arena);
    free(sys);
}

// ---- reading ----

const hn_scene *hn_system_scene(const hn_system *sys) {
    return sys->scene;
}

hn_system_info hn_system_get_info(const hn_system *sys) {
    hn_system_info info = sys->info;
    info.nodes = hn_graph_size(sys->g);
    return info;
}

int hn_system_user_coordinate(const hn_system *sys, int i) {
    HN_ASSERT(i >= 0 && i < sys->nv);
    return sys->scene->is_lagrangian ? i : sys->tree.user[i];
}

const char *hn_system_row_name(const hn_system *sys, int row) {
    HN_ASSERT(row >= 0 && row < sys->nc);
    return sys->rows[row].name;
}

int hn_system_row_loop(const hn_system *sys, int row) {
    HN_ASSERT(row >= 0 && row < sys->nc);
    return sys->rows[row].loop;
}

int hn_system_row_is_length(const hn_system *sys, int row) {
    HN_ASSERT(row >= 0 && row < sys->nc);
    return sys->rows[row].is_length;
}

double hn_system_row_unit(const hn_system *sys, int row) {
    return sys->rows[row].is_length ? sys->length : 1;
}

int hn_system_loop_joint(const hn_system *sys, int loop) {
    HN_ASSERT(loop >= 0 && loop < sys->n_loops);
    return sys->loops[loop].joint;
}

const char *hn_system_loop_name(const hn_system *sys, int loop) {
    HN_ASSERT(loop >= 0 && loop < sys->n_loops);
    return sys->loops[loop].name;
}

double hn_system_length(const hn_system *sys) {
    return sys->length;
}

int hn_system_tree_joint(const hn_system *sys, int body) {
    HN_ASSERT(body >= 0 && body < sys->scene->n_bodies);
    return sys->scene->is_lagrangian ? -1 : sys->tree.links[body].joint;
}

int hn_system_joint_is_cut(const hn_system *sys, int joint) {
    HN_ASSERT(joint >= 0 && joint < sys->scene->n_joints);
    return !sys->scene->is_lagrangian && sys->tree.joint_cut[joint] >= 0;
}

hn_graph *hn_system_graph(const hn_system *sys) {
    return sys->g;
}

hn_system_exprs hn_system_get_exprs(const hn_system *sys) {
    return (hn_system_exprs){.M = sys->M_dense,
                             .f = sys->f,
                             .phi = sys->phi,
                             .phi_t = sys->phi_t,
                             .J = sys->J_dense,
                             .gamma = sys->gamma,
                             .points = sys->points,
                             .kinetic = sys->kinetic,
                             .potential = sys->potential,
                             .q_symbols = sys->q_symbols,
                             .v_symbols = sys->v_symbols,
                             .t_symbol = sys->t_symbol};
}

// ---- user and system coordinates: user_i = sign_i (q_i - q_ref(i) - offset_i), references first
// in tree order ----

static const hn_link *link_of(const hn_system *sys, int coordinate) {
    return &sys->tree.links[sys->tree.link_of[coordinate]];
}

/// Angles and ways: user_i = sign (q_i - q_ref - offset); `place` says where q_i stands (NULL: at
/// i). Balls are left out.
static void to_user(const hn_system *sys, const double *q, double *user, const int *place) {
    for (int i = 0; i < sys->nv; i++) {
        const hn_link *l = link_of(sys, i);
        if (l->n_speeds == 3) {
            continue;
        }
        const int ref = l->angle_ref;
        const double turned = ref < 0 ? 0 : q[place ? place[ref] : ref];
        user[i] = l->sign * (q[place ? place[i] : i] - turned - (place ? l->offset : 0));
    }
}

static void from_user(const hn_system *sys, const double *user, double *q, const int *place) {
    for (int k = 0; k < sys->tree.n_order; k++) {
        const hn_link *l = &sys->tree.links[sys->tree.order[k]];
        if (l->n_speeds != 1) {
            continue;
        }
        const int i = l->coordinate, ref = l->angle_ref;
        const double turned = ref < 0 ? 0 : q[place ? place[ref] : ref];
        q[place ? place[i] : i] = l->sign * user[i] + turned + (place ? l->offset : 0);
    }
}

static void copy(const double *from, double *to, int n) {
    if (n > 0) {
        memcpy(to, from, (size_t)n * sizeof *to);
    }
}

void hn_system_to_user(const hn_system *sys, const double *q, double *user_q) {
    if (sys->scene->is_lagrangian) {
        copy(q, user_q, sys->nv);
        return;
    }
    to_user(sys, q, user_q, sys->tree.position);
    for (int k = 0; k < sys->n_balls; k++) {
        hn_quat_log(q + sys->balls[k].position, user_q + sys->balls[k].speed);
    }
}

void hn_system_from_user(const hn_system *sys, const double *user_q, double *q) {
    if (sys->scene->is_lagrangian) {
        copy(user_q, q, sys->nv);
        return;
    }
    from_user(sys, user_q, q, sys->tree.position);
    for (int k = 0; k < sys->n_balls; k++) {
        hn_quat_exp(user_q + sys->balls[k].speed, q + sys->balls[k].position);
    }
}

void hn_system_rates_to_user(const hn_system *sys, const double *v, double *user_v) {
    if (sys->scene->is_lagrangian) {
        copy(v, user_v, sys->nv);
        return;
    }
    to_user(sys, v, user_v, NULL);
    for (int k = 0; k < sys->n_balls; k++) {
        copy(v + sys->balls[k].speed, user_v + sys->balls[k].speed, 3);
    }
}

void hn_system_rates_from_user(const hn_system *sys, const double *user_v, double *v) {
    if (sys->scene->is_lagrangian) {
        copy(user_v, v, sys->nv);
        return;
    }
    from_user(sys, user_v, v, NULL);
    for (int k = 0; k < sys->n_balls; k++) {
        copy(user_v + sys->balls[k].speed, v + sys->balls[k].speed, 3);
    }
}

void hn_system_forces_to_user(const hn_system *sys, const double *f, double *user_f) {
    copy(f, user_f, sys->nv);
    if (sys->scene->is_lagrangian) {
        return;
    }
    // v = S user_v with S filled from references downwards, so user_f = S' f gathers from the
    // leaves up
    for (int k = sys->tree.n_order - 1; k >= 0; k--) {
        const hn_link *l = &sys->tree.links[sys->tree.order[k]];
        if (l->angle_ref >= 0) {
            user_f[l->angle_ref] += user_f[l->coordinate];
        }
    }
    for (int i = 0; i < sys->nv; i++) {
        user_f[i] *= link_of(sys, i)->sign; // 1 for balls
    }
}

// ---- positions and speeds: balls, and everything else ----

/// Entries of q that are not a ball's stand in the order of their speeds, so between balls runs of
/// equal length go in step.
typedef struct stretch {
    int position, speed, n;
} stretch;

/// The run of plain coordinates before ball k (k = n_balls: after the last).
static stretch run_before(const hn_system *sys, int k) {
    stretch run = {0, 0, 0};
    if (k > 0) {
        run.position = sys->balls[k - 1].position + 4;
        run.speed = sys->balls[k - 1].speed + 3;
    }
    run.n = (k < sys->n_balls ? sys->balls[k].speed : sys->nv) - run.speed;
    return run;
}

void hn_system_kinematics(const hn_system *sys, const double *q, const double *v, double *qdot) {
    for (int k = 0; k <= sys->n_balls; k++) {
        const stretch run = run_before(sys, k);
        copy(v + run.speed, qdot + run.position, run.n);
    }
    for (int k = 0; k < sys->n_balls; k++) {
        const hn_ball *ball = &sys->balls[k];
        hn_quat_rate(q + ball->position, v + ball->speed, qdot + ball->position);
    }
}

void hn_system_move(const hn_system *sys, double *q, const double *delta) {
    for (int k = 0; k <= sys->n_balls; k++) {
        const stretch run = run_before(sys, k);
        for (int i = 0; i < run.n; i++) {
            q[run.position + i] += delta[run.speed + i];
        }
    }
    for (int k = 0; k < sys->n_balls; k++) {
        hn_quat_move(q + sys->balls[k].position, delta + sys->balls[k].speed);
    }
}

void hn_system_difference(const hn_system *sys, const double *from, const double *to,
                          double *delta) {
    for (int k = 0; k <= sys->n_balls; k++) {
        const stretch run = run_before(sys, k);
        for (int i = 0; i < run.n; i++) {
            delta[run.speed + i] = to[run.position + i] - from[run.position + i];
        }
    }
    for (int k = 0; k < sys->n_balls; k++) {
        const hn_ball *ball = &sys->balls[k];
        hn_quat_difference(from + ball->position, to + ball->position, delta + ball->speed);
    }
}

int hn_system_normalise(const hn_system *sys, double *q) {
    int changed = 0;
    for (int k = 0; k < sys->n_balls; k++) {
        changed |= hn_quat_normalise(q + sys->balls[k].position);
    }
    return changed;
}

int hn_system_position_of(const hn_system *sys, int i) {
    HN_ASSERT(i >= 0 && i < sys->nv);
    return sys->scene->is_lagrangian ? i : sys->tree.position[i];
}

double hn_system_next_corner(const hn_system *sys, double t) {
    double next = HUGE_VAL;
    for (int k = 0; k < sys->scene->n_loads; k++) {
        const hn_profile *table = &sys->scene->loads[k].table;
        for (int i = 0; i < table->n; i++) {
            if (table->t[i] > t) {
                next = fmin(next, table->t[i]);
                break;
            }
        }
    }
    return next;
}
