// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/study/report_text.h"

#include "cli/shell/table.h"
#include "session/report/report_words.h"

#include <math.h>
#include <stdio.h>

static void put_answers(hn_strbuf *b, const hn_report *r) {
    static const char *const heads[HN_REPORT_BANDS] = {"1e-3", "1e-6", "1e-9"};
    hn_table t;
    hn_table_init(&t);

    // columns: a method and its cost for each accuracy
    hn_table_column(&t, "cheapest for an error of", 0);
    for (int i = 0; i < HN_REPORT_BANDS; i++) {
        hn_table_column(&t, heads[i], 0);
        hn_table_column(&t, "", 1);
    }

    // a line for each scene; a scene without a study has dashes
    for (int i = 0; i < hn_report_n_scenes(r); i++) {
        const hn_report_scene *s = hn_report_scene_at(r, i);
        hn_table_cell(&t, "%s", hn_report_scene_id(s));
        for (int k = 0; k < HN_REPORT_BANDS; k++) {
            const hn_report_answer a = s->study
                                           ? hn_report_find_answer(s, hn_report_accuracy[k])
                                           : (hn_report_answer){-1, (double)NAN, HN_COST_OPS, 0};
            hn_table_cell(&t, "%s",
                          a.method < 0 ? "-" : hn_study_wp(s->study)->methods[a.method].spelling);
            hn_table_quantity(&t, a.cost, a.by == HN_COST_TIME ? "s" : "op");
        }
    }

    hn_table_write(b, &t);
    hn_table_reset(&t);
}

/// Writes a table with a line for each method and a column for each scene, as many as a table can
/// have; the other scenes are in the files.
static void put_verdicts(hn_strbuf *b, const hn_report *r, const hn_study *any) {
    int left = 0;
    hn_table t;
    hn_table_init(&t);

    // columns: the scenes that fit
    hn_table_column(&t, "smallest error of the coordinates", 0);
    const int n =
        hn_report_n_scenes(r) < HN_TABLE_COLUMNS - 1 ? hn_report_n_scenes(r) : HN_TABLE_COLUMNS - 1;
    for (int i = 0; i < n; i++) {
        hn_table_column(&t, hn_report_scene_id(hn_report_scene_at(r, i)), 0);
    }

    // a line for each method
    for (int m = 0; m < hn_study_wp(any)->n_methods; m++) {
        hn_table_cell(&t, "%s", hn_study_wp(any)->methods[m].spelling);
        for (int i = 0; i < n; i++) {
            const hn_report_scene *s = hn_report_scene_at(r, i);
            if (!s->study) {
                hn_table_cell(&t, "-");
                continue;
            }

            // the verdict, with the number of sizes left out
            const hn_verdict v = hn_report_find_verdict(s, m);
            if (v.skipped > 0 && v.done > 0) {
                hn_table_cell(&t, "%s (%d left)", v.text, v.skipped);
                left = 1;
            } else {
                hn_table_cell(&t, "%s", v.text);
            }
        }
    }

    hn_strbuf_add(b, "\n");
    hn_table_write(b, &t);
    hn_table_reset(&t);

    // explain the mark
    if (left) {
        hn_strbuf_add(b, "(1 left): one finer size was not run, to keep the time limit\n");
    }
}

static void put_survival(hn_strbuf *b, const hn_report_scene *s) {
    hn_strbuf_printf(b, "\n%s: step sizes that survive the singular configurations\n",
                     hn_report_scene_id(s));
    for (int m = 0; m < hn_study_wp(s->study)->n_methods; m++) {
        hn_strbuf_printf(b, "  %-24s %2d of %d\n", hn_study_wp(s->study)->methods[m].spelling,
                         hn_strip_survived(&s->strips[m]), s->strips[m].n);
    }
}

void hn_report_text(hn_strbuf *b, const hn_report *r) {
    const hn_study *any = hn_report_any_study(r);
    hn_report_sentences(b, r);
    hn_strbuf_add(b, any ? "\n" : "");
    put_answers(b, r);
    if (any) {
        put_verdicts(b, r, any);
    }
    for (int i = 0; i < hn_report_n_scenes(r); i++) {
        const hn_report_scene *s = hn_report_scene_at(r, i);
        if (!s->study) {
            hn_strbuf_printf(b, "\n%s: %s\n", hn_report_scene_id(s), s->reason);
        } else if (s->strips) {
            put_survival(b, s);
        }
    }
}
