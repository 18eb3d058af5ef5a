// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/assembly/assemble_rows.h"

#include "linalg/dense.h"
#include "linalg/gram.h"
#include "linalg/row_check.h"

#include <math.h>
#include <string.h>

// pivots of J J' at or below this times its largest entry: rows that depend on each other
static const double DEPENDENT = 1e-12;

// One velocity that moves a row: an entry of J, or what such velocities are counted from.
typedef struct node {
    int velocity;
    int source; ///< entry of J, -1: it has none of its own
    int base;   ///< node of the same row that it is counted from, -1: none
    int entry;  ///< entry that it becomes, -1: its coordinate is held
    double sum;
} node;

struct hn_assemble_rows {
    const hn_assembler *s;
    int n_nodes, n_entries, n_kept;
    node *nodes; ///< row by row, bases first
    int *row, *col;
    const int *kept;
    double *value, *size, *y; ///< of an entry, of a row; y: nc
    hn_gram *gram;
};

bool hn_assemble_is_large(const hn_assembler *s) {
    return s->n >= HN_ASSEMBLE_LARGE;
}

// ---- places ----

/// While the rows are listed.
typedef struct lister {
    const hn_assembler *s;
    int *node_of; ///< per velocity: 1 + its node in the row at hand, valid where of_row agrees
    int *of_row;
    int *path;    ///< velocities on the way to a base
    int *kept_at; ///< per user coordinate: 1 + its column, 0: held
    node *nodes;
    int *node_row;
    int n_nodes, room;
} lister;

static bool add_node(lister *l, int row, int velocity, int base) {
    if (l->n_nodes == l->room) {
        const int room = 2 * l->room + 256;
        node *nodes = hn_arena_get(l->s->arena, (size_t)room * sizeof *nodes);
        int *rows = hn_arena_ints(l->s->arena, (size_t)room);
        if (!nodes || !rows) {
            return false;
        }
        if (l->n_nodes > 0) {
            memcpy(nodes, l->nodes, (size_t)l->n_nodes * sizeof *nodes);
            memcpy(rows, l->node_row, (size_t)l->n_nodes * sizeof *rows);
        }
        l->nodes = nodes;
        l->node_row = rows;
        l->room = room;
    }
    l->nodes[l->n_nodes] = (node){.velocity = velocity, .source = -1, .base = base, .entry = -1};
    l->node_row[l->n_nodes] = row;
    l->of_row[velocity] = row + 1;
    l->node_of[velocity] = l->n_nodes++;
    return true;
}

/// The node of a velocity in a row, with all that it is counted from; -1 when memory is out.
static int find_node(lister *l, int row, int velocity) {
    int n = 0, i = velocity;
    while (i >= 0 && l->of_row[i] != row + 1) {
        l->path[n++] = i;
        i = l->s->rates.base[i];
    }
    for (int base = i >= 0 ? l->node_of[i] : -1; n > 0; base = l->n_nodes - 1) {
        if (!add_node(l, row, l->path[--n], base)) {
            return -1;
        }
    }
    return l->node_of[velocity];
}

static hn_status list_nodes(lister *l) {
    const int *row, *col, n = hn_eval_pattern(l->s->eval, HN_TERM_J, &row, &col);
    for (int k = 0; k < n; k++) {
        const int at = find_node(l, row[k], col[k]);
        if (at < 0) {
            return HN_ERR_MEMORY;
        }
        l->nodes[at].source = k;
    }
    return HN_OK;
}

/// Nodes of coordinates that are not held become entries.
static hn_status list_entries(hn_assemble_rows *r, const lister *l) {
    r->nodes = l->nodes;
    r->n_nodes = l->n_nodes;
    r->row = hn_arena_ints(l->s->arena, (size_t)l->n_nodes);
    r->col = hn_arena_ints(l->s->arena, (size_t)l->n_nodes);
    r->value = hn_arena_doubles(l->s->arena, (size_t)l->n_nodes);
    r->size = hn_arena_doubles(l->s->arena, (size_t)l->s->nc);
    r->y = hn_arena_doubles(l->s->arena, (size_t)l->s->nc);
    if (hn_arena_failed(l->s->arena)) {
        return HN_ERR_MEMORY;
    }
    for (int k = 0; k < r->n_nodes; k++) {
        const int at = l->kept_at[r->nodes[k].velocity];
        if (at > 0) {
            r->row[r->n_entries] = l->node_row[k];
            r->col[r->n_entries] = at - 1;
            r->nodes[k].entry = r->n_entries++;
        }
    }
    return HN_OK;
}

hn_status hn_assemble_rows_create(const hn_assembler *s, int n_kept, const int *kept,
                                  hn_assemble_rows **out) {
    const size_t n = (size_t)s->n;
    lister l = {.s = s,
                .node_of = hn_arena_ints(s->arena, n),
                .of_row = hn_arena_ints(s->arena, n),
                .path = hn_arena_ints(s->arena, n),
                .kept_at = hn_arena_ints(s->arena, n)};
    hn_assemble_rows *r = hn_arena_get(s->arena, sizeof *r);
    *out = NULL;
    if (hn_arena_failed(s->arena)) {
        return HN_ERR_MEMORY;
    }
    *r = (hn_assemble_rows){.s = s, .n_kept = n_kept, .kept = kept};
    for (int k = 0; k < n_kept; k++) {
        l.kept_at[kept[k]] = k + 1;
    }

    // entries, and their products
    HN_TRY(list_nodes(&l));
    HN_TRY(list_entries(r, &l));
    HN_TRY(hn_gram_create(s->arena, s->nc, n_kept, r->n_entries, r->row, r->col, &r->gram));
    *out = r->gram ? r : NULL;
    return HN_OK;
}

// ---- numbers ----

/// J in the user's rates: what a velocity moves, its base moves too.
static void gather(hn_assemble_rows *r) {
    const hn_assembler *s = r->s;
    const double *J = hn_eval_list(s->eval, HN_TERM_J);
    for (int k = 0; k < r->n_nodes; k++) {
        r->nodes[k].sum = r->nodes[k].source >= 0 ? J[r->nodes[k].source] : 0;
    }
    for (int k = r->n_nodes - 1; k >= 0; k--) {
        const node *at = &r->nodes[k];
        if (at->base >= 0) {
            r->nodes[at->base].sum += at->sum;
        }
        if (at->entry >= 0) {
            r->value[at->entry] = s->rates.sign[at->velocity] * at->sum * s->reach[at->velocity];
        }
    }
}

void hn_assemble_rows_fill(hn_assemble_rows *r, const double *row_unit) {
    gather(r);
    memset(r->size, 0, (size_t)r->s->nc * sizeof *r->size);
    for (int k = 0; k < r->n_entries && !row_unit; k++) {
        r->size[r->row[k]] += r->value[k] * r->value[k];
    }
    for (int k = 0; k < r->n_entries; k++) {
        const double square = r->size[r->row[k]];
        r->value[k] *= row_unit ? row_unit[r->row[k]] : (square > 0 ? 1 / sqrt(square) : 0);
    }
    hn_gram_fill(r->gram, r->value);
}

bool hn_assemble_rows_stand_apart(hn_assemble_rows *r) {
    return hn_gram_factor(r->gram, 0, HN_ROW_CHECK_DISTANCE * HN_ROW_CHECK_DISTANCE) == HN_OK;
}

void hn_assemble_rows_gradient(const hn_assemble_rows *r, const double *x, double *y) {
    hn_gram_times_transpose(r->gram, x, y);
}

void hn_assemble_rows_change(const hn_assemble_rows *r, const double *x, double *y) {
    hn_gram_times(r->gram, x, y);
}

double hn_assemble_rows_largest(const hn_assemble_rows *r) {
    return hn_gram_largest(r->gram);
}

double hn_assemble_rows_size(const hn_assemble_rows *r) {
    return hn_norm2(r->n_entries, r->value);
}

hn_status hn_assemble_rows_step(hn_assemble_rows *rows, const double *r, double mu, double *step) {
    const double tol = mu > 0 ? 0 : DEPENDENT * hn_gram_largest(rows->gram);
    HN_TRY(hn_gram_factor(rows->gram, mu, tol));
    for (int i = 0; i < rows->s->nc; i++) {
        rows->y[i] = -r[i];
    }
    hn_gram_solve(rows->gram, rows->y);
    hn_gram_times_transpose(rows->gram, rows->y, step);
    return HN_OK;
}
