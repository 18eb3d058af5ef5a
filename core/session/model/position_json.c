// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/position_json.h"

#include "session/model/position_form.h"

static void put_names(hn_strbuf *b, const char *key, const hn_system *sys, const int *list, int n) {
    hn_json_key(b, key);
    hn_json_array(b);
    for (int i = 0; i < n; i++) {
        hn_json_string(b, hn_position_name(sys, list[i]));
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

static void put_analysis(hn_strbuf *b, const hn_position_form *f) {
    const hn_chart *chart = &f->chart;
    const int serves = !hn_dyads_refusal(f->dyads);
    if (serves) {
        hn_json_put_int(b, "operations", hn_dyads_info(f->dyads).ops);
    }
    if (chart->nc == chart->rank) {
        const double step = hn_eval_info(chart->loop).ops +
                            hn_sparse_lu_factor_ops(chart->here.lu) +
                            hn_sparse_lu_solve_ops(chart->here.lu);
        hn_json_put_int(b, "operations_of_a_newton_step", (long long)step);
    }
    if (serves) {
        put_steps(b, chart->sys, f->dyads);
    }
}

hn_status hn_position_put(hn_strbuf *b, const hn_model *model) {
    char answer[HN_CHART_TEXT + 80];
    hn_position_form f;
    const hn_status status = hn_position_form_create(model, NULL, &f);
    if (status == HN_OK) {
        hn_json_key(b, "position_analysis");
        hn_json_object(b);
        if (f.dyads) {
            put_names(b, "independent", f.chart.sys, f.chart.ind, f.chart.r);
        }
        hn_position_answer(&f, answer, sizeof answer);
        hn_json_put_string(b, "answers", answer);
        if (f.dyads) {
            put_analysis(b, &f);
        }
        hn_json_end_object(b);
    }
    hn_position_form_free(&f);
    return status;
}
