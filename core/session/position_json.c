#include "session/position_json.h"

#include "dynamics/dyads.h"
#include "methods/chart.h"

#include <stdio.h>

static const char *name_of(const hn_system *sys, int coordinate) {
    const int place = hn_system_position_of(sys, coordinate);
    return place >= 0
               ? hn_graph_symbol_name(hn_system_graph(sys),
                                      hn_system_get_exprs(sys).q_symbols[place])
               : hn_system_scene(sys)->coordinates[hn_system_user_coordinate(sys, coordinate)].name;
}

static void put_names(hn_strbuf *b, const char *key, const hn_system *sys, const int *list, int n) {
    hn_json_key(b, key);
    hn_json_array(b);
    for (int i = 0; i < n; i++) {
        hn_json_string(b, name_of(sys, list[i]));
    }
    hn_json_end_array(b);
}

static void put_steps(hn_strbuf *b, const hn_system *sys, const hn_dyads *dyads) {
    hn_json_key(b, "steps");
    hn_json_array(b);
    for (int k = 0; k < hn_dyads_count(dyads); k++) {
        const hn_dyad d = hn_dyads_at(dyads, k);
        hn_json_object(b);
        hn_json_put_string(b, "kind", hn_dyad_kind_name(d.kind));
        hn_json_put_string(b, "meets", hn_dyad_kind_about(d.kind));
        put_names(b, "unknowns", sys, d.unknown, d.n);
        hn_json_key(b, "rows");
        hn_json_array(b);
        for (int i = 0; i < d.n; i++) {
            hn_json_string(b, hn_system_row_name(sys, d.row[i]));
        }
        hn_json_end_array(b);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

static void put_answer(hn_strbuf *b, const hn_dyads *dyads) {
    char text[320];
    const char *refusal = hn_dyads_refusal(dyads);
    const int n = hn_dyads_proper(dyads), single = hn_dyads_count(dyads) - n;
    if (refusal) {
        snprintf(text, sizeof text, "Newton, because %s", refusal);
    } else if (n > 0) {
        snprintf(text, sizeof text, "dyads: closed form (%d of them%s)", n,
                 single > 0 ? ", and single unknowns" : "");
    } else {
        snprintf(text, sizeof text, "closed form, one unknown after the other");
    }
    hn_json_put_string(b, "answers", text);
}

/// The chart has been located at the start.
static hn_status put_analysis(hn_strbuf *b, const hn_chart *chart, hn_arena *arena) {
    hn_dyads *dyads = NULL;
    const hn_status status = hn_dyads_create(chart->sys, chart->dep, chart->rank, arena, &dyads);
    if (status != HN_OK) {
        return status;
    }
    put_names(b, "independent", chart->sys, chart->ind, chart->r);
    put_answer(b, dyads);
    if (!hn_dyads_refusal(dyads)) {
        hn_json_put_int(b, "operations", hn_dyads_info(dyads).ops);
    }
    if (chart->nc == chart->rank) {
        const double step = hn_eval_info(chart->loop).ops +
                            hn_sparse_lu_factor_ops(chart->here.lu) +
                            hn_sparse_lu_solve_ops(chart->here.lu);
        hn_json_put_int(b, "operations_of_a_newton_step", (long long)step);
    }
    if (!hn_dyads_refusal(dyads)) {
        put_steps(b, chart->sys, dyads);
    }
    hn_dyads_free(dyads);
    return HN_OK;
}

hn_status hn_position_put(hn_strbuf *b, const hn_model *model) {
    const hn_system *sys = hn_model_system(model);
    hn_arena *arena = hn_arena_create(0);
    hn_chart chart = {0};
    hn_status status = arena ? hn_chart_init(&chart, sys, 1, arena, NULL) : HN_ERR_MEMORY;
    if (status == HN_OK) {
        hn_json_key(b, "position_analysis");
        hn_json_object(b);
        chart.plain_only = 1;
        const double *q = hn_model_q(model);
        const int has = hn_chart_choose(&chart, 0, q, HN_CHART_PREFERRED) == HN_OK &&
                        hn_chart_locate(&chart, &chart.here, 0, q) == HN_OK;
        if (!has) {
            char text[HN_CHART_TEXT + 16];
            snprintf(text, sizeof text, "none: %s", chart.why);
            hn_json_put_string(b, "answers", text);
        } else if (chart.nc == 0) {
            hn_json_put_string(b, "answers", "none: there are no loops to close");
        } else {
            status = put_analysis(b, &chart, arena);
        }
        hn_json_end_object(b);
    }
    hn_chart_destroy(&chart);
    hn_arena_free(arena);
    return status;
}
