// SPDX-License-Identifier: GPL-3.0-or-later
// holonom extreme [ID...]: cases in which methods break, predicted and observed.
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/progress.h"
#include "cli/study/study.h"
#include "session/extreme/extreme.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void show_progress(void *user, const char *id, double share) {
    char what[40];
    snprintf(what, sizeof what, "extreme %.20s", id);
    hn_progress_tell(user, what, share);
}

// the table for people -----------------------------------------------------------------------------------------------

enum { WHAT = 58, PREDICTED = 32, OBSERVED = 40 };

/// How many bytes of text fit into so many columns, broken at a blank where there is one.
static size_t fit(const char *text, int columns) {
    size_t n = 0, blank = 0;
    for (int used = 0; text[n] && used < columns; used++) {
        blank = text[n] == ' ' ? n : blank;
        n++;
        while ((text[n] & 0xC0) == 0x80) {
            n++;
        }
    }
    return !text[n] || blank == 0 ? n : blank;
}

static int columns_of(const char *text, size_t n) {
    int columns = 0;
    for (size_t i = 0; i < n; i++) {
        columns += (text[i] & 0xC0) != 0x80;
    }
    return columns;
}

/// Puts what fits of *text, padded, and moves it on.
static void put_part(hn_strbuf *b, const char **text, int columns) {
    const size_t n = fit(*text, columns);
    hn_strbuf_printf(b, "%.*s%*s", (int)n, *text, columns - columns_of(*text, n) + 2, "");
    *text += n;
    *text += strspn(*text, " ");
}

static void put_row(hn_strbuf *b, const char *what, const char *predicted, const char *observed,
                    const char *verdict) {
    do {
        hn_strbuf_add(b, "  ");
        put_part(b, &what, WHAT);
        put_part(b, &predicted, PREDICTED);
        put_part(b, &observed, OBSERVED);
        hn_strbuf_add(b, verdict);
        verdict = "";
        while (b->n > 0 && b->text[b->n - 1] == ' ') {
            b->text[--b->n] = 0;
        }
        hn_strbuf_add(b, "\n");
    } while (*what || *predicted || *observed);
}

static void put_case(hn_strbuf *b, const hn_extreme_case *c) {
    hn_strbuf_printf(b, "%-4s %s (%s)\n", c->id, c->title, hn_extreme_verdict_name(c->verdict));
    for (int k = 0; k < c->n_trials; k++) {
        const hn_extreme_trial *t = &c->trials[k];
        put_row(b, t->what, t->expect.text, t->observed, hn_extreme_verdict_name(t->verdict));
        if (t->expect.was) {
            hn_strbuf_printf(b, "    corrected; before: %s\n", t->expect.was);
        }
        for (int i = 0; i < t->n_seen && t->verdict != HN_EXTREME_PASS && t->n_seen > 1; i++) {
            const hn_extreme_seen *s = &t->seen[i];
            hn_strbuf_printf(b, "    %s on %s: ", s->method, s->scene);
            if (t->expect.word) {
                hn_strbuf_printf(b, "%s %s\n", s->word, s->reason);
            } else {
                hn_strbuf_printf(b, "%.6g %s\n", s->value, s->reason);
            }
        }
    }
    hn_strbuf_add(b, "\n");
}

static void put_table(hn_strbuf *b, const hn_extreme *x) {
    put_row(b, "what", "predicted", "observed", "verdict");
    hn_strbuf_add(b, "\n");
    for (int i = 0; i < x->n_cases; i++) {
        put_case(b, &x->cases[i]);
    }
    for (int v = 0, first = 1; v < HN_EXTREME_VERDICTS; v++) {
        const hn_extreme_verdict verdict = (hn_extreme_verdict)v;
        const int n = hn_extreme_count(x, verdict);
        if (n > 0) {
            hn_strbuf_printf(b, "%s%d %s", first ? "" : ", ", n, hn_extreme_verdict_name(verdict));
            first = 0;
        }
    }
    hn_strbuf_printf(b, "; %d cases\n", x->n_cases);
}

// the command --------------------------------------------------------------------------------------------------------

HN_FORM(html, hn_extreme, hn_extreme_html)
HN_FORM(json, hn_extreme, hn_extreme_json)
HN_FORM(csv, hn_extreme, hn_extreme_csv)
HN_FORM(text, hn_extreme, put_table)
static const hn_forms FORMS = {{{".html", put_html}, {".json", put_json}, {".csv", put_csv}},
                               put_text};

static hn_status check_args(const hn_args *args, hn_diags *diags) {
    const hn_status status = hn_forms_check(&FORMS, args, diags);
    return status == HN_OK && args->budget < 0
               ? hn_diags_add(diags, HN_ERR_INPUT, "/budget", NULL, "a budget is not negative")
               : status;
}

static hn_status load(const hn_library *lib, const hn_args *args, const char *folder,
                      hn_extreme **out, hn_diags *diags) {
    hn_status status = check_args(args, diags);
    if (status == HN_OK) {
        status = hn_extreme_load(lib, args->words.word, args->words.n, out, diags);
    }
    if (status == HN_OK && folder) {
        status = hn_extreme_resume(*out, folder, diags);
    }
    return status;
}

hn_exit hn_command_extreme(const hn_library *lib, const hn_args *args) {
    char place[400];
    const char *folder = hn_study_folder(args, place);
    hn_extreme *x = NULL;
    hn_diags diags = {0};
    hn_progress progress = {0};
    const hn_status status = load(lib, args, folder, &x, &diags);
    if (status != HN_OK) {
        hn_extreme_free(x);
        return hn_report_diags(args, status, &diags);
    }
    const hn_extreme_opts opts = {.budget = isnan(args->budget) ? 0 : args->budget,
                                  .run_long = args->run_long,
                                  .user = &progress,
                                  .stop = hn_is_interrupted,
                                  .progress = show_progress};
    hn_study_tell_resumed(args, x->resumed, "trials");
    hn_interrupt_begin();
    hn_extreme_run(x, &opts);
    hn_interrupt_end();
    hn_progress_end(&progress);
    hn_study_tell_end(x->stopped, x->out_of_time, opts.budget, "trials", folder);
    hn_exit result = hn_forms_write(&FORMS, args, x);
    const int whole = hn_extreme_count(x, HN_EXTREME_FAIL) == 0 && !x->stopped;
    if (result == HN_EXIT_DONE && !whole) {
        result = HN_EXIT_ENDED;
    }
    hn_extreme_free(x);
    return result;
}
