// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/analyse/dyads.h"

#include "dynamics/analyse/dyads_form.h"
#include "dynamics/compile/system_impl.h"
#include "expr/construct.h"
#include "expr/diff.h"

#include <stdbool.h>
#include <suitesparse/btf.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REFUSAL_TEXT = 240, MOST_NAMED = 6, OUTPUTS = 3 };

struct hn_dyads {
    const hn_system *sys;
    int n_dep, *dep;
    int n;
    hn_dyad_step *steps;
    // inputs of both tapes: q, t, the signs, parameters that stayed symbols
    int n_in;
    double *in, *signs; ///< signs: where they stand in `in`
    hn_tape *solve, *branch;
    double *out, *solve_work, *branch_work;
    long long solves, reads; ///< runs of the tapes
    char refusal[REFUSAL_TEXT];
};

static const char *const kind_names[HN_DYAD_KIND_COUNT] = {
#define HN_DYAD_NAME(code, name, about) name,
    HN_DYAD_KIND_LIST(HN_DYAD_NAME)
#undef HN_DYAD_NAME
};
static const char *const kind_abouts[HN_DYAD_KIND_COUNT] = {
#define HN_DYAD_ABOUT(code, name, about) about,
    HN_DYAD_KIND_LIST(HN_DYAD_ABOUT)
#undef HN_DYAD_ABOUT
};

const char *hn_dyad_kind_name(hn_dyad_kind kind) {
    return kind_names[kind];
}

const char *hn_dyad_kind_about(hn_dyad_kind kind) {
    return kind_abouts[kind];
}

// ---- blocks ----

/// While it is built; scratch from malloc.
typedef struct builder {
    hn_dyads *d;
    const hn_system *sys;
    hn_arena *arena;
    int *dep_at;           ///< per velocity: its place in dep, -1
    int *start, *rows;     ///< J_d by columns
    int *P, *Q, *R, *work; ///< of BTF
    double *x;             ///< a value per symbol
    hn_ex *outputs, *with; ///< of the tapes; composed solutions
    int *solved, *symbols;
} builder;

static bool allocate(builder *b) {
    const size_t n = (size_t)b->d->n_dep, nv = (size_t)b->sys->nv;
    const size_t n_symbols = (size_t)hn_graph_n_symbols(b->sys->g) + n;
    b->dep_at = malloc((nv + 1) * sizeof *b->dep_at);
    b->start = calloc(n + 2, sizeof *b->start);
    b->rows = malloc(((size_t)b->sys->J.n + 1) * sizeof *b->rows);
    b->P = malloc((n + 1) * sizeof *b->P);
    b->Q = malloc((n + 1) * sizeof *b->Q);
    b->R = malloc((n + 2) * sizeof *b->R);
    b->work = malloc((5 * n + 1) * sizeof *b->work);
    b->x = malloc((n_symbols + 1) * sizeof *b->x);
    b->outputs = malloc((OUTPUTS * n + 1) * sizeof *b->outputs);
    b->with = malloc((n + 1) * sizeof *b->with);
    b->solved = malloc((n + 1) * sizeof *b->solved);
    b->symbols = malloc((n_symbols + 1) * sizeof *b->symbols);
    b->d->dep = hn_arena_ints(b->arena, n + 1);
    b->d->steps = hn_arena_get(b->arena, (n + 1) * sizeof *b->d->steps);
    return b->dep_at && b->start && b->rows && b->P && b->Q && b->R && b->work && b->x &&
           b->outputs && b->with && b->solved && b->symbols && b->d->dep && b->d->steps;
}

static void release(builder *b) {
    void *const all[] = {b->dep_at, b->start, b->rows,    b->P,    b->Q,      b->R,
                         b->work,   b->x,     b->outputs, b->with, b->solved, b->symbols};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        free(all[i]);
    }
}

static void fill_columns(builder *b) {
    const hn_entries *J = &b->sys->J;
    for (int k = 0; k < J->n; k++) {
        const int c = b->dep_at[J->at[k].col];
        if (c >= 0) {
            b->start[c + 1]++;
        }
    }
    for (int c = 0; c < b->d->n_dep; c++) {
        b->start[c + 1] += b->start[c];
    }
    // sorted by row, so columns fill in order; P serves as the next free place
    memcpy(b->P, b->start, (size_t)b->d->n_dep * sizeof *b->P);
    for (int k = 0; k < J->n; k++) {
        const int c = b->dep_at[J->at[k].col];
        if (c >= 0) {
            b->rows[b->P[c]++] = J->at[k].row;
        }
    }
}

static const char *name_of(const hn_system *sys, int coordinate) {
    const int place = hn_system_position_of(sys, coordinate);
    return place >= 0 ? hn_graph_symbol_name(sys->g, sys->q_symbols[place])
                      : sys->scene->coordinates[hn_system_user_coordinate(sys, coordinate)].name;
}

/// "th2, th3, ..." of a block's unknowns, behind what is said already.
static void name_block(builder *b, int first, int end, const char *format) {
    char list[REFUSAL_TEXT] = "";
    size_t used = 0;
    const int shown = end - first > MOST_NAMED ? MOST_NAMED : end - first;
    for (int k = 0; k < shown && used < sizeof list; k++) {
        const int wrote = snprintf(list + used, sizeof list - used, "%s%.40s", k ? ", " : "",
                                   name_of(b->sys, b->d->dep[b->Q[first + k]]));
        used += wrote > 0 ? (size_t)wrote : 0;
    }
    snprintf(b->d->refusal, sizeof b->d->refusal, format, end - first, list,
             shown < end - first ? ", ..." : "");
}

/// Finds what keeps the whole mechanism from a closed form, before the blocks are examined.
static bool refuse_whole(builder *b) {
    hn_dyads *d = b->d;
    if (d->n_dep != b->sys->nc) {
        snprintf(d->refusal, sizeof d->refusal,
                 "closure equations are redundant: %d equations for %d dependent coordinates",
                 b->sys->nc, d->n_dep);
        return true;
    }
    for (int k = 0; k < d->n_dep; k++) {
        if (hn_system_position_of(b->sys, d->dep[k]) < 0) {
            snprintf(d->refusal, sizeof d->refusal, "the orientation of a ball, %.60s, is unknown",
                     name_of(b->sys, d->dep[k]));
            return true;
        }
    }
    return false;
}

/// The blocks from the last one on: rows of the block triangular form hold the unknowns of their
/// own block and of later ones.
static void recognise_blocks(builder *b, int n_blocks) {
    hn_dyads *d = b->d;
    unsigned seed = 12345;
    for (int k = n_blocks - 1; k >= 0 && !d->refusal[0]; k--) {
        const int first = b->R[k], end = b->R[k + 1];
        if (end - first > 2) {
            name_block(b, first, end, "%d unknowns appear together in the closure equations: %s%s");
            return;
        }

        // a block of one or two rows and their unknowns
        hn_dyad_step *step = &d->steps[d->n];
        step->dyad.n = end - first;
        for (int i = first; i < end; i++) {
            step->dyad.row[i - first] = b->P[i];
            step->dyad.unknown[i - first] = d->dep[b->Q[i]];
        }

        if (!hn_dyad_recognise(b->sys, step, b->x, &seed)) {
            name_block(b, first, end,
                       "a block of %d equations is not a dyad: it depends on %s%s in another way "
                       "than links that turn or slide in a plane");
            return;
        }
        d->n++;
    }
}

static void find_steps(builder *b) {
    hn_dyads *d = b->d;
    double work = 0;
    int matched = 0;
    fill_columns(b);
    const int n_blocks =
        btf_order(d->n_dep, b->start, b->rows, 0, &work, b->P, b->Q, b->R, &matched, b->work);
    if (matched < d->n_dep) {
        snprintf(d->refusal, sizeof d->refusal,
                 "the constraints do not determine %d of the dependent coordinates",
                 d->n_dep - matched);
        return;
    }
    recognise_blocks(b, n_blocks);
}

// ---- tapes ----

static int symbol_of(const hn_system *sys, int coordinate) {
    return sys->q_symbols[hn_system_position_of(sys, coordinate)];
}

/// Each step's solution with those before it put in: outputs of the solving tape are room, x, y of
/// each.
static void compose(builder *b) {
    hn_dyads *d = b->d;
    hn_graph *g = b->sys->g;
    int n = 0;
    for (int k = 0; k < d->n; k++) {
        hn_dyad_step *s = &d->steps[k];
        hn_dyad_solve_form(b->sys, s, k);
        const hn_ex list[OUTPUTS] = {s->room, s->x[0], s->dyad.n == 2 ? s->x[1] : hn_num(0)};
        hn_substitute(g, list, OUTPUTS, b->solved, b->with, n, b->outputs + OUTPUTS * k);
        for (int i = 0; i < s->dyad.n; i++) {
            b->solved[n] = symbol_of(b->sys, s->dyad.unknown[i]);
            b->with[n++] = b->outputs[OUTPUTS * k + 1 + i];
        }
    }
}

static int count_params(const hn_system *sys) {
    return sys->opts.symbolic_params ? sys->scene->n_params : 0;
}

static void list_inputs(builder *b) {
    const hn_system *sys = b->sys;
    int n = 0;
    for (int i = 0; i < sys->nq; i++) {
        b->symbols[n++] = sys->q_symbols[i];
    }
    b->symbols[n++] = sys->t_symbol;
    for (int k = 0; k < b->d->n; k++) {
        b->symbols[n++] = hn_ex_symbol(sys->g, b->d->steps[k].sign);
    }
    for (int i = 0; i < count_params(sys); i++) {
        b->d->in[n] = sys->scene->params[i].value;
        b->symbols[n++] = hn_ex_symbol(sys->g, sys->params[i]);
    }
}

static hn_status compile_one(builder *b, int n_out, hn_tape **tape, double **work) {
    HN_TRY(hn_tape_compile(b->sys->g, b->outputs, n_out, b->symbols, b->d->n_in, tape));
    *work = hn_arena_doubles(b->arena, hn_tape_work_size(*tape));
    if (!*work) {
        return HN_ERR_MEMORY;
    }
    hn_tape_prepare(*tape, *work);
    return HN_OK;
}

static hn_status compile(builder *b) {
    hn_dyads *d = b->d;
    compose(b);
    d->n_in = b->sys->nq + 1 + d->n + count_params(b->sys);
    d->in = hn_arena_doubles(b->arena, (size_t)d->n_in);
    d->out = hn_arena_doubles(b->arena, OUTPUTS * (size_t)d->n + 1);
    HN_TRY(hn_graph_status(b->sys->g));
    if (!d->in || !d->out) {
        return HN_ERR_MEMORY;
    }
    d->signs = d->in + b->sys->nq + 1;
    list_inputs(b);
    HN_TRY(compile_one(b, OUTPUTS * d->n, &d->solve, &d->solve_work));
    for (int k = 0; k < d->n; k++) {
        b->outputs[k] = d->steps[k].branch;
        d->signs[k] = 1;
    }
    return compile_one(b, d->n, &d->branch, &d->branch_work);
}

static hn_status build(builder *b, const int *dep) {
    hn_dyads *d = b->d;
    if (!allocate(b)) {
        return HN_ERR_MEMORY;
    }
    for (int j = 0; j < b->sys->nv; j++) {
        b->dep_at[j] = -1;
    }
    for (int k = 0; k < d->n_dep; k++) {
        d->dep[k] = dep[k];
        b->dep_at[dep[k]] = k;
    }
    if (refuse_whole(b)) {
        return HN_OK;
    }
    find_steps(b);
    return d->refusal[0] ? HN_OK : compile(b);
}

hn_status hn_dyads_create(const hn_system *sys, const int *dep, int n, hn_arena *arena,
                          hn_dyads **out) {
    HN_ASSERT(sys && arena && out);
    hn_dyads *d = hn_arena_get(arena, sizeof *d);
    *out = NULL;
    if (!d) {
        return HN_ERR_MEMORY;
    }
    d->sys = sys;
    d->n_dep = n;
    // the graph may gain nodes; system.h says that this is the one thing that changes a system
    builder b = {.d = d, .sys = sys, .arena = arena};
    const hn_status status = build(&b, dep);
    release(&b);
    if (status != HN_OK) {
        hn_dyads_free(d);
        return status;
    }
    *out = d;
    return HN_OK;
}

void hn_dyads_free(hn_dyads *d) {
    if (d) {
        hn_tape_free(d->solve);
        hn_tape_free(d->branch);
        d->solve = d->branch = NULL;
    }
}

// ---- reading and running ----

const char *hn_dyads_refusal(const hn_dyads *d) {
    return d->refusal[0] ? d->refusal : NULL;
}

bool hn_dyads_serve(const hn_dyads *d, const int *dep, int n) {
    return d->n_dep == n && memcmp(d->dep, dep, (size_t)n * sizeof *dep) == 0;
}

int hn_dyads_count(const hn_dyads *d) {
    return d->n;
}

int hn_dyads_proper(const hn_dyads *d) {
    int n = 0;
    for (int k = 0; k < d->n; k++) {
        n += d->steps[k].dyad.n == 2;
    }
    return n;
}

hn_dyad hn_dyads_at(const hn_dyads *d, int k) {
    return d->steps[k].dyad;
}

hn_tape_info hn_dyads_info(const hn_dyads *d) {
    return hn_tape_get_info(d->solve);
}

hn_tape_info hn_dyads_branch_info(const hn_dyads *d) {
    return hn_tape_get_info(d->branch);
}

double hn_dyads_ops(const hn_dyads *d) {
    return (double)d->solves * hn_tape_get_info(d->solve).ops +
           (double)d->reads * hn_tape_get_info(d->branch).ops;
}

hn_ex hn_dyads_expression(const hn_dyads *d, int k, int i) {
    return d->steps[k].shown[i];
}

int hn_dyads_n_parts(const hn_dyads *d, int k) {
    return d->steps[k].n_parts;
}

hn_dyad_part hn_dyads_part(const hn_dyads *d, int k, int i) {
    return (hn_dyad_part){d->steps[k].part[i], d->steps[k].part_is[i]};
}

static bool has_sign(const hn_dyads *d, int k) {
    const hn_dyad_kind kind = d->steps[k].dyad.kind;
    return kind != HN_DYAD_SINGLE && kind != HN_DYAD_PRP;
}

const char *hn_dyads_sign_name(const hn_dyads *d, int k) {
    const hn_graph *g = d->sys->g;
    return has_sign(d, k) ? hn_graph_symbol_name(g, hn_ex_symbol(g, d->steps[k].sign)) : NULL;
}

double hn_dyads_sign(const hn_dyads *d, int k) {
    return d->signs[k];
}

static void read_branches(hn_dyads *d, double t, const double *q) {
    HN_ASSERT(d->branch);
    memcpy(d->in, q, (size_t)d->sys->nq * sizeof *q);
    d->in[d->sys->nq] = t;
    hn_tape_eval(d->branch, d->in, d->out, d->branch_work);
    d->reads++;
}

int hn_dyads_find_turned(hn_dyads *d, double t, const double *q) {
    read_branches(d, t, q);
    for (int k = 0; k < d->n; k++) {
        if (d->out[k] * d->signs[k] < 0) { // 1 times 1 for a step that has one way only
            return k;
        }
    }
    return -1;
}

bool hn_dyads_take_branch(hn_dyads *d, double t, const double *q) {
    read_branches(d, t, q);
    int stands = 1;
    for (int k = 0; k < d->n; k++) {
        d->signs[k] = d->out[k] > 0 ? 1 : d->out[k] < 0 ? -1 : 0;
        stands &= d->signs[k] != 0;
    }
    return stands;
}

/// The unknowns of one step into q.
static void put_step(const hn_dyads *d, int k, double *q) {
    const hn_dyad_step *s = &d->steps[k];
    for (int i = 0; i < s->dyad.n; i++) {
        double *place = &q[hn_system_position_of(d->sys, s->dyad.unknown[i])];
        const double x = d->out[OUTPUTS * k + 1 + i];
        *place = s->is_angle[i] ? x + 2 * M_PI * round((*place - x) / (2 * M_PI)) : x;
    }
}

int hn_dyads_solve(hn_dyads *d, double t, double *q) {
    HN_ASSERT(d->solve);
    memcpy(d->in, q, (size_t)d->sys->nq * sizeof *q);
    d->in[d->sys->nq] = t;
    hn_tape_eval(d->solve, d->in, d->out, d->solve_work);
    d->solves++;
    for (int k = 0; k < d->n; k++) {
        const double *out = d->out + OUTPUTS * k;
        if (!(out[0] >= 0) || !isfinite(out[1]) || !isfinite(out[2])) {
            return k;
        }
    }
    for (int k = 0; k < d->n; k++) {
        put_step(d, k, q);
    }
    return -1;
}
