// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/exercise_panel.h"

#include "terminal/keys.h"
#include "tui/best_scores.h"
#include "tui/text_panel.h"

#include <stdio.h>
#include <string.h>

/// Writes the text anew; `reveal`: the chosen field comes into sight.
static void write_text(hn_workbench *w, bool reveal) {
    int first = 0, last = 0;
    hn_strbuf_clear(&w->text);
    hn_tui_exercise_text(w->exercise, w->cursor, &w->text, &first, &w->marked, &last);
    if (reveal) {
        hn_text_panel_reveal(w, first, last);
    }
}

void hn_exercise_panel_open(hn_workbench *w, const char *id) {
    hn_diags diags = {0};
    const bool same = w->exercise && strcmp(hn_tui_exercise_id(w->exercise), id) == 0;
    hn_tui_exercise *fresh = NULL;
    if (!same && hn_tui_exercise_create(w->library, id, &fresh, &diags) != HN_OK) {
        hn_workbench_say_fault(w, &diags);
        return;
    }
    if (!same) {
        hn_tui_exercise_free(w->exercise);
        w->exercise = fresh;
    }
    hn_text_panel_open(w, "exercise: Enter types an answer, c checks, Esc goes back");
    w->panel = HN_PANEL_EXERCISE;
    w->cursor = 0;
    write_text(w, false);
}

static void check(hn_workbench *w) {
    hn_diag diag = {0};
    const hn_status status = hn_tui_exercise_check(w->exercise, &diag);
    if (status != HN_OK) {
        hn_workbench_say(w, "not checked: %s",
                         diag.message[0] ? diag.message : hn_status_text(status));
        return;
    }
    const hn_verdict *v = hn_tui_exercise_verdict(w->exercise);
    write_text(w, true);
    if (v->kind == HN_VERDICT_GRADED) {
        const char *id = hn_tui_exercise_id(w->exercise);
        const bool kept = hn_best_scores_keep(id, v->score, v->max_score, &diag) == HN_OK;
        char summary[HN_GRADE_TEXT];
        hn_tui_exercise_summary(w->exercise, summary);
        hn_workbench_say(w, "%g of %g points: %s%s%s", v->score, v->max_score, summary,
                         kept ? "" : "; this score is not kept: ", kept ? "" : diag.message);
    } else {
        hn_workbench_say(w, "not graded: %s%s%s", v->reason, v->hint[0] ? "; " : "", v->hint);
    }
}

static void show_hint(hn_workbench *w) {
    const int n = hn_tui_exercise_n_hints(w->exercise);
    if (hn_tui_exercise_show_hint(w->exercise)) {
        write_text(w, false);
        hn_text_panel_scroll(w, 1 << 20); // hints are at the end
    } else if (n == 0) {
        hn_workbench_say(w, "this exercise has no hints");
    } else {
        hn_workbench_say(w, "%s%d hint%s shown", n > 1 ? "all " : "", n, n == 1 ? " is" : "s are");
    }
}

static void type_answer(hn_workbench *w) {
    hn_workbench_ask(w, HN_PROMPT_ANSWER, hn_tui_exercise_answer(w->exercise, w->cursor));
}

void hn_exercise_panel_accept(hn_workbench *w) {
    const int n = hn_tui_exercise_n_fields(w->exercise);
    char why[HN_GRADE_TEXT];
    hn_tui_exercise_set_answer(w->exercise, w->cursor, w->input);
    if (hn_tui_exercise_is_unreadable(w->exercise, w->cursor, why)) {
        hn_workbench_say(w, "%s: %s", hn_tui_exercise_field(w->exercise, w->cursor), why);
        write_text(w, true);
        return; // to be put right
    }

    // on to the next field, as a form does
    w->cursor = w->cursor + 1 < n ? w->cursor + 1 : w->cursor;
    write_text(w, true);
}

void hn_exercise_panel_key(hn_workbench *w, int key) {
    const int n = hn_tui_exercise_n_fields(w->exercise);
    const int by = (key == HN_KEY_DOWN) - (key == HN_KEY_UP);
    if (by != 0) {
        w->cursor = w->cursor + by < 0 ? 0 : w->cursor + by >= n ? n - 1 : w->cursor + by;
        write_text(w, true);
    } else if (key == HN_KEY_ENTER && n > 0) {
        type_answer(w);
    } else if (key == 'c') {
        check(w);
    } else if (key == 'h') {
        show_hint(w);
    } else {
        hn_text_panel_key(w, key);
    }
}
