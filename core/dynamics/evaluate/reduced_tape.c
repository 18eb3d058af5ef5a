// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/evaluate/reduced_tape.h"

#include "dynamics/evaluate/block_lu.h"
#include "dynamics/evaluate/inputs.h"
#include "expr/construct.h"
#include "expr/diff.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { MOST_FREE = 3 };             // independent velocities: (3) is solved by elimination
static const double SURE = 1e-2;    // of a pivot's measure: far above where a chart ends
static const double MASSIVE = 1e-8; // of the largest mass: a pivot of (3)

struct hn_reduced_tape {
    hn_inputs in;
    int nv, nc, rank, r, n_guards;
    int *dep, *ind;
    // where each group of outputs starts, in this order
    int at_gap, at_guard, at_mass, at_accel, at_basis, at_offset;
    double *measure;     ///< n_guards: pivots where the measure was taken
    double fixed_volume; ///< the product of the pivots that are numbers, with the order's sign
};

// ---- building ----

/// Expressions while the tape is built, in scratch memory.
typedef struct builder {
    const hn_system *sys;
    const hn_reduced_split *split;
    hn_arena *scratch;
    hn_block_lu order;
    // terms at the corrected configuration: the entries of J and M, phi, phi_t, f, gamma
    hn_ex *terms, *J, *M, *phi, *phi_t, *f, *gamma;
    int n_terms;
    hn_ex *Jd, *rhs, *x;         ///< rank x rank; rank x (r + 1) each
    hn_ex *q_d, *N, *s, *c;      ///< rank; nv x r; nv; nv
    hn_ex *mass, *force, *accel; ///< r x r, r, r
    hn_ex *outputs;
    int *symbols;
    hn_ex guard[HN_BLOCK_LU_MOST], mass_pivot[MOST_FREE], diagonal[MOST_FREE];
} builder;

static hn_ex *take(builder *b, int n) {
    return hn_arena_get(b->scratch, ((size_t)n + 1) * sizeof(hn_ex));
}

static bool allocate(builder *b) {
    const hn_system *sys = b->sys;
    const int nv = sys->nv, nc = sys->nc, rank = b->split->rank, r = b->split->r;
    b->n_terms = sys->J.n + sys->M.n + 3 * nc + nv;
    b->terms = take(b, b->n_terms);
    b->Jd = take(b, rank * rank);
    b->rhs = take(b, rank * (r + 1));
    b->x = take(b, rank * (r + 1));
    b->q_d = take(b, rank);
    b->N = take(b, nv * r);
    b->s = take(b, nv);
    b->c = take(b, nv);
    b->mass = take(b, r * r);
    b->force = take(b, r);
    b->accel = take(b, r);
    b->outputs = take(b, 2 * rank + nc + HN_BLOCK_LU_MOST + 3 * r + rank * r);
    b->symbols = hn_arena_ints(b->scratch, (size_t)rank);
    return !hn_arena_failed(b->scratch);
}

/// The terms as they are, then groups of them by name.
static void list_terms(builder *b) {
    const hn_system *sys = b->sys;
    const size_t nc = (size_t)sys->nc, nv = (size_t)sys->nv;
    b->J = b->terms;
    b->M = b->J + sys->J.n;
    b->phi = b->M + sys->M.n;
    b->phi_t = b->phi + nc;
    b->gamma = b->phi_t + nc;
    b->f = b->gamma + nc;
    for (int k = 0; k < sys->J.n; k++) {
        b->J[k] = sys->J.at[k].e;
    }
    for (int k = 0; k < sys->M.n; k++) {
        b->M[k] = sys->M.at[k].e;
    }
    memcpy(b->phi, sys->phi, nc * sizeof(hn_ex));
    memcpy(b->phi_t, sys->phi_t, nc * sizeof(hn_ex));
    memcpy(b->gamma, sys->gamma, nc * sizeof(hn_ex));
    memcpy(b->f, sys->f, nv * sizeof(hn_ex));
}

static int find(int n, const int *list, int value) {
    for (int k = 0; k < n; k++) {
        if (list[k] == value) {
            return k;
        }
    }
    return -1;
}

/// J_d of the present terms.
static void take_dependent(builder *b) {
    const hn_reduced_split *p = b->split;
    for (int k = 0; k < p->rank * p->rank; k++) {
        b->Jd[k] = hn_num(0);
    }
    for (int k = 0; k < b->sys->J.n; k++) {
        const int col = find(p->rank, p->dep, b->sys->J.at[k].col);
        if (col >= 0) {
            b->Jd[b->sys->J.at[k].row * p->rank + col] = b->J[k];
        }
    }
}

/// x = J_d^-1 rhs with m columns.
static void solve(builder *b, int m) {
    take_dependent(b);
    hn_block_lu_solve(b->sys->g, &b->order, b->Jd, b->rhs, m, b->x);
}

/// The order of elimination from the values of J.
static bool plan(builder *b) {
    const hn_reduced_split *p = b->split;
    double value[HN_BLOCK_LU_MOST * HN_BLOCK_LU_MOST] = {0};
    take_dependent(b);
    for (int k = 0; k < b->sys->J.n; k++) {
        const int col = find(p->rank, p->dep, b->sys->J.at[k].col);
        if (col >= 0) {
            value[b->sys->J.at[k].row * p->rank + col] = p->J[k];
        }
    }
    return hn_block_lu_plan(&b->order, p->rank, b->Jd, value);
}

/// 1 where the loops are open, 0 where they are closed to rounding.
static hn_ex is_open(const builder *b) {
    hn_graph *g = b->sys->g;
    hn_ex over = hn_num(-b->split->closed * b->split->closed);
    for (int i = 0; i < b->sys->nc; i++) {
        over = hn_add(g, over, hn_mul(g, b->phi[i], b->phi[i]));
    }
    return hn_apply(g, HN_OP_STEP, &over);
}

/// (1), and the terms at the configuration that it leads to.
static void correct(builder *b) {
    const hn_reduced_split *p = b->split;
    hn_graph *g = b->sys->g;
    const hn_ex open = is_open(b);
    memcpy(b->rhs, b->phi, (size_t)p->rank * sizeof *b->rhs);
    solve(b, 1);
    for (int k = 0; k < p->rank; k++) {
        b->q_d[k] = hn_sub(g, b->sys->q[p->dep[k]], hn_mul(g, open, b->x[k]));
        b->symbols[k] = b->sys->q_symbols[p->dep[k]];
    }
    hn_substitute(g, b->terms, b->n_terms, b->symbols, b->q_d, p->rank, b->terms);
}

/// N and s of (2).
static void make_basis(builder *b) {
    const hn_reduced_split *p = b->split;
    const int m = p->r + 1;
    for (int k = 0; k < p->rank * m; k++) {
        b->rhs[k] = k % m == p->r ? hn_neg(b->phi_t[k / m]) : hn_num(0);
    }
    for (int k = 0; k < b->sys->J.n; k++) {
        const int col = find(p->r, p->ind, b->sys->J.at[k].col);
        if (col >= 0) {
            b->rhs[b->sys->J.at[k].row * m + col] = hn_neg(b->J[k]);
        }
    }
    solve(b, m);
    memcpy(b->guard, b->order.pivot, sizeof b->guard);

    // ones on the independent velocities
    for (int k = 0; k < b->sys->nv * p->r; k++) {
        b->N[k] = hn_num(0);
    }
    for (int i = 0; i < b->sys->nv; i++) {
        b->s[i] = hn_num(0);
    }
    for (int j = 0; j < p->r; j++) {
        b->N[p->ind[j] * p->r + j] = hn_num(1);
        for (int k = 0; k < p->rank; k++) {
            b->N[p->dep[k] * p->r + j] = b->x[k * m + j];
        }
    }
    for (int k = 0; k < p->rank; k++) {
        b->s[p->dep[k]] = b->x[k * m + p->r];
    }
}

/// f and gamma at the velocities of (2), and c of (3).
static void make_rates(builder *b) {
    const hn_reduced_split *p = b->split;
    const hn_system *sys = b->sys;
    hn_graph *g = sys->g;
    for (int k = 0; k < p->rank; k++) {
        hn_ex v = b->s[p->dep[k]];
        for (int j = 0; j < p->r; j++) {
            v = hn_add(g, v, hn_mul(g, b->N[p->dep[k] * p->r + j], sys->v[p->ind[j]]));
        }
        b->x[k] = v;
        b->symbols[k] = sys->v_symbols[p->dep[k]];
    }
    hn_substitute(g, b->gamma, sys->nc + sys->nv, b->symbols, b->x, p->rank, b->gamma);

    for (int k = 0; k < p->rank; k++) {
        b->rhs[k] = hn_neg(b->gamma[k]);
    }
    solve(b, 1);
    for (int i = 0; i < sys->nv; i++) {
        b->c[i] = hn_num(0);
    }
    for (int k = 0; k < p->rank; k++) {
        b->c[p->dep[k]] = b->x[k];
    }
}

/// y (nv) = M x for column `col` of x (nv x n).
static void multiply_mass(builder *b, const hn_ex *x, int n, int col, hn_ex *y) {
    hn_graph *g = b->sys->g;
    for (int i = 0; i < b->sys->nv; i++) {
        y[i] = hn_num(0);
    }
    for (int k = 0; k < b->sys->M.n; k++) {
        const int i = b->sys->M.at[k].row, j = b->sys->M.at[k].col;
        y[i] = hn_add(g, y[i], hn_mul(g, b->M[k], x[j * n + col]));
        if (i != j) {
            y[j] = hn_add(g, y[j], hn_mul(g, b->M[k], x[i * n + col]));
        }
    }
}

/// Column `row` of N times y (nv).
static hn_ex project(const builder *b, int row, const hn_ex *y) {
    hn_graph *g = b->sys->g;
    hn_ex sum = hn_num(0);
    for (int i = 0; i < b->sys->nv; i++) {
        sum = hn_add(g, sum, hn_mul(g, b->N[i * b->split->r + row], y[i]));
    }
    return sum;
}

/// u' of (3). False when memory is out.
static bool make_accelerations(builder *b) {
    const int r = b->split->r, nv = b->sys->nv;
    hn_ex *y = take(b, nv);
    hn_block_lu lu;
    if (!y) {
        return false;
    }
    for (int j = 0; j < r; j++) {
        multiply_mass(b, b->N, r, j, y);
        for (int i = 0; i < r; i++) {
            b->mass[i * r + j] = project(b, i, y);
        }
        b->diagonal[j] = b->mass[j * r + j];
    }
    multiply_mass(b, b->c, 1, 0, y);
    for (int i = 0; i < nv; i++) {
        y[i] = hn_sub(b->sys->g, b->f[i], y[i]);
    }
    for (int i = 0; i < r; i++) {
        b->force[i] = project(b, i, y);
    }

    hn_block_lu_plan_in_order(&lu, r);
    hn_block_lu_solve(b->sys->g, &lu, b->mass, b->force, 1, b->accel);
    memcpy(b->mass_pivot, lu.pivot, sizeof b->mass_pivot);
    return true;
}

// ---- the tape ----

/// Pivots that are numbers go into fixed_volume, the others become outputs.
static int list_guards(const builder *b, hn_reduced_tape *tape, hn_ex *out) {
    int n = 0;
    tape->fixed_volume = b->order.sign;
    for (int k = 0; k < b->order.n_blocks; k++) {
        double value;
        if (hn_is_number(b->guard[k], &value)) {
            tape->fixed_volume *= value;
        } else {
            out[n++] = b->guard[k];
        }
    }
    return n;
}

static hn_status compile(builder *b, hn_arena *arena, hn_reduced_tape *tape) {
    const hn_reduced_split *p = b->split;
    hn_ex *out = b->outputs;
    int n = p->rank;
    memcpy(out, b->q_d, (size_t)p->rank * sizeof *out);
    tape->at_gap = n;
    memcpy(out + n, b->phi, (size_t)tape->nc * sizeof *out);
    n += tape->nc;

    // guards: pivots of J_d, then pivots and diagonal of the reduced mass
    tape->at_guard = n;
    tape->n_guards = list_guards(b, tape, out + n);
    n += tape->n_guards;
    tape->at_mass = n;
    for (int j = 0; j < p->r; j++) {
        out[n++] = b->mass_pivot[j];
        out[n++] = b->diagonal[j];
    }

    tape->at_accel = n;
    memcpy(out + n, b->accel, (size_t)p->r * sizeof *out);
    n += p->r;
    tape->at_basis = n;
    for (int k = 0; k < p->rank * p->r; k++) {
        out[n++] = b->N[p->dep[k / p->r] * p->r + k % p->r];
    }
    tape->at_offset = n;
    for (int k = 0; k < p->rank; k++) {
        out[n++] = b->s[p->dep[k]];
    }
    HN_TRY(hn_graph_status(b->sys->g));
    return hn_inputs_compile(b->sys, out, n, arena, &tape->in);
}

static hn_status build(builder *b, hn_arena *arena, hn_reduced_tape *tape, bool *serves) {
    if (!allocate(b)) {
        return HN_ERR_MEMORY;
    }
    list_terms(b);
    *serves = plan(b);
    if (!*serves) {
        return HN_OK;
    }
    correct(b);
    make_basis(b);
    make_rates(b);
    return make_accelerations(b) ? compile(b, arena, tape) : HN_ERR_MEMORY;
}

static bool can_serve(const hn_system *sys, const hn_reduced_split *split) {
    return sys->n_balls == 0 && split->rank == sys->nc && split->rank >= 1 &&
           split->rank <= HN_BLOCK_LU_MOST && split->r >= 1 && split->r <= MOST_FREE;
}

hn_status hn_reduced_tape_create(const hn_system *sys, const hn_reduced_split *split,
                                 hn_arena *arena, hn_reduced_tape **out) {
    *out = NULL;
    if (!can_serve(sys, split)) {
        return HN_OK;
    }
    const size_t rank = (size_t)split->rank, r = (size_t)split->r;
    hn_reduced_tape *tape = hn_arena_get(arena, sizeof *tape);
    builder b = {.sys = sys, .split = split, .scratch = hn_arena_create(0)};
    if (!tape || !b.scratch) {
        hn_arena_free(b.scratch);
        return HN_ERR_MEMORY;
    }
    *tape = (hn_reduced_tape){.nv = sys->nv, .nc = sys->nc, .rank = split->rank, .r = split->r};
    tape->dep = hn_arena_ints(arena, rank);
    tape->ind = hn_arena_ints(arena, r);
    tape->measure = hn_arena_doubles(arena, HN_BLOCK_LU_MOST);
    bool serves = false;
    hn_status status = hn_arena_failed(arena) ? HN_ERR_MEMORY : build(&b, arena, tape, &serves);
    hn_arena_free(b.scratch);
    if (status == HN_ERR_LIMIT) { // too long to be written out
        return HN_OK;
    }
    if (status != HN_OK || !serves) {
        return status;
    }
    memcpy(tape->dep, split->dep, rank * sizeof *tape->dep);
    memcpy(tape->ind, split->ind, r * sizeof *tape->ind);
    *out = tape;
    return HN_OK;
}

void hn_reduced_tape_free(hn_reduced_tape *tape) {
    if (tape) {
        hn_inputs_free(&tape->in);
    }
}

bool hn_reduced_tape_is_for(const hn_reduced_tape *tape, const int *dep, int rank) {
    return tape->rank == rank && memcmp(tape->dep, dep, (size_t)rank * sizeof *dep) == 0;
}

// ---- running ----

void hn_reduced_tape_run(hn_reduced_tape *tape, double t, const double *q, const double *u) {
    double *x = tape->in.x;
    for (int i = 0; i < tape->in.nq; i++) {
        x[i] = q[i];
    }
    for (int j = 0; j < tape->r; j++) {
        x[tape->in.nq + tape->ind[j]] = u[j];
    }
    x[tape->in.nq + tape->nv] = t;
    if (tape->in.pulls) {
        hn_inputs_put_pulls(&tape->in, t);
    }
    hn_tape_run(tape->in.tape, x);
}

static double output(const hn_reduced_tape *tape, int k) {
    return tape->in.x[tape->in.slots[k]];
}

void hn_reduced_tape_take_measure(hn_reduced_tape *tape) {
    for (int k = 0; k < tape->n_guards; k++) {
        tape->measure[k] = fabs(output(tape, tape->at_guard + k));
    }
}

bool hn_reduced_tape_is_sure(const hn_reduced_tape *tape) {
    bool sure = true;
    double largest = 0;
    for (int k = 0; k < tape->n_guards; k++) { // a NaN is not above anything
        sure &= fabs(output(tape, tape->at_guard + k)) > SURE * tape->measure[k];
    }
    for (int j = 0; j < tape->r; j++) {
        const double mass = output(tape, tape->at_mass + 2 * j + 1);
        largest = mass > largest ? mass : largest;
    }
    for (int j = 0; j < tape->r; j++) {
        sure &= output(tape, tape->at_mass + 2 * j) > MASSIVE * largest;
    }
    return sure;
}

double hn_reduced_tape_gap(const hn_reduced_tape *tape) {
    double sum = 0;
    for (int i = 0; i < tape->nc; i++) {
        const double phi = output(tape, tape->at_gap + i);
        sum += phi * phi;
    }
    return sqrt(sum);
}

double hn_reduced_tape_determinant(const hn_reduced_tape *tape) {
    double product = tape->fixed_volume;
    for (int k = 0; k < tape->n_guards; k++) {
        product *= output(tape, tape->at_guard + k);
    }
    return product;
}

void hn_reduced_tape_get_position(const hn_reduced_tape *tape, double *q) {
    for (int k = 0; k < tape->rank; k++) {
        q[tape->dep[k]] = output(tape, k);
    }
}

bool hn_reduced_tape_get_accelerations(const hn_reduced_tape *tape, double *u_dot) {
    bool finite = true;
    for (int j = 0; j < tape->r; j++) {
        u_dot[j] = output(tape, tape->at_accel + j);
        finite &= fabs(u_dot[j]) <= DBL_MAX;
    }
    return finite;
}

void hn_reduced_tape_get_basis(const hn_reduced_tape *tape, double *N, double *s) {
    const int r = tape->r;
    for (int j = 0; j < r; j++) {
        s[tape->ind[j]] = 0;
        for (int i = 0; i < r; i++) {
            N[tape->ind[i] * r + j] = i == j;
        }
    }
    for (int k = 0; k < tape->rank; k++) {
        s[tape->dep[k]] = output(tape, tape->at_offset + k);
        for (int j = 0; j < r; j++) {
            N[tape->dep[k] * r + j] = output(tape, tape->at_basis + k * r + j);
        }
    }
}

hn_tape_info hn_reduced_tape_info(const hn_reduced_tape *tape) {
    return hn_tape_get_info(tape->in.tape);
}
