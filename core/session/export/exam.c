// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export/exam.h"

#include "base/clock.h"
#include "dynamics/compile/compile.h"
#include "dynamics/evaluate/eval.h"
#include "expr/angles.h"
#include "expr/diff.h"
#include "session/export/states.h"

#include <string.h>

static const struct {
    const char *name;
    hn_term term;
} PARTS[HN_EXPORT_PARTS] = {
    {"mass", HN_TERM_M}, {"force", HN_TERM_F}, {"jacobian", HN_TERM_J}, {"bias", HN_TERM_GAMMA}};

const char *hn_export_part_name(hn_export_part part) {
    return PARTS[part].name;
}

const hn_ex *hn_export_exam_entry(const hn_export_exam *exam, hn_export_part part) {
    const hn_exporter *e = &exam->e;
    const hn_ex *const parts[HN_EXPORT_PARTS] = {e->M, e->x.f, e->J, e->x.gamma};
    return parts[part];
}

static const double *copy(hn_arena *arena, const double *x, int n) {
    double *own = hn_arena_doubles(arena, (size_t)n + 1);
    if (own && n > 0) {
        memcpy(own, x, (size_t)n * sizeof *x);
    }
    return own;
}

/// Evaluates every part at a state, and the force at rest.
static void ask(hn_export_exam *exam, hn_eval *eval, const hn_export_state *at,
                hn_export_question *out) {
    out->t = at->t;
    out->q = copy(exam->arena, at->q, exam->nq);
    out->v = copy(exam->arena, at->v, exam->nv);
    hn_eval_run(eval, at->t, at->q, at->v);
    for (int part = 0; part < HN_EXPORT_PARTS; part++) {
        out->answer[part] =
            copy(exam->arena, hn_eval_get(eval, PARTS[part].term), exam->size[part]);
    }
    hn_eval_run(eval, at->t, at->q, NULL);
    out->still = copy(exam->arena, hn_eval_get(eval, HN_TERM_F), exam->nv);
}

void hn_export_exam_symbols(const hn_export_exam *exam, int k, double *x) {
    const hn_exporter *e = &exam->e;
    const hn_export_question *at = &exam->question[k];
    const hn_scene *scene = hn_model_scene(e->model);
    for (int i = 0; i < scene->n_params; i++) {
        const int symbol = hn_graph_find_symbol(hn_system_graph(e->sys), scene->params[i].name);
        if (symbol >= 0) {
            x[symbol] = scene->params[i].value;
        }
    }
    for (int i = 0; i < e->info.nq; i++) {
        x[e->x.q_symbols[i]] = at->q[i];
    }
    for (int i = 0; i < e->info.nv; i++) {
        x[e->x.v_symbols[i]] = at->v[i];
    }
    if (e->x.t_symbol >= 0) {
        x[e->x.t_symbol] = at->t;
    }
}

/// Splits each entry of the parts into its terms, and evaluates them at every state.
static hn_status split_entries(hn_export_exam *exam) {
    const hn_exporter *e = &exam->e;
    hn_graph *g = hn_system_graph(e->sys);
    double *x = hn_arena_doubles(exam->arena, (size_t)hn_graph_n_symbols(g) + 1);
    for (int part = 0; part < HN_EXPORT_PARTS; part++) {
        const size_t bytes = ((size_t)exam->size[part] + 1) * sizeof(hn_export_sum);
        exam->sum[part] = hn_arena_get(exam->arena, bytes);
        if (!x || !exam->sum[part]) {
            return HN_ERR_MEMORY;
        }
        for (int i = 0; i < exam->size[part]; i++) {
            hn_export_sum *sum = &exam->sum[part][i];
            sum->n = hn_angles_terms(g, hn_export_exam_entry(exam, (hn_export_part)part)[i],
                                     sum->term, HN_EXPORT_EXAM_TERMS);
            for (int k = 0; k < HN_EXPORT_EXAM_STATES; k++) {
                hn_export_exam_symbols(exam, k, x);
                for (int m = 0; m < sum->n; m++) {
                    sum->t[m][k] = hn_graph_eval(g, sum->term[m], x);
                }
            }
        }
    }
    return hn_graph_failed(g) ? HN_ERR_MEMORY : HN_OK;
}

static hn_status ask_all(hn_export_exam *exam, hn_diags *diags) {
    hn_exporter *e = &exam->e;
    hn_eval *eval = NULL;
    const int nv = e->info.nv, nc = e->info.nc;
    exam->nq = e->info.nq;
    exam->nv = nv;
    exam->nc = nc;
    const int sizes[HN_EXPORT_PARTS] = {nv * nv, nv, nc * nv, nc};
    const int columns[HN_EXPORT_PARTS] = {nv, 0, nv, 0};
    memcpy(exam->size, sizes, sizeof sizes);
    memcpy(exam->columns, columns, sizeof columns);

    // the start, and states on the way to the later one
    HN_TRY(hn_eval_create(e->sys, HN_TERM_M | HN_TERM_F | HN_TERM_J | HN_TERM_GAMMA, exam->arena,
                          &eval));
    hn_status status = HN_OK;
    for (int k = 0; k < HN_EXPORT_EXAM_STATES && status == HN_OK; k++) {
        hn_export_state at = e->start;
        if (k > 0) {
            const double t = e->later.t * k / (HN_EXPORT_EXAM_STATES - 1);
            status = hn_export_state_at(e, t, &at, diags);
        }
        if (status == HN_OK) {
            ask(exam, eval, &at, &exam->question[k]);
        }
    }
    hn_eval_free(eval);
    HN_THEN(status, split_entries(exam));
    return status == HN_OK && hn_arena_failed(exam->arena) ? HN_ERR_MEMORY : status;
}

hn_status hn_export_exam_init(hn_export_exam *exam, const hn_model *model,
                              const hn_walk_limits *limits, hn_diags *diags) {
    *exam = (hn_export_exam){.arena = hn_arena_create(0)};
    exam->e = (hn_exporter){.model = model,
                            .arena = exam->arena,
                            .limits = limits ? *limits : (hn_walk_limits){0},
                            .started = hn_clock_thread()};
    if (!exam->arena) {
        return HN_ERR_MEMORY;
    }
    const hn_status status = hn_export_states_find(&exam->e, diags);
    return status == HN_OK ? ask_all(exam, diags) : status;
}

void hn_export_exam_reset(hn_export_exam *exam) {
    hn_system_free(exam->e.sys);
    hn_arena_free(exam->arena);
    *exam = (hn_export_exam){0};
}
