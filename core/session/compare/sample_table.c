// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/compare/sample_table.h"

#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "session/model/reactions_json.h"
#include "session/store/columns_json.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

struct hn_sample_table {
    hn_arena *arena; ///< owns the table and its columns
    const hn_model *model;
    const hn_system *sys;
    int n_user, nc;
    long long n, cap;
    double *t, *q, *v, *lambda, *gap, *velocity_gap, *energy, *work, *energy_change;
    double *mark;                  ///< hn_multiplier_mark of a sample
    hn_drawing drawing;            ///< its labelled points are columns too
    int n_points;                  ///< number of labelled points
    double *points;                ///< 3 per point, world [m]
    double *raw_lambda;            ///< NULL: not asked for, or the method has none
    hn_reaction_writer *reactions; ///< NULL: not asked for
    double *force, *moment;        ///< 3 per carrier
    double *effort;                ///< one per effort
    double *state;                 ///< q and v of a sample in system coordinates
    double *flat;                  ///< one row of all columns
};

/// Makes the columns that every run has.
static hn_status make_columns(hn_sample_table *tab, const hn_sample_columns *columns,
                              hn_diags *diags) {
    // numbers per sample decide whether the table may be built
    const double width =
        7 + 2.0 * tab->n_user + (columns->raw_lambda ? 2.0 : 1.0) * tab->nc + 3.0 * tab->n_points;
    if (width * (double)tab->cap > (double)columns->max_numbers) {
        return hn_diags_add(
            diags, HN_ERR_LIMIT, "/every", "ask for fewer output times",
            "%lld samples of %g numbers are more than one answer may hold (%lld numbers)", tab->cap,
            width, columns->max_numbers);
    }

    const size_t n = (size_t)tab->cap, n_user = (size_t)tab->n_user, nc = (size_t)tab->nc;
    tab->t = hn_arena_doubles(tab->arena, n);
    tab->q = hn_arena_doubles(tab->arena, n * n_user);
    tab->v = hn_arena_doubles(tab->arena, n * n_user);
    tab->lambda = hn_arena_doubles(tab->arena, n * nc);
    tab->mark = hn_arena_doubles(tab->arena, n);
    tab->points = hn_arena_doubles(tab->arena, 3 * n * (size_t)tab->n_points + 1);
    tab->raw_lambda = columns->raw_lambda ? hn_arena_doubles(tab->arena, n * nc) : NULL;
    tab->gap = hn_arena_doubles(tab->arena, n);
    tab->velocity_gap = hn_arena_doubles(tab->arena, n);
    tab->energy = hn_arena_doubles(tab->arena, n);
    tab->work = hn_arena_doubles(tab->arena, n);
    tab->energy_change = hn_arena_doubles(tab->arena, n);
    return hn_arena_failed(tab->arena) ? HN_ERR_MEMORY : HN_OK;
}

/// Makes the columns of reactions and efforts.
static hn_status make_reactions(hn_sample_table *tab, const hn_sample_columns *columns,
                                hn_diags *diags) {
    const hn_system_info info = hn_system_get_info(tab->sys);
    HN_TRY(hn_reaction_writer_create(tab->model, tab->arena, &tab->reactions, diags));
    const int carriers = hn_reaction_writer_count(tab->reactions),
              efforts = hn_reaction_writer_efforts(tab->reactions);
    if ((double)tab->cap * (6.0 * carriers + efforts) > (double)columns->max_numbers) {
        return hn_diags_add(diags, HN_ERR_LIMIT, "/reactions", "ask for fewer output times",
                            "%lld samples of %d reactions are more than one answer may hold",
                            tab->cap, carriers + efforts);
    }
    const size_t n = 3 * (size_t)tab->cap * (size_t)carriers;
    tab->force = hn_arena_doubles(tab->arena, n + 1);
    tab->moment = hn_arena_doubles(tab->arena, n + 1);
    tab->effort = hn_arena_doubles(tab->arena, (size_t)tab->cap * (size_t)efforts + 1);
    tab->state = hn_arena_doubles(tab->arena, (size_t)info.nq + (size_t)info.nv + 1);
    return hn_arena_failed(tab->arena) ? HN_ERR_MEMORY : HN_OK;
}

/// Makes room for one row of all columns.
static hn_status make_row(hn_sample_table *tab) {
    size_t width = 8 + 2 * (size_t)tab->n_user + 2 * (size_t)tab->nc + 3 * (size_t)tab->n_points;
    if (tab->reactions) {
        width += 6 * (size_t)hn_reaction_writer_count(tab->reactions) +
                 (size_t)hn_reaction_writer_efforts(tab->reactions);
    }
    tab->flat = hn_arena_doubles(tab->arena, width);
    return tab->flat ? HN_OK : HN_ERR_MEMORY;
}

hn_status hn_sample_table_create(const hn_model *model, long long cap,
                                 const hn_sample_columns *columns, hn_sample_table **out,
                                 hn_diags *diags) {
    hn_arena *arena = hn_arena_create(0);
    hn_sample_table *tab = arena ? hn_arena_get(arena, sizeof *tab) : NULL;
    if (!tab) {
        hn_arena_free(arena);
        return HN_ERR_MEMORY;
    }
    const hn_system *sys = hn_model_system(model);
    const hn_system_info info = hn_system_get_info(sys);
    *tab = (hn_sample_table){.arena = arena,
                             .model = model,
                             .sys = sys,
                             .n_user = info.n_user,
                             .nc = info.nc,
                             .cap = cap,
                             .drawing = hn_system_drawing(sys)};
    for (int i = 0; i < tab->drawing.n_points; i++) {
        tab->n_points += tab->drawing.labels[i] != NULL;
    }

    hn_status status = make_columns(tab, columns, diags);
    if (status == HN_OK && columns->reactions) {
        status = make_reactions(tab, columns, diags);
    }
    HN_THEN(status, make_row(tab));
    if (status != HN_OK) {
        hn_sample_table_free(tab);
        return status;
    }
    *out = tab;
    return HN_OK;
}

void hn_sample_table_free(hn_sample_table *tab) {
    if (tab) {
        hn_reaction_writer_free(tab->reactions);
        hn_arena_free(tab->arena);
    }
}

/// Adds the reactions of a sample; null where the accelerations cannot be computed.
static void add_reactions(hn_sample_table *tab, const hn_sample *s, size_t k) {
    const size_t n = 3 * (size_t)hn_reaction_writer_count(tab->reactions),
                 n_efforts = (size_t)hn_reaction_writer_efforts(tab->reactions);
    double *q = tab->state, *v = tab->state + hn_system_get_info(tab->sys).nq;
    double *effort = tab->effort + k * n_efforts;
    hn_system_from_user(tab->sys, s->q, q);
    hn_system_rates_from_user(tab->sys, s->v, v);
    if (hn_reaction_writer_eval(tab->reactions, s->t, q, v) == HN_OK) {
        hn_reaction_writer_rows(tab->reactions, tab->force + k * n, tab->moment + k * n, effort);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        tab->force[k * n + i] = tab->moment[k * n + i] = nan("");
    }
    for (size_t i = 0; i < n_efforts; i++) {
        effort[i] = nan("");
    }
}

static void add_points(hn_sample_table *tab, const hn_sample *s, size_t k) {
    double *to = tab->points + 3 * k * (size_t)tab->n_points;
    for (int i = 0; i < tab->drawing.n_points; i++) {
        if (tab->drawing.labels[i]) {
            memcpy(to, s->points + 3 * i, 3 * sizeof *to);
            to += 3;
        }
    }
}

void hn_sample_table_add(hn_sample_table *tab, const hn_sample *s, int mark) {
    // the state, and the multipliers with the mark of how far they are determined
    const size_t k = (size_t)tab->n++, nq = (size_t)tab->n_user, nc = (size_t)tab->nc;
    tab->t[k] = s->t;
    memcpy(tab->q + k * nq, s->q, nq * sizeof(double));
    memcpy(tab->v + k * nq, s->v, nq * sizeof(double));
    if (nc > 0) {
        memcpy(tab->lambda + k * nc, s->lambda, nc * sizeof(double));
        tab->mark[k] = mark;
    }
    for (size_t i = 0; tab->raw_lambda && i < nc; i++) {
        tab->raw_lambda[k * nc + i] = s->raw_lambda ? s->raw_lambda[i] : nan(""); // written as null
    }

    // what was asked for besides, and the error measures
    if (tab->reactions) {
        add_reactions(tab, s, k);
    }
    add_points(tab, s, k);
    tab->gap[k] = s->gap;
    tab->velocity_gap[k] = s->velocity_gap;
    tab->energy[k] = s->energy;
    tab->work[k] = s->work;
    tab->energy_change[k] = s->energy_change;
}

bool hn_sample_table_has_room(const hn_sample_table *tab) {
    return tab->n < tab->cap;
}

long long hn_sample_table_count(const hn_sample_table *tab) {
    return tab->n;
}

double hn_sample_table_last_time(const hn_sample_table *tab) {
    return tab->n > 0 ? tab->t[tab->n - 1] : 0;
}

static double *append(double *to, const double *values, size_t k, size_t width) {
    if (values) {
        memcpy(to, values + k * width, width * sizeof *to);
    }
    return values ? to + width : to;
}

int hn_sample_table_row(const hn_sample_table *tab, const double **values) {
    const size_t k = (size_t)tab->n - 1;
    const size_t nq = (size_t)tab->n_user, nc = (size_t)tab->nc;
    const size_t carriers =
        tab->reactions ? 3 * (size_t)hn_reaction_writer_count(tab->reactions) : 0;
    const size_t efforts = tab->reactions ? (size_t)hn_reaction_writer_efforts(tab->reactions) : 0;

    // the columns in their order; a part without values has no column
    const struct {
        const double *values;
        size_t width;
    } parts[] = {{tab->t, 1},
                 {tab->q, nq},
                 {tab->v, nq},
                 {tab->lambda, nc},
                 {tab->raw_lambda, nc},
                 {nc > 0 ? tab->mark : NULL, 1},
                 {tab->force, carriers},
                 {tab->moment, carriers},
                 {tab->effort, efforts},
                 {tab->points, 3 * (size_t)tab->n_points},
                 {tab->gap, 1},
                 {tab->velocity_gap, 1},
                 {tab->energy, 1},
                 {tab->work, 1},
                 {tab->energy_change, 1}};

    double *to = tab->flat;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        to = append(to, parts[i].values, k, parts[i].width);
    }
    *values = tab->flat;
    return (int)(to - tab->flat);
}

void hn_sample_table_put(hn_strbuf *b, const hn_sample_table *tab) {
    hn_json_key(b, "samples");
    hn_json_object(b);

    // state and multipliers
    hn_json_put_numbers(b, "t", tab->t, (size_t)tab->n);
    hn_columns_put_table(b, "q", tab->q, tab->n, tab->n_user);
    hn_columns_put_table(b, "v", tab->v, tab->n, tab->n_user);
    hn_columns_put_table(b, "lambda", tab->lambda, tab->n, tab->nc);
    if (tab->nc > 0) {
        hn_json_put_numbers(b, "lambda_mark", tab->mark, (size_t)tab->n);
    }
    if (tab->raw_lambda) {
        hn_columns_put_table(b, "raw_lambda", tab->raw_lambda, tab->n, tab->nc);
    }

    // reactions, where they were asked for
    if (tab->reactions) {
        const int width = 3 * hn_reaction_writer_count(tab->reactions);
        hn_columns_put_table(b, "reaction_force", tab->force, tab->n, width);
        hn_columns_put_table(b, "reaction_moment", tab->moment, tab->n, width);
        hn_columns_put_table(b, "effort", tab->effort, tab->n,
                             hn_reaction_writer_efforts(tab->reactions));
    }

    // positions and error measures
    hn_columns_put_table(b, "points", tab->points, tab->n, 3 * tab->n_points);
    hn_json_put_numbers(b, "gap", tab->gap, (size_t)tab->n);
    hn_json_put_numbers(b, "velocity_gap", tab->velocity_gap, (size_t)tab->n);
    hn_json_put_numbers(b, "energy", tab->energy, (size_t)tab->n);
    hn_json_put_numbers(b, "work", tab->work, (size_t)tab->n);
    hn_json_put_numbers(b, "energy_change", tab->energy_change, (size_t)tab->n);
    hn_json_end_object(b);
}

void hn_sample_table_put_names(hn_strbuf *b, const hn_sample_table *tab) {
    hn_columns_put_coordinates(b, tab->sys);
    hn_columns_put_rates(b, tab->sys);
    hn_columns_put_rows(b, tab->sys);
    hn_json_key(b, "points");
    hn_json_array(b);
    for (int i = 0; i < tab->drawing.n_points; i++) {
        if (tab->drawing.labels[i]) {
            hn_json_string(b, tab->drawing.labels[i]);
        }
    }
    hn_json_end_array(b);
    hn_json_key(b, "lambda_marks");
    hn_json_strings(b, hn_multiplier_marks, HN_N_MULTIPLIER_MARKS);
    if (tab->reactions) {
        hn_reaction_writer_names(b, tab->reactions);
    }
}

void hn_sample_table_put_marks(hn_strbuf *b, const hn_sample_table *tab) {
    hn_json_key(b, "samples");
    hn_json_object(b);
    if (tab->nc > 0) {
        hn_json_put_numbers(b, "lambda_mark", tab->mark, (size_t)tab->n);
    }
    hn_json_end_object(b);
}
